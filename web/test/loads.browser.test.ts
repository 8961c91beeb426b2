import { readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, visit, type Visit } from './browser'

const { models } = inject('samples')
const ARROWS = 'Force arrows'
/** Number of shown digits of a force, which is stored with 24 bits. */
const SHOWN = 6e-4

let browser: Browser
beforeAll(async () => {
  browser = await launch()
})
afterAll(() => browser?.close())

/** The rows of the run's loads.csv, by their headings. */
function table(): Record<string, string>[] {
  const [header, ...lines] = readFileSync(fileURLToPath(models.press).replace('report.html', 'loads.csv'), 'utf8')
    .trim()
    .split('\n')
  const names = header.split(',')
  return lines.map((line) => Object.fromEntries(line.split(',').map((cell, k) => [names[k], cell])))
}

describe('forces of the press', () => {
  let visited: Visit
  let page: Page
  const reading = () => page.getByTestId('load-reading').innerText()
  const row = (name: string) =>
    page
      .getByTestId('load-row')
      .filter({ has: page.locator('td:first-child', { hasText: new RegExp(`^${name}$`) }) })
      .locator('td')
  const close = (shown: number, expected: number) =>
    expect(Math.abs(shown - expected)).toBeLessThanOrEqual(SHOWN * Math.abs(expected))

  beforeAll(async () => {
    visited = await visit(browser, models.press)
    page = visited.page
    await page.getByTestId('tab-loads').click()
  })
  afterAll(() => page?.context().close())

  test('are as large as in loads.csv, when they are', async () => {
    for (const name of ['A', 'B', 'C']) {
      const own = table().filter(({ joint }) => joint === name)
      const sizes = own.map((at) => Math.hypot(Number(at['force.x [N]']), Number(at['force.y [N]'])))
      const [, on, largest, at] = await row(name).allInnerTexts()
      expect(on).toBe(own[0].body)
      close(Number(largest), Math.max(...sizes))
      const when = own.find((one) => Math.abs(Number(one['t [s]']) - Number(at)) < 1e-4)!
      expect(sizes[own.indexOf(when)]).toBeGreaterThan(0.9999 * Math.max(...sizes))
    }
  })

  test('are seen from their body as loads.csv has them, and from the other one the other way', async () => {
    await page.getByTestId('load-which').selectOption({ label: 'B' })
    await page.getByTestId('play').focus()
    await page.keyboard.press('Home')
    for (let k = 0; k < 25; k++) await page.keyboard.press('ArrowRight')
    const own = table().filter(({ joint }) => joint === 'B')[25]
    const [x, y] = ['x', 'y'].map((axis) => Number(own[`force in body.${axis} [N]`]))
    const [size, angle] = numbers(await reading())
    close(size, Math.hypot(x, y))
    expect(Math.abs(angle - (Math.atan2(y, x) * 180) / Math.PI)).toBeLessThan(0.06)
    expect(await reading()).toContain('only the determined part is shown')
    // The crank feels the opposite.
    await page.getByTestId('load-body').selectOption({ label: 'crank' })
    const [same, other] = numbers(await reading())
    close(same, size)
    // Rod and crank have turned by different angles.
    const turned = (((angle + 180 - other) % 360) + 360) % 360
    expect(Math.abs(turned)).toBeGreaterThan(1)
  })

  test('have arrows that can be put away', async () => {
    const scale = page.locator('.view .scale')
    expect(await scale.innerText()).toContain(ARROWS)
    await page.keyboard.press('n')
    expect(await page.getByTestId('forces').getAttribute('aria-pressed')).toBe('false')
    await expect.poll(() => scale.innerText()).not.toContain(ARROWS)
    await page.getByTestId('forces').click()
    await expect.poll(() => scale.innerText()).toContain(ARROWS)
  })

  test('follow the design: more counterweight increases the bearing force, and the original path stays', async () => {
    await page.getByTestId('load-which').selectOption({ label: 'A' })
    const before = Number(await row('A').nth(2).innerText())
    const field = page.getByTestId('variable-counterweight').getByTestId('change-value')
    await page.getByTestId('tab-variables').click()
    await field.fill('+20')
    await field.press('Enter')
    await page.getByTestId('tab-loads').click()
    await expect.poll(async () => Number(await row('A').nth(2).innerText())).toBeGreaterThan(before)
    expect(await page.locator('.loads .path.former').getAttribute('d')).toMatch(/^M/)
    // 20 kg at 60 mm go round once a second, and weigh.
    const by = Number(await row('A').nth(2).innerText()) - before
    expect(by).toBeLessThan(20 * (9.80665 + 0.06 * (2 * Math.PI) ** 2))
    expect(by).toBeGreaterThan(20 * (9.80665 - 0.06 * (2 * Math.PI) ** 2))
    expect(visited.complaints).toEqual([])
  })
})

describe('a model without masses and forces', () => {
  test('has no forces to be seen', async () => {
    const { page, complaints } = await visit(browser, models.four_bar)
    expect(await page.getByTestId('tab-loads').count()).toBe(0)
    expect(await page.getByTestId('forces').isHidden()).toBe(true)
    await page.keyboard.press('n')
    expect(complaints).toEqual([])
    await page.context().close()
  })
})

/** The first two numbers of a reading. */
function numbers(text: string): number[] {
  return [...text.replaceAll('−', '-').matchAll(/-?\d+(?:\.\d+)?/g)].slice(0, 2).map(([found]) => Number(found))
}
