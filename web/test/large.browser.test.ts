import type { Browser, CDPSession, Page } from 'playwright-core'
import { afterAll, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, visit, type Visit } from './browser'
import { drawn } from './person'

const { large } = inject('samples')

/** Frames that are counted over. */
const FRAMES = 30
/** Rows that a window of at most 480 px shows at 30 px each, with those made beyond it on either side. */
const MOST_ROWS = 16 + 2 * 6 + 1
/** Elements of the map, which is always drawn on one canvas. */
const MAP = 40
/** Elements of the page for every variable: 50 others, the button for its bounds, and the place of their fields. */
const EACH = 52
/** A frame that something moves in lays out the page once; a few more may come from elsewhere. */
const LAYOUTS = FRAMES + 6
/** A choice also asks once where the row of the variable is, and a new plot where it is. */
const PER_CHOICE = 3

let browser: Browser
beforeAll(async () => {
  browser = await launch()
})
afterAll(() => browser?.close())

describe('a model of 81 bodies and 240 variables', () => {
  let visited: Visit
  let page: Page
  let session: CDPSession
  beforeAll(async () => {
    visited = await visit(browser, large)
    page = visited.page
    session = await page.context().newCDPSession(page)
    await session.send('Performance.enable')
  })
  afterAll(() => page?.context().close())

  /** Number of layouts of the page meanwhile. */
  async function layouts(doing: () => Promise<unknown>): Promise<number> {
    const count = async () =>
      (await session.send('Performance.getMetrics')).metrics.find(({ name }) => name === 'LayoutCount')!.value
    await drawn(page)
    const before = await count()
    await doing()
    return (await count()) - before
  }

  /** Scrolls by this number of pixels in every frame. */
  const scroll = (selector: string, by: number) =>
    page.locator(selector).evaluate(
      async (window, { by, frames }) => {
        for (let k = 0; k < frames; k++) {
          window.scrollTop += by
          await new Promise(requestAnimationFrame)
        }
        return window.scrollTop
      },
      { by, frames: FRAMES },
    )

  const elements = (selector: string) => page.locator(`${selector} *`).count()

  test('is a page of bounded size', async () => {
    expect(await page.locator('[data-testid^=variable-]:has(.name)').count()).toBe(240)
    expect(await elements('html')).toBeLessThan(240 * EACH)
    expect(await page.locator('.ranking tr').count()).toBeLessThanOrEqual(MOST_ROWS)
    expect(await elements('.heat .window')).toBeLessThan(MAP)
  })

  test('scrolls its table with few rows at a time, one layout a frame', async () => {
    await page.getByTestId('tab-table').click()
    const first = await page.locator('.ranking tr .plain').first().innerText()
    expect(await layouts(() => scroll('.ranking .scroll', 60))).toBeLessThanOrEqual(LAYOUTS)
    await drawn(page)
    expect(await page.locator('.ranking tr').count()).toBeLessThanOrEqual(MOST_ROWS)
    expect(await page.locator('.ranking tr .plain').first().innerText()).not.toBe(first)
  })

  test('scrolls its map, which grows by nothing, one layout a frame', async () => {
    const map = page.locator('.heat canvas')
    await map.scrollIntoViewIfNeeded()
    const [before, size] = [await map.screenshot(), await elements('.heat')]
    expect(await layouts(() => scroll('.heat .window', 30))).toBeLessThanOrEqual(LAYOUTS)
    await drawn(page)
    expect((await map.screenshot()).equals(before)).toBe(false)
    expect(await elements('.heat')).toBe(size)
  })

  test('is scrubbed with one layout a frame, and nothing is left behind', async () => {
    const [time, size] = [await page.getByTestId('time').innerText(), await elements('html')]
    const scrub = () =>
      page.getByTestId('scrub').evaluate(async (slider: HTMLInputElement, frames) => {
        for (let k = 1; k <= frames; k++) {
          slider.value = String(3 * k)
          slider.dispatchEvent(new Event('input', { bubbles: true }))
          await new Promise(requestAnimationFrame)
        }
      }, FRAMES)
    expect(await layouts(scrub)).toBeLessThanOrEqual(LAYOUTS)
    expect(await page.getByTestId('time').innerText()).not.toBe(time)
    expect(await elements('html')).toBe(size)
  })

  test('lets variables be chosen, a few layouts each', async () => {
    await page.getByTestId('tab-variables').click()
    const choose = () =>
      page.getByTestId('variables').evaluate(async (list, frames) => {
        const names = [...list.querySelectorAll<HTMLElement>('.name')]
        for (let k = 1; k <= frames; k++) {
          names[7 * k].click()
          await new Promise(requestAnimationFrame)
        }
      }, FRAMES)
    expect(await layouts(choose)).toBeLessThanOrEqual(FRAMES * PER_CHOICE)
    expect(await page.locator('.variables [aria-current=true] .name').innerText()).toBe(
      await page
        .locator('.variables .name')
        .nth(7 * FRAMES)
        .innerText(),
    )
  })

  test('was requested nothing else, and reported nothing on the console', () => {
    expect(visited.complaints).toEqual([])
  })
})
