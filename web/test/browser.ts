import { existsSync } from 'node:fs'
import { delimiter, join } from 'node:path'
import {
  type Browser,
  type BrowserContext,
  type BrowserContextOptions,
  chromium,
  type LaunchOptions,
} from 'playwright-core'
import { WAIT } from './limits'

/**
 * Draws WebGL in software, so that the tests need neither a graphics card nor a screen. What surrounds the picture is
 * composed without the software graphics card, and lines are not smoothed: two thirds of the CPU time of pictures.
 */
const SOFTWARE_3D = [
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
  '--disable-gpu-compositing',
  '--webgl-antialiasing-mode=none',
]
/** Chromium's remark, once a page, that it composes a WebGL picture without a graphics card. */
const COMPOSED_IN_SOFTWARE = /GL Driver Message \(OpenGL, Performance, .*GPU stall due to ReadPixels/
/**
 * The engine's functions are compiled once more, optimised, only where they run fifty times longer than is usual: on a
 * page that is open for seconds that was a quarter of all CPU time.
 */
const ENGINE_AS_FIRST_COMPILED = '--js-flags=--wasm-tiering-budget=100000000'
const QUIET = [
  ENGINE_AS_FIRST_COMPILED,
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
]
export const NO_3D = ['--disable-gpu', '--disable-software-rasterizer', '--disable-3d-apis']

/** Without the parts that only a window needs, a page takes three quarters of the CPU time. */
const BROWSERS = ['chromium-headless-shell', 'chromium']

/** The preference is there unless the reader has chosen otherwise, also after the page is opened again. */
const PREFER_OWN_MOTION = () => {
  localStorage['hardpoint.own-motion'] ??= 'yes'
}

/** `CHROMIUM` names the browser where none of these is on the path. */
function chromiumPath(): string {
  const folders = (process.env.PATH ?? '').split(delimiter)
  const onPath = BROWSERS.flatMap((name) => folders.map((folder) => join(folder, name)))
  const found = process.env.CHROMIUM ?? onPath.find((path) => existsSync(path))
  if (!found)
    throw new Error(`no ${BROWSERS.join(' or ')} on the path: install one, or name it in the variable CHROMIUM`)
  return found
}

export function launch(graphics: string[] = SOFTWARE_3D, options: LaunchOptions = {}): Promise<Browser> {
  const args = [...QUIET, ...graphics]
  return chromium.launch({ executablePath: chromiumPath(), headless: true, args, timeout: WAIT, ...options })
}

export interface Visit {
  page: Awaited<ReturnType<BrowserContext['newPage']>>
  /** Anything on the console, uncaught exceptions, and requests to anything but the file itself. */
  complaints: string[]
}

/**
 * `engine: false` is a browser that runs no WebAssembly: the page stays the report that it was made as. With
 * `derived: false` a reader is assumed who prefers the motion of the model to one that the page derives from it.
 */
export async function visit(
  browser: Browser,
  url: string,
  { engine = true, derived = false, ...options }: BrowserContextOptions & { engine?: boolean; derived?: boolean } = {},
): Promise<Visit> {
  const page = await browser.newPage({ viewport: { width: 1200, height: 760 }, ...options })
  if (!engine) await page.addInitScript(() => Reflect.deleteProperty(globalThis, 'WebAssembly'))
  if (!derived) await page.addInitScript(PREFER_OWN_MOTION)
  page.setDefaultTimeout(WAIT)
  const complaints: string[] = []
  page.on('console', (message) => {
    if (!COMPOSED_IN_SOFTWARE.test(message.text())) complaints.push(`console: ${message.text()}`)
  })
  page.on('pageerror', (error) => complaints.push(`exception: ${error.message}`))
  // A worker's code comes out of the page itself.
  const own = (asked: string) => asked === url || asked.startsWith('blob:')
  page.on('request', (request) => own(request.url()) || complaints.push(`request: ${request.url()}`))
  await page.goto(url)
  await page.waitForFunction(() => performance.getEntriesByName('ready').length > 0)
  // Harnesses of single parts have no engine to wait for.
  await page.waitForFunction(
    () => !document.getElementById('engine') || document.getElementById('page')!.dataset.engine !== undefined,
  )
  return { page, complaints }
}
