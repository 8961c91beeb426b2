import { execFileSync } from 'node:child_process'
import { mkdtempSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { pathToFileURL } from 'node:url'
import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, expect, inject, test } from 'vitest'
import { launch } from './browser'
import { WAIT } from './limits'

const { hardpoint } = inject('samples')
const MODELS = join(import.meta.dirname, '../../models')
const NAMES = ['slider_crank', 'four_bar', 'jansen', 'excavator', 'peaucellier', 'gear_train', 'press']

let browser: Browser
let folder: string
let page: Page
const faults: string[] = []
beforeAll(async () => {
  folder = mkdtempSync(join(tmpdir(), 'hardpoint-site-'))
  execFileSync(hardpoint, ['site', folder, ...NAMES.map((name) => join(MODELS, `${name}.toml`))])
  browser = await launch()
  page = await browser.newPage({ viewport: { width: 1300, height: 900 } })
  page.setDefaultTimeout(WAIT)
  page.on('pageerror', (error) => faults.push(error.message))
  await page.goto(pathToFileURL(join(folder, 'index.html')).href)
})
afterAll(async () => {
  await browser?.close()
  rmSync(folder, { recursive: true })
})

test('every model has a drawing that fills its frame', async () => {
  const drawings = page.locator('.model svg')
  expect(await drawings.count()).toBe(NAMES.length)
  for (let k = 0; k < NAMES.length; k++) {
    const [width, height, inside] = await drawings.nth(k).evaluate((svg: SVGSVGElement) => {
      const { x, y, width, height } = svg.getBBox()
      return [width / 300, height / 200, Number(x >= 0 && y >= 0 && x + width <= 300 && y + height <= 200)]
    })
    expect(Math.max(width, height), NAMES[k]).toBeGreaterThan(0.75)
    expect(inside, NAMES[k]).toBe(1)
  }
  // The foot of the leg is followed.
  expect(await page.locator('.model', { hasText: 'jansen.toml' }).locator('polyline').count()).toBeGreaterThan(0)
})

test('a search leaves the models with its words, and each page leads back', async () => {
  await page.getByTestId('search').fill('leg JANSEN')
  expect(await page.locator('.model:visible h2').allInnerTexts()).toEqual(['Jansen leg'])
  await page.locator('.model:visible h2 a').click()
  await page.getByTestId('up').click()
  await page.waitForFunction(() => document.querySelectorAll('.model').length > 1)
  expect(faults).toEqual([])
})
