import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { pathToFileURL } from 'node:url'
import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, visit } from './browser'
import { ready, settled } from './pages'
import { slide } from './person'

const { models } = inject('samples')

let browser: Browser
let folder: string
beforeAll(async () => {
  browser = await launch()
  folder = mkdtempSync(join(tmpdir(), 'hardpoint-handover-'))
})
afterAll(async () => {
  await browser?.close()
  rmSync(folder, { recursive: true })
})
const exported = async (page: Page, entry: string) => {
  await page.getByTestId('export').click()
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByTestId(entry).click()])
  return { name: download.suggestedFilename(), data: readFileSync(await download.path()) }
}

describe('the page that is handed over', () => {
  test('opens with the present design, and asks for nothing outside', async () => {
    const { page, complaints } = await visit(browser, models.four_bar)
    await ready(page)
    await slide(page, '[data-testid=variable-B_x] [data-testid=change]', 12)
    await settled(page)
    const card = (page: Page) => page.getByTestId('values').innerText()
    const before = await card(page)
    await page.getByTestId('open-model').click()
    const { name, data } = await exported(page, 'export-html')
    expect(name).toBe('four_bar.html')
    const path = join(folder, name)
    writeFileSync(path, data)
    const copy = await visit(browser, pathToFileURL(path).href)
    await ready(copy.page)
    await settled(copy.page)
    expect(await copy.page.getByTestId('variable-B_x').getByTestId('change-value').inputValue()).toBe('12')
    await expect.poll(() => card(copy.page)).toBe(before)
    expect(await copy.page.getByTestId('drawer').isVisible()).toBe(false)
    // A copy of the copy is no larger: the code, which was unpacked, is not in it twice.
    const again = await exported(copy.page, 'export-html')
    expect(again.data.length).toBe(data.length)
    expect([...complaints, ...copy.complaints]).toEqual([])
    await Promise.all([page.context().close(), copy.page.context().close()])
  })
})

describe('the motion', () => {
  test('is recorded as a video, once through, and the time is as before', async () => {
    const { page, complaints } = await visit(browser, models.slider_crank)
    await ready(page)
    await slide(page, '[data-testid=scrub]', 3)
    await page.getByTestId('speed').selectOption({ index: 5 })
    const { name, data } = await exported(page, 'export-video')
    expect(name).toMatch(/\.webm$/)
    // The signature of its container.
    expect(data.subarray(0, 4).toString('hex')).toBe('1a45dfa3')
    expect(data.length).toBeGreaterThan(5000)
    expect(await page.getByTestId('scrub').inputValue()).toBe('3')
    expect(complaints).toEqual([])
    await page.context().close()
  })
})
