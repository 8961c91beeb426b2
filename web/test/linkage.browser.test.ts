import { deflateSync } from 'node:zlib'
import type { Page } from 'playwright-core'
import { describe, expect, inject, test } from 'vitest'
import { pages, ready, settled } from './pages'
import { drawn, text } from './person'

const { models } = inject('samples')

let page: Page
const visit = pages()

const sheet = () => page.getByTestId('linkage-sheet')
const pin = (name: string) => page.getByTestId(`linkage-pin-${name}`)
const tool = (name: string) => page.getByTestId(`linkage-${name}`).click()
const words = async (name: string) => (await pin(name).getAttribute('aria-label'))!
/** Clicks the sheet at parts of its size. */
const click = async (...places: [number, number][]) => {
  for (const [x, y] of places) {
    const { width, height } = (await sheet().boundingBox())!
    await sheet().click({ position: { x: x * width, y: y * height } })
  }
}
const draw = async (name = 'macpherson', options = {}) => {
  page = await visit(models[name], options)
  await ready(page)
  await page.getByTestId('draw-linkage').click()
  await sheet().waitFor()
}
/** Waits until the engine has judged the drawing. */
const checked = () =>
  page.waitForFunction(
    () => document.querySelector<HTMLElement>('[data-testid=linkage-pane]')!.dataset.checked === 'yes',
  )
/** Sets a field of the pane. */
const type = async (field: string, value: string) => {
  await page.getByTestId(`linkage-${field}`).fill(value)
  await page.getByTestId(`linkage-${field}`).press('Enter')
}
const place = async (name: string, x: number, y: number) => {
  await tool('select')
  await pin(name).click()
  await type('x', String(x))
  await type('y', String(y))
}
/** Shows the drawn model, and waits until it is solved. */
const show = async () => {
  await checked()
  await page.getByTestId('linkage-show').click()
  await sheet().waitFor({ state: 'hidden' })
  await ready(page)
}

describe('a linkage is drawn', () => {
  test('as a four-bar with a plate by clicks alone, from an empty sheet in the page of another model', async () => {
    await draw()
    expect(await text(page, 'linkage-hint')).toBe('Click a place for the first joint.')
    await click([0.3, 0.75], [0.34, 0.55], [0.62, 0.4], [0.7, 0.75])
    await page.keyboard.press('Escape')
    await page.getByTestId('linkage-bar-bar_2').click()
    expect(await text(page, 'linkage-hint')).toContain('bar_2 becomes a plate')
    await click([0.5, 0.3])
    // Without a motor the engine is not asked yet; with one free motion too many it objects.
    await tool('ground')
    await pin('A').click()
    expect(await text(page, 'linkage-hint')).toContain('Choose Motor')
    await tool('motor')
    await pin('A').click()
    await checked()
    const messages = page.getByTestId('linkage-messages')
    expect(await messages.innerText()).toContain('under-driven')
    expect(await messages.innerText()).toContain('HP0301')
    expect(await page.getByTestId('linkage-show').isDisabled()).toBe(true)
    await tool('ground')
    await pin('D').click()
    await checked()
    expect(await text(page, 'linkage-hint')).toBe('It can move.')
    // A crank that turns fully.
    await place('A', 0, 0)
    await place('B', 35, 60)
    await place('C', 250, 190)
    await place('D', 300, 0)
    await show()
    await page.getByTestId('model-text').waitFor()
    expect(await page.getByTestId('title').innerText()).toBe('linkage')
    expect(await page.getByTestId('model-text').innerText()).toContain('bar_2 = ["B", "C", "E"]')
    expect(await page.getByTestId('banner').isVisible()).toBe(false)
    expect(await page.getByTestId('scrub').getAttribute('max')).toBe('180')
    // Its variables are solved, and undo returns to the model before.
    await settled(page)
    expect(await page.locator('.variables').innerText()).toContain('B_x')
    await page.getByTestId('undo').click()
    await page.waitForFunction(() => document.querySelector('[data-testid=title]')!.textContent!.includes('strut'))
  })

  test('as a slider-crank, with names, and is drawn on after it was shown', async () => {
    await draw('four_bar')
    await click([0.2, 0.6], [0.3, 0.4], [0.7, 0.6])
    await page.keyboard.press('Escape')
    await tool('ground')
    await pin('A').click()
    await tool('slider')
    await pin('C').click()
    await tool('motor')
    // Only a support can have one.
    await pin('B').click()
    expect(await text(page, 'linkage-hint')).toContain('B is neither a fixed pivot nor a slider')
    // The check of the drawing does not replace the reason.
    await checked()
    expect(await text(page, 'linkage-hint')).toContain('B is neither a fixed pivot nor a slider')
    await pin('A').click()
    await place('A', 0, 0)
    await place('B', 30, 40)
    await place('C', 200, 10)
    await type('direction', '10')
    await type('name', 'piston')
    await page.getByTestId('linkage-bar-bar_2').click()
    await type('name', 'rod')
    await type('name', 'bar_1')
    expect(await text(page, 'linkage-hint')).toBe('bar_1 is there already.')
    await show()
    const model = page.getByTestId('model-text')
    await model.waitFor()
    expect(await model.innerText()).toContain('rod = ["B", "piston"]')
    expect(await model.innerText()).toContain('axis = [0.984807753012, 0.173648177667]')
    expect(await page.getByTestId('scrub').getAttribute('max')).toBe('180')
    await page.getByTestId('draw-linkage').click()
    expect(await words('piston')).toBe('joint piston: 200, 10 mm, slider')
    await place('piston', 220, 10)
    await show()
    expect(await model.innerText()).toContain('piston = [220, 10]')
  })

  test('with the keyboard alone', async () => {
    await draw()
    const press = async (...keys: string[]) => {
      for (const key of keys) await page.keyboard.press(key)
    }
    for (const name of ['A', 'B']) {
      await page.getByTestId('linkage-add').focus()
      await press('Enter')
      expect(await page.evaluate(() => document.activeElement!.textContent)).toBe(name)
      if (name === 'A') await press('Escape', 'Escape')
    }
    const before = await words('B')
    await press('ArrowRight', 'Shift+ArrowUp')
    expect(await words('B')).not.toBe(before)
    await press('Control+z', 'Control+z')
    expect(await words('B')).toBe(before)
    await press('Control+y', 'Escape')
    await pin('A').focus()
    await press('Enter')
    await pin('B').focus()
    await press('Enter')
    expect(await page.getByTestId('linkage-bar-bar_1').count()).toBe(1)
    await press('Delete')
    expect(await pin('B').count()).toBe(0)
    expect(await page.getByTestId('linkage-bar-bar_1').count()).toBe(0)
    await press('Control+z')
    expect(await page.getByTestId('linkage-bar-bar_1').count()).toBe(1)
    // With nothing selected, Escape closes the sheet; the drawing is kept.
    await press('Escape', 'Escape')
    await sheet().waitFor({ state: 'hidden' })
    await page.getByTestId('draw-linkage').click()
    expect(await pin('B').count()).toBe(1)
  })

  test('with a hand that drags joints, moves the sheet and zooms', async () => {
    await draw()
    await click([0.4, 0.5])
    const box = (await pin('A').boundingBox())!
    const centre = [box.x + box.width / 2, box.y + box.height / 2]
    const before = await words('A')
    await page.mouse.move(centre[0], centre[1])
    await page.mouse.down()
    await page.mouse.move(centre[0] + 100, centre[1] - 50, { steps: 4 })
    await page.mouse.up()
    expect(await words('A')).not.toBe(before)
    await page.keyboard.press('Escape')
    await page.getByTestId('linkage-undo').click()
    // The whole drag is one step.
    expect(await words('A')).toBe(before)
    // The wheel and the background move the sheet, not the joint.
    const at = async () => (await pin('A').boundingBox())!
    const first = await at()
    await page.mouse.move(first.x + 150, first.y + 20)
    await page.mouse.down()
    await page.mouse.move(first.x + 110, first.y + 40, { steps: 4 })
    await page.mouse.up()
    const moved = await at()
    expect([moved.x - first.x, moved.y - first.y].map(Math.round)).toEqual([-40, 20])
    await page.mouse.wheel(0, -300)
    await expect.poll(async () => (await at()).x).toBeLessThan(moved.x - 10)
    expect(await words('A')).toBe(before)
  })
})

/** A picture in one colour, of this size, as PNG. */
function png(width: number, height: number): Buffer {
  const crc = (bytes: Buffer) => {
    let sum = ~0
    for (const byte of bytes) {
      sum ^= byte
      for (let k = 0; k < 8; k++) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0)
    }
    return ~sum >>> 0
  }
  const chunk = (kind: string, data: Buffer) => {
    const body = Buffer.concat([Buffer.from(kind), data])
    const [length, check] = [Buffer.alloc(4), Buffer.alloc(4)]
    length.writeUInt32BE(data.length)
    check.writeUInt32BE(crc(body))
    return Buffer.concat([length, body, check])
  }
  const head = Buffer.alloc(13)
  head.writeUInt32BE(width)
  head.writeUInt32BE(height, 4)
  head.set([8, 0], 8)
  const rows = Buffer.concat(Array.from({ length: height }, () => Buffer.from([0, ...Array(width).fill(160)])))
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a])
  const end = chunk('IEND', Buffer.alloc(0))
  return Buffer.concat([signature, chunk('IHDR', head), chunk('IDAT', deflateSync(rows)), end])
}

describe('a picture behind the plane', () => {
  const choose = async (data: Buffer, name = 'plan.png', mimeType = 'image/png') => {
    await page.getByTestId('backdrop-file').setInputFiles({ name, mimeType, buffer: data })
  }
  const picture = () => page.getByTestId('backdrop')

  test('gets its scale by two clicks and their distance, and is kept for path points', async () => {
    await draw('four_bar')
    await choose(png(400, 200))
    await picture().waitFor()
    await page.getByTestId('backdrop-scale').click()
    // The pane takes room of the sheet, which is drawn anew in the next frame.
    await drawn(page)
    const before = (await picture().boundingBox())!
    expect(before.width / before.height).toBeCloseTo(2, 2)
    const seen = (await sheet().boundingBox())!
    // A quarter and three quarters of the picture from the left, at half its height.
    const at = (part: number) => ({
      x: before.x - seen.x + part * before.width,
      y: before.y - seen.y + before.height / 2,
    })
    await sheet().click({ position: at(0.25) })
    await page.getByTestId('backdrop-apply').click()
    expect(await text(page, 'backdrop-status')).toBe('Click two points of the picture first.')
    await sheet().click({ position: at(0.75) })
    await page.getByTestId('backdrop-distance').fill('1 m')
    await page.getByTestId('backdrop-distance').press('Enter')
    await page.getByLabel('first point is the origin').check()
    await page.getByLabel('second to its right').check()
    await page.getByTestId('backdrop-apply').click()
    expect(await text(page, 'backdrop-status')).toBe('The scale is set: 1000 mm between the points.')
    // All of the picture is seen; a joint on the second point is 1 m to the right of the origin.
    await drawn(page)
    const after = (await picture().boundingBox())!
    const now = (await sheet().boundingBox())!
    expect(after.x).toBeGreaterThan(now.x)
    expect(after.x + after.width).toBeLessThan(now.x + now.width)
    const second = { x: after.x - now.x + 0.75 * after.width, y: after.y - now.y + after.height / 2 }
    await sheet().click({ position: second })
    const [, x, y] = /joint A: (\S+), (\S+) mm/.exec(await words('A'))!
    expect(Math.abs(Number(x) - 1000)).toBeLessThan(20)
    expect(Math.abs(Number(y))).toBeLessThan(20)
    // The picture is that of the unit, whatever is drawn over it.
    await page.getByTestId('linkage-close').click()
    await page.getByTestId('path-points').click()
    await picture().waitFor()
    const behind = page.getByTestId('path-overlay').locator('img')
    expect(await behind.count()).toBe(1)
    await page.getByTestId('backdrop-remove').last().click()
    await picture().waitFor({ state: 'detached' })
  })

  test('that cannot be read is refused with the reason', async () => {
    await draw('four_bar')
    await choose(Buffer.from('no picture'), 'notes.png')
    await expect.poll(() => text(page, 'backdrop-status')).toContain('notes.png is not a picture')
    expect(await picture().count()).toBe(0)
  })
})

test('a mechanism with a measured point beside its plane is planar: path points are offered', async () => {
  page = await visit(models.slider_crank)
  await ready(page)
  await page.getByTestId('path-points').click()
  expect(await page.getByTestId('path-pane').isVisible()).toBe(true)
  expect(await page.getByTestId('look-straight').getAttribute('aria-pressed')).toBe('true')
})
