import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, visit, type Visit } from './browser'
import { examine, paper } from './desk'
import { curve, drawn, frames, picture, scrub, settled, slide, text, VIEW } from './person'

const { models } = inject('samples')

let browser: Browser
beforeAll(async () => {
  browser = await launch()
})
afterAll(() => browser?.close())

const step = (page: Page) => page.getByTestId('scrub').inputValue()
/** Rows of the variables, the selected one, and one that is not. */
const rows = (page: Page) => page.getByTestId('variables').locator('[data-testid^=variable-]:has(.name)')
const selected = (page: Page) => rows(page).and(page.locator('[aria-current=true]'))
const other = (page: Page) => rows(page).and(page.locator(':not([aria-current=true])')).first()
/** The selected variable's slider. */
const CHANGE = '[data-testid^=variable-][aria-current=true] [data-testid=change]'

test('a measured distance has its dimension line and its value in the view while its curve is pointed at', async () => {
  const { page, complaints } = await visit(browser, models.bricard)
  const leading = page.getByTestId('quantity').first()
  await leading.selectOption({ label: 'angle_1' })
  const names = page.locator('.view .labels text')
  await page.getByTestId('add-curve').click()
  const second = page.getByTestId('quantity').nth(1)
  await second.selectOption({ label: 'opening' })
  await page.mouse.move(1, 1)
  await second.blur()
  const before = await picture(page)
  expect(await names.count()).toBe(0)

  await second.hover()
  await drawn(page)
  expect(await names.allTextContents()).toEqual([expect.stringMatching(/^opening [\d.]+ m$/)])
  expect((await picture(page)).equals(before)).toBe(false)
  await page.mouse.move(1, 1)
  await drawn(page)
  expect(await names.count()).toBe(0)
  expect((await picture(page)).equals(before)).toBe(true)

  await second.focus()
  await drawn(page)
  expect(await names.count()).toBe(1)
  expect(complaints).toEqual([])
  await page.context().close()
})

// Both of the paper's examples: a planar mechanism, and a spatial one that belongs to a vehicle. Without the engine,
// what changes is predicted.
describe.each(['slider_crank', 'macpherson'])('a reader of %s', (name) => {
  let visited: Visit
  let page: Page

  beforeAll(async () => {
    visited = await visit(browser, models[name], { engine: false, viewport: { width: 1400, height: 900 } })
    page = visited.page
    await page.getByTestId('plot-0').getByTestId('over').selectOption('')
  })
  afterAll(() => page?.context().close())

  test('finds the mechanism, a curve and the variables, the one with the largest effect selected', async () => {
    expect((await curve(page, 'plot-0')).colours).toBeGreaterThan(10)
    expect(await rows(page).count()).toBeGreaterThan(1)
    expect(await rows(page).first().getAttribute('aria-current')).toBe('true')
  })

  test('scrubs: time, mechanism and readings go with it', async () => {
    const before = { time: await text(page, 'time'), view: await picture(page), readings: await text(page, 'plot-0') }
    await scrub(page, 7)
    expect(await text(page, 'time')).not.toBe(before.time)
    expect(await text(page, 'plot-0')).not.toBe(before.readings)
    expect((await picture(page)).equals(before.view)).toBe(false)
  })

  test('clicks in a curve: the time moves to that place', async () => {
    const area = (await page.getByTestId('plot-0').locator('.u-over').boundingBox())!
    const last = Number(await page.getByTestId('scrub').getAttribute('max'))
    await page.mouse.click(area.x + area.width - 1, area.y + area.height / 2)
    expect(Number(await step(page))).toBeGreaterThan(last * 0.9)
    await page.mouse.click(area.x + 1, area.y + area.height / 2)
    expect(Number(await step(page))).toBeLessThan(last / 10)
  })

  test('plays until it is paused', async () => {
    const start = await text(page, 'time')
    await page.getByTestId('play').click()
    await expect.poll(() => text(page, 'time')).not.toBe(start)
    await page.getByTestId('play').click()
    const stopped = await text(page, 'time')
    // While it plays, every frame moves the time.
    await frames(page, 12)
    expect(await text(page, 'time')).toBe(stopped)
  })

  test('steps with the arrow keys and plays with space', async () => {
    await scrub(page, 3)
    await page.locator('h1').click()
    await page.keyboard.press('ArrowRight')
    expect(await step(page)).toBe('4')
    await page.keyboard.press('Space')
    await expect.poll(() => page.getByTestId('play').getAttribute('aria-label')).toBe('pause')
    await page.keyboard.press('ArrowLeft')
    expect(await page.getByTestId('play').getAttribute('aria-label')).toBe('play')
    await scrub(page, 0)
  })

  test('chooses another quantity: the curve and the effects change', async () => {
    const select = page.getByTestId('plot-0').getByTestId('quantity')
    const first = await select.inputValue()
    const before = { curve: await curve(page, 'plot-0'), variables: await text(page, 'variables') }
    const values = await select
      .locator('option')
      .evaluateAll((all) => all.map((one) => (one as HTMLOptionElement).value))
    await select.selectOption(values.find((value) => value !== first)!)
    expect((await curve(page, 'plot-0')).sum).not.toBe(before.curve.sum)
    expect(await text(page, 'variables')).not.toBe(before.variables)
    await select.selectOption(first)
    expect((await curve(page, 'plot-0')).sum).toBe(before.curve.sum)
  })

  test('chooses the acceleration: its unit is shown', async () => {
    const order = page.getByTestId('plot-0').getByTestId('order')
    await order.selectOption('2')
    expect(await text(page, 'plot-0')).toMatch(/\/s²/)
    await order.selectOption('0')
  })

  test('draws a curve over another quantity, and clicks there', async () => {
    const over = page.getByTestId('plot-0').getByTestId('over')
    const name = (await over.locator('option').nth(1).innerText()).replace('over ', '')
    const before = await curve(page, 'plot-0')
    await over.selectOption({ index: 1 })
    expect((await curve(page, 'plot-0')).sum).not.toBe(before.sum)
    expect(await page.getByTestId('plot-0').getByRole('application').getAttribute('aria-label')).toContain(
      `over ${name}`,
    )
    const time = await text(page, 'time')
    await page
      .getByTestId('plot-0')
      .locator('.u-over')
      .click({ position: { x: 60, y: 40 } })
    expect(await text(page, 'time')).not.toBe(time)
    await over.selectOption({ index: 0 })
    await scrub(page, 0)
  })

  test('dragging along an axis shows that part of the time in all plots; a double click shows all of it', async () => {
    const axis = (await page.getByTestId('plot-1').locator('.abscissa').boundingBox())!
    const seen = async () => [(await curve(page, 'plot-0')).sum, (await curve(page, 'plot-1')).sum]
    const before = await seen()
    const drag = async (to: number) => {
      await page.mouse.move(axis.x + 40, axis.y + 8)
      await page.mouse.down()
      await page.mouse.move(axis.x + 40 + to, axis.y + 8, { steps: 3 })
      await page.mouse.up()
    }
    // A press that hardly moves is none.
    await drag(2)
    expect(await seen()).toEqual(before)
    await drag(120)
    const closer = await seen()
    for (const k of [0, 1]) expect(closer[k]).not.toBe(before[k])
    const area = page.getByTestId('plot-0').locator('.u-over')
    const { width } = (await area.boundingBox())!
    const last = Number(await page.getByTestId('scrub').getAttribute('max'))
    // Values at its left and right end.
    const ends: number[] = []
    for (const x of [1, width - 1]) {
      await area.click({ position: { x, y: 20 } })
      ends.push(Number(await step(page)) / last)
    }
    expect(ends[0]).toBeGreaterThan(40 / width - 0.05)
    expect(ends[1]).toBeLessThan(160 / width + 0.05)
    await page.getByTestId('plot-1').locator('.abscissa').dblclick()
    await scrub(page, 0)
    expect(await seen()).toEqual(before)
  })

  test('a plot zooms by button, keys and Shift with a drag; a drag without Shift sets the time', async () => {
    const plot = page.getByTestId('plot-0')
    const sum = async () => (await curve(page, 'plot-0')).sum
    const before = await sum()
    await plot.getByTestId('closer').click()
    const closer = await sum()
    expect(closer).not.toBe(before)
    await plot.getByTestId('whole').click()
    expect(await sum()).toBe(before)
    expect(await plot.getByTestId('whole').isVisible()).toBe(false)
    // Scrubbing shows no other part.
    const area = (await plot.locator('.u-over').boundingBox())!
    const drag = async () => {
      await page.mouse.move(area.x + 50, area.y + 30)
      await page.mouse.down()
      await page.mouse.move(area.x + 150, area.y + 30, { steps: 3 })
      await page.mouse.up()
    }
    await drag()
    expect(await step(page)).not.toBe('0')
    expect(await sum()).toBe(before)
    await scrub(page, 0)
    await page.keyboard.down('Shift')
    await drag()
    await page.keyboard.up('Shift')
    expect(await step(page)).toBe('0')
    expect(await sum()).not.toBe(before)
    await plot.getByRole('application').focus()
    const press = async (key: string) => {
      await page.keyboard.press(key)
      return sum()
    }
    expect(await press('0')).toBe(before)
    expect(await press('+')).toBe(closer)
    const later = await press('Shift+ArrowRight')
    expect(later).not.toBe(closer)
    expect(await press('Shift+ArrowLeft')).toBe(closer)
    expect(await press('-')).toBe(before)
    expect(await step(page)).toBe('0')
  })

  test('adds a curve and removes it', async () => {
    const plots = page.getByTestId('curves').locator('[data-testid^=plot-]')
    const count = await plots.count()
    await page.getByTestId('add-curve').click()
    expect(await plots.count()).toBe(count + 1)
    await plots.last().getByTestId('remove').click()
    expect(await plots.count()).toBe(count)
  })

  test('chooses another variable: its arrows are drawn and its row is marked', async () => {
    const before = await picture(page)
    const name = await other(page).locator('.name').innerText()
    await other(page).locator('.name').click()
    expect(await selected(page).locator('.name').innerText()).toBe(name)
    expect(await selected(page).count()).toBe(1)
    expect((await picture(page)).equals(before)).toBe(false)
    await rows(page).first().locator('.name').click()
  })

  test('changes a variable with its slider, sees what is predicted, and takes it back', async () => {
    const before = { view: await picture(page), curve: await curve(page, 'plot-0') }
    await slide(page, CHANGE, await page.locator(CHANGE).getAttribute('max').then(Number))
    expect((await picture(page)).equals(before.view)).toBe(false)
    expect((await curve(page, 'plot-0')).sum).not.toBe(before.curve.sum)
    expect(await page.locator('body').innerText()).toContain('predicted to first order')
    await selected(page).getByTestId('reset').click()
    expect((await picture(page)).equals(before.view)).toBe(true)
    expect((await curve(page, 'plot-0')).sum).toBe(before.curve.sum)
  })

  test('types a change and takes all changes back', async () => {
    const before = await curve(page, 'plot-0')
    await selected(page).getByTestId('change-value').fill('0.01')
    await selected(page).getByTestId('change-value').press('Enter')
    expect((await curve(page, 'plot-0')).sum).not.toBe(before.sum)
    await page.getByTestId('reset-all').click()
    expect((await curve(page, 'plot-0')).sum).toBe(before.sum)
  })

  test('points at the mechanism: what is there is named; a click selects it', async () => {
    const desk = await browser.newPage()
    const [first] = (await examine(desk, await picture(page), await paper(page))).places
    await desk.context().close()
    const view = (await page.locator(VIEW).boundingBox())!
    await page.mouse.move(view.x + first.x, view.y + first.y)
    await drawn(page)
    for (const line of ['strong', 'div']) expect(await page.getByTestId('tip').locator(line).innerText()).not.toBe('')
    expect(await page.getByTestId('tip').isVisible()).toBe(true)
    await page.mouse.move(view.x + 2, view.y + view.height - 2)
    await drawn(page)
    expect(await page.getByTestId('tip').isVisible()).toBe(false)
    const before = await picture(page)
    await page.mouse.click(view.x + first.x, view.y + first.y)
    expect((await picture(page)).equals(before)).toBe(false)
    await page.keyboard.press('Escape')
  })

  test('asks for names of hardpoints with a key', async () => {
    const view = page.locator('.view')
    // The pointer leaves the view, so that nothing else is named.
    await page.locator('h1').click()
    await drawn(page)
    const names = () => page.locator('.labels').textContent()
    expect(await names()).toBe('')
    const [before, mechanism] = [await settled(view), await picture(page)]
    await page.keyboard.press('l')
    await expect.poll(names).not.toBe('')
    await expect.poll(async () => (await view.screenshot()).equals(before)).toBe(false)
    await page.keyboard.press('l')
    await expect.poll(names).toBe('')
    expect((await picture(page)).equals(mechanism)).toBe(true)
  })

  test('looks from every standard side, turns the wheel, and fits again', async () => {
    const looks = page.locator('[data-testid^=look-]')
    const seen = [await picture(page)]
    for (const look of (await looks.all()).slice(1)) {
      await look.click()
      seen.push(await picture(page))
      expect(seen.slice(0, -1).some((picture) => picture.equals(seen.at(-1)!))).toBe(false)
    }
    await looks.first().click()
    expect((await picture(page)).equals(seen[0])).toBe(true)
    await page.locator(VIEW).hover()
    await page.mouse.wheel(0, -400)
    await expect.poll(async () => (await picture(page)).equals(seen[0])).toBe(false)
    await page.getByTestId('fit').click()
    await expect.poll(async () => (await picture(page)).equals(seen[0])).toBe(true)
  })

  test('reads the keys on the page itself', async () => {
    await page.locator('h1').click()
    await page.keyboard.press('?')
    expect(await page.getByTestId('keys').isVisible()).toBe(true)
    expect(await text(page, 'keys')).toMatch(/space/i)
    await page.keyboard.press('Escape')
    expect(await page.getByTestId('keys').isVisible()).toBe(false)
  })

  test('finds figures of the solver under checks, not before', async () => {
    expect(await page.getByTestId('summary').isVisible()).toBe(false)
    await page.getByTestId('tab-checks').click()
    expect(await page.getByTestId('summary').isVisible()).toBe(true)
    expect((await curve(page, 'plot-margin')).colours).toBeGreaterThan(10)
    await page.getByTestId('tab-table').click()
    expect(await page.getByTestId('heat').isVisible()).toBe(true)
  })

  test('was requested nothing else, and reported nothing on the console', () => {
    expect(visited.complaints).toEqual([])
  })
})
