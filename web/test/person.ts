import type { Page } from 'playwright-core'

/** The canvas of the 3D view. */
export const VIEW = '[data-testid=view-canvas]'

/** Lets so many frames pass. */
export function frames(page: Page, count: number): Promise<void> {
  return page.evaluate(async (count) => {
    for (let k = 0; k < count; k++) await new Promise(requestAnimationFrame)
  }, count)
}

/** Waits until what was asked for is on the screen: one frame to draw, one to be sure that it was drawn. */
export const drawn = (page: Page) => frames(page, 2)

/** What a reader of one part of the page sees. */
export const text = (page: Page, id: string) => page.getByTestId(id).innerText()

/** Moves a slider to a value, as a drag does. */
export function slide(page: Page, id: string, value: number | string): Promise<void> {
  return page.getByTestId(id).evaluate((slider: HTMLInputElement, value) => {
    slider.value = value
    slider.dispatchEvent(new Event('input', { bubbles: true }))
    slider.dispatchEvent(new Event('change', { bubbles: true }))
  }, String(value))
}

/** Moves the time to a step. */
export const scrub = (page: Page, step: number) => slide(page, 'scrub', step)
