import { describe, expect, inject, test } from 'vitest'
import { pages, ready } from './pages'
import { curve, drawn, picture, scrub, text } from './person'

const { knee, models } = inject('samples')

/** The step at which the coupler is deepest in the first screw, of 100. */
const DEEPEST = 38

describe('a mechanism with shapes', () => {
  const open = pages()

  test('shows them with the nearest points, until a button hides both', async () => {
    const page = await open(knee)
    await scrub(page, 0)
    const shown = await picture(page)
    expect(await page.locator('.labels').textContent()).toMatch(/coupler_rod – screw[12] 10\.12 mm/)
    expect(await page.locator('.labels .alert').count()).toBe(0)
    await scrub(page, DEEPEST)
    await drawn(page)
    expect(await page.locator('.labels .alert').textContent()).toBe('coupler_rod – screw1 −0.2063 mm')
    await scrub(page, 0)
    await page.getByTestId('shapes').click()
    const hidden = await picture(page)
    expect(hidden.equals(shown)).toBe(false)
    expect(await page.locator('.labels').textContent()).toBe('')
    await page.keyboard.press('h')
    expect((await picture(page)).equals(shown)).toBe(true)
  })

  test('marks its contacts on the slider and in the curve of the clearance', async () => {
    const page = await open(knee)
    const mark = page.getByTestId('contacts').locator('span')
    expect(await mark.count()).toBe(1)
    const [from, to] = await mark.evaluate(({ style }) =>
      ['--from', '--to'].map((name) => Number(style.getPropertyValue(name))),
    )
    expect([from, to]).toEqual([0.32103, 0.44868])
    // Where the thumb is: its middle is half of its width from either end.
    await scrub(page, DEEPEST)
    const [slider, span] = await Promise.all([page.getByTestId('scrub').boundingBox(), mark.boundingBox()])
    const thumb = slider!.x + 8 + ((slider!.width - 16) * DEEPEST) / 100
    expect(span!.x).toBeLessThan(thumb)
    expect(span!.x + span!.width).toBeGreaterThan(thumb)
    const select = page.getByTestId('plot-0').getByTestId('quantity')
    await select.selectOption({ label: 'rods_to_screws' })
    expect(await text(page, 'plot-0')).toMatch(/Red: shapes touch\./)
    expect((await curve(page, 'plot-0')).colours).toBeGreaterThan(10)
    await select.selectOption({ label: 'rocker_angle' })
    expect(await text(page, 'plot-0')).not.toMatch(/shapes touch/)
  })

  test('has the distances of all pairs in a table', async () => {
    const page = await open(knee)
    await page.getByRole('tab', { name: 'Checks' }).click()
    const table = page.getByTestId('checks').locator('details').filter({ hasText: 'Least distances of shapes' })
    expect(await table.locator('tbody tr').count()).toBe(4)
    expect(await table.locator('tbody tr').first().innerText()).toMatch(/coupler_rod - screw1\s+-0\.20643 mm/)
  })

  test('says that shapes touch while a point is dragged, and by how much', async () => {
    const page = await open(knee)
    await ready(page)
    await scrub(page, 0)
    await page.getByTestId('grips').click()
    await page.getByTestId('grip-C').click()
    expect(await text(page, 'refusal')).not.toMatch(/touch/)
    const before = await page.getByTestId('contacts').locator('span').getAttribute('style')
    await page.getByTestId('grip-y').fill('55')
    await page.getByTestId('grip-y').press('Enter')
    await expect.poll(() => text(page, 'refusal')).toMatch(/touch.* [\d.]+ mm deep at 0\.\d+ s\./)
    expect(await page.getByTestId('contacts').locator('span').getAttribute('style')).not.toBe(before)
    // Away from the screws nothing touches, and the hint returns.
    await page.getByTestId('grip-y').fill('48')
    await page.getByTestId('grip-y').press('Enter')
    await expect.poll(() => text(page, 'refusal')).toMatch(/Drag the point/)
    expect(await page.getByTestId('contacts').locator('span').count()).toBe(0)
    // Shapes that were apart stop the way back, unless they are hidden.
    await page.getByTestId('grip-y').fill('55')
    await page.getByTestId('grip-y').press('Enter')
    await expect.poll(() => text(page, 'refusal')).toMatch(/touches .* at t = 0\.\d+ s beyond this design/)
    const stopped = Number(await page.getByTestId('grip-y').inputValue())
    expect(stopped).toBeGreaterThan(48)
    expect(stopped).toBeLessThan(55)
    expect(await page.getByTestId('contacts').locator('span').count()).toBe(0)
    await page.getByTestId('shapes').click()
    await page.getByTestId('grip-y').fill('55')
    await page.getByTestId('grip-y').press('Enter')
    await expect.poll(() => text(page, 'refusal')).toMatch(/touch.* [\d.]+ mm deep at 0\.\d+ s\./)
  })

  test('is the only one with a button for them', async () => {
    const page = await open(models.macpherson)
    expect(await page.getByTestId('shapes').isHidden()).toBe(true)
    expect(await page.getByTestId('contacts').locator('span').count()).toBe(0)
    const before = await picture(page)
    await page.keyboard.press('h')
    expect((await picture(page)).equals(before)).toBe(true)
  })
})
