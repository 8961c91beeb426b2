import { readFileSync } from 'node:fs'
import { describe, expect, inject, test, vi } from 'vitest'
import { valueContent } from '../src/page/contents'
import { crossings } from '../src/curve'
import { State } from '../src/state'
import { NO_3D } from './browser'
import { pages } from './pages'
import { reportOf } from './payload'

const { tolerance } = inject('samples')
const open = pages(NO_3D)

/** A metric of a curve is interpolated by splines, the table of values by straight lines. */
const INTERPOLATION = 1e-3

describe('the page of a study', () => {
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
  })
})
