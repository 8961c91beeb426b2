import { readFileSync } from 'node:fs'
import { createServer } from 'node:http'
import type { AddressInfo } from 'node:net'
import type { Browser, Page } from 'playwright-core'
import { afterAll, afterEach, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, NO_3D, visit, type Visit } from './browser'
import { ready, settles } from './pages'
import { slide } from './person'

const { cases, models } = inject('samples')

/** A four-bar that locks before its crank has turned once, unless B is nearer to A. */
const LOCKS = `name = "locks"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [62, 0], C = [120, 80], D = [120, 0] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }
drivers.motor = { joint = "A", law = "360*t" }
design.B = { move = "B", along = "x" }
measures.r = { type = "coordinate", joint = "D" }
`

/** With the view, and without it where the camera does not matter. */
let browser: Browser
let flat: Browser
let visited: Visit
let page: Page
/** Pages come from a server: the browser now and then loses the storage of a file that is opened again at once. */
const server = createServer(({ url }, response) => {
  response.setHeader('content-type', 'text/html').end(readFileSync(new URL(models[url!.slice(1)])))
})
beforeAll(async () => {
  ;[browser, flat] = await Promise.all([launch(), launch(NO_3D), new Promise<void>((up) => server.listen(0, up))])
})
afterAll(() => Promise.all([browser?.close(), flat?.close(), server.close()]))
afterEach(async () => {
  expect(visited.complaints).toEqual([])
  await page.context().close()
})

const open = async (name: string, where = flat) => {
  visited = await visit(where, `http://localhost:${(server.address() as AddressInfo).port}/${name}`)
  page = visited.page
  await ready(page)
}
const change = (name: string) => page.getByTestId(`variable-${name}`).getByTestId('change-value')
const over = (id: string) => page.getByTestId(id).getByTestId('over').locator('option:checked').innerText()
const quantity = (id: string) => page.getByTestId(id).getByTestId('quantity').locator('option:checked').innerText()
const figures = () => page.getByTestId('curves').locator('[data-testid^=plot-]').count()

/** Opens the page again once its storage holds this. */
async function reload(stored: string): Promise<void> {
  await page.waitForFunction((stored) => Object.values(localStorage).some((v) => v.includes(stored)), stored)
  await page.reload()
}

/** Choices of a reader that nothing but the reader is to take back. */
async function choose(): Promise<void> {
  await page.getByTestId('plot-0').getByTestId('over').selectOption({ label: 'over wheel_travel' })
  await page.getByTestId('plot-0').getByTestId('quantity').selectOption({ label: 'camber' })
  await page.getByTestId('add-curve').click()
  await page.getByTestId('tab-checks').click()
}

/** Further choices in the view. */
async function look(): Promise<void> {
  await page.getByTestId('look-side').click()
  await page.getByTestId('trace').click()
  for (const point of ['tie_rod_outer', 'ball_joint']) await page.getByTestId(`trace-${point}`).check()
  await page.keyboard.press('Escape')
  await page.getByTestId('labels').click()
}

/** The same choices, as the page shows them. */
async function chosen() {
  return {
    over: await over('plot-0'),
    quantity: await quantity('plot-0'),
    figures: await figures(),
    tab: await page.getByTestId('tab-checks').getAttribute('aria-selected'),
  }
}

async function looked() {
  return {
    look: await page.getByTestId('look-side').getAttribute('aria-pressed'),
    trace: await page.getByTestId('trace').innerText(),
    traces: await page.getByTestId('traces').locator('input:checked').count(),
    labels: await page.getByTestId('labels').getAttribute('aria-pressed'),
  }
}

describe('axes, plots, camera, path and tab', () => {
  test('survive an edit of the text and its undo', async () => {
    await open('macpherson', browser)
    await choose()
    await look()
    const before = { ...(await chosen()), ...(await looked()) }
    await page.getByTestId('open-model').click()
    await page.locator('.cm-content').click()
    await page.keyboard.press('Control+f')
    await page.keyboard.type('strut, BMW')
    await page.keyboard.press('Enter')
    await page.keyboard.press('Escape')
    await page.keyboard.type('another')
    await page.waitForFunction(() => document.querySelector('[data-testid=title]')!.textContent!.includes('another'))
    await ready(page)
    expect({ ...(await chosen()), ...(await looked()) }).toEqual(before)
    await page.getByTestId('undo').click()
    await page.waitForFunction(() => document.querySelector('[data-testid=title]')!.textContent!.includes('BMW'))
    await ready(page)
    expect({ ...(await chosen()), ...(await looked()) }).toEqual(before)
  })
})

describe('work on a design', () => {
  test('is offered again after a reload, with its design, its named designs and its plots', async () => {
    await open('macpherson')
    await choose()
    const before = await chosen()
    await page.getByTestId('tab-variables').click()
    await settles(page, () => slide(page, '[data-testid=variable-tie_rod_outer_z] [data-testid=change]', 5))
    await page.getByTestId('designs').click()
    await page.getByTestId('snapshot-name').fill('higher')
    await page.getByTestId('snapshot-keep').click()
    await page.getByTestId('tab-checks').click()
    await reload('"name":"higher"')
    await page.getByTestId('restore-bar').waitFor()
    expect(await page.getByTestId('restore-bar').innerText()).toContain('1 change')
    expect(await change('tie_rod_outer_z').inputValue()).toBe('0')
    await settles(page, () => page.getByTestId('restore').click())
    expect(await change('tie_rod_outer_z').inputValue()).toBe('5')
    expect(await chosen()).toEqual(before)
    expect(await page.getByTestId('designs').innerText()).toContain('1')
    expect(await page.getByTestId('restore-bar').count()).toBe(0)
    // What is discarded is not offered again.
    await reload('"name":"higher"')
    await page.getByTestId('discard').click()
    await page.reload()
    await ready(page)
    expect(await page.getByTestId('restore-bar').count()).toBe(0)
  })

  test('goes with a link', async () => {
    await open('macpherson')
    await settles(page, () => slide(page, '[data-testid=variable-tie_rod_outer_z] [data-testid=change]', 5))
    await page.getByTestId('export').click()
    await page.getByTestId('export-link').click()
    await page.waitForFunction(() => location.hash.startsWith('#state='))
    const other = await visit(flat, page.url())
    await other.page.waitForFunction(() => document.getElementById('page')!.dataset.settled === 'yes')
    await expect
      .poll(() => other.page.getByTestId('variable-tie_rod_outer_z').getByTestId('change-value').inputValue())
      .toBe('5')
    await other.page.context().close()
  })

  test('goes with a link together with its case', async () => {
    visited = await visit(flat, cases)
    page = visited.page
    await ready(page)
    await page.getByTestId('case').selectOption('steer')
    const title = (page: Page) => page.getByTestId('title').innerText()
    await expect.poll(() => title(page)).toContain('steer')
    await ready(page)
    await page.getByTestId('export').click()
    await page.getByTestId('export-link').click()
    await page.waitForFunction(() => location.hash.startsWith('#state='))
    const other = await visit(flat, page.url())
    await expect.poll(() => title(other.page)).toContain('steer')
    await other.page.context().close()
  })

  test('whose motion is longer than that of the original says so, and is shown whole on request', async () => {
    await open('slider_crank')
    await page.getByTestId('open-model').click()
    await page.getByTestId('model-text').click()
    await page.keyboard.press('Control+a')
    await page.keyboard.insertText(LOCKS)
    await expect.poll(() => page.getByTestId('title').innerText()).toContain('locks')
    await ready(page)
    const banner = page.getByTestId('banner')
    expect(await banner.innerText()).toContain('This motion is incomplete.')
    await page.getByTestId('tab-variables').click()
    const change = page.getByTestId('variable-B').getByTestId('change-value')
    await settles(page, async () => {
      await change.fill('-10')
      await change.press('Enter')
    })
    expect(await banner.innerText()).toMatch(/^Only a part of this motion is shown.*up to 0\.4\d* s/)
    // The rocker turns to 69.6 deg after the time at which the original locks.
    const card = () => page.getByTestId('card-r').innerText()
    expect(await card()).not.toContain('69.6')
    await page.getByTestId('whole-motion').click()
    await expect.poll(() => banner.isVisible()).toBe(false)
    await expect.poll(card).toContain('69.6')
    await page.getByTestId('undo').click()
    await expect.poll(() => banner.isVisible()).toBe(true)
  })

  test('is not left without a warning where its text has errors, and its export is the last valid text', async () => {
    await open('macpherson')
    const asked: string[] = []
    page.on('dialog', (dialog) => {
      asked.push(dialog.type())
      void dialog.accept()
    })
    await page.getByTestId('open-model').click()
    await page.getByTestId('model-text').click()
    await page.keyboard.press('Control+Home')
    await page.keyboard.type('nonsense = 1\n')
    await expect.poll(() => page.getByTestId('model-messages').innerText()).toContain('nonsense')
    await page.getByTestId('export').click()
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByTestId('export-toml').click()])
    expect(readFileSync(await download.path(), 'utf8')).not.toContain('nonsense')
    await expect.poll(() => page.getByTestId('studio-status').innerText()).toContain('Exported the last valid text')
    await page.reload()
    await expect.poll(() => asked).toEqual(['beforeunload'])
  })

  test('is not left without a warning where the browser keeps nothing', async () => {
    await open('macpherson')
    const asked: string[] = []
    page.on('dialog', (dialog) => {
      asked.push(dialog.type())
      void dialog.accept()
    })
    await page.locator('h1').click()
    await settles(page, () => slide(page, '[data-testid=variable-tie_rod_outer_z] [data-testid=change]', 5))
    await page.evaluate(() => {
      Storage.prototype.setItem = () => {
        throw new Error('the storage is full')
      }
    })
    await page.reload()
    await expect.poll(() => asked).toEqual(['beforeunload'])
  })

  test('opens on a motion with one driver that it derives, and keeps a preference for all drivers', async () => {
    const text = readFileSync('../models/front_axle.toml', 'utf8')
    const toml = async () => {
      await page.getByTestId('export').click()
      const [file] = await Promise.all([page.waitForEvent('download'), page.getByTestId('export-toml').click()])
      return readFileSync((await file.path())!, 'utf8')
    }
    visited = await visit(flat, models.front_axle, { derived: true })
    page = visited.page
    await ready(page)
    expect(await page.getByTestId('derived-motion').innerText()).toContain('bump moves alone')
    expect(await page.getByTestId('case').locator('option').allInnerTexts()).toEqual([
      'bump alone',
      'steering alone',
      'all drivers',
    ])
    expect(await over('plot-0')).toBe('over left.wheel_travel')
    // Values, sensitivities and designs are of this motion; the text is that of the model, with the change alone.
    const value = (name: string) => page.getByTestId(`card-${name}`).getByTestId('card-value').innerText()
    expect(await value('largest_camber')).toBe('1.99')
    expect(await value('bump_steer')).toBe('0.02832')
    await settles(page, async () => {
      await change('tie_rod_outer_z').fill('1')
      await change('tie_rod_outer_z').press('Enter')
    })
    expect(await value('bump_steer')).not.toBe('0.02832')
    const changed = await toml()
    expect(changed).not.toContain('[cases')
    expect(changed.split('\n').length).toBe(text.split('\n').length)
    // Each case keeps its own axes.
    await page.getByTestId('case').selectOption({ label: 'steering alone' })
    await page.waitForFunction(() => document.querySelector('[data-testid=title]')!.textContent!.includes('steering'))
    await ready(page)
    expect(await over('plot-0')).not.toBe('over left.wheel_travel')
    await page.getByTestId('case').selectOption({ label: 'bump alone' })
    await page.waitForFunction(() => document.querySelector('[data-testid=title]')!.textContent!.includes('bump'))
    await ready(page)
    expect(await over('plot-0')).toBe('over left.wheel_travel')
    await page.getByTestId('write-cases').click()
    await page.getByTestId('derived-motion').waitFor({ state: 'detached' })
    await expect
      .poll(() => page.getByTestId('case').locator('option').allInnerTexts())
      .toEqual(['bump', 'steering', 'all_drivers'])
    await ready(page)
    expect(await over('plot-0')).toBe('over left.wheel_travel')
    expect(await toml()).toContain('[cases.bump]\nlaws = { left_bump = "60*sin(4*pi*t)" }')
    await page.getByTestId('undo').click()
    await page.getByTestId('own-motion').click()
    await page.getByTestId('derived-motion').waitFor({ state: 'detached' })
    await expect.poll(() => over('plot-0')).toBe('over time')
    await ready(page)
    await settles(page, () => page.getByTestId('reset-all').click())
    await page.reload()
    await ready(page)
    expect(await over('plot-0')).toBe('over time')
  })
})
