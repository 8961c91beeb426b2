import { spawnSync } from 'node:child_process'
import { readdirSync, readFileSync } from 'node:fs'
import { join } from 'node:path'
import { inflateRawSync } from 'node:zlib'
import { expect, inject, test } from 'vitest'
import { type Ask, instantiate } from '../src/engine/instance'
import type { OpenReply, OptimizeOffer, Request, DesignReply, StudyReply, ProgressReply } from '../src/engine/protocol'
import { answer } from '../src/engine/answer'
import { design } from '../src/report'
import type { Design, ModelText, Payload } from '../src/payload'

/**
 * Numbers agree to this part of the largest of their kind; what a page draws is rounded to `f32`, which leaves this
 * much.
 */
const SAME = 1e-9
const DRAWN = 3e-7

const ROOT = join(import.meta.dirname, '../..')
const MODELS = join(ROOT, 'models')
const files = readdirSync(MODELS)
  .filter((file) => file.endsWith('.toml'))
  .sort()

const binary = inflateRawSync(readFileSync(join(ROOT, 'crates/hardpoint-report/page/engine.deflate')))
/** Compiled once; each test has an instance of its own. */
const compiled = WebAssembly.compile(new Uint8Array(binary))

async function engine(onProgress: (progress: ProgressReply) => void = () => {}): Promise<Ask> {
  return instantiate(await compiled, onProgress)
}

/** The native engine's answers to the same requests. */
function native(requests: Request[]): ArrayBuffer[] {
  const { stdout, stderr, status } = spawnSync(inject('samples').answers, {
    input: requests.map((request) => JSON.stringify(request)).join('\n'),
    maxBuffer: 2 ** 30,
    encoding: 'utf8',
  })
  expect(status, stderr).toBe(0)
  return stdout
    .trim()
    .split('\n')
    .map((line) => Uint8Array.from(Buffer.from(line, 'base64')).buffer)
}

/** A model's text; files that it names are next to it. */
function model(file: string): ModelText {
  const text = readFileSync(join(MODELS, file), 'utf8')
  const named = [...text.matchAll(/"([\w/.-]+\.csv)"/g)].map(([, name]) => name)
  return {
    file,
    text,
    files: Object.fromEntries(named.map((name) => [name, readFileSync(join(MODELS, name), 'utf8')])),
    case: null,
    shown: null,
  }
}

function near(found: readonly (number | null)[], wanted: readonly (number | null)[], part: number, what: string): void {
  expect(found.length, what).toBe(wanted.length)
  const largest = Math.max(1e-30, ...wanted.map((x) => (x === null || Number.isNaN(x) ? 0 : Math.abs(x))))
  wanted.forEach((x, k) => {
    const y = found[k]
    if (x === null || Number.isNaN(x)) expect(y === null || Number.isNaN(y), `${what} ${k}`).toBe(true)
    else expect(Math.abs(y! - x), `${what} ${k}: ${y} for ${x}`).toBeLessThanOrEqual(part * largest)
  })
}

test('the page has an engine that asks for nothing but to tell', async () => {
  const imports = WebAssembly.Module.imports(await compiled)
  expect(imports.map(({ module, name }) => `${module}.${name}`).sort()).toEqual(['page.tell'])
})

test.each(files)('%s is understood and solved as the command does', async (file) => {
  const ask = await engine()
  const open: Request = { ask: 'open', model: model(file) }
  const { grips } = answer<OpenReply>(ask(open)).json
  // One hardpoint moves a little, if the change is admissible.
  const size = Math.max(...grips.flatMap(({ place }) => place.map(Math.abs)))
  const change = grips.slice(0, 1).map(({ coordinates }) => ({ name: coordinates[0].variable, by: 1e-3 * size }))
  const requests: Request[] = [
    open,
    { ask: 'design', change, from: null, solid: false },
    { ask: 'page', model: model(file) },
    { ask: 'text', change },
  ]
  const wanted = native(requests)
  const found = requests.map((request) => ask(request))
  const [a, b] = [found, wanted].map((blocks) => answer<DesignReply>(blocks[1]))
  expect(a.json.why?.code).toBe(b.json.why?.code)
  if (a.json.design && b.json.design) {
    near(a.json.design.values, b.json.design.values, SAME, 'values')
    const [own, other] = [a, b].map(({ json, decode }) => design(json.design as Design, decode))
    other.poses.forEach((poses, body) => near([...own.poses[body]], [...poses], DRAWN, `poses of body ${body}`))
  }
  const [page, page2] = [found, wanted].map((blocks) => answer<Payload>(blocks[2]))
  expect(page.json.title).toBe(page2.json.title)
  page2.json.values.forEach((value, k) => {
    near([page.json.values[k].value], [value.value], SAME, value.name)
    near(page.json.values[k].sensitivities, value.sensitivities, 10 * SAME, `sensitivities of ${value.name}`)
  })
  page2.json.quantities.forEach((quantity, k) =>
    near([...page.decode(page.json.quantities[k].value)], [...page2.decode(quantity.value)], DRAWN, quantity.name),
  )
  expect(new Uint8Array(found[3])).toEqual(new Uint8Array(wanted[3]))
})

test('a search indicates of its iterations and finds what the native one finds', async () => {
  const reports: ProgressReply[] = []
  const ask = await engine((news) => reports.push(news))
  const strut = model('studies/strut_toe.toml')
  const offer = answer<OptimizeOffer>(ask({ ask: 'optimize_offer', model: strut })).json
  const chosen = <T extends { chosen: boolean }>(list: T[]) => list.filter(({ chosen }) => chosen)
  const asked = {
    variables: chosen(offer.variables).map(({ name, bounds }) => ({ name, bounds: bounds! })),
    goals: chosen(offer.goals).map(({ metric, weight, target }) => ({ metric, weight, target })),
    starts: 1,
    iterations: 30,
  }
  const request: Request = { ask: 'optimize', model: strut, asked }
  const [found, wanted] = [ask(request), native([request])[0]].map((block) => answer<StudyReply>(block).json)
  expect(reports.length).toBeGreaterThan(2)
  expect(reports.at(-1)!.change!.length).toBeGreaterThan(0)
  // Two machines walk there by other last digits: the ends agree as far as the search goes.
  near(
    found.change!.map(({ by }) => by),
    wanted.change!.map(({ by }) => by),
    1e-4,
    'design found',
  )
  expect(found.text).toContain('[optimize')
})
