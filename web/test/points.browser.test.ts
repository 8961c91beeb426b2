import type { Locator, Page } from 'playwright-core'
import { describe, expect, inject, test } from 'vitest'
import { pages, ready, settled } from './pages'
import { drawn } from './person'

const { models } = inject('samples')

let page: Page
const visit = pages()

const open = async (name: string, options = {}) => {
  page = await visit(models[name], options)
  await ready(page)
  await page.getByTestId('grips').click()
}
const grip = (name: string) => page.getByTestId(`grip-${name}`)
const field = (axis: string) => page.getByTestId(`grip-${axis}`)
const coordinates = async () => Promise.all(['x', 'y', 'z'].map(async (axis) => Number(await field(axis).inputValue())))
const type = async (axis: string, text: string) => {
  await field(axis).fill(text)
  await field(axis).press('Enter')
}
/** Drags an element by a number of pixels. */
const drag = async (id: string, right: number, down: number, while_?: () => Promise<void>) => {
  const { x, y, width, height } = (await page.getByTestId(id).boundingBox())!
  await page.mouse.move(x + width / 2, y + height / 2)
  await page.mouse.down()
  await page.mouse.move(x + width / 2 + right, y + height / 2 + down, { steps: 4 })
  await drawn(page)
  await while_?.()
  await page.mouse.up()
}

describe('a hardpoint', () => {
  test('moves along the arrow that is dragged, ten times finer with Shift, and shows by how much', async () => {
    await open('macpherson')
    await grip('tie_rod_outer').click()
    const [x, y, z] = await coordinates()
    let label = ''
    await drag('arrow-z', 0, -20, async () => {
      label = await page.getByTestId('drag-label').innerText()
    })
    await settled(page)
    const coarse = await coordinates()
    expect(coarse.slice(0, 2)).toEqual([x, y])
    expect(coarse[2] - z).toBeGreaterThan(10)
    expect(label).toMatch(/^z \+[\d.]+ mm$/)
    expect(Number(/[\d.]+/.exec(label)![0])).toBeCloseTo(coarse[2] - z, 6)
    expect(await page.getByTestId('drag-label').isVisible()).toBe(false)
    await page.keyboard.down('Shift')
    await drag('arrow-z', 0, -20)
    await page.keyboard.up('Shift')
    await settled(page)
    const fine = (await coordinates())[2] - coarse[2]
    expect(fine / (coarse[2] - z)).toBeGreaterThan(0.07)
    expect(fine / (coarse[2] - z)).toBeLessThan(0.13)
  })

  test('keeps one coordinate in a drag, and the chosen direction is remembered', async () => {
    await open('macpherson')
    const before = await (await grip('strut_top').click(), coordinates())
    await drag('grip-strut_top', 12, 8)
    await settled(page)
    const after = await coordinates()
    expect(after.filter((x, k) => x === before[k])).toHaveLength(1)
    await page.getByTestId('way-y').click()
    await page.reload()
    await ready(page)
    expect(await page.getByTestId('way-y').getAttribute('aria-pressed')).toBe('true')
  })

  test('takes units, decimal commas and relative values, and says what is wrong with others', async () => {
    await open('macpherson')
    await grip('tie_rod_outer').click()
    const error = page.getByTestId('field-error')
    for (const [text, wanted] of [
      ['2,5', 2.5],
      ['+2', 4.5],
      ['1/2 in', 12.7],
      ['3 MM', 3],
      ['-=1 cm', -7],
    ] as const) {
      await type('z', text)
      await expect.poll(async () => (await coordinates())[2], { message: text }).toBe(wanted)
    }
    await settled(page)
    for (const [text, why] of [
      ['abc', 'abc is not a number with a unit.'],
      ['1e400', '1e400 is not finite.'],
      ['2 deg', 'This is a length, but deg is not a unit of length.'],
    ]) {
      await type('z', text)
      expect(await error.innerText()).toBe(why)
      expect(await field('z').inputValue()).toBe(text)
      expect(await field('z').getAttribute('aria-invalid')).toBe('true')
    }
    await field('z').press('Escape')
    expect(await field('z').inputValue()).toBe('-7')
    expect(await field('z').getAttribute('aria-invalid')).toBe(null)
    const change = page.getByTestId('variable-tie_rod_outer_z').getByTestId('change-value')
    await change.fill('2,5')
    await change.press('Enter')
    await settled(page)
    expect(await change.inputValue()).toBe('2.5')
    await change.fill('+=1/2 in')
    await change.press('Enter')
    expect(await change.inputValue()).toBe('15.2')
    await change.fill('2 furlong')
    await change.press('Enter')
    expect(await error.innerText()).toContain('There is no unit furlong')
  })

  test('steps in round numbers by keys, and Escape leaves the mode', async () => {
    await open('macpherson')
    await grip('tie_rod_outer').click()
    const [, , z] = await coordinates()
    await page.keyboard.press('z')
    await page.keyboard.press('ArrowUp')
    expect((await coordinates())[2]).toBeCloseTo(z + 1, 9)
    await page.keyboard.press('Shift+ArrowDown')
    expect((await coordinates())[2]).toBeCloseTo(z + 0.9, 9)
    expect(await field('z').inputValue()).toMatch(/^-?\d+\.\d{1,3}$/)
    await page.keyboard.press('Escape')
    expect(await page.getByTestId('grip-pane').isVisible()).toBe(false)
    expect(await page.getByTestId('grips').getAttribute('aria-pressed')).toBe('false')
    await page.keyboard.press('m')
    expect(await page.getByTestId('grip-pane').isVisible()).toBe(true)
    expect(await page.evaluate(() => document.activeElement!.className)).toContain('grip')
    await page.keyboard.press('Escape')
    expect(await page.getByTestId('grip-pane').isVisible()).toBe(false)
  })

  test('that locks stops at a round number and keeps the reason', async () => {
    await open('rssr')
    await page.locator('.grip').first().click()
    const [x] = await coordinates()
    await type('x', `${x + 10_000}`)
    await page.waitForFunction(() => !document.querySelector('[data-testid=refusal]')!.classList.contains('hint'))
    await settled(page)
    expect(await field('x').inputValue()).toMatch(/^-?\d+(\.\d{1,2})?$/)
    expect(await page.getByTestId('refusal').innerText()).toMatch(
      /Locks at t = [\d.]+ s; shown is the last|cannot be assembled/,
    )
  })

  test('that locks under an entry has the value of the design, typed again as well, and the reason is visible', async () => {
    await open('rssr')
    await page.keyboard.press('Escape')
    await page.getByTestId('open-points').click()
    const cell = page.getByTestId('point-A').locator('input').first()
    const change = page.getByTestId('variable-A_x').getByTestId('change-value')
    const news = page.getByTestId('points-news')
    const shortfall = page.getByTestId('shortfall')
    const enter = async (input: Locator, text: string) => {
      await input.fill(text)
      await input.press('Enter')
      await settled(page)
    }
    const paste = async () => {
      await cell.evaluate((input) => {
        const data = new DataTransfer()
        data.setData('text/plain', '10000\t60')
        input.dispatchEvent(new ClipboardEvent('paste', { clipboardData: data, bubbles: true, cancelable: true }))
      })
      await settled(page)
    }
    const reason = /(Locks at t = [\d.]+ s|cannot be assembled.*); shown is the last position that works\./
    for (const entry of [
      () => enter(change, '9000'),
      () => enter(change, '9000'),
      () => enter(cell, '9000'),
      () => enter(cell, '9000'),
      paste,
    ]) {
      await entry()
      const [by, place] = [Number(await change.inputValue()), Number(await cell.inputValue())]
      expect(by).toBeLessThan(8000)
      expect(place).toBeCloseTo(80 + by, 2)
      expect(await shortfall.innerText()).toMatch(reason)
      expect(await news.innerText()).toMatch(reason)
    }
    expect(await news.innerText()).toContain('1 hardpoint set.')
    // The slider has no bounds, and is extended to the value.
    const slider = page.getByTestId('variable-A_x').getByTestId('change')
    const step = Number(await slider.getAttribute('step'))
    expect(Math.abs(Number(await slider.inputValue()) - Number(await change.inputValue()))).toBeLessThanOrEqual(step)
    await enter(change, '1')
    expect(await shortfall.innerText()).toBe('')
    expect(await news.innerText()).not.toMatch(reason)
  })

  test('moved with its mirror image reaches the variable of both sides', async () => {
    await open('front_axle')
    await grip('left_tie_rod_outer').click()
    const [, , z] = await coordinates()
    await type('z', '+8.22')
    await settled(page)
    expect(await page.getByTestId('variable-tie_rod_outer_z').getByTestId('change-value').inputValue()).toBe('8.22')
    await grip('right_tie_rod_outer').click()
    expect((await coordinates())[2]).toBeCloseTo(z + 8.22, 6)
  })
})

describe.each([
  ['a desk', { viewport: { width: 1440, height: 900 } }],
  ['a phone', { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true }],
  ['a phone on its side', { viewport: { width: 844, height: 390 }, hasTouch: true, isMobile: true }],
])('on the screen of %s', (_, options) => {
  test('the pane hides nothing of the view, and its height is the same with and without a point', async () => {
    await open('macpherson', options)
    const box = async (id: string) => (await page.getByTestId(id).boundingBox())!
    const [pane, view] = [await box('grip-pane'), await box('view-canvas')]
    expect(view.y + view.height).toBeLessThanOrEqual(pane.y + 1)
    expect(view.height).toBeGreaterThan(150)
    await grip('tie_rod_outer').click()
    await drawn(page)
    expect((await box('grip-pane')).height).toBe(pane.height)
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(options.viewport.width)
  })
})

describe('the table of hardpoints', () => {
  test('is edited, and takes rows of a spreadsheet as one step', async () => {
    await open('macpherson')
    await page.getByTestId('open-points').click()
    const cell = (name: string, k: number) => page.getByTestId(`point-${name}`).locator('input').nth(k)
    await cell('strut_top', 1).fill('+1')
    await cell('strut_top', 1).press('Enter')
    await settled(page)
    expect(await page.getByTestId('point-strut_top').locator('.change').innerText()).toBe('1')
    await cell('strut_top', 0).evaluate((input) => {
      const data = new DataTransfer()
      data.setData('text/plain', 'tie_rod_outer\t-201\t575,5\t2\nnobody\t1\t2\t3\n')
      input.dispatchEvent(new ClipboardEvent('paste', { clipboardData: data, bubbles: true, cancelable: true }))
    })
    await settled(page)
    expect(await page.getByTestId('points-news').innerText()).toBe('1 hardpoint set. There is no hardpoint nobody.')
    const values = await Promise.all([0, 1, 2].map((k) => cell('tie_rod_outer', k).inputValue()))
    expect(values).toEqual(['-201', '575.5', '2'])
    await page.getByTestId('undo').click()
    await settled(page)
    expect(await cell('tie_rod_outer', 0).inputValue()).toBe('-200')
    expect(await page.getByTestId('point-strut_top').locator('.change').innerText()).toBe('1')
  })
})
