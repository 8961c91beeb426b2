import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, beforeEach, afterEach, describe, expect, test } from 'vitest'
import { launch, visit, type Visit } from './browser'
import { cleared, harness } from './harness/harness'

let browser: Browser
let url: string
beforeAll(async () => {
  ;[browser, url] = await Promise.all([launch(), harness('editor')])
})
afterAll(async () => {
  await browser?.close()
  cleared(url)
})

let visited: Visit
let page: Page
beforeEach(async () => {
  visited = await visit(browser, url, { viewport: { width: 620, height: 800 } })
  page = visited.page
})
afterEach(async () => {
  expect(visited.complaints).toEqual([])
  await page.context().close()
})

const content = () => page.getByTestId('model-text')
const messages = () => page.getByTestId('model-messages').locator('li')
const status = () => page.getByTestId('model-status').innerText()
const text = () => page.evaluate(() => window.pane.text)
const valid = () => page.evaluate(() => window.valid)
const checked = () => expect.poll(() => page.getByTestId('model-pane').getAttribute('aria-busy')).toBe('false')
const reveal = (line: number, column: number) =>
  page.evaluate(([line, column]) => window.pane.reveal(line, column), [line, column])
const press = async (...keys: string[]) => {
  for (const key of keys) await page.keyboard.press(key)
}
/** The line and column of a part of the text, from 1. */
async function place(part: string): Promise<[line: number, column: number]> {
  const before = (await text()).split(part)[0].split('\n')
  return [before.length, before.at(-1)!.length + 1]
}
/** The text with the cursor as `|`. */
const aroundCursor = () =>
  page.evaluate(() => {
    const { anchorNode, anchorOffset } = getSelection()!
    const line = (anchorNode instanceof Element ? anchorNode : anchorNode!.parentElement!).closest('.cm-line')!
    const range = document.createRange()
    range.setStart(line, 0)
    range.setEnd(anchorNode!, anchorOffset)
    const before = range.toString()
    return `${before}|${line.textContent!.slice(before.length)}`
  })

describe('a text that is typed', () => {
  test('shows what is wrong at its place while it is, and goes to the page when it is mended', async () => {
    const [line, column] = await place('"knuckle", "strut"]')
    await reveal(line, column + 1)
    await page.keyboard.type('x')
    await checked()
    expect(await page.locator('.cm-lintRange-error').innerText()).toBe('"xknuckle"')
    expect(await status()).toBe('1 error, 1 note. The page shows the last valid model.')
    expect(await messages().first().innerText()).toMatch(
      /there is no body named xknuckle.*valid names: ground, lca.*help correct the name/s,
    )
    expect(await page.locator('.cm-lint-marker-error').count()).toBe(1)
    expect(await valid()).toEqual([])
    await page.keyboard.press('Backspace')
    await checked()
    expect(await page.locator('.cm-lintRange-error').count()).toBe(0)
    expect(await status()).toBe('1 note')
    // It is the text that the page already shows.
    expect(await valid()).toEqual([])
    await page.keyboard.press('End')
    await page.keyboard.insertText('   # mended')
    await checked()
    expect(await valid()).toEqual([await text()])
  })

  test('is checked where it rests, not at every change', async () => {
    await checked()
    const asked = await page.evaluate(() => window.asked)
    await page.evaluate(() => {
      for (let k = 0; k < 10; k++) window.pane.setText(`# ${k}\n${window.pane.text}`)
    })
    await checked()
    expect(await page.evaluate(() => window.asked)).toBe(asked + 1)
  })

  test('is checked again where a check fails, and says so where it goes on failing', async () => {
    const fail = (times: number) => page.evaluate((times) => (window.failing = times), times)
    await reveal(1, 1)
    await fail(2)
    await page.keyboard.insertText('# one\n')
    await checked()
    expect(await valid()).toHaveLength(1)
    await fail(9)
    await page.keyboard.insertText('# two\n')
    await checked()
    expect(await messages().first().innerText()).toContain('the text could not be checked: the engine has ended')
    expect(await valid()).toHaveLength(1)
  })

  test('has its message under the pointer too', async () => {
    await reveal(...(await place('"ground", "lca"]')))
    await page.keyboard.type('"grond", ')
    await checked()
    await page.locator('.cm-lintRange-error').hover()
    await expect.poll(() => page.locator('.cm-tooltip-lint').innerText()).toContain('help correct the name')
  })
})

describe('by the keyboard alone', () => {
  test('tabs pass through the text, go into it once it is typed in, and leave it after Escape', async () => {
    await page.locator('#before').focus()
    const passed: string[] = []
    for (let k = 0; k < 12 && passed.at(-1) !== 'after'; k++) {
      await press('Tab')
      passed.push(
        await page.evaluate(() => document.activeElement!.getAttribute('data-testid') ?? document.activeElement!.id),
      )
    }
    expect(passed).toEqual(expect.arrayContaining(['model-find', 'model-text', 'after']))
    await press('Shift+Tab', 'Shift+Tab')
    expect(await content().evaluate((one) => one === document.activeElement)).toBe(true)
    const before = await text()
    await press('Control+Home', 'Tab')
    expect(await text()).toBe(`  ${before}`)
    await press('Shift+Tab')
    expect(await text()).toBe(before)
    await press('Escape', 'Tab')
    expect(await content().evaluate((one) => one === document.activeElement)).toBe(false)
    expect(await text()).toBe(before)
  })

  test('a message of the list leads to its place', async () => {
    await reveal(...(await place('"ground", "strut"]')))
    await page.keyboard.type('"grond", ')
    await press('Control+Home')
    await checked()
    await messages().first().locator('button').focus()
    await press('Enter')
    expect(await aroundCursor()).toBe('bodies = [|"grond", "ground", "strut"]')
    await press('Control+Home', 'F8')
    expect(await aroundCursor()).toMatch(/grond|cut/)
  })

  test('lines become comments, words are found, typing is undone and done again', async () => {
    const before = await text()
    await reveal(...(await place('cut = true')))
    await press('Control+/')
    expect(await text()).toContain('# cut = true')
    await press('Control+z')
    expect(await text()).toBe(before)
    await press('Control+y')
    expect(await text()).toContain('# cut = true')
    await press('Control+f')
    await page.keyboard.type('tie_rod_outer_z')
    await press('Enter', 'Escape')
    expect(await page.evaluate(() => getSelection()!.toString())).toBe('tie_rod_outer_z')
  })

  test('names are completed from the text itself', async () => {
    await reveal(...(await place('"tie_rod_outer", "tie_rod_inner"]')))
    await page.keyboard.type('"strut_t')
    await page.locator('.cm-tooltip-autocomplete').waitFor()
    expect(await page.locator('.cm-tooltip-autocomplete li').allInnerTexts()).toEqual([
      expect.stringContaining('strut_top'),
    ])
  })
})

describe('a text from outside', () => {
  const longer = (text: string) =>
    text
      .replace('[270.51, 345.44, -59.69]', '[271.25, 345.44, -59.69]')
      .replace('[-200, 200, -50]', '[-200, 212.5, -50]')

  test('leaves the cursor and what is seen where they are, and is one step of undo', async () => {
    const [line, column] = await place('"rack_slide"')
    await reveal(line, column + 3)
    const typed = await text()
    const top = () => page.locator('.cm-scroller').evaluate((scroller) => scroller.scrollTop)
    const [cursor, seen] = [await aroundCursor(), await top()]
    expect(seen).toBeGreaterThan(0)
    await page.evaluate((text) => window.pane.setText(text), longer(typed))
    expect(await text()).toBe(longer(typed))
    expect(await aroundCursor()).toBe(cursor)
    expect(await top()).toBe(seen)
    await checked()
    // The page knows it already.
    expect(await valid()).toEqual([])
    await press('Control+z')
    expect(await text()).toBe(typed)
    await checked()
    expect(await valid()).toEqual([typed])
  })

  test('of a drag is one step, beside what was typed before and after', async () => {
    await reveal(1, 1)
    const first = await text()
    await page.keyboard.type('#')
    const typed = await text()
    await page.evaluate((text) => {
      for (let k = 0; k < 20; k++) window.pane.setText(text.replace('-59.69', String(-59.69 + k)), k > 0)
    }, typed)
    await page.keyboard.type('#')
    await press('Control+z')
    expect(await text()).toContain(String(-59.69 + 19))
    await press('Control+z')
    expect(await text()).toBe(typed)
    await press('Control+z')
    expect(await text()).toBe(first)
  })

  test('keeps its line breaks', async () => {
    const windows = (await text()).replaceAll('\n', '\r\n')
    await page.evaluate((text) => window.pane.setText(text), windows)
    expect(await text()).toBe(windows)
    await reveal(1, 1)
    await page.keyboard.insertText('# one\n')
    await checked()
    expect(await valid()).toEqual([`# one\r\n${windows}`])
  })
})

test('buttons undo and find without a keyboard', async () => {
  const before = await text()
  await reveal(1, 1)
  await page.keyboard.insertText('# x')
  await page.getByTestId('model-undo').click()
  expect(await text()).toBe(before)
  expect(await page.getByTestId('model-undo').isDisabled()).toBe(true)
  await page.getByTestId('model-redo').click()
  expect(await text()).toBe(`# x${before}`)
  await page.getByTestId('model-find').click()
  expect(await page.locator('.cm-search').isVisible()).toBe(true)
})

test('a finger writes, and goes from a message to its place', async () => {
  const { page, complaints } = await visit(browser, url, {
    viewport: { width: 390, height: 760 },
    hasTouch: true,
    isMobile: true,
  })
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(390)
  await page
    .locator('.cm-line')
    .first()
    .tap({ position: { x: 1, y: 8 } })
  await page.keyboard.insertText('x =\n')
  await expect.poll(() => page.getByTestId('model-pane').getAttribute('aria-busy')).toBe('false')
  const message = page.getByTestId('model-messages').locator('.error button')
  expect((await message.boundingBox())!.height).toBeGreaterThanOrEqual(44)
  await message.tap()
  expect(await page.getByTestId('model-text').evaluate((one) => one === document.activeElement)).toBe(true)
  await page.getByTestId('model-undo').tap()
  await expect.poll(() => page.getByTestId('model-status').innerText()).toBe('1 note')
  expect(complaints).toEqual([])
  await page.context().close()
})
