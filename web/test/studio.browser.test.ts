import type { Browser, Page } from 'playwright-core'
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, test } from 'vitest'
import { launch, visit, type Visit } from './browser'
import { cleared, harness } from './harness/harness'
import { drawn } from './person'
import type {} from './harness/studio'

let browser: Browser
let url: string
beforeAll(async () => {
  ;[browser, url] = await Promise.all([launch(), harness('studio')])
})
afterAll(async () => {
  await browser?.close()
  cleared(url)
})

let visited: Visit
let page: Page
beforeEach(async () => {
  visited = await visit(browser, url, { viewport: { width: 900, height: 1000 } })
  page = visited.page
})
afterEach(async () => {
  expect(visited.complaints).toEqual([])
  await page.context().close()
})

const press = async (...keys: string[]) => {
  for (const key of keys) await page.keyboard.press(key)
}

describe('the designs that were gone through', () => {
  const go = (by: number) =>
    page.evaluate(
      (by) => window.designs.go({ text: window.model, settings: [{ name: 'rack_z', by }], label: `rack_z ${by}` }),
      by,
    )
  const shown = () => page.evaluate(() => window.shown.map(({ settings }) => settings[0]?.by ?? 0))

  test('are undone and done again by buttons that say what, and by keys', async () => {
    expect(await page.getByTestId('undo').isDisabled()).toBe(true)
    await go(1)
    await go(2)
    expect(await page.getByTestId('undo').getAttribute('aria-label')).toBe('Undo: rack_z 2 (Ctrl+Z)')
    await page.getByTestId('undo').click()
    expect(await page.getByTestId('redo').getAttribute('aria-label')).toBe('Redo: rack_z 2 (Ctrl+Y)')
    await press('Control+z', 'Control+Shift+Z', 'Control+y', 'Control+y')
    expect(await shown()).toEqual([1, 0, 1, 2])
    await page.getByTestId('reset-design').click()
    await press('Control+z')
    expect(await shown()).toEqual([1, 0, 1, 2, 0, 2])
  })

  test('are left alone while a text is typed', async () => {
    await go(1)
    await page.locator('#text').focus()
    await press('Control+z')
    expect(await shown()).toEqual([])
  })

  test('are kept by name, taken again, compared, renamed and deleted, by the keyboard alone', async () => {
    await go(1)
    await page.getByTestId('designs').focus()
    await press('Enter')
    await page.keyboard.insertText('stiff')
    await press('Enter')
    await go(2)
    await press('Enter')
    const names = () =>
      page.getByTestId('snapshot-rename').evaluateAll((all) => all.map((one) => (one as HTMLInputElement).value))
    expect(await names()).toEqual(['stiff', 'design 1'])
    await press('Tab', 'Tab')
    await page.keyboard.insertText('soft')
    await press('Tab', 'Tab')
    expect(await names()).toEqual(['soft', 'design 1'])
    await press('Enter')
    expect(await page.evaluate(() => window.compared)).toEqual(['soft'])
    // The button keeps the focus, though the list was made anew.
    expect(await page.evaluate(() => document.activeElement!.getAttribute('aria-pressed'))).toBe('true')
    await press('Shift+Tab', 'Enter')
    expect(await shown()).toEqual([1])
    expect(await page.getByTestId('snapshots').isVisible()).toBe(false)
    await press('Enter')
    await page.getByTestId('snapshot-delete').first().click()
    expect(await names()).toEqual(['design 1'])
    expect(await page.evaluate(() => window.compared)).toEqual(['soft', undefined])
    await press('Escape')
    expect(await page.evaluate(() => document.activeElement!.getAttribute('data-testid'))).toBe('designs')
  })
})

describe('a study', () => {
  const table = {
    title: 'Goals',
    note: '',
    header: ['goal', 'nominal', 'optimised', 'target'],
    rows: [['toe_error (bump)', '0.40243 deg', '0.0058794 deg', '0 deg']],
  }
  const found = {
    tables: [table],
    change: [{ name: 'rack_z', by: 2 }],
    text: 'name = "found"',
    message: 'an optimum within the bounds',
  }
  const last = () => page.evaluate(() => ({ ...window.studies.at(-1)! }))
  const end = (result: typeof found | { tables: never[]; change: null; text: null; message: string }) =>
    page.evaluate((result) => window.studies.at(-1)!.end(result), result)

  test('is requested by a form, indicates how far it is, and its design is taken', async () => {
    await page.getByTestId('search-outer_z').getByRole('checkbox').uncheck()
    await page.getByLabel('highest of rack_z').fill('20.5')
    await page.getByTestId('goal-camber_range').getByRole('checkbox').check()
    await page.getByLabel('target of camber_range').fill('2')
    await page.getByLabel('weight of camber_range').fill('0.5')
    await page.getByTestId('optimise-starts').fill('8')
    await page.getByTestId('optimise-run').click()
    expect((await last()).request).toEqual({
      variables: [
        { name: 'outer_x', bounds: [-15, 15] },
        { name: 'rack_z', bounds: [-15, 20.5] },
      ],
      goals: [
        { metric: 'toe_error', weight: 1, target: null },
        { metric: 'camber_range', weight: 0.5, target: 2 },
      ],
      starts: 8,
      iterations: 100,
    })
    await page.evaluate(() => window.studies[0].tell(3, 100, '3  objective 3.4786e-5  limits kept'))
    expect(await page.getByTestId('optimise-lines').innerText()).toBe('3  objective 3.4786e-5  limits kept')
    expect(
      await page.getByTestId('optimise-progress').evaluate((bar: HTMLProgressElement) => [bar.value, bar.max]),
    ).toEqual([3, 100])
    await end(found)
    await page.getByTestId('optimise-take').click()
    expect(await page.evaluate(() => window.taken)).toEqual([
      { change: [{ name: 'rack_z', by: 2 }], studied: 'name = "strut"' },
    ])
    // The selection is unchanged.
    expect(await page.getByLabel('highest of rack_z').inputValue()).toBe('20.5')
  })

  test('is cancelled, and the best so far shown and discarded', async () => {
    await page.getByTestId('optimise-run').click()
    await page.getByTestId('optimise-cancel').click()
    expect((await last()).cancelled).toBe(true)
    expect(await page.getByTestId('optimise-cancel').isDisabled()).toBe(true)
    await end({ ...found, message: 'interrupted; the best of 4 designs' })
    expect(await page.getByTestId('optimise').innerText()).toMatch(
      /interrupted.*toe_error \(bump\)\s+0.40243 deg\s+0.0058794 deg/s,
    )
    await page.getByTestId('optimise-discard').click()
    expect(await page.evaluate(() => window.taken)).toEqual([])
    expect(await page.getByTestId('optimise-run').isEnabled()).toBe(true)
  })

  test('says why it cannot be requested, and what went wrong', async () => {
    const why = () => page.getByTestId('optimise-why').innerText()
    await page.getByTestId('search-top_x').getByRole('checkbox').check()
    expect(await why()).toBe('top_x needs a lower and an upper bound.')
    await page.getByLabel('lowest of top_x').fill('3')
    await page.getByLabel('highest of top_x').fill('2')
    expect(await why()).toBe('The lower bound of top_x is not below its upper bound.')
    expect(await page.getByTestId('optimise-run').isDisabled()).toBe(true)
    await page.getByLabel('highest of top_x').fill('4')
    await page.getByTestId('optimise-run').click()
    await page.evaluate(() => window.studies[0].fail('the mechanism locks in `bump`'))
    expect(await page.getByTestId('optimise-refused').innerText()).toBe('the mechanism locks in bump')
    expect(await page.getByLabel('highest of top_x').inputValue()).toBe('4')
  })

  test('has a goal that is added without writing, of a quantity, with the reason why it cannot start', async () => {
    await page.getByTestId('goal-form').locator('summary').click()
    expect(await page.getByTestId('goal-of').inputValue()).toBe('of toe')
    expect(await page.getByTestId('goal-over').inputValue()).toBe('travel')
    await page.getByTestId('goal-aim').selectOption('keep')
    expect(await page.getByTestId('goal-why').innerText()).toBe('Enter a lower limit, an upper limit, or both.')
    expect(await page.getByTestId('goal-add').isDisabled()).toBe(true)
    await page.getByTestId('goal-min').fill('2 mm')
    expect(await page.getByTestId('goal-why').innerText()).toBe('This is an angle, but mm is not a unit of angle.')
    await page.getByTestId('goal-min').fill('-0,5')
    await page.getByTestId('goal-max').fill('0.5')
    await page.getByTestId('goal-case').selectOption('bump')
    await page.getByTestId('goal-max').press('Enter')
    expect(await page.evaluate(() => [window.model, window.studies.length])).toEqual([
      'name = "strut"\n\n[metrics]\ntoe_range = { case = "bump", of = "toe", over = "travel", take = "range" }\n\n' +
        '[optimize.goals]\ntoe_error = {}\n\n[optimize.limits]\ntoe_range = { metric = "toe_range", min = -0.5, max = 0.5 }\n',
      0,
    ])
  })

  test('shows its designs while it runs, and those of its starts', async () => {
    await page.getByTestId('optimise-starts').fill('3')
    await page.getByTestId('optimise-run').click()
    const change = (by: number) => [{ name: 'rack_z', by }]
    await page.evaluate(() => window.studies[0].tell(0, 3, '', [{ name: 'rack_z', by: 1 }]))
    await page.evaluate(() => window.studies[0].tell(1, 3, '  nominal  objective 2', [{ name: 'rack_z', by: 2 }]))
    await page.evaluate(() => window.studies[0].tell(2, 3, '  start 1  objective 1', [{ name: 'rack_z', by: 3 }]))
    await page.getByTestId('optimise-start').first().click()
    expect(await page.getByTestId('optimise-start').allInnerTexts()).toEqual(['nominal', 'start 1'])
    const best = [1, 2, 3].map((by) => ({ name: 'optimisation, best so far', change: change(by) }))
    const start = (name: string, by: number) => ({ name: `optimisation, ${name}`, change: change(by) })
    expect(await page.evaluate(() => window.previews)).toEqual([...best, start('nominal', 2)])
    await end(found)
    await page.getByTestId('optimise-start').last().click()
    await page.getByTestId('optimise-discard').click()
    expect((await page.evaluate(() => window.previews)).slice(4)).toEqual([
      { name: 'optimised design', change: change(2) },
      start('start 1', 3),
      undefined,
    ])
  })

  test('of a design that has changed since says so', async () => {
    await page.getByTestId('optimise-run').click()
    await page.evaluate(() => (window.model = 'name = "other"'))
    await end(found)
    expect(await page.getByTestId('optimise-stale').isVisible()).toBe(true)
    await page.getByTestId('optimise-take').click()
    expect(await page.evaluate(() => window.taken[0].studied)).toBe('name = "strut"')
  })

  test('follows the text, but keeps what was chosen until it is reported to read it again', async () => {
    await page.getByTestId('optimise-starts').fill('5')
    const change = (text: string) =>
      page.evaluate((text) => {
        window.model = text
        window.refresh()
      }, text)
    await change('name = "other"')
    expect(await page.getByTestId('optimise-starts').inputValue()).toBe('5')
    await page.getByTestId('optimise-again').click()
    await expect.poll(() => page.getByTestId('optimise-starts').inputValue()).toBe('1')
    await change('broken')
    await expect
      .poll(() => page.getByTestId('optimise-refused').innerText())
      .toBe('the mechanism does not move: rack_drive has no law')
    await change('name = "strut"')
    await page.getByTestId('optimise-run').waitFor()
  })

  test('is refused for a design that has no text, with the reason', async () => {
    const unwritten = (why: string) =>
      page.evaluate((why) => {
        window.unwritten = why
        window.refresh()
      }, why)
    const why = (name: string) => page.getByTestId(`${name}-why`).innerText()
    await unwritten('`A.x` is an expression')
    for (const name of ['optimise', 'tolerance']) {
      expect(await page.getByTestId(`${name}-run`).isDisabled()).toBe(true)
      expect(await why(name)).toBe('A.x is an expression')
    }
    await unwritten('')
    expect([await why('optimise'), await page.getByTestId('optimise-run').isEnabled()]).toEqual(['', true])
    // The design has changed, and the page does not know yet whether it has a text.
    await page.evaluate(() => (window.unwritten = '`A.y` is an expression'))
    await page.getByTestId('optimise-run').click()
    await expect.poll(() => page.getByTestId('optimise-refused').innerText()).toBe('A.y is an expression')
    expect(await page.evaluate(() => window.studies.length)).toBe(0)
  })

  test('has a form for goals whose entries outlive the text, so that a proposal is not lost', async () => {
    const [of, form] = [page.getByTestId('goal-of'), page.getByTestId('goal-form')]
    const change = (text: string) =>
      page.evaluate((text) => {
        window.model = text
        window.refresh()
      }, text)
    await page.evaluate(() => window.propose('travel'))
    expect(await of.inputValue()).toBe('of travel')
    const former = await form.elementHandle()
    await change('name = "other"')
    await page.waitForFunction((former) => !former!.isConnected, former)
    expect(await of.inputValue()).toBe('of travel')
    // Proposed while the form of another text is on its way.
    await page.evaluate(() => {
      window.model = 'name = "third"'
      window.refresh()
      window.propose('toe_error')
    })
    await expect.poll(() => page.getByTestId('optimise-again').isVisible()).toBe(false)
    expect(await of.inputValue()).toBe('metric toe_error')
    await page.getByTestId('goal-aim').selectOption('keep')
    await page.getByTestId('goal-max').fill('2')
    await change('name = "fourth"')
    await expect.poll(() => page.getByTestId('optimise-again').isVisible()).toBe(false)
    expect(await page.getByTestId('goal-max').inputValue()).toBe('2')
  })

  test('of tolerances asks for a seed and how many designs are drawn, and has no design to take', async () => {
    await page.getByTestId('tolerance-samples').fill('500')
    await page.getByTestId('tolerance-seed').fill('0')
    expect(await page.getByTestId('tolerance-why').innerText()).toBe('Seed: a whole number from 1 to 4294967295.')
    await page.getByTestId('tolerance-seed').fill('7')
    await press('Enter')
    expect((await last()).request).toEqual({ samples: 500, seed: 7 })
    await end({ tables: [], change: null, text: null, message: '500 designs were drawn' })
    expect(await page.getByTestId('tolerance-take').count()).toBe(0)
    await page.getByTestId('tolerance-discard').click()
    expect(await page.getByTestId('tolerance-run').isVisible()).toBe(true)
  })
})

describe('a target that is drawn', () => {
  const made = () => page.evaluate(() => window.drawn as [number, number][])
  const area = async () => (await page.getByTestId('sketch').boundingBox())!
  /** Draws along a function of 0 to 1, both ways within the area. */
  async function stroke(from: number, to: number, y: (x: number) => number, steps = 40) {
    const { x: left, y: top, width, height } = await area()
    for (let k = 0; k <= steps; k++) {
      const x = from + ((to - from) * k) / steps
      await page.mouse.move(left + x * width, top + y(x) * height)
      if (k === 0) await page.mouse.down()
    }
    await page.mouse.up()
  }

  beforeEach(async () => {
    await page.locator('#sketch').click()
    await drawn(page)
  })

  test('freehand is a handful of points near it', async () => {
    await stroke(0.1, 0.9, (x) => 0.5 - 0.3 * Math.sin(2 * Math.PI * x))
    await page.getByTestId('sketch-take').click()
    const points = await made()
    expect(points.length).toBeGreaterThan(4)
    expect(points.length).toBeLessThan(20)
    const xs = points.map(([x]) => x)
    expect([xs[0], xs.at(-1)!].map(Math.round)).toEqual([1, 9])
    expect(xs).toEqual([...xs].sort((a, b) => a - b))
    // The middle of the plot is 0, and it is as high above as below.
    const ys = points.map(([, y]) => y)
    expect(Math.max(...ys) + Math.min(...ys)).toBeCloseTo(0, 1)
    expect(Math.max(...ys)).toBeGreaterThan(0.8)
    expect(await page.getByTestId('sketch').count()).toBe(0)
  })

  test('drawn over takes the place of that part only, from the right too', async () => {
    await stroke(0, 1, () => 0.5)
    await stroke(0.6, 0.4, () => 0.25)
    await page.getByTestId('sketch-take').click()
    const points = await made()
    const at = (x: number) =>
      points.reduce((best, point) => (Math.abs(point[0] - x) < Math.abs(best[0] - x) ? point : best))[1]
    expect(Math.abs(at(0))).toBeLessThan(0.02)
    expect(Math.abs(at(10))).toBeLessThan(0.02)
    expect(at(4)).toBeGreaterThan(0.5)
    expect(at(6)).toBeGreaterThan(0.5)
  })

  test('is set point by point, and moved, by keys alone', async () => {
    expect(await page.evaluate(() => document.activeElement!.getAttribute('data-testid'))).toBe('sketch')
    await press('Enter', 'ArrowRight', 'ArrowRight', 'ArrowUp', 'Enter', 'ArrowRight', 'Enter', 'Delete')
    expect(await page.getByTestId('sketch-reading').innerText()).toMatch(/2 points$/)
    await press('PageUp', 'PageUp', 'PageUp')
    expect(await page.getByTestId('sketch-reading').innerText()).toMatch(/^5 s: 0 deg/)
    await press('Shift+Tab')
    for (
      let k = 0;
      k < 6 && !(await page.getByTestId('sketch-take').evaluate((one) => one === document.activeElement));
      k++
    )
      await press('Shift+Tab')
    await press('Enter')
    const points = await made()
    expect(points).toHaveLength(2)
    expect(points[0]).toEqual([5, 0])
    expect(points[1][0]).toBe(5.4)
    expect(points[1][1]).toBeGreaterThan(0)
  })

  test('has points that are set by a press and moved by a drag, but not past each other', async () => {
    const { x, y, width, height } = await area()
    await page.mouse.click(x + 0.25 * width, y + 0.5 * height)
    await page.mouse.click(x + 0.75 * width, y + 0.5 * height)
    await page.mouse.move(x + 0.25 * width, y + 0.5 * height)
    await page.mouse.down()
    await page.mouse.move(x + 0.9 * width, y + 0.25 * height)
    await page.mouse.up()
    await page.getByTestId('sketch-take').click()
    const [a, b] = await made()
    expect(a[0]).toBeLessThan(b[0])
    expect(a[1]).toBeGreaterThan(0.3)
    expect(b).toEqual([7.5, 0])
  })

  test('stays in place when the plot is redrawn, has room beyond the curves, and is cancelled by Escape', async () => {
    await stroke(0.2, 0.8, () => 0.5)
    const place = () => page.locator('.sketch .point').first().getAttribute('cy').then(Number)
    const before = await place()
    await page.evaluate(() => window.show())
    await drawn(page)
    expect(Math.abs((await place()) - before)).toBeLessThan(1)
    const top = () => page.evaluate(() => window.plot.overlay!.reach(-1, 1)[1])
    const least = await top()
    await page.getByTestId('sketch-room').click()
    expect(await top()).toBeGreaterThan(least)
    await page.getByTestId('sketch').focus()
    await press('Escape')
    expect(await page.evaluate(() => window.drawn)).toBe('cancelled')
    expect(await page.getByTestId('sketch').count()).toBe(0)
  })
})

test('a target that is drawn becomes a metric of the text', async () => {
  const button = page.getByTestId('draw-target')
  await button.click()
  await press('Enter', 'ArrowRight', 'Enter')
  await page.getByTestId('sketch-take').click()
  expect(await page.evaluate(() => window.model)).toBe(
    'name = "strut"\n\n[metrics.wheel_z_target]\nof = "wheel.z"\nover = "travel"\n' +
      'take = "rms"\nwindow = [5, 5.2]\ntarget = [[5, 0], [5.2, 0]]\n',
  )
  expect(await button.evaluate((one) => one === document.activeElement)).toBe(true)
  await button.click()
  await button.click()
  expect(await page.getByTestId('sketch').count()).toBe(0)
  expect(await button.getAttribute('aria-pressed')).toBe('false')
})

test('a finger sets points, and draws with touch as a mouse does', async () => {
  const { page, complaints } = await visit(browser, url, { viewport: { width: 700, height: 900 }, hasTouch: true })
  await page.locator('#sketch').tap()
  await drawn(page)
  const { x, y, width, height } = (await page.getByTestId('sketch').boundingBox())!
  await page.touchscreen.tap(x + 0.25 * width, y + 0.5 * height)
  await page.touchscreen.tap(x + 0.75 * width, y + 0.25 * height)
  const points = () => page.locator('.sketch .point').count()
  await expect.poll(points).toBe(2)
  const devtools = await page.context().newCDPSession(page)
  const touch = (type: 'touchStart' | 'touchMove' | 'touchEnd', across?: number) =>
    devtools.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: across === undefined ? [] : [{ x: x + across * width, y: y + 0.4 * height }],
    })
  await touch('touchStart', 0.4)
  for (let k = 1; k <= 10; k++) await touch('touchMove', 0.4 + 0.02 * k)
  await touch('touchEnd')
  // Both ends of the new part, and the adjacent ends of the old one.
  await expect.poll(points).toBe(6)
  expect(complaints).toEqual([])
  await page.context().close()
})
