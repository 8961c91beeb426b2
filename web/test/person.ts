import type { Locator, Page } from 'playwright-core'
import { expect } from 'vitest'

/** The canvas of the 3D view. */
export const VIEW = '[data-testid=view-canvas]'

/** For pictures of the view alone, without the buttons and names over it. */
const ONLY_THE_VIEW = `.view > :not(${VIEW}) { visibility: hidden !important }`

/** Waits for this number of frames. */
export function frames(page: Page, count: number): Promise<void> {
  return page.evaluate(async (count) => {
    for (let k = 0; k < count; k++) await new Promise(requestAnimationFrame)
  }, count)
}

/** Waits until the requested state is on the screen: one frame to draw, one to be sure that it was drawn. */
export const drawn = (page: Page) => frames(page, 2)

/** Picture of a part of the page that no longer changes, as a PNG. */
export async function settled(part: Locator): Promise<Buffer> {
  let last = await part.screenshot()
  await expect
    .poll(async () => {
      const before = last
      last = await part.screenshot()
      return last.equals(before)
    })
    .toBe(true)
  return last
}

/** Present picture of the view, as a PNG. */
export async function picture(page: Page): Promise<Buffer> {
  await drawn(page)
  return page.locator(VIEW).screenshot({ style: ONLY_THE_VIEW })
}

/** Contents of a curve's canvas: number of colours, and a sum that changes with the picture. */
export async function curve(page: Page, id: string): Promise<{ colours: number; sum: number }> {
  // A plot out of sight is drawn when it is seen again.
  await page.getByTestId(id).scrollIntoViewIfNeeded()
  await drawn(page)
  return page
    .getByTestId(id)
    .locator('canvas')
    .first()
    .evaluate((canvas: HTMLCanvasElement) => {
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d')!
      copy.drawImage(canvas, 0, 0)
      const pixels = new Uint32Array(copy.getImageData(0, 0, canvas.width, canvas.height).data.buffer)
      return { colours: new Set(pixels).size, sum: pixels.reduce((sum, pixel) => (Math.imul(sum, 31) + pixel) | 0, 0) }
    })
}

/** Text of one part of the page. */
export const text = (page: Page, id: string) => page.getByTestId(id).innerText()

/** Moves a slider to a value, as a drag does. */
export function slide(page: Page, selector: string, value: number | string): Promise<void> {
  return page.locator(selector).evaluate((slider: HTMLInputElement, value) => {
    slider.value = value
    slider.dispatchEvent(new Event('input', { bubbles: true }))
    slider.dispatchEvent(new Event('change', { bubbles: true }))
  }, String(value))
}

/** Moves the time to a step. */
export const scrub = (page: Page, step: number) => slide(page, '[data-testid=scrub]', step)
