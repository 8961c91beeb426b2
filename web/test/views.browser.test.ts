import type { Page } from 'playwright-core'
import { describe, expect, inject, test } from 'vitest'
import { pages } from './pages'
import { drawn, frames, picture, scrub } from './person'

const { models } = inject('samples')

let page: Page
const visit = pages()
const open = async (name: string) => {
  page = await visit(models[name])
  await drawn(page)
}
/** Begins measuring, and waits for the view to have its new size. */
const measure = async (spot: string) => {
  await page.keyboard.press('d')
  let last = ''
  await expect
    .poll(async () => {
      const before = last
      last = JSON.stringify(await centre(spot))
      await frames(page, 3)
      return last === before
    })
    .toBe(true)
}
const number = (text: string) => Number(text.replace('−', '-'))
const centre = async (id: string) => {
  const { x, y, width, height } = (await page.getByTestId(id).boundingBox())!
  return { x: x + width / 2, y: y + height / 2 }
}
const pressed = () => page.locator('[data-testid^=look-][aria-pressed=true]').allInnerTexts()

describe('standard views', () => {
  test('from the front are to scale: the picture is linear in the coordinates', async () => {
    await open('macpherson')
    await page.getByTestId('grips').waitFor()
    await page.getByTestId('grips').click()
    // In a parallel projection pixels per mm are the same near and far.
    await page.getByTestId('look-front').click()
    await drawn(page)
    const names = await page
      .locator('.grip:not([hidden])')
      .evaluateAll((all) => all.map((one) => one.getAttribute('data-testid')!.slice('grip-'.length)))
    const places: { at: { x: number; y: number }; z: number }[] = []
    for (const name of names) {
      await page.getByTestId(`grip-${name}`).focus()
      await page.keyboard.press('Enter')
      const z = Number(await page.getByTestId('grip-z').inputValue())
      places.push({ at: await centre(`grip-${name}`), z })
    }
    expect(await pressed()).toEqual(['front'])
    const [low, high] = [...places].sort((a, b) => a.z - b.z).filter((_, k, all) => k === 0 || k === all.length - 1)
    const scale = (high.at.y - low.at.y) / (high.z - low.z)
    for (const { at, z } of places) expect(Math.abs(at.y - low.at.y - scale * (z - low.z))).toBeLessThan(1.5)
  })

  test('are no longer pressed when the view was turned', async () => {
    await open('macpherson')
    expect(await pressed()).toEqual(['corner'])
    const box = (await page.getByTestId('view-canvas').boundingBox())!
    await page.mouse.move(box.x + 40, box.y + 80)
    await page.mouse.down()
    await page.mouse.move(box.x + 120, box.y + 100, { steps: 3 })
    await page.mouse.up()
    await drawn(page)
    expect(await pressed()).toEqual([])
    await page.keyboard.press('1')
    expect(await pressed()).toEqual(['corner'])
  })
})

describe('the ends of the axes in the corner', () => {
  const end = (name: string) => page.getByTestId(`axis-${name}`)

  test('are views from six sides, by mouse and keys', async () => {
    await open('front_axle')
    const words = ['front', 'rear', 'left', 'right', 'top', 'bottom']
    const titles = await page.locator('.triad button').evaluateAll((all) => all.map((one) => one.getAttribute('title')))
    expect(titles).toEqual(words)
    await end('front').click()
    await drawn(page)
    expect(await pressed()).toEqual(['front'])
    // From below: the wheel that is left from the front is left again, and what is in front is up.
    await end('bottom').focus()
    await page.keyboard.press('Enter')
    await drawn(page)
    expect(await pressed()).toEqual([])
    const [front, left] = [await centre('axis-front'), await centre('axis-left')]
    const [rear, right] = [await centre('axis-rear'), await centre('axis-right')]
    expect(front.y).toBeLessThan(rear.y - 20)
    expect(left.x).toBeGreaterThan(right.x + 20)
  })

  test('are remembered as the other views are', async () => {
    await open('macpherson')
    await end('bottom').click()
    await drawn(page)
    const place = async () => JSON.stringify([await centre('axis-left'), await centre('axis-front')])
    const before = await place()
    await page.getByTestId('open-model').click()
    await page.locator('.cm-content').click()
    await page.keyboard.press('Control+f')
    await page.keyboard.type('strut, BMW')
    await page.keyboard.press('Enter')
    await page.keyboard.press('Escape')
    await page.keyboard.type('another')
    await page.waitForFunction(() => document.querySelector('[data-testid=title]')!.textContent!.includes('another'))
    await page.getByTestId('open-model').click()
    await drawn(page)
    await expect.poll(place).toBe(before)
  })
})

describe('the buttons of the view', () => {
  /** Hardpoints that are under a button. */
  const covered = () =>
    page.evaluate(() => {
      const boxes = [...document.querySelectorAll('.looks > *')].map((one) => one.getBoundingClientRect())
      return [...document.querySelectorAll('.ruler-point')].filter((one) => {
        const { left, right, top, bottom } = one.getBoundingClientRect()
        const [x, y] = [(left + right) / 2, (top + bottom) / 2]
        return boxes.some((box) => x > box.left && x < box.right && y > box.top && y < box.bottom)
      }).length
    })

  test('are over no point of the mechanism, also where they wrap, and after a click on the view', async () => {
    await open('four_bar')
    // A click on the background is no turn of the view.
    const box = (await page.getByTestId('view-canvas').boundingBox())!
    await page.mouse.click(box.x + 20, box.y + 0.5 * box.height)
    await measure('spot-B')
    expect(await covered()).toBe(0)
    const height = await rows()
    await page.setViewportSize({ width: 760, height: 760 })
    await drawn(page)
    expect(await rows()).toBeGreaterThan(height)
    expect(await covered()).toBe(0)
  })
  const rows = async () => (await page.locator('.looks').boundingBox())!.height
})

test('paths of several hardpoints are drawn at once, and one button removes them', async () => {
  await open('four_bar')
  const traces = page.getByTestId('traces')
  const button = page.getByTestId('trace')
  const bare = await picture(page)
  await button.click()
  await page.getByTestId('trace-B').check()
  await expect.poll(() => button.innerText()).toContain('path of B')
  await drawn(page)
  const one = await picture(page)
  await page.getByTestId('trace-C').check()
  await expect.poll(() => button.innerText()).toContain('2 paths')
  await drawn(page)
  const two = await picture(page)
  expect(one.equals(bare) || two.equals(one)).toBe(false)
  await page.getByTestId('trace-none').click()
  expect(await traces.locator('input:checked').count()).toBe(0)
  await page.keyboard.press('Escape')
  expect(await traces.isVisible()).toBe(false)
  expect(await button.innerText()).toContain('no path')
  await drawn(page)
  expect((await picture(page)).equals(bare)).toBe(true)
})

test('without a graphics card the picture is lighter while something is dragged, and whole again after that', async () => {
  await open('macpherson')
  await scrub(page, 0)
  const before = await picture(page)
  const light = page.locator('.view.light')
  const { x, y } = await centre('scrub')
  await page.mouse.move(x, y)
  expect(await light.count()).toBe(0)
  await page.mouse.down()
  await page.mouse.move(x + 40, y, { steps: 3 })
  expect(await light.count()).toBe(1)
  const step = Number(await page.getByTestId('scrub').inputValue())
  const dragged = await picture(page)
  await page.mouse.up()
  expect(await light.count()).toBe(0)
  // The same moment with its shadows.
  expect(Number(await page.getByTestId('scrub').inputValue())).toBe(step)
  expect((await picture(page)).equals(dragged)).toBe(false)
  await scrub(page, 0)
  expect((await picture(page)).equals(before)).toBe(true)
})

describe('measuring', () => {
  test('shows the distance of two points and the angle of three, at every moment', async () => {
    await open('four_bar')
    await page.keyboard.press('d')
    const result = page.getByTestId('measured')
    expect(await result.innerText()).toContain('Click two points')
    await page.getByTestId('spot-A').click()
    await page.getByTestId('spot-B').click()
    await expect.poll(() => result.innerText()).toMatch(/^203\.96 mm \(Δx 40, Δy 200, Δz 0\)$/)
    await page.getByTestId('measure-2').selectOption('D')
    await expect.poll(() => result.innerText()).toContain('angle')
    const before = await result.innerText()
    await scrub(page, 20)
    await drawn(page)
    // The crank is as long as before, in another position.
    expect(await result.innerText()).toMatch(/^203\.96 mm/)
    expect(await result.innerText()).not.toBe(before)
    await page.keyboard.press('d')
    expect(await page.getByTestId('measuring').isVisible()).toBe(false)
  })
})

describe('a body that is clicked', () => {
  test('shows its points, lengths, rotation and joints, and leads to them', async () => {
    await open('four_bar')
    await measure('spot-B')
    const [b, c] = [await centre('spot-B'), await centre('spot-C')]
    await page.mouse.click(b.x + 0.3 * (c.x - b.x), b.y + 0.3 * (c.y - b.y))
    const inspector = page.getByTestId('inspector')
    await inspector.waitFor()
    // It covers no point of the body.
    const { x, y, width, height } = (await inspector.boundingBox())!
    for (const at of [b, c]) expect(at.x > x && at.x < x + width && at.y > y && at.y < y + height).toBe(false)
    const text = await inspector.innerText()
    expect(text).toContain('B – C')
    expect(number(/B – C\s+([\d.]+) mm/.exec(text)![1])).toBeCloseTo(Math.hypot(320, 400), 1)
    await scrub(page, 20)
    await expect.poll(() => inspector.innerText()).toMatch(/Rotation since the start\s+0\.\d+ deg/)
    await inspector.locator('.link').first().click()
    await expect.poll(() => inspector.innerText()).toMatch(/Bodies[^]*Location/)
    await page.keyboard.press('Escape')
    await expect.poll(() => inspector.isVisible()).toBe(false)
  })
})

describe('a body that is dragged', () => {
  test('moves the mechanism along its motion, and a press elsewhere turns the view', async () => {
    await open('four_bar')
    await measure('spot-B')
    const [a, b] = [await centre('spot-A'), await centre('spot-B')]
    const inner = { x: a.x + 0.6 * (b.x - a.x), y: a.y + 0.6 * (b.y - a.y) }
    await page.mouse.move(inner.x, inner.y)
    await frames(page, 2)
    await page.mouse.down()
    await page.mouse.move(inner.x - 30, inner.y + 12, { steps: 6 })
    await drawn(page)
    const step = Number(await page.getByTestId('scrub').inputValue())
    await page.mouse.up()
    expect(step).toBeGreaterThan(0)
    expect(await pressed()).toEqual(['straight'])
    // The point of the crank under the hand is in the direction of the hand.
    const turned = await centre('spot-B')
    const direction = Math.atan2(turned.y - a.y, turned.x - a.x)
    const hand = Math.atan2(inner.y + 12 - a.y, inner.x - 30 - a.x)
    expect(Math.abs(direction - hand)).toBeLessThan(0.05)
  })
})
