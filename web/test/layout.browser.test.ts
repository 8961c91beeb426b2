import { execFileSync } from 'node:child_process'
import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, NO_3D, visit } from './browser'
import { curve, drawn, picture, scrub, text } from './person'

const { whole, partial, models, hardpoint } = inject('samples')

let browser: Browser
beforeAll(async () => {
  browser = await launch()
})
afterAll(() => browser?.close())

/** The areas of the page; none may lie on another. */
const AREAS = ['title', 'values', 'view-canvas', 'scrub', 'curves', 'variables', 'ranking', 'checks']
/** Areas may share a border line. */
const LINE = 1
/** Screens of less have one section at a time. */
const NARROW = 600
/** Visible controls that lie outside their screen's width cannot be reached by a reader. */
const CONTROLS = 'button:visible, select:visible, input:visible, summary:visible'

/** Visible areas with their boxes. */
async function boxes(page: Page) {
  const found = await Promise.all(
    AREAS.map(async (name) => {
      const area = page.getByTestId(name).first()
      return { name, box: (await area.isVisible()) ? (await area.boundingBox())! : undefined }
    }),
  )
  return found.flatMap(({ name, box }) => (box ? [{ name, ...box }] : []))
}

describe.each([
  [390, 844],
  [1024, 768],
  [1440, 900],
  [2560, 1440],
])('on a screen of %d by %d', (width, height) => {
  let page: Page
  beforeAll(async () => {
    page = (await visit(browser, models.macpherson, { viewport: { width, height } })).page
    await drawn(page)
  })
  afterAll(() => page?.context().close())

  test('nothing reaches beyond the side', async () => {
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(width)
  })

  test('view, curves or variables, and time are seen without scrolling, and no area lies on another', async () => {
    const areas = await boxes(page)
    const names = areas.map(({ name }) => name)
    expect(names).toEqual(expect.arrayContaining(['title', 'view-canvas', 'scrub']))
    expect(names.some((name) => name === 'curves' || name === 'variables')).toBe(true)
    for (const [k, a] of areas.entries()) {
      for (const b of areas.slice(0, k)) {
        const apart =
          a.x + a.width <= b.x + LINE ||
          b.x + b.width <= a.x + LINE ||
          a.y + a.height <= b.y + LINE ||
          b.y + b.height <= a.y + LINE
        expect(apart, `${a.name} beside ${b.name}`).toBe(true)
      }
    }
    for (const name of ['view-canvas', 'scrub']) {
      const { y, height: tall } = areas.find((area) => area.name === name)!
      expect(y + tall, `${name} ends on the screen`).toBeLessThanOrEqual(height)
    }
  })

  test('the keys and the path of a hardpoint are within reach', async () => {
    const help = page.getByTestId(width < NARROW ? 'nav-help' : 'help')
    for (const control of [help, page.getByTestId('trace')]) {
      const { x, y, width: wide, height: tall } = (await control.boundingBox())!
      expect(x).toBeGreaterThanOrEqual(0)
      expect(x + wide).toBeLessThanOrEqual(width)
      expect(y + tall).toBeLessThanOrEqual(height)
    }
    await help.click()
    expect(await page.getByTestId('keys').isVisible()).toBe(true)
    await page.keyboard.press('Escape')
  })

  test('the table shows its figures with their units, whole', async () => {
    if (width < NARROW) await page.getByTestId('nav-tables').click()
    const cut = await page
      .locator('.ranking td.figure')
      .evaluateAll((cells) =>
        cells.filter((cell) => cell.scrollWidth > cell.clientWidth).map((cell) => cell.textContent),
      )
    expect(cut).toEqual([])
    if (width < NARROW) await page.getByTestId('nav-curves').click()
  })

  test('every area can be brought up', async () => {
    const bring = async (button: string, area: string) => {
      await page.getByTestId(button).click()
      expect(await page.getByTestId(area).isVisible(), area).toBe(true)
      expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(width)
      for (const stays of ['view-canvas', 'scrub', 'values'])
        expect(await page.getByTestId(stays).isVisible(), stays).toBe(true)
    }
    if (width < NARROW) {
      await bring('nav-curves', 'curves')
      await bring('nav-variables', 'variables')
      await bring('nav-tables', 'tab-table')
    }
    await bring('tab-checks', 'checks')
    await bring('tab-table', 'ranking')
  })
})

/** Fields above plots whose selection is wider than they are, less the arrow. */
const cutFields = (page: Page) =>
  page.locator('.plot figcaption select').evaluateAll((all: HTMLSelectElement[]) => {
    const context = document.createElement('canvas').getContext('2d')!
    return all.flatMap((field) => {
      const { fontWeight, fontSize, fontFamily, paddingLeft, paddingRight } = getComputedStyle(field)
      context.font = `${fontWeight} ${fontSize} ${fontFamily}`
      const name = field.selectedOptions[0].text
      const room = field.clientWidth - parseFloat(paddingLeft) - parseFloat(paddingRight) - 16
      return context.measureText(name).width > room + 1 ? [name] : []
    })
  })

describe('on a laptop', () => {
  test('the fields above plots show their selection whole, and the variables of a search are all in sight', async () => {
    const { page } = await visit(browser, models.four_bar, { viewport: { width: 1440, height: 900 } })
    expect(await page.getByTestId('plot-0').getByTestId('over').locator('option:checked').innerText()).toBe(
      'over crank_angle',
    )
    expect(await cutFields(page)).toEqual([])
    await page.waitForFunction(() => document.getElementById('page')!.dataset.engine === 'ready')
    await page.getByTestId('open-optimise').click()
    await page.getByTestId('search-B_x').waitFor()
    const isCut = (table: Element) => table.scrollHeight > table.clientHeight
    expect(await page.locator('.study .scroll').first().evaluate(isCut)).toBe(false)
    expect(await page.getByTestId('variable-note').innerText()).toBe('Moves B along x')
    await page.context().close()
  })

  test('a badge is below the name where there is no room beside it', async () => {
    const { page } = await visit(browser, models.delta, { viewport: { width: 1440, height: 900 } })
    const names = page.locator('.variables li:has(.badge) .name')
    expect(await names.count()).toBeGreaterThan(0)
    const cut = await names.evaluateAll((all) => all.filter((name) => name.scrollWidth > name.clientWidth).length)
    expect(cut).toBe(0)
    await page.context().close()
  })
})

describe.each([
  [390, 844],
  [844, 390],
])('on a phone of %d by %d, while points are moved', (width, height) => {
  test('cards do not overlap, all of the pane is in sight, and the view has room', async () => {
    const options = { viewport: { width, height }, hasTouch: true, isMobile: true }
    const { page } = await visit(browser, models.macpherson, options)
    await page.waitForFunction(() => document.getElementById('page')!.dataset.engine === 'ready')
    await page.getByTestId('grips').click()
    const over = await page
      .locator('.card:visible')
      .evaluateAll((all) => all.flatMap((card) => (card.scrollWidth > card.clientWidth ? [card.textContent] : [])))
    expect(over).toEqual([])
    for (const control of ['snap', 'grip-reset', 'grip-done']) {
      const { x, y, width: wide, height: tall } = (await page.getByTestId(control).boundingBox())!
      expect(x + wide, control).toBeLessThanOrEqual(width)
      expect(y + tall, control).toBeLessThanOrEqual(height)
    }
    expect((await page.getByTestId('view-canvas').boundingBox())!.height).toBeGreaterThan(170)
    await page.context().close()
  })
})

describe('with the keyboard only', () => {
  test('every control is reached, shows that it has the focus, and can be left', async () => {
    const { page, complaints } = await visit(browser, models.macpherson, { viewport: { width: 1440, height: 900 } })
    // One of a set of tabs or of radio buttons takes the focus for all of them.
    const expected = await page.locator(CONTROLS).evaluateAll((all) => {
      const stops = all.filter((one) => (one as HTMLElement).tabIndex >= 0 && !(one as HTMLButtonElement).disabled)
      stops.forEach((one, k) => (one.id ||= `stop-${k}`))
      return stops.map(({ id }) => id)
    })
    const reached = new Set<string>()
    const unseen: string[] = []
    for (let k = 0; k < 3 * expected.length; k++) {
      await page.keyboard.press('Tab')
      const { id, name, seen } = await page.evaluate(() => {
        const one = document.activeElement as HTMLElement
        const { outlineStyle, boxShadow } = getComputedStyle(one)
        const name = one.dataset.testid ?? one.getAttribute('aria-label') ?? one.innerText
        return { id: one.id, name, seen: one === document.body || outlineStyle !== 'none' || boxShadow !== 'none' }
      })
      if (!seen) unseen.push(name)
      if (id) reached.add(id)
    }
    expect(unseen).toEqual([])
    const missed = await page.evaluate(
      (ids) => ids.map((id) => document.getElementById(id)?.outerHTML.slice(0, 120)),
      expected.filter((id) => !reached.has(id)),
    )
    expect(missed).toEqual([])
    expect(complaints).toEqual([])
    await page.context().close()
  })

  test('a variable is chosen and changed, a view taken, the time moved, a file requested', async () => {
    const { page } = await visit(browser, models.macpherson, { viewport: { width: 1440, height: 900 } })
    const row = page.getByTestId('variables').locator('[data-testid^=variable-]:has(.name)').nth(1)
    const name = await row.locator('.name').innerText()
    await row.locator('.name').focus()
    await page.keyboard.press('Enter')
    expect(await page.locator('[data-testid^=variable-][aria-current=true] .name').innerText()).toBe(name)
    // The focus is unchanged, so that the reader continues from there.
    expect(await page.evaluate(() => document.activeElement!.textContent)).toBe(name)
    const before = await picture(page)
    await page.locator('[data-testid^=variable-][aria-current=true] [data-testid=change]').focus()
    await page.keyboard.press('End')
    // On a slow machine the design follows some frames later.
    await expect.poll(async () => (await picture(page)).equals(before), { timeout: 10_000 }).toBe(false)
    const changed = await picture(page)
    await page.locator('h1').click()
    await page.keyboard.press('2')
    expect((await picture(page)).equals(changed)).toBe(false)
    await page.keyboard.press('1')
    await page.keyboard.press('ArrowRight')
    expect(await page.getByTestId('scrub').inputValue()).toBe('1')
    await page.getByTestId('export').focus()
    await page.keyboard.press('Enter')
    expect(await page.getByTestId('export-menu').isVisible()).toBe(true)
    await page.keyboard.press('Escape')
    expect(await page.getByTestId('export-menu').isVisible()).toBe(false)
    await page.context().close()
  })
})

describe('printed', () => {
  test('the report is a few pages with its picture, curves, values and variables', async () => {
    const { page, complaints } = await visit(browser, models.macpherson, { colorScheme: 'dark' })
    const pdf = await page.pdf({ format: 'A4', printBackground: true })
    const pages = pdf.toString('latin1').match(/\/Type\s*\/Page\b/g)!.length
    expect(pages).toBeLessThanOrEqual(6)
    await page.emulateMedia({ media: 'print' })
    for (const name of ['title', 'values', 'plot-0', 'variables', 'summary'])
      expect(await page.getByTestId(name).isVisible(), name).toBe(true)
    // Buttons are of no use on paper.
    for (const name of ['export', 'help', 'play', 'scrub'])
      expect(await page.getByTestId(name).isVisible(), name).toBe(false)
    // Paper is white, independent of the screen.
    expect(await page.evaluate(() => getComputedStyle(document.body).backgroundColor)).toMatch(
      /^rgb\(255, 255, 255\)$|^rgba\(0, 0, 0, 0\)$/,
    )
    expect(complaints).toEqual([])
    await page.context().close()
  })
})

describe('printed in parts', () => {
  test('the parts are chosen by the names of the command, and remembered; the next print has all again', async () => {
    const { page, complaints } = await visit(browser, models.macpherson)
    await page.waitForFunction(() => document.getElementById('page')!.dataset.engine === 'ready')
    await page.evaluate(() => (window.print = () => undefined))
    const open = async () => {
      await page.getByTestId('export').click()
      await page.getByTestId('export-print').click()
    }
    await open()
    const offered = await page
      .locator('[data-testid=composer] input')
      .evaluateAll((all) => all.map((one) => one.getAttribute('name')))
    const help = execFileSync(hardpoint, ['run', '--help'], { encoding: 'utf8' })
    const parts = /report\.pdf, which this writes[^:]*: ([\w\s,]*)/
      .exec(help)![1]
      .trim()
      .split(/[\s,]+/)
    expect(offered).toEqual([...parts, 'checks'])
    for (const name of ['curves', 'variables', 'checks']) await page.getByTestId(`print-${name}`).uncheck()
    await page.getByTestId('print-run').click()
    await page.emulateMedia({ media: 'print' })
    for (const name of ['values', 'comparison', 'hardpoints', 'time'])
      expect(await page.getByTestId(name).first().isVisible(), name).toBe(true)
    for (const name of ['plot-0', 'variables', 'summary'])
      expect(await page.getByTestId(name).isVisible(), name).toBe(false)
    await page.evaluate(() => dispatchEvent(new Event('afterprint')))
    expect(await page.getByTestId('plot-0').isVisible()).toBe(true)
    await page.emulateMedia({ media: 'screen' })
    await open()
    expect(await page.getByTestId('print-curves').isChecked()).toBe(false)
    expect(await page.getByTestId('print-hardpoints').isChecked()).toBe(true)
    expect(complaints).toEqual([])
    await page.context().close()
  })
})

describe('for readers who want no motion', () => {
  test('nothing moves by itself, a change of view is there at once, and play still plays', async () => {
    const { page, complaints } = await visit(browser, models.macpherson, { reducedMotion: 'reduce' })
    expect(await page.evaluate(() => document.getAnimations().length)).toBe(0)
    const start = await picture(page)
    await page.locator('[data-testid^=look-]').nth(1).click()
    const turned = await picture(page)
    expect(turned.equals(start)).toBe(false)
    expect((await picture(page)).equals(turned)).toBe(true)
    await page.getByTestId('play').click()
    await expect.poll(() => page.getByTestId('scrub').inputValue()).not.toBe('0')
    expect(complaints).toEqual([])
    await page.context().close()
  })
})

describe('without WebGL', () => {
  test('curves, variables and tables still work', async () => {
    const browser = await launch(NO_3D)
    try {
      const { page, complaints } = await visit(browser, whole)
      expect(await text(page, 'no-webgl')).toContain('needs WebGL')
      expect((await curve(page, 'plot-0')).colours).toBeGreaterThan(10)
      const before = await text(page, 'plot-0')
      await scrub(page, 7)
      expect(await text(page, 'plot-0')).not.toBe(before)
      await page.getByTestId('tab-table').click()
      expect(await page.getByTestId('heat').isVisible()).toBe(true)
      expect(complaints).toEqual([])
    } finally {
      await browser.close()
    }
  })
})

describe('what went wrong', () => {
  test.each([1024, 1440])('names in legends and rows are whole in a window %d wide', async (width) => {
    const { page } = await visit(browser, models.delta, { viewport: { width, height: 768 } })
    await drawn(page)
    const labels = page.locator('.legend .label:visible')
    expect(await labels.count()).toBeGreaterThan(3)
    const cut = await labels.evaluateAll((all) =>
      all
        .filter((label) => {
          const { right, bottom } = label.getBoundingClientRect()
          const [line, value] = [label.closest('li')!, label.nextElementSibling!].map((one) =>
            one.getBoundingClientRect(),
          )
          const isWhole = label.scrollWidth <= label.clientWidth && bottom <= line.bottom + 1 && right <= value.left
          return !isWhole || value.right > line.right + 1
        })
        .map((label) => label.textContent),
    )
    expect(cut).toEqual([])
    const rows = page.locator('.variables .name:visible')
    expect(await rows.count()).toBeGreaterThan(3)
    expect(await rows.evaluateAll((all) => all.filter((name) => name.scrollWidth > name.clientWidth).length)).toBe(0)
    await page.context().close()
  })

  test('a variable that no motion follows is struck out and says why', async () => {
    const { page } = await visit(browser, whole)
    const row = page.getByTestId('variable-crank_pin_tilt')
    expect(await row.locator('.name').evaluate((name) => getComputedStyle(name).textDecorationLine)).toBe(
      'line-through',
    )
    await row.locator('.name').click()
    expect(await page.locator('body').innerText()).toContain('No motion closes crank_pin')
    await page.context().close()
  })

  test('a motion that stops says so in a banner', async () => {
    const { page, complaints } = await visit(browser, partial)
    expect(await page.getByRole('status').first().innerText()).toContain('It stops at t = 1.2 s')
    expect(complaints).toEqual([])
    await page.context().close()
  })
})
