import { readFileSync } from 'node:fs'
import type { Page } from 'playwright-core'
import { describe, expect, inject, test } from 'vitest'
import { NO_3D } from './browser'
import { pages, ready, settles } from './pages'
import { curve, drawn, slide } from './person'
import { motionBeside } from './table'

const { models } = inject('samples')

/** The curves need no view, and are drawn sooner without one. */
let page: Page
const visit = pages(NO_3D)

const open = async (name: string, viewport = { width: 1440, height: 900 }) => {
  page = await visit(models[name], { viewport })
  await ready(page)
}
const plot = (k: number) => page.getByTestId(`plot-${k}`)
const chosen = (k: number, name: string) => plot(k).getByTestId(name).locator('option:checked').innerText()
const change = (name: string, by: number) => slide(page, `[data-testid=variable-${name}] [data-testid=change]`, by)
const numberOf = (text: string) => Number(text.replaceAll('−', '-'))

describe('after a change', () => {
  test('the metrics have the numbers of the cards at once, and what needs sensitivities names its design', async () => {
    await open('front_axle')
    /** Row and card of a metric, and the name above the other columns; waits until the card differs. */
    const read = (card: string) =>
      page.waitForFunction((former) => {
        const row = [...document.querySelectorAll('[data-testid=metrics] tbody tr')].find((row) =>
          row.textContent.startsWith('bump_steer'),
        )
        const card = document.querySelector('[data-testid=card-bump_steer] [data-testid=card-value]')!.textContent
        const heading = document.querySelector('[data-testid=metrics] [data-testid=of-design]')?.textContent
        return card === former ? null : { value: row!.children[1].textContent, card, heading }
      }, card)
    const both = async (former = '') => (await (await read(former)).jsonValue())!
    const isSame = ({ value, card }: { value: string; card: string }) =>
      Math.abs(numberOf(value.split(' ')[0]) - numberOf(card)) < 1e-5
    await page.getByTestId('tab-metrics').click()
    const before = await both()
    expect([before.heading, isSame(before)]).toEqual([undefined, true])
    await Promise.all([
      change('upper_ball_x', 10),
      both(before.card).then((during) => expect([during.heading, isSame(during)]).toEqual(['Original design', true])),
    ])
    await page.waitForFunction(() => document.getElementById('page')!.dataset.settled === 'yes')
    const after = await both()
    expect([after.heading, isSame(after)]).toEqual([undefined, true])
    expect(after.value).not.toBe(before.value)
  })

  test('ranges of cards and of Compare are those of the curve, as the metrics beside them', async () => {
    await open('front_axle')
    const largest = await page.getByTestId('card-largest_camber').getByTestId('card-value').innerText()
    await page.getByTestId('tab-compare').click()
    const row = page.getByTestId('comparison').locator('tr', { hasText: /^left\.camber/ })
    expect(await row.locator('td').first().innerText()).toMatch(new RegExp(` … ${largest.replace('.', '\\.')}$`))
  })

  test('cards show what it did to the range over the motion, where the value at ride height stays', async () => {
    await open('macpherson')
    const toe = page.getByTestId('card-toe')
    const before = await toe.getByTestId('card-motion').innerText()
    expect(before).toMatch(/^−8\.71 … 8\.95 · slope −0\.0218 deg\/mm$/)
    await settles(page, () => change('tie_rod_outer_z', 5))
    const after = await toe.getByTestId('card-motion').innerText()
    expect(after).toMatch(/^−[\d.]+ \([+−][\d.]+\) … [\d.]+ \([+−][\d.]+\) · slope −?[\d.]+ deg\/mm$/)
    expect(await toe.getByTestId('card-change').isVisible()).toBe(false)
  })
})

describe('the sheet', () => {
  test('of a suspension opens on toe over wheel travel, and has three numbers on every ordinate', async () => {
    await open('double_wishbone_4x4', { width: 1024, height: 768 })
    expect([await chosen(0, 'quantity'), await chosen(0, 'over')]).toEqual([
      'front_left.toe',
      'over front_left.wheel_travel',
    ])
    const areas = page.getByTestId('curves').locator('.area')
    for (const height of await areas.evaluateAll((all) => all.map((area) => area.clientHeight)))
      expect(height).toBeGreaterThanOrEqual(180)
    const titles = await page
      .getByTestId('curves')
      .getByTestId('quantity')
      .evaluateAll((all) => all.map((select) => (select as HTMLSelectElement).selectedOptions[0].textContent))
    for (const name of ['camber', 'caster', 'roll_centre_height', 'half_track'])
      expect(titles).toContain(`front_left.${name}`)
  })

  test('is that of the model file, whose named designs are compared', async () => {
    await open('solid_axle')
    expect([await chosen(0, 'quantity'), await chosen(0, 'over')]).toEqual(['lateral_shift', 'over left_travel'])
    expect([await chosen(2, 'quantity'), await chosen(3, 'quantity')]).toEqual(['axle_steer', 'axle_roll'])
    await page.getByTestId('designs').click()
    const name = page.getByTestId('snapshots').getByTestId('snapshot-rename')
    expect([await name.inputValue(), await name.getAttribute('readonly')]).toEqual(['level_rod', ''])
    await page.getByTestId('snapshot-compare').click()
    await expect.poll(() => plot(0).locator('.legend .label').allInnerTexts()).toEqual(['current', 'level_rod'])
    await page.getByTestId('snapshot-open').click()
    const value = page.getByTestId('variable-panhard_chassis_z').getByTestId('change-value')
    await expect.poll(() => value.inputValue()).toBe('-60')
  })

  test('holds several quantities and designs, whose lines are hidden by a click on the legend', async () => {
    await open('front_axle')
    const labels = () => plot(0).locator('.legend .label').allInnerTexts()
    expect(await labels()).toEqual(['left.toe', 'right.toe'])
    await plot(0).getByTestId('also').focus()
    await plot(0).getByTestId('also').selectOption({ label: 'left.camber' })
    expect(await labels()).toEqual(['left.toe', 'right.toe', 'left.camber'])
    const before = await curve(page, 'plot-0')
    await plot(0).locator('.legend button').last().click()
    expect((await curve(page, 'plot-0')).sum).not.toBe(before.sum)
    expect(await plot(0).locator('.legend button').last().getAttribute('aria-pressed')).toBe('false')
    await plot(0).locator('.legend button').last().click()
    expect((await curve(page, 'plot-0')).sum).toBe(before.sum)
    // Two kept designs besides the present one and the original.
    for (const [by, name] of [
      [4, 'forward'],
      [8, 'far'],
    ] as const) {
      await settles(page, () => change('tie_rod_outer_x', by))
      await page.getByTestId('designs').click()
      await page.getByTestId('snapshot-name').fill(name)
      await page.getByTestId('snapshot-keep').click()
      await page.getByTestId('snapshot-compare').last().click()
      await page.keyboard.press('Escape')
    }
    // The original is solved already, so that the page may have settled again before it can be asked.
    await page.getByTestId('reset-design').click()
    for (const name of ['forward', 'far'])
      await expect.poll(async () => (await labels()).join()).toContain(`left.toe, ${name}`)
    await page.getByTestId('tab-compare').click()
    const header = page.getByTestId('comparison').locator('thead th')
    expect(await header.allInnerTexts()).toEqual(['value', 'far', 'current', 'forward', 'change', 'unit'])
  })

  test('shows changes to the original, and values at chosen abscissas', async () => {
    await open('double_wishbone_4x4')
    await plot(0).getByTestId('values-at').click()
    const rows = () => plot(0).getByTestId('value-table').locator('tbody tr').allInnerTexts()
    await plot(0).getByTestId('abscissas').fill('-60 0 60')
    await plot(0).getByTestId('abscissas').press('Enter')
    expect((await rows()).map((row) => row.split('\t')[0])).toEqual(['−60', '0', '60'])
    expect(numberOf((await rows())[1].split('\t')[1])).toBeCloseTo(0, 3)
    await plot(0).getByTestId('difference').click()
    expect(await plot(0).locator('.caption').first().innerText()).toBe('Nothing is changed yet.')
    await settles(page, () => change('tie_rod_inner_z', 5))
    expect(await plot(0).locator('.caption').first().innerText()).toBe('Change to: original.')
    const differences = (await rows()).map((row) => numberOf(row.split('\t')[1]))
    expect(Math.max(...differences.map(Math.abs))).toBeGreaterThan(0.1)
  })

  test('of a crank that turns has both branches over another measure, with all values in the table', async () => {
    await open('four_bar')
    await plot(0).getByTestId('quantity').selectOption({ label: 'rocker_angle' })
    await plot(0).getByTestId('over').selectOption({ label: 'over midpoint_x' })
    await plot(0).getByTestId('values-at').click()
    const list = plot(0).getByTestId('abscissas')
    const enter = async (text: string) => {
      await list.fill(text)
      await list.press('Enter')
    }
    const rows = async () =>
      (await plot(0).getByTestId('value-table').locator('tbody tr').allInnerTexts()).map((row) => row.split('\t'))
    // The command's values at two of its output times, and at the times with the same abscissa on the other branch.
    const motion = motionBeside(models.four_bar)
    const [x, y] = ['midpoint_x', 'rocker_angle'].map((name) => motion.get(name)!)
    const [low, high] = [Math.min(...x), Math.max(...x)]
    const k = x.findIndex((value, k) => k > 20 && value > (low + high) / 2 + 3)
    await enter(`${x[k]}`)
    const [[, both]] = await rows()
    const values = both.split('; ').map(numberOf)
    expect(values).toHaveLength(2)
    expect(Math.min(...values.map((value) => Math.abs(value - y[k])))).toBeLessThan(1e-3 * Math.abs(y[k]))
    expect(await plot(0).getByTestId('values-note').innerText()).toBe('Several values: in the order of the motion.')
    // An inch is entered as in every field of a length, and what is none is named.
    await enter('8 in; 9 1/2 in')
    expect((await rows()).map(([at]) => at)).toEqual(['203.2', '241.3'])
    await enter('203.2 1/8s')
    expect(await plot(0).getByTestId('abscissas-wrong').innerText()).toContain('There is no unit s')
    expect(await list.inputValue()).toBe('203.2 1/8s')
    // The curve is drawn from the first step to the last.
    const [picture] = await Promise.all([
      page.waitForEvent('download'),
      page
        .getByTestId('export')
        .click()
        .then(() => page.getByTestId('export-plot-svg').first().click()),
    ])
    const svg = readFileSync(await picture.path(), 'utf8')
    const longest = Math.max(
      ...[...svg.matchAll(/(?:points|d)="([^"]*)"/g)].map(([, path]) => path.split(/[ ML]+/).length),
    )
    expect(longest).toBeGreaterThan(x.length - 2)
  })

  test('draws a measured file only where it has what is plotted', async () => {
    await open('four_bar')
    const file = 'time [ms],midpoint_x [in],crank_angle [rad]\n0,8,0\n500,9,3.14159\n'
    const read = (name: string, text: string) =>
      plot(0)
        .getByTestId('measured-file')
        .setInputFiles({ name, mimeType: 'text/csv', buffer: Buffer.from(text) })
    const legend = () => plot(0).locator('.legend .label').allInnerTexts()
    const missed = () => plot(0).locator('.caption.missed').first().innerText()
    await plot(0).getByTestId('quantity').selectOption({ label: 'midpoint_x' })
    await plot(0).getByTestId('over').selectOption('')
    await read('rig.csv', file)
    await expect.poll(legend).toEqual(['midpoint_x', 'midpoint_x, rig.csv'])
    await read('wrong.csv', 'time,midpoint_x [furlong]\n0,1\n')
    await expect.poll(missed).toBe('midpoint_x [furlong] of wrong.csv: the page has no unit furlong')
    // The columns of what is shown then.
    await plot(0).getByTestId('quantity').selectOption({ label: 'crank_angle' })
    await expect.poll(legend).toEqual(['crank_angle', 'crank_angle, rig.csv'])
    await plot(0).getByTestId('quantity').selectOption({ label: 'rocker_angle' })
    await expect.poll(missed).toContain('rig.csv has no column rocker_angle')
    expect(await legend()).toEqual(['rocker_angle'])
    await plot(0).getByTestId('quantity').selectOption({ label: 'midpoint_x' })
    await plot(0).getByTestId('over').selectOption({ label: 'over rocker_angle' })
    await expect.poll(missed).toContain('rig.csv has no column rocker_angle')
    expect(await legend()).toEqual(['midpoint_x'])
    // Values are no changes.
    await plot(0).getByTestId('over').selectOption('')
    await expect.poll(legend).toEqual(['midpoint_x', 'midpoint_x, rig.csv'])
    await plot(0).getByTestId('difference').click()
    await expect.poll(() => plot(0).locator('.caption').first().innerText()).toContain('not shown among changes')
    expect(await legend()).toEqual(['midpoint_x'])
  })

  test('is maximised and restored, and zooms along the ordinate', async () => {
    await open('double_wishbone_4x4')
    const width = () => plot(0).evaluate((element) => element.clientWidth)
    const before = await width()
    await plot(0).getByTestId('maximise').click()
    expect(await width()).toBe(1440)
    await page.keyboard.press('Escape')
    expect(await width()).toBe(before)
    await plot(0).locator('.u-over').dblclick()
    expect(await width()).toBe(1440)
    await plot(0).locator('.u-over').dblclick()
    expect(await width()).toBe(before)
    const whole = await curve(page, 'plot-0')
    const axis = (await plot(0).locator('.ordinate').boundingBox())!
    await page.mouse.move(axis.x + 40, axis.y + 30)
    await page.mouse.down()
    await page.mouse.move(axis.x + 40, axis.y + 80, { steps: 3 })
    await page.mouse.up()
    expect((await curve(page, 'plot-0')).sum).not.toBe(whole.sum)
    await plot(0).getByTestId('whole').click()
    await page.mouse.move(1, 1)
    expect((await curve(page, 'plot-0')).sum).toBe(whole.sum)
  })

  test('reads all plots under one pointer, and draws measured data', async () => {
    await open('double_wishbone_4x4')
    const area = (await plot(0).locator('.u-over').boundingBox())!
    await page.mouse.move(area.x + area.width * 0.8, area.y + 40)
    await drawn(page)
    const moment = await plot(0).locator('.moment').innerText()
    expect(moment).toMatch(/wheel_travel \d/)
    expect(await plot(1).locator('.moment').innerText()).toBe(moment)
    const rig = 'front_left.wheel_travel [mm],front_left.toe [deg]\n-50,-1.5\n0,0.1\n50,1.2\n'
    await plot(0)
      .getByTestId('measured-file')
      .setInputFiles({ name: 'rig.csv', mimeType: 'text/csv', buffer: Buffer.from(rig) })
    await expect.poll(() => plot(0).locator('.legend').innerText()).toContain('front_left.toe, rig.csv')
    await plot(0)
      .getByTestId('measured-file')
      .setInputFiles({ name: 'none.csv', mimeType: 'text/csv', buffer: Buffer.from('nothing') })
    await expect.poll(() => plot(0).innerText()).toContain('needs two columns')
  })
})
