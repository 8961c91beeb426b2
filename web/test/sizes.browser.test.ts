import { readdirSync, readFileSync } from 'node:fs'
import { join } from 'node:path'
import { expect, inject, test } from 'vitest'
import { launch, NO_3D, visit } from './browser'

const { models } = inject('samples')
const SOURCES = join(import.meta.dirname, '../src')
/** Names and dimensions in the picture are as large as what they are part of. */
const IN_PICTURES = ['labels.css', 'palette.css']

test('letters are as large as in the settings of the browser', async () => {
  const browser = await launch([...NO_3D, '--blink-settings=defaultFontSize=24'])
  try {
    const { page } = await visit(browser, models.four_bar, { viewport: { width: 1440, height: 900 } })
    const sizes = await page.evaluate(() =>
      ['body', '.card-name', '.variables .name', '.controls select', '[role=tab]'].map((selector) =>
        parseFloat(getComputedStyle(document.querySelector(selector)!).fontSize),
      ),
    )
    for (const size of sizes) expect(size).toBeGreaterThan(17)
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(1440)
  } finally {
    await browser.close()
  }
})

test('no size of letters is in pixels', () => {
  const files = readdirSync(SOURCES, { recursive: true, encoding: 'utf8' }).filter(
    (file) => file.endsWith('.css') && !IN_PICTURES.some((name) => file.endsWith(name)),
  )
  expect(files.length).toBeGreaterThan(10)
  for (const file of files) expect(readFileSync(join(SOURCES, file), 'utf8'), file).not.toMatch(/font-size: [\d.]+px/)
})

test('with colours of the system sliders and bars are seen, and the choice as well', async () => {
  const browser = await launch(NO_3D)
  try {
    const { page } = await visit(browser, models.four_bar, { forcedColors: 'active' })
    const bar = await page
      .locator('.bar-of:not(.negative)')
      .first()
      .evaluate((bar) => getComputedStyle(bar).backgroundColor)
    expect(bar).not.toMatch(/^rgba\(0, 0, 0, 0\)$|^rgb\(255, 255, 255\)$/)
    const chosen = page.locator('.variables li[aria-current=true]')
    expect(await chosen.evaluate((row) => getComputedStyle(row).outlineStyle)).toBe('solid')
  } finally {
    await browser.close()
  }
})
