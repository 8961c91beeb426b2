import type { OptimizeRequest, Running, Studies, StudyResult, ToleranceRequest } from '../engine/engine'
import type {
  OptimizeOffer,
  Request,
  VariableSetting,
  StudyReply,
  ProgressReply,
  ToleranceOffer,
} from '../engine/protocol'
import { Solver } from '../engine/solver'
import { messageOf } from '../format'
import type { ModelText } from '../payload'

const BEST = 'This is the best design so far.'

/** The studies of a model, each run by an engine of its own in the page. */
export class Workers implements Studies {
  constructor(
    private readonly module: WebAssembly.Module,
    /** A text with the other files that it reads. */
    private readonly model: (text: string) => ModelText,
  ) {}

  optimizeOffer(text: string): Promise<OptimizeOffer> {
    return this.#once({ ask: 'optimize_offer', model: this.model(text) })
  }

  toleranceOffer(text: string): Promise<ToleranceOffer> {
    return this.#once({ ask: 'tolerance_offer', model: this.model(text) })
  }

  optimize(text: string, asked: OptimizeRequest): Running<StudyResult> {
    return this.#run({ ask: 'optimize', model: this.model(text), asked })
  }

  tolerance(text: string, asked: ToleranceRequest): Running<StudyResult> {
    return this.#run({ ask: 'tolerance', model: this.model(text), asked })
  }

  async #once<T>(request: Request): Promise<T> {
    const solver = new Solver(this.module)
    try {
      return (await solver.ask<T>(request)).json
    } finally {
      solver.stop()
    }
  }

  /** A busy engine receives no messages: cancelling ends it, and its last report has the best design so far. */
  #run(request: Request): Running<StudyResult> {
    const solver = new Solver(this.module)
    const listeners: ((progress: ProgressReply) => void)[] = []
    let best: VariableSetting[] | null = null
    let ended: (result: StudyResult) => void
    const cancelled = new Promise<StudyResult>((done) => (ended = done))
    const onProgress = (news: ProgressReply) => {
      best = news.change ?? best
      for (const listener of listeners) listener(news)
    }
    const whole = solver.ask<StudyReply>(request, onProgress).then(
      ({ json }) => json,
      (error): StudyReply => {
        // The designs before a failure are still of use, such as where the last one cannot be written as a text.
        if (!best) throw error
        return { tables: [], change: best, text: null, message: `Failed: ${messageOf(error)}. ${BEST}` }
      },
    )
    return {
      onProgress: (listener) => listeners.push(({ done, total, line, change }) => listener(done, total, line, change)),
      cancel: () => {
        ended({
          tables: [],
          change: best,
          text: null,
          message: best ? `Cancelled. ${BEST}` : 'Cancelled before a better design was found.',
        })
        solver.stop()
      },
      result: Promise.race([cancelled, whole]).finally(() => solver.stop()),
    }
  }
}
