import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, visit, type Visit } from './browser'
import { curve, picture, text } from './person'

const { changed } = inject('samples')

describe('a changed design beside the original', () => {
  let browser: Browser
  let visited: Visit
  let page: Page
  beforeAll(async () => {
    browser = await launch()
    visited = await visit(browser, changed)
    page = visited.page
  })
  afterAll(() => browser?.close())

  const lines = () => text(page, 'plot-0')

  test('is drawn solid, the original dashed, and both have a curve', async () => {
    expect(await page.locator('.ghost-key').innerText()).toContain('original')
    expect(await lines()).toMatch(/current/)
    expect(await lines()).toMatch(/original/)
  })

  test('has the changed variables in its rows', async () => {
    expect(Number(await page.getByTestId('variable-tie_rod_outer_z').getByTestId('change-value').inputValue())).toBe(6)
  })

  test('can be compared with what was predicted: the dashed curve and the dashed mechanism follow', async () => {
    const before = { view: await picture(page), curve: await curve(page, 'plot-0') }
    const options = page.getByTestId('compare').locator('option')
    const predicted = (await options.allInnerTexts()).findIndex((name) => name.includes('first order'))
    expect(predicted).toBeGreaterThan(0)
    await page.getByTestId('compare').selectOption({ index: predicted })
    expect((await curve(page, 'plot-0')).sum).not.toBe(before.curve.sum)
    expect(await page.locator('.ghost-key').innerText()).toContain('first order')
    await page.getByTestId('compare').selectOption({ index: 0 })
    expect((await picture(page)).equals(before.view)).toBe(true)
  })

  test('is the original again when all changes are reset', async () => {
    await page.getByTestId('tab-variables').click()
    await page.getByTestId('reset-all').click()
    expect(await page.locator('.ghost-key').isVisible()).toBe(false)
    expect(await lines()).not.toMatch(/original/)
  })

  test('was requested nothing else, and reported nothing on the console', () => {
    expect(visited.complaints).toEqual([])
  })
})
