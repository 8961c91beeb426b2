import { execFileSync } from 'node:child_process'
import { readFileSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import type { Browser, Page } from 'playwright-core'
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, inject, test } from 'vitest'
import { animation } from './animation'
import { launch, NO_3D, visit, type Visit } from './browser'
import { ready, settled } from './pages'
import { frames, slide } from './person'

const { models, answers } = inject('samples')
const MODELS = join(import.meta.dirname, '../../models')
/** Folder for the documents' pictures, if the tests are to make them anew: `UPDATE_DOCS=1 npm test`. */
const IMAGES = process.env.UPDATE_DOCS && join(import.meta.dirname, '../../docs/images')

let browser: Browser
/** Without a view, for tests that do not look at it: it takes two thirds of the time of opening a page. */
let flat: Browser
let visited: Visit
let page: Page
beforeAll(async () => {
  ;[browser, flat] = await Promise.all([launch(), launch(NO_3D)])
})
afterEach(() => page.context().close())
afterAll(() => Promise.all([browser?.close(), flat?.close()]))

const open = async (name: string, within = browser) => {
  visited = await visit(within, models[name])
  page = visited.page
  await ready(page)
}
const card = async (name: string) =>
  Number((await page.getByTestId(`card-${name}`).getByTestId('card-value').innerText()).replace('−', '-'))
const grip = (name: string) => page.getByTestId(`grip-${name}`)
/** Value of the command for a measure of the strut at the start, with a change. */
const coordinate = async (axis: string) =>
  Number((await page.getByTestId(`grip-${axis}`).inputValue()).replace('−', '-'))

/** The value of every card as the native engine has it with these changes. */
function native(file: string, change: { name: string; by: number }[]): number[] {
  const model = { file, text: readFileSync(join(MODELS, file), 'utf8'), files: {}, case: null, shown: null }
  const requests = [
    { ask: 'open', model },
    { ask: 'design', change, from: null },
  ]
  const lines = execFileSync(answers, {
    input: requests.map((r) => JSON.stringify(r)).join('\n'),
    encoding: 'utf8',
    maxBuffer: 2 ** 28,
  })
    .trim()
    .split('\n')
  const block = Buffer.from(lines[1], 'base64')
  return JSON.parse(block.subarray(4, 4 + block.readUInt32LE(0)).toString()).design.values
}

describe('a hardpoint of the strut in the hand', () => {
  beforeEach(async () => {
    await open('macpherson')
    await page.getByTestId('grips').click()
    // The pane takes room of the view, which has its new size in the next frame.
    await frames(page, 3)
  })

  test('is dragged, and every value becomes the one that the command gives for that design', async () => {
    const box = (await grip('tie_rod_outer').boundingBox())!
    const before = await card('tie_rod_length')
    await page.mouse.move(box.x + 9, box.y + 9)
    await page.mouse.down()
    await page.mouse.move(box.x + 9, box.y - 2, { steps: 5 })
    await page.mouse.up()
    await settled(page)
    // The mechanism that is drawn follows the hand, to the roundness of its coordinates.
    const after = (await grip('tie_rod_outer').boundingBox())!
    expect(Math.hypot(after.x - box.x, after.y - (box.y - 11))).toBeLessThan(2)
    expect(await card('tie_rod_length')).not.toBe(before)
    const by = await page.evaluate(() =>
      [...document.querySelectorAll<HTMLInputElement>('.coordinates input')].map(({ value }) => Number(value)),
    )
    expect(by.every(Number.isFinite)).toBe(true)
    const names = await page.getByTestId('values').locator('.card-name b').allInnerTexts()
    const text = await toml()
    // Read from the page's own text, the command's engine gives the same cards.
    const model = { file: 'x.toml', text, files: {}, case: null, shown: null }
    const lines = execFileSync(answers, {
      input: JSON.stringify({ ask: 'page', model }),
      encoding: 'utf8',
      maxBuffer: 2 ** 28,
    })
    const block = Buffer.from(lines, 'base64')
    const values: { name: string; value: number }[] = JSON.parse(
      block.subarray(4, 4 + block.readUInt32LE(0)).toString(),
    ).values
    for (const name of new Set(names))
      expect(await card(name), name).toBeCloseTo(
        Number(values.find((value) => value.name === name)!.value.toPrecision(4)),
        6,
      )
  })

  test('is drawn once for each design while it is dragged, without outlines, and only plots that change', async () => {
    await page.evaluate(() => {
      const { prototype: scene } = WebGL2RenderingContext
      const { prototype: paper } = CanvasRenderingContext2D
      const { clear, drawArrays, drawElements, drawElementsInstanced } = scene
      const { clearRect } = paper
      const count = { pictures: 0, calls: 0, plots: [] as string[], labels: [] as number[] }
      Object.assign(globalThis, { count })
      scene.clear = function (...args) {
        count.pictures++
        clear.apply(this, args)
      }
      scene.drawArrays = function (...args) {
        count.calls++
        drawArrays.apply(this, args)
      }
      scene.drawElements = function (...args) {
        count.calls++
        drawElements.apply(this, args)
      }
      scene.drawElementsInstanced = function (...args) {
        count.calls++
        drawElementsInstanced.apply(this, args)
      }
      paper.clearRect = function (...args) {
        const plot = this.canvas instanceof HTMLCanvasElement && this.canvas.closest('figure')
        if (plot) count.plots.push(plot.querySelector('[data-testid=shown]')!.getAttribute('aria-pressed')!)
        clearRect.apply(this, args)
      }
      const label = document.querySelector('[data-testid=drag-label]')!
      new MutationObserver(() => count.labels.push(count.pictures)).observe(label, { childList: true, subtree: true })
    })
    type Count = { pictures: number; calls: number; plots: string[]; labels: number[] }
    const count = () => page.evaluate(() => (globalThis as unknown as { count: Count }).count)
    const reset = () =>
      page.evaluate(() =>
        Object.assign((globalThis as unknown as { count: Count }).count, {
          pictures: 0,
          calls: 0,
          plots: [],
          labels: [],
        }),
      )
    /** Pictures and draw calls of one change, after which nothing moves. */
    const after = async (change: () => Promise<void>) => {
      await reset()
      await change()
      await expect.poll(async () => (await count()).pictures).toBeGreaterThan(0)
      await frames(page, 8)
      return count()
    }
    const box = (await grip('tie_rod_outer').boundingBox())!
    await page.mouse.move(box.x + 9, box.y + 9)
    await page.mouse.down()
    // The first move makes the picture light.
    await after(() => page.mouse.move(box.x + 9, box.y + 6))
    const dragged = await after(() => page.mouse.move(box.x + 9, box.y + 2))
    expect(dragged.pictures).toBe(1)
    // The label changes with the picture: before it, it would cost a frame of its own.
    expect(dragged.labels).toEqual([1])
    // Sensitivities are those of the last design until the hand lets go.
    expect(dragged.plots).toContain('false')
    expect(dragged.plots).not.toContain('true')
    await page.mouse.up()
    await settled(page)
    const whole = await after(() => page.keyboard.press('l'))
    expect(dragged.calls).toBeLessThan(0.7 * (whole.calls / (whole.pictures / 2)))
  })

  test('is typed with a unit, reset, undone and done again', async () => {
    await grip('tie_rod_outer').click()
    const z = await coordinate('z')
    await page.getByTestId('grip-z').fill(`${(z + 2) / 10} cm`)
    await page.getByTestId('grip-z').press('Enter')
    await settled(page)
    expect(await coordinate('z')).toBeCloseTo(z + 2, 4)
    expect(await page.getByTestId('variable-tie_rod_outer_z').getByTestId('change-value').inputValue()).toBe('2')
    const wanted = native('macpherson.toml', [{ name: 'tie_rod_outer_z', by: 2 }])
    expect(await card('toe')).toBeCloseTo(Number(wanted[0].toPrecision(4)), 6)
    await page.getByTestId('undo').click()
    await settled(page)
    expect(await coordinate('z')).toBeCloseTo(z, 6)
    await page.keyboard.press('Control+y')
    await settled(page)
    expect(await coordinate('z')).toBeCloseTo(z + 2, 4)
    await page.getByTestId('grip-reset').click()
    await settled(page)
    expect(await coordinate('z')).toBeCloseTo(z, 6)
  })

  test('depends on the arrow keys along an axis', async () => {
    await grip('strut_top').focus()
    await page.keyboard.press('Enter')
    const before = await coordinate('y')
    await page.keyboard.press('y')
    expect(await page.getByTestId('way-y').getAttribute('aria-pressed')).toBe('true')
    await page.keyboard.press('ArrowRight')
    await page.keyboard.press('ArrowRight')
    await settled(page)
    expect(await coordinate('y')).not.toBe(before)
    expect(await page.getByTestId('undo').isDisabled()).toBe(false)
  })

  test('stops where the mechanism locks, and says why', async () => {
    await page.context().close()
    await open('rssr')
    await page.getByTestId('grips').click()
    await page.locator('.grip').first().click()
    const before = await coordinate('x')
    await page.getByTestId('grip-x').fill(String(before + 10_000))
    await page.getByTestId('grip-x').press('Enter')
    await page.waitForFunction(() => document.querySelector('[data-testid=refusal]')!.textContent !== '')
    await settled(page)
    expect(await coordinate('x')).toBeLessThan(before + 9_999)
    expect(await page.getByTestId('refusal').innerText()).toMatch(
      /Locks at t = [\d.]+ s; shown is the last|cannot be assembled/,
    )
  })
})

describe('the model in the page', () => {
  beforeEach(() => open('macpherson', flat))

  test('follows a slider: solved, not predicted', async () => {
    await slide(page, '[data-testid=variable-tie_rod_outer_z] [data-testid=change]', 5)
    await settled(page)
    expect(await page.getByTestId('plot-0').innerText()).toContain('current')
    const by = Number(await page.getByTestId('variable-tie_rod_outer_z').getByTestId('change-value').inputValue())
    expect(await card('toe')).toBeCloseTo(
      Number(native('macpherson.toml', [{ name: 'tie_rod_outer_z', by }])[0].toPrecision(4)),
      6,
    )
    expect(await toml()).not.toBe(readFileSync(join(MODELS, 'macpherson.toml'), 'utf8'))
  })

  test('is typed: a slip is shown at its place, mended, and the page solves it', async () => {
    await page.getByTestId('open-model').click()
    const text = page.locator('.cm-content')
    await text.click()
    await page.keyboard.press('Control+Home')
    await page.keyboard.type('nonsense = 1\n')
    await expect.poll(() => page.getByTestId('model-messages').innerText()).toContain('nonsense')
    expect(await page.getByTestId('title').innerText()).toContain('strut')
    for (let k = 0; k < 'nonsense = 1'.length + 1; k++) {
      await page.keyboard.press('Control+Home')
      await page.keyboard.press('Delete')
    }
    await expect.poll(() => page.getByTestId('model-messages').innerText()).not.toContain('nonsense')
    // The typed text is solved: another title, and the curves of the present text.
    await page.keyboard.press('Control+f')
    await page.keyboard.type('strut, BMW')
    await page.keyboard.press('Enter')
    await page.keyboard.press('Escape')
    await page.keyboard.type('another')
    await page.waitForFunction(() => document.querySelector('[data-testid=title]')!.textContent!.includes('another'))
    await ready(page)
    await page.getByTestId('reset-design').click()
    await page.waitForFunction(() => document.querySelector('[data-testid=title]')!.textContent!.includes('BMW'))
  })

  test('is exported with its comments and the changes', async () => {
    await slide(page, '[data-testid=variable-tie_rod_outer_z] [data-testid=change]', 5)
    await settled(page)
    const original = readFileSync(join(MODELS, 'macpherson.toml'), 'utf8')
    const found = await toml()
    const comments = (text: string) => [...text.matchAll(/#.*/g)].map(([line]) => line)
    expect(comments(found)).toEqual(comments(original))
  })

  test('is compared with a design that was kept', async () => {
    await slide(page, '[data-testid=variable-tie_rod_outer_z] [data-testid=change]', 5)
    await settled(page)
    await page.getByTestId('designs').click()
    await page.getByTestId('snapshot-name').fill('higher')
    await page.getByTestId('snapshot-keep').click()
    await page.getByTestId('snapshot-compare').click()
    await page.getByTestId('designs').click()
    await page.getByTestId('reset-design').click()
    await settled(page)
    expect(await page.getByTestId('plot-0').innerText()).toContain('higher')
  })

  test('gets a kept design as a table, with a variable for a point that had none, and undone it is only kept', async () => {
    await page.context().close()
    await open('macpherson')
    await page.getByTestId('grips').click()
    await frames(page, 3)
    await grip('strut_lower').click()
    await page.getByTestId('grip-z').fill('+=2')
    await page.getByTestId('grip-z').press('Enter')
    await settled(page)
    await page.getByTestId('designs').click()
    await page.getByTestId('snapshot-name').fill('longer')
    await page.getByTestId('snapshot-keep').click()
    await page.getByTestId('snapshot-write').click()
    await expect.poll(() => page.getByTestId('snapshot-done').innerText()).toContain('new design variables')
    // Where the present design becomes the nominal one, the kept one is the same: it differs from it by nothing.
    await settled(page)
    expect(await toml()).toMatch(/\[designs\.longer\]\nstrut_lower_z = 0\n$/)
    await page.getByTestId('tab-variables').click()
    await page.getByTestId('reset-all').click()
    await settled(page)
    const original = readFileSync(join(MODELS, 'macpherson.toml'), 'utf8')
    const found = await toml()
    const block = '\n\n[design]\nstrut_lower_z = { move = "strut_lower", along = "z" }'
    expect(found).toContain(block)
    expect(found.replace(block, '')).toBe(`${original.trimEnd()}\n\n[designs.longer]\nstrut_lower_z = 2\n`)
    const listed = page.getByTestId('snapshot-rename')
    expect(await listed.evaluate((name: HTMLInputElement) => name.readOnly)).toBe(true)
    await page.getByTestId('undo').click()
    await settled(page)
    await page.getByTestId('undo').click()
    await expect.poll(() => listed.evaluate((name: HTMLInputElement) => name.readOnly)).toBe(false)
  })

  test('asks for nothing outside the page', () => {
    expect(visited.complaints).toEqual([])
  })
})

test('one side of a mirrored axle cannot be a design of its text: it is refused, and both sides are written', async () => {
  await open('front_axle')
  const name = 'left_uca_front'
  const keep = async () => {
    await page.getByTestId('designs').click()
    await page.getByTestId('snapshot-keep').click()
    await page.getByTestId('snapshot-write').last().click()
  }
  await page.getByTestId('grips').click()
  await frames(page, 3)
  await grip(name).focus()
  await page.keyboard.press('Enter')
  await page.getByTestId('mirror').uncheck()
  await page.getByTestId('grip-z').fill('+=2')
  await page.getByTestId('grip-z').press('Enter')
  // The text cannot follow this design.
  await page.getByTestId('studio-status').getByText('cannot be saved').waitFor()
  await keep()
  await expect.poll(() => page.getByTestId('snapshot-done').innerText()).toContain('mirror image')
  await page.keyboard.press('Escape')
  await page.getByTestId('reset-design').click()
  await page.getByTestId('mirror').check()
  await page.getByTestId('grip-z').fill('+=2')
  await page.getByTestId('grip-z').press('Enter')
  await settled(page)
  await keep()
  await expect.poll(() => page.getByTestId('snapshot-done').innerText()).toContain(`variables ${name}_z`)
})

/** The text that the page exports. */
async function toml(): Promise<string> {
  await page.getByTestId('export').click()
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByTestId('export-toml').click()])
  return readFileSync(await download.path(), 'utf8')
}

describe('studies in the page', () => {
  test('a search indicates how it goes, and its design is taken', async () => {
    await openText('studies/strut_toe.toml')
    await page.getByTestId('open-optimise').click()
    await page.getByTestId('optimise-run').click()
    await page.getByTestId('optimise-take').waitFor()
    const before = await page.getByTestId('values').innerText()
    await page.getByTestId('optimise-take').click()
    await page.waitForFunction(
      (before) => document.querySelector('[data-testid=values]')!.textContent !== before,
      before,
    )
    await ready(page)
    expect(await page.getByTestId('undo').isDisabled()).toBe(false)
    // What was gained is seen: the original stays, dashed.
    await expect.poll(() => page.getByTestId('plot-0').innerText()).toContain('original')
    expect(visited.complaints).toEqual([])
  })

  test('a search that is cancelled keeps the best so far', async () => {
    await openText('studies/strut_toe.toml')
    await page.getByTestId('open-optimise').click()
    await page.getByTestId('optimise-starts').fill('500')
    await page.getByTestId('optimise-run').click()
    await page.waitForFunction(() => document.querySelector('[data-testid=optimise-lines]')?.textContent !== '')
    await page.getByTestId('optimise-cancel').click()
    expect(await page.getByTestId('optimise-outcome').innerText()).toMatch(/best design so far/)
  })

  test('tolerances are studied', async () => {
    await openText('studies/strut_tolerances.toml')
    await page.getByTestId('open-tolerance').click()
    await page.getByTestId('tolerance-samples').fill('200')
    await page.getByTestId('tolerance-run').click()
    await page.getByTestId('tolerance-outcome').waitFor()
    expect(await page.getByTestId('tolerance').locator('table').count()).toBeGreaterThan(0)
  })
})

/** Opens the strut's page with another model's text in it. */
async function openText(file: string): Promise<void> {
  await open('macpherson', flat)
  const text = readFileSync(join(MODELS, file), 'utf8')
  const title = /^name = "(.*)"/m.exec(text)![1]
  await page.getByTestId('open-model').click()
  await page.locator('.cm-content').evaluate((content, text) => {
    const data = new DataTransfer()
    data.setData('text/plain', text)
    document.getSelection()!.selectAllChildren(content)
    content.dispatchEvent(new ClipboardEvent('paste', { clipboardData: data, bubbles: true, cancelable: true }))
  }, text)
  await page.waitForFunction(
    (title) => document.querySelector('[data-testid=title]')!.textContent!.includes(title),
    title,
  )
  await ready(page)
  await page.getByTestId('drawer-close').click()
}

test.skipIf(!IMAGES)('a hardpoint in the hand is the picture of the studio', async () => {
  visited = await visit(browser, models.macpherson, { viewport: { width: 1280, height: 800 }, derived: true })
  page = visited.page
  await ready(page)
  await page.getByTestId('grips').click()
  await frames(page, 3)
  await page.getByTestId('quantity').first().selectOption({ label: 'toe' })
  const { x, y } = (await grip('tie_rod_outer').boundingBox())!
  const pictures: Buffer[] = []
  await page.mouse.move(x + 9, y + 9)
  await page.mouse.down()
  const STEPS = 20
  for (let k = 0; k < STEPS; k++) {
    await page.mouse.move(x + 9, y + 9 - 26 * Math.sin((2 * Math.PI * k) / STEPS))
    await frames(page, 6)
    pictures.push(await page.screenshot())
  }
  await page.mouse.up()
  const desk = await browser.newPage()
  const made = await animation(desk, pictures, 110, 900)
  expect(made.length, 'bytes of a picture that readers load').toBeLessThan(1_500_000)
  writeFileSync(join(IMAGES!, 'studio.webp'), made)
})
