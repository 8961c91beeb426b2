import { describe, expect, inject, test } from 'vitest'
import { pages } from './pages'
import { picture, text } from './person'

const { elastic } = inject('samples')

describe('a mechanism with elastic joints', () => {
  const open = pages()

  test('is shown with the rigid one, thin in the plots and dashed in the view, until a button hides it', async () => {
    const page = await open(elastic)
    expect(await text(page, 'plot-0')).toMatch(/left\.toe, rigid/)
    expect(await page.locator('.ghost-key').innerText()).toBe('rigid')
    const before = await picture(page)
    await page.getByTestId('rigid').click()
    expect(await text(page, 'plot-0')).not.toMatch(/rigid/)
    expect(await page.locator('.ghost-key').isVisible()).toBe(false)
    expect((await picture(page)).equals(before)).toBe(false)
    await page.getByTestId('rigid').click()
    expect((await picture(page)).equals(before)).toBe(true)
  })

  test('has the deflections of its bushings as curves, and the largest ones in a table', async () => {
    const page = await open(elastic)
    await page.getByTestId('plot-0').getByTestId('quantity').selectOption({ label: 'left_lca_rear along z' })
    expect(await text(page, 'plot-0')).toMatch(/left_lca_rear along z\s+[−\d.]+ mm/)
    await page.getByRole('tab', { name: 'Checks' }).click()
    const table = page.locator('details').filter({ hasText: 'force or moment there' })
    await table.locator('summary').click()
    expect(await table.locator('tbody tr').count()).toBe(48)
  })

  test('has a table of its metrics with rigid values, signs and the most influential variables', async () => {
    const page = await open(elastic)
    await page.getByRole('tab', { name: 'Metrics' }).click()
    const table = page.getByTestId('metrics')
    expect(await table.locator('thead').innerText()).toMatch(/metric\s+value\s+rigid\s+positive.*most influential/s)
    const row = table.locator('tr').filter({ hasText: 'bump_steer' })
    expect(await row.innerText()).toMatch(/deg\/mm\s+[\d.]+ deg\/mm\s+toe-in in bump/)
  })

  test('has the metrics of the rigid one in a column of their own, and changes to it in the plots', async () => {
    const page = await open(elastic)
    await page.getByRole('tab', { name: 'Compare' }).click()
    const heading = page.getByTestId('comparison').locator('thead')
    expect(await heading.innerText()).toMatch(/original\s+rigid\s+change/)
    await page.getByTestId('plot-0').getByTestId('difference').click()
    expect(await page.getByTestId('plot-0').locator('figcaption + * ~ .caption').first().innerText()).toBe(
      'Change to: rigid.',
    )
  })
})
