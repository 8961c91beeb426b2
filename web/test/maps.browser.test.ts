import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, visit, type Visit } from './browser'

const { map } = inject('samples')

let browser: Browser
beforeAll(async () => {
  browser = await launch()
})
afterAll(() => browser?.close())

describe('a map over travel and steer', () => {
  let visited: Visit
  let page: Page
  const reading = () => page.getByTestId('map-reading').textContent()
  const choose = (name: string, label: string) => page.getByTestId(name).selectOption({ label })

  beforeAll(async () => {
    visited = await visit(browser, map)
    page = visited.page
    await page.getByTestId('tab-maps').click()
  })
  afterAll(() => page?.context().close())

  test('has areas between round values, and a legend of them', async () => {
    await choose('map-quantity', 'steer')
    const map = page.getByTestId('map')
    // -25 to 25 deg: between the levels -20, -10, 0, 10 and 20 there are six bands.
    await expect.poll(() => map.locator('path.area').count()).toBe(5)
    expect(await map.locator('rect.band').count()).toBe(6)
    expect(await map.locator('text').allTextContents()).toEqual(
      expect.arrayContaining(['bump [mm]', 'steering [deg]', '20 deg', '−20']),
    )
    expect(await map.locator('circle.place').count()).toBe(13 * 11)
    expect(await reading()).toBe('steer: −25 to 25 deg')
  })

  test('reads positions by pointer and by keys', async () => {
    await choose('map-quantity', 'travel')
    const frame = page.getByTestId('map').locator('rect.frame')
    await frame.scrollIntoViewIfNeeded()
    const box = (await frame.boundingBox())!
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2)
    expect(await reading()).toMatch(/^travel: \S+ mm at bump \S+ mm, steering \S+ deg$/)
    await page.getByTestId('map').locator('.picture').focus()
    await page.keyboard.press('ArrowRight')
    await page.keyboard.press('ArrowUp')
    expect(await reading()).toBe('travel: 0 mm at bump 0 mm, steering 5 deg')
    await page.keyboard.press('ArrowRight')
    expect(await reading()).toBe('travel: 10 mm at bump 10 mm, steering 5 deg')
  })

  test('shows the sensitivity by a variable', async () => {
    await choose('map-quantity', 'rack')
    await choose('map-by', 'per rack_z')
    expect(await reading()).toMatch(/^rack per rack_z: \S+ to \S+ mm\/mm$/)
    // Another measure by the same variable.
    await choose('map-quantity', 'camber')
    expect(await page.getByTestId('map-by').locator('option:checked').textContent()).toBe('per rack_z')
    expect(visited.complaints).toEqual([])
  })
})
