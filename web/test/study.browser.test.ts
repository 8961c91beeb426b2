import { readFileSync } from 'node:fs'
import { describe, expect, inject, test, vi } from 'vitest'
import { valueContent } from '../src/page/contents'
import { crossings } from '../src/curve'
import { State } from '../src/state'
import { NO_3D } from './browser'
import { pages } from './pages'
import { reportOf } from './payload'

const { tolerance, fitted, front } = inject('samples')
const open = pages(NO_3D)

/** A metric of a curve is interpolated by splines, the table of values by straight lines. */
const INTERPOLATION = 1e-3

describe('the page of a study', () => {
  const SMALL = { viewport: { width: 1280, height: 800 } }

  test('of a fit opens on the fitted values with their standard deviations, on the first screen', async () => {
    const page = await open(fitted, SMALL)
    expect(await page.getByTestId('tab-study').getAttribute('aria-selected')).toBe('true')
    const study = page.getByTestId('study')
    expect(await study.getByTestId('answer').innerText()).toMatch(/^result\s+found: .*\s*residuals/s)
    const table = study.locator('table').first()
    const header = (await table.locator('th').allInnerTexts()).join(' ')
    expect(header).toContain('fitted')
    expect(header).toContain('standard deviation')
    const last = (await table.locator('tr').last().boundingBox())!
    expect(last.y + last.height).toBeLessThan(801)
  })

  test('of a front shows result, front and reading on the first screen', async () => {
    const page = await open(front, SMALL)
    expect(await page.getByTestId('tab-designs').innerText()).toBe('Front')
    const plot = page.getByTestId('sweep')
    expect(await plot.getByTestId('answer').innerText()).toMatch(/^result\s+trade-off between .*\s*balanced\s+point/s)
    await plot.locator('.picture').press('ArrowRight')
    await expect.poll(() => page.getByTestId('sweep-reading').innerText()).toContain('point 0: track')
    const panel = (await page.locator('#panel-designs').boundingBox())!
    for (const part of [plot.getByTestId('answer'), plot.locator('svg'), page.getByTestId('sweep-reading')]) {
      const box = (await part.boundingBox())!
      expect(box.y).toBeGreaterThanOrEqual(panel.y)
      expect(box.y + box.height).toBeLessThanOrEqual(panel.y + panel.height)
    }
    const { width, height } = (await plot.locator('svg').boundingBox())!
    expect(width).toBeGreaterThan(400)
    expect(height).toBeGreaterThan(150)
  })

  test('opens on its result, which says so when the design is another one', async () => {
    const page = await open(tolerance)
    expect(await page.getByTestId('tab-study').getAttribute('aria-selected')).toBe('true')
    const study = page.getByTestId('study')
    expect(await study.textContent()).toContain('keep all limits')
    const other = study.getByText('Result of the study, not of the present design')
    expect(await other.isVisible()).toBe(false)
    await page.getByTestId('tab-variables').click()
    await page.getByLabel('change of ball_joint_z').first().press('ArrowRight')
    await page.getByTestId('tab-study').click()
    await expect.poll(() => other.isVisible()).toBe(true)
  })

  test('has a band at constant travel that is the deviation of the metric there', async () => {
    vi.stubGlobal('document', { documentElement: { classList: { contains: () => false } } })
    vi.stubGlobal('matchMedia', () => ({ matches: false }))
    vi.stubGlobal('getComputedStyle', () => ({ getPropertyValue: () => '#000' }))
    const report = await reportOf(tolerance)
    const [header, first] = readFileSync(new URL('metrics.csv', tolerance), 'utf8').split('\n')
    const fact = (name: string) => first.split(',')[header.split(',').indexOf(name)]
    expect([fact('metric'), fact('case')]).toEqual(['toe_in_bump', 'bump'])
    const find = (name: string) => report.quantities.findIndex((quantity) => quantity.name === name)
    const [toe, travel] = [find('toe'), find('wheel_travel')]
    const content = valueContent(new State(report), { quantity: toe, order: 0, over: travel })
    const x = report.quantities[travel].curves[0]
    const [low, high] = ['mean - 3 sigma', 'mean + 3 sigma'].map((label) => {
      const edge = content.lines.find((line) => line.label === label)!
      return crossings([x], [edge.curve], report.times, 30, [0, x.length - 1])[0]
    })
    expect(Math.abs((high - low) / 6 / Number(fact('rss')) - 1)).toBeLessThan(INTERPOLATION)
    expect(Math.abs((high + low) / 2 - Number(fact('nominal')))).toBeLessThan(INTERPOLATION)
    expect(content.caption).toBe('Tolerance band at constant wheel_travel, to first order.')
    // Worst cases are known over time only.
    const worst = ['worst-case minimum', 'worst-case maximum']
    const labels = (of: typeof content) => of.lines.map(({ label }) => label).filter((label) => worst.includes(label))
    expect(labels(content)).toEqual([])
    expect(labels(valueContent(new State(report), { quantity: toe, order: 0 }))).toEqual(worst)
  })
})
