import axe from 'axe-core'
import type { Page } from 'playwright-core'
import { expect, inject, test } from 'vitest'
import { pages, ready } from './pages'

const { models } = inject('samples')

const visit = pages()

/** Rules that the page as it is violates, each with the elements. */
async function violations(page: Page): Promise<string[]> {
  return page.evaluate(async () => {
    const { violations } = await (window as unknown as { axe: typeof axe }).axe.run()
    return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(' ')).join(', ')}`)
  })
}

test('the page, its tabs and its panes have no accessibility violations, beside the view or below it', async () => {
  const page = await visit(models.macpherson, { viewport: { width: 1440, height: 900 } })
  await ready(page)
  await page.evaluate(axe.source)
  const found = new Map<string, string[]>()
  const examine = async (place: string) => {
    const here = await violations(page)
    if (here.length > 0) found.set(place, here)
  }
  const press = async (button: string, shown: string) => {
    await page.getByTestId(button).click()
    await page.getByTestId(shown).first().waitFor()
    await examine(button)
  }
  await examine('start')
  const tabs = await page.getByRole('tab').evaluateAll((all) => all.map(({ id }) => id))
  expect(tabs.length).toBeGreaterThan(3)
  for (const tab of tabs) await press(tab, tab)
  await page.getByTestId('grips').click()
  await press('grip-tie_rod_outer', 'grip-pane')
  await press('open-model', 'model-text')
  await press('open-points', 'points')
  await press('open-optimise', 'optimise')
  await press('open-tolerance', 'tolerance')
  await page.getByTestId('drawer-close').click()
  await page.setViewportSize({ width: 390, height: 844 })
  for (const section of ['nav-curves', 'nav-variables', 'nav-tables']) await press(section, section)
  expect(Object.fromEntries(found)).toEqual({})
})
