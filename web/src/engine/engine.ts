import type {
  DiagnosticMessage,
  OptimizeOffer,
  OptimizeRequest,
  VariableSetting,
  ToleranceOffer,
  ToleranceRequest,
} from './protocol'
import type { Table } from '../payload'

export type {
  DiagnosticMessage as Diagnostic,
  OptimizeOffer,
  OptimizeRequest,
  SearchGoal,
  SearchVariable,
  ToleranceOffer,
  ToleranceRequest,
} from './protocol'

/** Reads and checks a text. */
export interface Checker {
  check(text: string): Promise<DiagnosticMessage[]>
}

export type ProgressListener = (
  done: number,
  total: number | null,
  line: string,
  change: VariableSetting[] | null,
) => void

/** A study under way in a worker of its own. */
export interface Running<T> {
  /** Calls back with the work done, the total if known, a line of text, and the best design so far. */
  onProgress(listener: ProgressListener): void
  /** Ends it soon; the result is then the best so far. */
  cancel(): void
  /** Rejected where there is nothing to show at all. */
  readonly result: Promise<T>
}

/** Result of a study. */
export interface StudyResult {
  tables: Table[]
  /** The optimised design, as changes from the studied text; null if none is better. */
  change: VariableSetting[] | null
  /** The text with the design found, its comments kept. */
  text: string | null
  /** Sentence about its end. */
  message: string
}

/** The studies of a text, each in a worker of its own. */
export interface Studies {
  /** Options of an optimisation of the text. */
  optimizeOffer(text: string): Promise<OptimizeOffer>
  optimize(text: string, request: OptimizeRequest): Running<StudyResult>
  toleranceOffer(text: string): Promise<ToleranceOffer>
  tolerance(text: string, request: ToleranceRequest): Running<StudyResult>
}
