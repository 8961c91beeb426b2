import { readFileSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import type { Browser, Page } from 'playwright-core'
import { afterAll, beforeAll, describe, expect, inject, test } from 'vitest'
import { launch, visit } from './browser'
import { examine, paper, sheet } from './desk'
import { drawn, picture, scrub } from './person'
import { motionBeside } from './table'

const { models } = inject('samples')
const SCHEMES = ['light', 'dark'] as const
type Scheme = (typeof SCHEMES)[number]

/** Parts of the motion at which nothing may have left the picture. */
const MOMENTS = [0.3, 0.75]

/** At any one moment a mechanism takes at least so much of the view, which has room for its whole motion. */
const FILLED = 0.35

/** Folder for the documents' pictures, if the tests are to make them anew: `UPDATE_DOCS=1 npm test`. */
const IMAGES = process.env.UPDATE_DOCS && join(import.meta.dirname, '../../docs/images')

/** Size of the window for these pictures, and for checks: three quarters of a check's time are drawn pixels. */
const LARGE = { width: 1440, height: 900 }
const SMALL = { width: 1000, height: 640 }

/** Text of a document. */
function documented(name: string): string {
  return readFileSync(join(import.meta.dirname, '../../docs', name), 'utf8')
}

/** Largest less smallest value, as a share of the largest size. */
const spread = (values: number[]) => (Math.max(...values) - Math.min(...values)) / Math.max(...values.map(Math.abs))
/** A quantity that changes by less than this share of its size is as good as constant. */
const CONSTANT = 1e-9

/** Quantity and abscissa of the first curve of each model, as the documents list them. */
const OPENINGS = new Map(
  [...documented('results.md').matchAll(/^\| `(\w+)` \| `([\w.]+)` \| (?:`([\w.]+)`|time) \| .* \|$/gm)].map(
    ([, model, quantity, over = 'time']) => [model, [quantity, `over ${over}`]],
  ),
)

describe('every model', () => {
  let browser: Browser
  let desk: Page
  const pictures: Record<Scheme, [string, Buffer][]> = { light: [], dark: [] }

  beforeAll(async () => {
    browser = await launch()
    desk = await browser.newPage()
  })
  afterAll(() => browser?.close())

  /** The present view, which must not be empty or cut off. */
  async function whole(page: Page, what: string): Promise<Buffer> {
    const png = await picture(page)
    const seen = await examine(desk, png, await paper(page))
    expect.soft(seen.drawn, `${what}: the mechanism is drawn`).toBeGreaterThan(0.005)
    expect.soft(seen.reach, `${what}: the mechanism fills the view`).toBeGreaterThan(FILLED)
    expect.soft(seen.border, `${what}: pixels at the border`).toBe(0)
    return png
  }

  // Opened in one scheme and switched to the other, by turns, so that both ways to each are seen.
  test.each(
    Object.entries(models).map(([name, url], k) => ({ name, url, order: k % 2 ? SCHEMES : SCHEMES.toReversed() })),
  )('$name is drawn whole in both schemes and says nothing on the console', async ({ name, url, order }) => {
    const { page, complaints } = await visit(browser, url, {
      viewport: IMAGES ? LARGE : SMALL,
      colorScheme: order[0],
      derived: true,
    })
    for (const scheme of order) {
      await page.emulateMedia({ colorScheme: scheme })
      pictures[scheme].push([name, await whole(page, scheme)])
    }
    const last = Number(await page.getByTestId('scrub').getAttribute('max'))
    for (const moment of MOMENTS) {
      await scrub(page, Math.round(moment * last))
      await whole(page, `at step ${Math.round(moment * last)} of ${last}`)
    }
    expect.soft(complaints).toEqual([])

    const motion = motionBeside(url)
    const varies = (quantity: string) => spread(motion.get(quantity) ?? []) > CONSTANT
    const offered = page.getByTestId('quantity').first().locator('option')
    const first = await offered.and(page.locator(':checked')).innerText()
    const over = await page.getByTestId('over').first().locator('option:checked').innerText()
    expect.soft([first, over], 'the first curve').toEqual(OPENINGS.get(name))
    if ((await offered.allInnerTexts()).some(varies))
      expect.soft(varies(first), `${first}, on which it opens, varies`).toBe(true)
    await page.context().close()
  })

  test.skipIf(!IMAGES)('is shown on the contact sheets', async () => {
    const colours = {
      light: { background: '#ffffff', text: '#1c2126' },
      dark: { background: '#0f1215', text: '#e6e9ec' },
    }
    for (const scheme of SCHEMES) {
      const made = await sheet(desk, pictures[scheme], colours[scheme])
      expect(made.length, 'bytes of a sheet that readers load').toBeLessThan(400_000)
      writeFileSync(join(IMAGES!, `models-${scheme}.webp`), made)
    }
  })

  test.skipIf(!IMAGES)("the strut's page is the README's picture", async () => {
    const { page } = await visit(browser, models.macpherson, { viewport: LARGE, derived: true })
    // Not a moment at which everything is in the design configuration.
    await scrub(page, 120)
    await drawn(page)
    writeFileSync(join(IMAGES!, 'report.png'), await page.screenshot())
  })
})
