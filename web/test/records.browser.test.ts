import type { Page } from 'playwright-core'
import { describe, expect, inject, test } from 'vitest'
import { NO_3D } from './browser'
import { pages, ready, settled } from './pages'

const { cases, fitted } = inject('samples')

let page: Page
const visit = pages(NO_3D)
const open = async (url: string, viewport = { width: 1440, height: 900 }) => {
  page = await visit(url, { viewport })
  await ready(page)
}
const change = async (name: string, value: string) => {
  await page.getByTestId('tab-variables').click()
  const field = page.getByTestId(`variable-${name}`).getByTestId('change-value')
  await field.fill(value)
  await field.press('Enter')
  await settled(page)
}
const showCase = async (name: string) => {
  await page.getByTestId('case').selectOption(name)
  await expect.poll(() => page.getByTestId('title').innerText()).toContain(name)
  await ready(page)
  await settled(page)
}

describe('metrics of several cases', () => {
  const card = (name: string) => page.getByTestId(`card-${name}`).getByTestId('card-value').innerText()
  const row = (name: string) =>
    page
      .getByTestId('metrics')
      .locator('tr', { hasText: new RegExp(`^${name}`) })
      .innerText()

  test('are those of the present design in the case shown, and of the original in all others', async () => {
    await open(cases)
    const others = page.getByTestId('other-cases')
    expect(await others.count()).toBe(0)
    await change('outer_z', '10')
    await page.getByTestId('tab-metrics').click()
    expect(await row('toe_error')).toContain(await card('toe_error'))
    expect(await row('toe_error')).not.toContain('0.40236')
    expect(await row('ackermann')).toContain('steer\t0.1336 deg')
    expect(await others.innerText()).toBe('Original design')
    // The other case has its own as soon as it is shown.
    await showCase('steer')
    expect(await row('ackermann')).toContain(await card('ackermann'))
    expect(await row('toe_error')).toContain('bump\t0.40236 deg')
    await page.getByTestId('reset-design').click()
    await settled(page)
    await expect.poll(() => others.count()).toBe(0)
    expect(await row('toe_error')).toContain('0.40236')
  })
})

describe('records of the page', () => {
  test('such as maps stay in another case, and are back when an edit is undone', async () => {
    await open(cases)
    await showCase('steer')
    expect(await page.getByTestId('tab-maps').count()).toBe(1)
    await page.getByTestId('tab-variables').click()
    const row = page.getByTestId('variable-rack_z')
    await row.locator('.name').click()
    await row.getByTestId('limits').click()
    await row.getByTestId('bound-low').fill('-9')
    await row.getByTestId('bound-low').press('Enter')
    await expect.poll(() => page.getByTestId('tab-maps').count()).toBe(0)
    await ready(page)
    await page.getByTestId('undo').click()
    await expect.poll(() => page.getByTestId('tab-maps').count()).toBe(1)
  })

  test('of a fit are of the fitted design, which is the one that is shown', async () => {
    page = await visit(fitted, { viewport: { width: 1440, height: 900 } })
    // What undo comes back to is known before anything is solved.
    const undo = page.getByTestId('undo')
    await undo.waitFor()
    expect(await undo.isEnabled()).toBe(true)
    await ready(page)
    await page.getByTestId('tab-designs').click()
    const heading = page.getByTestId('of-record')
    expect(await heading.isVisible()).toBe(false)
    await change('tie_rod_inner_z', '0')
    await page.getByTestId('tab-designs').click()
    expect(await heading.innerText()).toBe('Fitted design')
    await undo.click()
    await settled(page)
    expect(await heading.isVisible()).toBe(false)
  })
})

describe('a change that the text cannot have', () => {
  const REASON = /the change of `?lca_tilt`? cannot be saved/
  const outcome = () => page.getByTestId('optimise-outcome').innerText()

  test('is named whole, and is not studied as another design', async () => {
    await open(cases)
    await page.getByTestId('open-optimise').click()
    await page.getByTestId('optimise-run').waitFor()
    await change('lca_tilt', '1')
    expect(await page.getByTestId('studio-status').getAttribute('title')).toMatch(REASON)
    expect(await page.getByTestId('variables').innerText()).toMatch(REASON)
    expect(await page.getByTestId('variables').innerText()).not.toContain('being updated')
    expect(await page.getByTestId('optimise-run').isDisabled()).toBe(true)
    expect(await page.getByTestId('optimise-why').innerText()).toMatch(REASON)
    await page.getByTestId('export').click()
    await page.getByTestId('export-toml').click()
    const failure = page.locator('.dropdown .failure', { hasText: REASON })
    await failure.waitFor()
    await page.getByTestId('undo').click()
    await settled(page)
    expect(await failure.isVisible()).toBe(false)
    expect(await page.getByTestId('optimise-run').isEnabled()).toBe(true)
    expect(await page.getByTestId('variables').innerText()).not.toMatch(REASON)
  })

  test('is applied where a study finds it, also after other changes', async () => {
    await open(cases)
    await change('outer_z', '2')
    await page.getByTestId('open-optimise').click()
    for (const name of ['outer_x', 'outer_y', 'outer_z', 'inner_y', 'rack_z'])
      await page.getByTestId(`search-${name}`).getByRole('checkbox').uncheck()
    await page.getByTestId('search-lca_tilt').getByRole('checkbox').check()
    await page.getByTestId('optimise-run').click()
    expect(await outcome()).toMatch(REASON)
    await page.getByTestId('optimise-take').click()
    await expect.poll(() => page.getByTestId('studio-status').getAttribute('title')).toMatch(REASON)
    const value = (name: string) => page.getByTestId(`variable-${name}`).getByTestId('change-value').inputValue()
    expect(Math.abs(Number(await value('lca_tilt')))).toBeGreaterThan(0.1)
    // The other change is in the text that was studied.
    expect(await value('outer_z')).toBe('0')
    await page.getByTestId('tab-compare').click()
    expect(await page.getByTestId('hardpoints').locator('tr', { hasText: 'tie_rod_outer' }).innerText()).toContain(
      '0.73',
    )
  })
})

describe('with a pane at the side', () => {
  test.each([1320, 1440, 1920])(
    'on a screen of %d px every control of the bar is beside it, and bounds are whole',
    async (width) => {
      await open(cases, { width, height: 900 })
      await change('outer_z', '2.123456')
      await page.getByTestId('open-optimise').click()
      await page.getByTestId('optimise-run').waitFor()
      const edge = (await page.getByTestId('drawer').boundingBox())!.x
      const ends = await page
        .locator('.topbar :is(button, select, input, .file):visible')
        .evaluateAll((all) => all.map((one) => one.getBoundingClientRect().right))
      expect(Math.max(...ends)).toBeLessThanOrEqual(edge)
      expect(await page.locator('.topbar .file').evaluate((one) => one.scrollWidth - one.clientWidth)).toBe(0)
      const cut = await page
        .getByTestId('optimise')
        .locator('td input[type=text]')
        .evaluateAll((all) => all.filter((one) => one.scrollWidth > one.clientWidth).length)
      expect(cut).toBe(0)
      expect(await page.getByLabel('highest of outer_z').inputValue()).toBe('12.87654')
    },
  )
})
