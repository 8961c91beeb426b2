import { readFileSync } from 'node:fs'
import { join } from 'node:path'
import type { Page } from 'playwright-core'
import { describe, expect, inject, test } from 'vitest'
import { NO_3D } from './browser'
import { pages, ready, settled } from './pages'
import { curve, text } from './person'

const { cases, models } = inject('samples')
const model = (file: string) => readFileSync(join(import.meta.dirname, '../../models', file), 'utf8')
const FOUR_BAR = model('four_bar.toml')
const TOE = model('studies/strut_toe.toml')

const visit = pages(NO_3D)
const open = async (url: string, width = 1440) => {
  const page = await visit(url, { viewport: { width, height: 900 } })
  await ready(page)
  return page
}

/** Pastes another text over that of the model, which is open. */
const paste = (page: Page, text: string) =>
  page.locator('.cm-content').evaluate((content, text) => {
    const data = new DataTransfer()
    data.setData('text/plain', text)
    document.getSelection()!.selectAllChildren(content)
    content.dispatchEvent(new ClipboardEvent('paste', { clipboardData: data, bubbles: true, cancelable: true }))
  }, text)

/** A text of which a part is another, which must be there. */
const replaced = (text: string, part: string | RegExp, by: string) => {
  const other = text.replace(part, by)
  expect(other).not.toBe(text)
  return other
}

test('the row of a parameter has its value, and counts from it, with its bounds', async () => {
  const page = await open(models.four_bar_by_lengths)
  const row = page.getByTestId('variable-ground')
  const field = row.getByTestId('change-value')
  expect(await field.inputValue()).toBe('400')
  const type = async (text: string) => {
    await field.fill(text)
    await field.press('Enter')
  }
  await type('+2')
  expect(await field.inputValue()).toBe('402')
  await type('39 cm')
  expect(await field.inputValue()).toBe('390')
  await type('500')
  expect(await field.inputValue()).toBe('450')
  expect(await text(page, 'field-error')).toBe('The bound of ground is 450 mm.')
  await row.getByTestId('limits').click()
  expect(await row.getByTestId('bound-low').inputValue()).toBe('350')
  await row.getByTestId('reset').click()
  await expect.poll(() => field.inputValue()).toBe('400')
})

describe('a text that is typed', () => {
  test('with one output time that is not zero has plots around it', async () => {
    const page = await open(models.four_bar)
    await page.getByTestId('open-model').click()
    await paste(page, replaced(FOUR_BAR, 'end = 1.0\nsteps = 200', 'at = [0.3]'))
    await expect.poll(() => page.getByTestId('plot-0').locator('.moment').innerText()).toBe('0.3 s')
    await settled(page)
    // The numbers along both axes have smooth edges.
    expect((await curve(page, 'plot-0')).colours).toBeGreaterThan(10)
    expect(await page.getByTestId('plot-0').getByTestId('closer').isHidden()).toBe(true)
  })

  test('without variables has a page, and its sensitivities again with them', async () => {
    const page = await open(models.four_bar)
    const heading = () => page.getByTestId('plot-1').locator('h3').innerText()
    expect(await heading()).toMatch(/^Sensitivities of midpoint_x \[/)
    await page.getByTestId('open-model').click()
    await paste(page, replaced(FOUR_BAR, /# The eight variables[^[]*\[design\][^[]*(?=\[points\])/, ''))
    await expect.poll(() => text(page, 'plot-1')).toContain('The model has no design variables')
    await ready(page)
    await settled(page)
    expect(await text(page, 'studio-status')).toBe('')
    expect((await curve(page, 'plot-0')).colours).toBeGreaterThan(10)
    await paste(page, FOUR_BAR)
    await expect.poll(heading).toMatch(/^Sensitivities of midpoint_x \[/)
    await settled(page)
    expect((await curve(page, 'plot-1')).colours).toBeGreaterThan(10)
  })

  test('with a long name of a case leaves the title its room', async () => {
    const page = await open(cases, 1600)
    const cut = () => page.getByTestId('title').evaluate((title) => title.scrollWidth > title.clientWidth)
    const select = page.getByTestId('case')
    const name = 'one wheel over a bump, the other one in a hole, at full lock'
    await page.getByTestId('open-model').click()
    const named = replaced(TOE, '[cases.steer]', `[cases."${name}"]`)
    await paste(page, replaced(named, 'case = "steer"', `case = "${name}"`))
    await expect.poll(() => select.locator('option').allInnerTexts()).toContain(name)
    await settled(page)
    await page.getByTestId('drawer-close').click()
    expect((await select.boundingBox())!.width).toBeLessThanOrEqual(150)
    expect(await select.getAttribute('title')).toBe(`Case ${await select.inputValue()}`)
    expect(await cut()).toBe(false)
  })
})
