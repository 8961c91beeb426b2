import { type StdioOptions, execFile, execFileSync } from 'node:child_process'
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { availableParallelism, tmpdir } from 'node:os'
import { basename, join } from 'node:path'
import { pathToFileURL } from 'node:url'
import { promisify } from 'node:util'
import type { TestProject } from 'vitest/node'
import { TEST } from './limits'

/** Addresses of pages made before the first test. */
export interface Samples {
  /** A slider-crank from its closed form, with a variable that cannot be followed. */
  whole: string
  /** The same, stopping on its way. */
  partial: string
  /** The strut with one end of its tie rod moved: today's design, the exact changed one and what was predicted. */
  changed: string
  /** The tutorial's: the strut whose rack is held, with its rack higher. */
  tutorial: string
  /** The strut over wheel travel and steer: a page with a map. */
  map: string
  /** The strut with tolerances: a page with bands. */
  tolerance: string
  /** A strut with two cases, their metrics, a map, and a tilt that its text cannot have. */
  cases: string
  /** The strut, fitted to measured data. */
  fitted: string
  /** A double wishbone suspension with the front of two goals. */
  front: string
  /** A front axle on bushings, in equilibrium over wheel travel. */
  elastic: string
  /** A four-bar whose rods pass screws: shapes, one of which hits another. */
  knee: string
  /** 81 bodies and 240 design variables. */
  large: string
  /** The program that answers as the page's engine does. */
  answers: string
  /** The report of every model of the repository, by the name of its file. */
  models: Record<string, string>
  /** The command itself. */
  hardpoint: string
}

declare module 'vitest' {
  export interface ProvidedContext {
    samples: Samples
  }
}

const ROOT = join(import.meta.dirname, '../..')
const MODELS = join(ROOT, 'models')

/**
 * Builds and writes the sample pages once, before any test. A global set-up has no time limit, so that compiling may
 * take as long as the machine needs.
 */
export default async function setup(project: TestProject): Promise<() => void> {
  const folder = mkdtempSync(join(tmpdir(), 'hardpoint-page-'))
  const page = (...names: string[]) => pathToFileURL(join(folder, ...names)).href
  const { hardpoint, sample_page: sample, rockers, answers } = build()
  const files = readdirSync(MODELS)
    .filter((file) => file.endsWith('.toml'))
    .sort()
  // A model with cases has a folder for each; its page is that of the first one.
  const firstCase = (file: string) =>
    /^\[cases\.(\w+)\]/m.exec(readFileSync(join(MODELS, file), 'utf8'))?.slice(1) ?? []
  const models = files.map((file) => {
    const name = basename(file, '.toml')
    return [name, page(name, ...firstCase(file), 'report.html')]
  })
  const ride = join(folder, 'ride.toml')
  writeFileSync(ride, ridden(readFileSync(join(MODELS, 'macpherson.toml'), 'utf8')))
  const large = join(folder, 'rockers.toml')
  const axle = join(folder, 'axle.toml')
  const cases = join(folder, 'cases.toml')
  const tilt = 'lca_tilt = { tilt = "lca_pivot", about = "y", bounds = [-2, 2] }'
  const toe = readFileSync(join(MODELS, 'studies', 'strut_toe.toml'), 'utf8')
  const ends = '{ from = -20, to = 20, steps = 4 }'
  const grid = `[cases.both]\ngrid = { strut_drive = ${ends}, rack_drive = ${ends} }`
  writeFileSync(cases, toe.replace('[design]\n', `${grid}\n\n[design]\n${tilt}\n`))
  const measured = ['strut_calibrate.toml', 'strut_measured.csv'].map((file) => join(MODELS, 'studies', file))
  const wishbone = join(MODELS, 'studies', 'wishbone_trade_off.toml')
  const change = ['--set', 'tie_rod_outer.z=+6mm', '-o', join(folder, 'changed')]
  const higher = [
    '--set',
    'tie_rod_inner.z=+32mm',
    '--measure',
    'toe',
    '--measure',
    'camber',
    '--measure',
    'half_track',
  ]
  await sideBySide([
    async () => {
      await command(rockers, [large])
      await command(hardpoint, ['run', large, '-o', join(folder, 'large')])
    },
    async () => {
      await command(hardpoint, ['new', axle, '--template', 'k-and-c'])
      await command(hardpoint, ['run', axle, '--case', 'parallel_travel', '-o', join(folder, 'elastic')])
    },
    () => command(sample, [join(folder, 'sample.html')]),
    () => command(sample, [join(folder, 'partial.html'), '--partial']),
    () => command(hardpoint, ['whatif', join(MODELS, 'macpherson.toml'), ...change]),
    () => command(hardpoint, ['whatif', ride, ...higher, '--over', 'wheel_travel', '-o', join(folder, 'tutorial')]),
    () => command(hardpoint, ['run', join(MODELS, 'studies', 'strut_map.toml'), '-o', join(folder, 'map')]),
    () =>
      command(hardpoint, [
        'tolerance',
        join(MODELS, 'studies', 'strut_tolerances.toml'),
        '--samples',
        '100',
        '-o',
        join(folder, 'tolerance'),
      ]),
    () => command(hardpoint, ['run', join(MODELS, 'studies', 'knee.toml'), '-o', join(folder, 'knee')]),
    () => command(hardpoint, ['run', cases, '-o', join(folder, 'cases')]),
    () => command(hardpoint, ['calibrate', ...measured, '-o', join(folder, 'fitted')]),
    () => command(hardpoint, ['trade-off', wishbone, '--points', '5', '-o', join(folder, 'front')]),
    ...files.map(
      (file) => () => command(hardpoint, ['run', join(MODELS, file), '-o', join(folder, basename(file, '.toml'))]),
    ),
  ])

  project.provide('samples', {
    answers,
    whole: page('sample.html'),
    partial: page('partial.html'),
    changed: page('changed', 'whatif.html'),
    tutorial: page('tutorial', 'whatif.html'),
    map: page('map', 'ride', 'report.html'),
    tolerance: page('tolerance', 'report-bump.html'),
    cases: page('cases', 'report.html'),
    fitted: page('fitted', 'report.html'),
    front: page('front', 'report.html'),
    elastic: page('elastic', 'report.html'),
    knee: page('knee', 'report.html'),
    large: page('large', 'report.html'),
    models: Object.fromEntries(models),
    hardpoint,
  })
  return () => rmSync(folder, { recursive: true })
}

/** Runs a command to its end. */
async function command(program: string, words: string[]): Promise<void> {
  await promisify(execFile)(program, words, { timeout: TEST, killSignal: 'SIGKILL', maxBuffer: Infinity })
}

/** Runs all tasks, one per core at a time. */
async function sideBySide(work: (() => Promise<void>)[]): Promise<void> {
  const left = work[Symbol.iterator]()
  const one = async () => {
    for (const next of left) await next()
  }
  await Promise.all(Array.from({ length: availableParallelism() }, one))
}

/** The strut as the tutorial has it: its rack is held. */
function ridden(strut: string): string {
  const text = strut.replace(/(\[drivers\.rack_drive\][^[]*law = )"[^"]*"/, '$1"0"')
  if (text === strut) throw new Error('the strut has no law of its rack where the tutorial finds it')
  return text
}

/**
 * Built programs: with the whole workspace, as `cargo test --release` builds it, so that nothing is left to compile
 * after that.
 */
function build(): Record<'hardpoint' | 'sample_page' | 'rockers' | 'answers', string> {
  const command = [
    'build',
    '--release',
    '--workspace',
    '--bin',
    'hardpoint',
    '--example',
    'sample_page',
    '--example',
    'rockers',
    '--example',
    'answers',
    '--message-format',
    'json',
  ]
  const stdio: StdioOptions = ['ignore', 'pipe', 'inherit']
  const messages = execFileSync('cargo', command, { cwd: ROOT, maxBuffer: Infinity, stdio })
    .toString()
    .trim()
    .split('\n')
  const built = messages.map((line) => JSON.parse(line) as { executable?: string | null; target?: { name: string } })
  const program = (name: string) => {
    const path = built.find(({ executable, target }) => executable && target?.name === name)?.executable
    if (!path) throw new Error(`cargo built no ${name}`)
    return path
  }
  return {
    hardpoint: program('hardpoint'),
    sample_page: program('sample_page'),
    rockers: program('rockers'),
    answers: program('answers'),
  }
}
