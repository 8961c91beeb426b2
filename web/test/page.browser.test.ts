import { pathToFileURL } from 'node:url'
import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, NO_3D, visit, type Visit } from './browser'

// HARDPOINT_REPORT names a report to test in place of the sample; what is expected here holds for every report
// that has at least two quantities and two variables with sensitivities.
const samples = inject('samples')
const given = process.env.HARDPOINT_REPORT
const url = pathToFileURL(given ?? samples.whole).href

/** Number of different colours on a canvas, and a sum that changes with its picture. */
function look(page: Page, selector: string): Promise<{ colours: number; picture: number }> {
  // Two frames: one to draw, one to be sure that it was drawn.
  return page.evaluate(async (selector) => {
    for (let k = 0; k < 2; k++) await new Promise(requestAnimationFrame)
    const source = document.querySelector<HTMLCanvasElement>(selector)!
    const copy = new OffscreenCanvas(source.width, source.height)
    const context = copy.getContext('2d')!
    context.drawImage(source, 0, 0)
    const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer)
    let picture = 0
    for (const pixel of pixels) picture = (Math.imul(picture, 31) + pixel) | 0
    return { colours: new Set(pixels).size, picture }
  }, selector)
}

/** Lets so many frames pass. */
function frames(page: Page, count: number): Promise<void> {
  return page.evaluate(async (count) => {
    for (let k = 0; k < count; k++) await new Promise(requestAnimationFrame)
  }, count)
}

const VIEW = '[data-testid=view-canvas]'
const plot = (name: string) => `[data-testid=plot-${name}] canvas`
const text = (page: Page, id: string) => page.getByTestId(id).innerText()

const scrub = (page: Page, step: number) =>
  page.getByTestId('scrub').evaluate((slider: HTMLInputElement, step) => {
    slider.value = String(step)
    slider.dispatchEvent(new Event('input'))
  }, step)

describe('the report', () => {
  let browser: Browser
  let visited: Visit
  let page: Page

  beforeAll(async () => {
    browser = await launch()
    visited = await visit(browser, url)
    page = visited.page
  })
  afterAll(() => browser?.close())

  test('draws the mechanism and four plots', async () => {
    expect((await look(page, VIEW)).colours).toBeGreaterThan(50)
    for (const name of ['value', 'peers', 'check', 'margin']) expect((await look(page, plot(name))).colours).toBeGreaterThan(10)
  })

  test('scrubbing moves the time, the mechanism and the readings', async () => {
    const before = { time: await text(page, 'time'), view: await look(page, VIEW), value: await text(page, 'plot-value') }
    const margin = await text(page, 'plot-margin')
    await scrub(page, 7)
    expect(await text(page, 'plot-margin')).not.toBe(margin)
    expect(await text(page, 'time')).not.toBe(before.time)
    expect((await look(page, VIEW)).picture).not.toBe(before.view.picture)
    expect(await text(page, 'plot-value')).not.toBe(before.value)
  })

  test('a click in a plot moves the time to where it was clicked', async () => {
    const area = (await page.locator('[data-testid=plot-value] .u-over').boundingBox())!
    const last = Number(await page.getByTestId('scrub').getAttribute('max'))
    await page.mouse.click(area.x + area.width - 1, area.y + area.height / 2)
    expect(Number(await page.getByTestId('scrub').inputValue())).toBeGreaterThan(last * 0.9)
    await page.mouse.click(area.x + 1, area.y + area.height / 2)
    expect(Number(await page.getByTestId('scrub').inputValue())).toBeLessThan(last / 10)
  })

  test('play advances until it is paused', async () => {
    const start = await text(page, 'time')
    await page.getByTestId('play').click()
    await expect.poll(() => text(page, 'time')).not.toBe(start)
    await page.getByTestId('play').click()
    const stopped = await text(page, 'time')
    // While it plays, every frame moves the time.
    await frames(page, 12)
    expect(await text(page, 'time')).toBe(stopped)
  })

  test('arrow keys step and space plays', async () => {
    await scrub(page, 3)
    await page.locator('h1').click()
    await page.keyboard.press('ArrowRight')
    expect(await page.getByTestId('scrub').inputValue()).toBe('4')
    await page.keyboard.press('Space')
    await expect.poll(() => page.getByTestId('play').getAttribute('aria-label')).toBe('pause')
    await page.keyboard.press('ArrowLeft')
    expect(await page.getByTestId('play').getAttribute('aria-label')).toBe('play')
  })

  test('choosing another quantity changes every plot and the ranking', async () => {
    const names = ['value', 'peers', 'check']
    const before = await Promise.all(names.map((name) => look(page, plot(name))))
    const ranking = await text(page, 'ranking')
    const select = page.getByTestId('quantity')
    const first = await select.inputValue()
    const values = await select.locator('option').evaluateAll((all) => all.map((one) => (one as HTMLOptionElement).value))
    await select.selectOption(values.find((value) => value !== first)!)
    const after = await Promise.all(names.map((name) => look(page, plot(name))))
    names.forEach((_, k) => expect(after[k].picture).not.toBe(before[k].picture))
    expect(await text(page, 'ranking')).not.toBe(ranking)
    await select.selectOption(first)
  })

  test('choosing an order changes the unit', async () => {
    await page.getByTestId('order-acceleration').check({ force: true })
    expect(await page.locator('[data-testid=plot-value] h3').innerText()).toMatch(/acceleration \[.*²\]/)
    await page.getByTestId('order-value').check({ force: true })
  })

  test('curves over another quantity have its name along the axis, and dragging there moves the time', async () => {
    const first = await page.getByTestId('over').locator('option').nth(1).innerText()
    const before = await look(page, plot('value'))
    await page.getByTestId('over').selectOption({ label: first })
    expect((await look(page, plot('value'))).picture).not.toBe(before.picture)
    expect(await page.getByTestId('plot-value').getByRole('img').getAttribute('aria-label')).toContain(`over ${first}`)
    const time = await text(page, 'time')
    await page.locator('[data-testid=plot-value] .u-over').click({ position: { x: 60, y: 40 } })
    expect(await text(page, 'time')).not.toBe(time)
    await page.getByTestId('over').selectOption({ label: 'time' })
    await scrub(page, 0)
  })

  test('choosing another variable in the ranking changes the comparison', async () => {
    const heading = page.locator('[data-testid=plot-check] h3')
    const before = await heading.innerText()
    await page.locator('[data-testid=ranking] tbody tr[aria-current=false]').first().click()
    expect(await heading.innerText()).not.toBe(before)
    expect(await page.locator('[data-testid=ranking] tr[aria-current=true]').count()).toBe(1)
  })

  test('a change of the selected variable is drawn over the mechanism and says that it is foreseen', async () => {
    const before = await look(page, VIEW)
    await page.getByTestId('change').evaluate((slider: HTMLInputElement) => {
      slider.value = slider.max
      slider.dispatchEvent(new Event('input'))
    })
    expect((await look(page, VIEW)).picture).not.toBe(before.picture)
    expect(await page.getByTestId('change').locator('xpath=..').innerText()).toContain('foreseen to first order')
    await page.getByTestId('change').evaluate((slider: HTMLInputElement) => {
      slider.value = '0'
      slider.dispatchEvent(new Event('input'))
    })
    expect((await look(page, VIEW)).picture).toBe(before.picture)
  })

  test('choosing by keyboard keeps the focus where it was', async () => {
    const row = page.locator('[data-testid=ranking] tbody tr[aria-current=false]').first()
    const name = await row.locator('button').innerText()
    await row.locator('button').press('Enter')
    expect(await page.evaluate(() => document.activeElement!.textContent)).toBe(name)
    expect(await page.locator('[data-testid=ranking] tr[aria-current=true] button').innerText()).toBe(name)
  })

  test('keeps to a narrow screen', async () => {
    await page.setViewportSize({ width: 400, height: 800 })
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(400)
    await page.setViewportSize({ width: 1400, height: 900 })
  })

  test('asks for nothing but itself and reports no error', () => {
    expect(visited.complaints).toEqual([])
  })
})

test('without WebGL the plots and tables still work', async () => {
  const browser = await launch(NO_3D)
  try {
    const { page, complaints } = await visit(browser, url)
    expect(await text(page, 'no-webgl')).toContain('no WebGL')
    expect((await look(page, plot('value'))).colours).toBeGreaterThan(10)
    const before = await text(page, 'plot-value')
    await scrub(page, 7)
    expect(await text(page, 'plot-value')).not.toBe(before)
    await page.locator('[data-testid=heat] .window').focus()
    await page.keyboard.press('ArrowDown')
    expect(await text(page, 'heat-reading')).toContain('d ')
    expect(complaints).toEqual([])
  } finally {
    await browser.close()
  }
})

describe.skipIf(given)('the sample', () => {
  test('strikes out what cannot be followed and says why', async () => {
    const browser = await launch()
    try {
      const { page } = await visit(browser, url)
      const button = page.getByTestId('variable-crank_pin_tilt')
      const decoration = button.locator('.name').evaluate((name) => getComputedStyle(name).textDecorationLine)
      expect(await decoration).toBe('line-through')
      await button.click()
      expect(await text(page, 'plot-check')).toContain('No motion closes crank_pin')
      expect(await page.locator(plot('check')).count()).toBe(0)
    } finally {
      await browser.close()
    }
  })

  test('of a motion that stops says so in a banner', async () => {
    const browser = await launch()
    try {
      const { page, complaints } = await visit(browser, pathToFileURL(samples.partial).href)
      expect(await page.getByRole('status').first().innerText()).toContain('It stops at t = 1.2 s')
      expect(complaints).toEqual([])
    } finally {
      await browser.close()
    }
  })
})
