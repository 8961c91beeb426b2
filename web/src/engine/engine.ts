import type { Table } from '../payload'

/** A message about the model's text, in the words of the command line. */
export interface Diagnostic {
  severity: 'error' | 'warning' | 'note'
  /** Stable, such as `HP0204`. */
  code: string
  message: string
  /** From 1; none where the text as a whole is meant. */
  line: number | null
  /** From 1, in characters. */
  column: number | null
  /** How many characters are underlined, line breaks included. */
  length: number | null
  /** What to write at the underlined place. */
  label: string | null
  /** Facts, with units. */
  notes: string[]
  /** What to do. */
  help: string | null
}

/** Reads and checks a text. */
export interface Checker {
  check(text: string): Promise<Diagnostic[]>
}

/** A study under way in a worker of its own. */
export interface Running<T> {
  /** Calls back with what is done of how much, where that is known, and a line about it. */
  onProgress(listener: (done: number, total: number | null, line: string) => void): void
  /** Ends it soon; the result is then the best so far. */
  cancel(): void
  /** Rejected where there is nothing to show at all. */
  readonly result: Promise<T>
}

/** What a study comes to. */
export interface StudyResult {
  tables: Table[]
  /** The design found, as changes of the variables from the text that was studied, in their units; none where nothing better was found. */
  change: number[] | null
  /** The text with the design found, its comments kept. */
  text: string | null
  /** How it ended, in a sentence. */
  message: string
}

/** A design variable that an optimisation may change. */
export interface SearchVariable {
  name: string
  unit: string
  /** Lowest and highest change, or value of a parameter; none where the text has no bounds. */
  bounds: [low: number, high: number] | null
  /** Whether the search of the text changes it. */
  chosen: boolean
}

/** A metric that an optimisation may make small, or bring to a target. */
export interface SearchGoal {
  metric: string
  unit: string
  /** The value of the present design, where it is known. */
  value: number | null
  weight: number
  /** Where it is to be; as small as possible where there is none. */
  target: number | null
  /** Whether its target is a curve, which the text has: then it has none of its own. */
  curve: boolean
  /** Whether it is a goal of the text. */
  chosen: boolean
}

/** What an optimisation of a text may choose, and what the text chooses: `[optimize]`, and what could stand there. */
export interface OptimizeOffer {
  variables: SearchVariable[]
  goals: SearchGoal[]
  /** What must hold, a sentence each. */
  limits: string[]
  starts: number
  iterations: number
}

/** What is asked of an optimisation; all else is as the text has it. */
export interface OptimizeRequest {
  variables: { name: string; bounds: [low: number, high: number] }[]
  goals: { metric: string; weight: number; target: number | null }[]
  /** From how many designs it starts. */
  starts: number
  /** After so many iterations a search ends. */
  iterations: number
}

/** What a tolerance study of a text may choose, and what the text chooses: `[tolerance]`. */
export interface ToleranceOffer {
  /** What may be off, by how much. */
  tolerances: { name: string; tolerance: number; unit: string; distribution: string }[]
  /** What is looked at. */
  metrics: string[]
  samples: number
  seed: number
}

/** What is asked of a tolerance study; all else is as the text has it. */
export interface ToleranceRequest {
  /** So many designs are drawn and solved exactly. */
  samples: number
  /** What they are drawn from: the same number gives the same designs. */
  seed: number
}

/** The studies of a text, each in a worker of its own. */
export interface Studies {
  /** What an optimisation of the text may choose. */
  optimizeOffer(text: string): Promise<OptimizeOffer>
  optimize(text: string, request: OptimizeRequest): Running<StudyResult>
  toleranceOffer(text: string): Promise<ToleranceOffer>
  tolerance(text: string, request: ToleranceRequest): Running<StudyResult>
}
