import { readFileSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import type { Browser, Page } from 'playwright-core'
import { GLTFLoader, type GLTF } from 'three/addons/loaders/GLTFLoader.js'
import { afterAll, beforeAll, describe, expect, inject, test, vi } from 'vitest'
import { launch, visit, type Visit } from './browser'
import { ready, settled } from './pages'
import { VIEW } from './person'
import { motionBeside, table } from './table'

// The loader looks for the window under its other name.
vi.stubGlobal('self', globalThis)

const { models } = inject('samples')

/** Folder for the documents' pictures, if the tests are to make them anew. */
const IMAGES = process.env.UPDATE_DOCS && join(import.meta.dirname, '../../docs/images')

/** Bytes of a PNG's header: its signature, and the offsets of width and height. */
const PNG = { signature: '89504e470d0a1a0a', width: 16, height: 20 }
/** Pixels of an exported picture per pixel of the page. */
const SHARP = 2
/** The page holds single precision. */
const SINGLE = 1e-6

describe('what a reader takes away', () => {
  let browser: Browser
  let visited: Visit
  let page: Page
  beforeAll(async () => {
    browser = await launch()
    visited = await visit(browser, models.slider_crank)
    page = visited.page
  })
  afterAll(() => browser?.close())

  /** The file that an entry of the menu exports. */
  async function taken(entry: string, from = page): Promise<Buffer> {
    await from.getByTestId('export').click()
    const [download] = await Promise.all([from.waitForEvent('download'), from.getByTestId(entry).first().click()])
    return readFileSync(await download.path())
  }

  const sizeOf = (png: Buffer) => {
    expect(png.subarray(0, 8).toString('hex')).toBe(PNG.signature)
    return { width: png.readUInt32BE(PNG.width), height: png.readUInt32BE(PNG.height) }
  }

  /** Elements of an SVG, which has to be well-formed. */
  const elements = (svg: Buffer, selector: string) =>
    page.evaluate(
      ({ svg, selector }) => {
        const parsed = new DOMParser().parseFromString(svg, 'image/svg+xml')
        return {
          errors: parsed.querySelectorAll('parsererror').length,
          root: parsed.documentElement.localName,
          found: parsed.querySelectorAll(selector).length,
        }
      },
      { svg: svg.toString(), selector },
    )

  const wordsOf = (svg: Buffer) =>
    page.evaluate(
      (svg) => new DOMParser().parseFromString(svg, 'image/svg+xml').documentElement.textContent,
      svg.toString(),
    )

  test('the view as PNG is twice as large as on the screen', async () => {
    const { width, height } = (await page.locator(VIEW).boundingBox())!
    const size = sizeOf(await taken('export-view-png'))
    expect(Math.abs(size.width - SHARP * width)).toBeLessThanOrEqual(SHARP)
    expect(Math.abs(size.height - SHARP * height)).toBeLessThanOrEqual(SHARP)
  })

  test('the menu has a row for each curve with its formats, and paper before them', async () => {
    const { page } = visited
    await page.getByTestId('export').click()
    const menu = page.getByTestId('export-menu')
    const rows = await menu.locator(':scope > *').allInnerTexts()
    const titles = await page.locator('.plot h3').allTextContents()
    expect(rows.slice(3, 6).map((row) => row.split('\n')[0])).toEqual(['Print or PDF…', 'View', 'Motion'])
    const [, ...curves] = rows.slice(6)
    expect(curves.length).toBeLessThanOrEqual(titles.length)
    for (const row of curves) expect(row).toMatch(/\nPNG\nSVG$/)
    const focused = () => page.evaluate(() => document.activeElement!.getAttribute('aria-label'))
    await page.keyboard.press('End')
    expect(await focused()).toMatch(/ as SVG$/)
    await page.keyboard.press('ArrowUp')
    expect(await focused()).toMatch(/ as PNG$/)
    await page.keyboard.press('Escape')
  })

  test('a curve as PNG is a picture', async () => {
    expect(sizeOf(await taken('export-plot-png')).width).toBeGreaterThan(100)
  })

  test('a curve as SVG is well-formed and has curves and words', async () => {
    const svg = await taken('export-plot-svg')
    expect(await elements(svg, 'path, polyline')).toMatchObject({ errors: 0, root: 'svg' })
    expect((await elements(svg, 'path, polyline')).found).toBeGreaterThan(0)
    expect((await elements(svg, 'text')).found).toBeGreaterThan(3)
  })

  test('the view as SVG is well-formed and has faces or lines', async () => {
    const svg = await taken('export-view-svg')
    expect(await elements(svg, 'path, polygon, polyline, line')).toMatchObject({ errors: 0, root: 'svg' })
    expect((await elements(svg, 'path, polygon, polyline, line')).found).toBeGreaterThan(10)
  })

  test('the curves as CSV are the numbers that the command wrote', async () => {
    const columns = table((await taken('export-csv')).toString())
    const motion = motionBeside(models.slider_crank)
    const names = [...columns.keys()].map((heading) => heading.replace(/ \[[^\]]*\]$/, ''))
    const shared = names.filter((name) => motion.has(name))
    expect(shared.length).toBeGreaterThan(0)
    for (const name of shared) {
      const ours = columns.get([...columns.keys()][names.indexOf(name)])!
      const theirs = motion.get(name)!
      const scale = Math.max(...theirs.map(Math.abs))
      expect(ours.length).toBe(theirs.length)
      for (const [k, value] of ours.entries())
        expect(Math.abs(value - theirs[k]), `${name}, row ${k}`).toBeLessThanOrEqual(SINGLE * scale)
    }
  })

  test('of plots that show a part, CSV and SVG are of that part', async () => {
    const { page } = visited
    // Without the rest of the sheet, and over time.
    while ((await page.getByTestId('remove').count()) > 1) await page.getByTestId('remove').last().click()
    await page.getByTestId('plot-0').getByTestId('over').selectOption('')
    const [rows, words] = [
      table((await taken('export-csv')).toString()).get('time [s]')!.length,
      await wordsOf(await taken('export-plot-svg')),
    ]
    await page.getByTestId('plot-0').getByTestId('closer').click()
    const part = table((await taken('export-csv')).toString()).get('time [s]')!
    expect(part.length).toBeGreaterThan(rows / 2 - 2)
    expect(part.length).toBeLessThan(rows / 2 + 3)
    expect(await wordsOf(await taken('export-plot-svg'))).not.toEqual(words)
    await page.getByTestId('plot-0').getByTestId('whole').click()
    expect(table((await taken('export-csv')).toString()).get('time [s]')!.length).toBe(rows)
  })

  test('each design has its own abscissa in the CSV', async () => {
    const { page } = await visit(browser, models.four_bar)
    await ready(page)
    await page.getByTestId('plot-0').getByTestId('quantity').selectOption({ label: 'rocker_angle' })
    await page.getByTestId('plot-0').getByTestId('over').selectOption({ label: 'over midpoint_x' })
    await page.getByTestId('tab-variables').click()
    const field = page.getByTestId('variable-C_x').getByTestId('change-value')
    await field.fill('20')
    await field.press('Enter')
    await settled(page)
    const columns = table((await taken('export-csv', page)).toString())
    const names = [...columns.keys()]
    const at = names.indexOf('midpoint_x [mm]')
    expect(names.slice(at, at + 4)).toEqual([
      'midpoint_x [mm]',
      'rocker_angle: current [deg]',
      'midpoint_x of rocker_angle: original [mm]',
      'rocker_angle: original [deg]',
    ])
    // The command's own for the original, and others for the changed one.
    const x = motionBeside(models.four_bar).get('midpoint_x')!
    const original = columns.get('midpoint_x of rocker_angle: original [mm]')!
    const present = columns.get('midpoint_x [mm]')!
    const scale = Math.max(...x.map(Math.abs))
    expect(Math.max(...x.map((value, k) => Math.abs(value - original[k])))).toBeLessThanOrEqual(SINGLE * scale)
    expect(Math.max(...x.map((value, k) => Math.abs(value - present[k])))).toBeGreaterThan(0.01 * scale)
    await page.context().close()
  })

  test('the picture of the tutorial is a curve as SVG', async () => {
    const tutorial = await visit(browser, inject('samples').tutorial)
    const svg = await taken('export-plot-svg', tutorial.page)
    const words = await wordsOf(svg)
    for (const word of ['toe', 'wheel_travel', 'current', 'original', 'predicted to first order'])
      expect(words).toContain(word)
    if (IMAGES) writeFileSync(join(IMAGES, 'tutorial.svg'), svg)
    await tutorial.page.context().close()
  })

  test('the motion as glTF loads again and moves', async () => {
    const bytes = await taken('export-gltf')
    const data = new Uint8Array(bytes).buffer
    const loaded = await new Promise<GLTF>((done, failed) => new GLTFLoader().parse(data, '', done, failed))
    expect(loaded.animations).toHaveLength(1)
    const times = motionBeside(models.slider_crank).get('t')!
    expect(loaded.animations[0].duration).toBeCloseTo(times.at(-1)! - times[0], 4)
  })

  test('nothing of it asks the network or speaks on the console', () => {
    expect(visited.complaints.filter((line) => !line.startsWith('request: blob:'))).toEqual([])
  })
})
