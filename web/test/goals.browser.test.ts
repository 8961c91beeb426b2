import { readFileSync } from 'node:fs'
import type { Page } from 'playwright-core'
import { describe, expect, inject, test } from 'vitest'
import { NO_3D } from './browser'
import { pages, ready, settled } from './pages'

const { models } = inject('samples')

let page: Page
const visit = pages(NO_3D)
const open = async (name: string) => {
  page = await visit(models[name])
  await ready(page)
}
/** The text of the model, as the page exports it. */
const model = async () => {
  await page.getByTestId('export').click()
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByTestId('export-toml').click()])
  return readFileSync(await download.path(), 'utf8')
}

describe('a goal', () => {
  test('is made of a plot, runs with the progress drawn, and is cancelled at once', async () => {
    await open('macpherson')
    await page.getByTestId('open-optimise').click()
    expect(await page.getByTestId('optimise-why').innerText()).toMatch(
      /^(Add a goal first|Choose at least one variable)/,
    )
    await page.getByTestId('drawer-close').click()
    await page.getByTestId('goal').first().click()
    expect(await page.getByTestId('goal-of').inputValue()).toBe('of toe')
    await page.getByTestId('goal-over').selectOption('wheel_travel')
    await page.getByTestId('goal-add').click()
    await page.getByTestId('goal-toe_range').waitFor()
    await ready(page)
    // The text has the metric alone, and the form the goal: no variable has bounds yet.
    expect(await page.getByTestId('goal-toe_range').getByRole('checkbox').isChecked()).toBe(true)
    expect(await page.getByTestId('optimise-why').innerText()).toBe('Choose at least one variable.')
    await page.getByTestId('search-tie_rod_outer_z').getByRole('checkbox').check()
    await page.getByLabel('lowest of tie_rod_outer_z').fill('-1 cm')
    await page.getByLabel('highest of tie_rod_outer_z').fill('10')
    await page.getByTestId('goal-of').selectOption('camber')
    await page.getByTestId('goal-aim').selectOption('keep')
    await page.getByTestId('goal-max').fill('10')
    await page.getByTestId('goal-add').click()
    await expect.poll(() => page.getByTestId('optimise').locator('.limits').innerText()).toMatch(/camber_range.*10 deg/)
    await ready(page)
    expect(await page.getByLabel('highest of tie_rod_outer_z').inputValue()).toBe('10')
    expect(await page.getByTestId('goal-toe_range').getByRole('checkbox').isChecked()).toBe(true)
    await page.getByTestId('optimise-starts').fill('1000')
    await page.getByTestId('optimise-run').click()
    await expect.poll(() => page.getByTestId('plot-0').innerText()).toContain('best so far')
    // The design of the first start differs from the present one.
    const ended = page.getByTestId('optimise-start')
    await ended.first().waitFor()
    await page.getByTestId('optimise-cancel').click()
    await page.getByTestId('optimise-outcome').waitFor()
    expect(await ended.count()).toBeLessThan(1000)
    await expect.poll(() => page.getByTestId('plot-0').innerText()).toContain('optimised design')
    expect(await page.getByTestId('plot-0').innerText()).not.toContain('best so far')
    await page.getByTestId('optimise-take').click()
    await settled(page)
    expect(await page.getByTestId('plot-0').innerText()).not.toContain('optimised design')
    expect(await page.getByTestId('plot-0').innerText()).toContain('original')
  })
})

describe('a right click on a value', () => {
  test('proposes a goal for it, wherever it hits the card and while the design is another one', async () => {
    await open('macpherson')
    await page.getByTestId('tab-variables').click()
    const field = page.getByTestId('variable-tie_rod_outer_z').getByTestId('change-value')
    await field.fill('5')
    await field.press('Enter')
    const card = page.getByTestId('card-camber')
    await card.getByTestId('card-motion').click({ button: 'right' })
    await page.getByTestId('goal-of').waitFor()
    await settled(page)
    await expect.poll(() => page.getByTestId('optimise-again').isVisible()).toBe(false)
    expect(await page.getByTestId('goal-of').inputValue()).toBe('of camber')
    await page.getByTestId('card-half_track').getByTestId('card-value').click({ button: 'right' })
    await expect.poll(() => page.getByTestId('goal-of').inputValue()).toBe('of half_track')
  })
})

describe('the card of a value', () => {
  test('has a button for its goal while it is pointed at or has the focus', async () => {
    await open('macpherson')
    const goal = page.getByTestId('card-goal')
    expect(await goal.count()).toBe(0)
    await page.getByTestId('card-camber').hover()
    await goal.click()
    await expect.poll(() => page.getByTestId('goal-of').inputValue()).toBe('of camber')
    // The pointer is away from the cards: one that it is on has the button.
    await page.getByTestId('scrub').hover()
    await page.getByTestId('card-half_track').focus()
    await page.getByLabel('Goal of half_track').waitFor({ timeout: 10_000 })
    await page.keyboard.press('Tab')
    expect(await page.evaluate(() => document.activeElement!.getAttribute('aria-label'))).toBe('Goal of half_track')
    await page.keyboard.press('Enter')
    await expect.poll(() => page.getByTestId('goal-of').inputValue()).toBe('of half_track')
    await page.getByTestId('title').hover()
    await page.getByTestId('title').click()
    await page.getByTestId('scrub').focus()
    expect(await goal.count()).toBe(0)
  })
})

describe('a variable', () => {
  test('gets bounds and a tolerance in its row, and keeps its change', async () => {
    await open('four_bar')
    const row = page.getByTestId('variable-B_x')
    await row.locator('.name').click()
    await row.getByTestId('change-value').fill('3')
    await row.getByTestId('change-value').press('Enter')
    await settled(page)
    await row.getByTestId('limits').click()
    await row.getByTestId('bound-low').fill('-20')
    await row.getByTestId('bound-low').press('Enter')
    expect(await page.getByTestId('field-error').innerText()).toBe('Enter the upper bound as well.')
    await row.getByTestId('bound-high').fill('2 cm')
    await row.getByTestId('bound-high').press('Enter')
    await page.waitForFunction(
      () => document.querySelector('[data-testid=variable-B_x] [type=range]')!.getAttribute('max') === '20',
    )
    await ready(page)
    await settled(page)
    expect(await row.getByTestId('change-value').inputValue()).toBe('3')
    await row.locator('.name').click()
    await row.getByTestId('limits').click()
    await row.getByTestId('tolerance-of').fill('0,2')
    await row.getByTestId('tolerance-of').press('Enter')
    await settled(page)
    await ready(page)
    const text = await model()
    // They count from the changed design, which the text has.
    expect(text).toContain('B_x = { move = "B", along = "x", bounds = [-23, 17], tolerance = 0.2 }')
  })
})
