import type { Page } from 'playwright-core'
import { afterAll, afterEach, beforeAll, expect } from 'vitest'
import { launch, visit, type Visit } from './browser'
import { frames } from './person'

type Options = Parameters<typeof visit>[2]

/**
 * Opens pages in a browser of a file of tests, one in each test: after the test nothing may have been complained of,
 * and the page is closed.
 */
export function pages(...browser: Parameters<typeof launch>): (url: string, options?: Options) => Promise<Page> {
  let launched: Awaited<ReturnType<typeof launch>>
  let visited: Visit
  beforeAll(async () => {
    launched = await launch(...browser)
  })
  afterAll(() => launched?.close())
  afterEach(async () => {
    expect(visited.complaints).toEqual([])
    await visited.page.context().close()
  })
  return async (url, options) => {
    visited = await visit(launched, url, options)
    return visited.page
  }
}

/** Waits until the engine of a page solves designs. */
export const ready = (page: Page) =>
  page.waitForFunction(() => document.getElementById('page')!.dataset.engine === 'ready')

/** Waits until text and sensitivities have followed the design. */
export async function settled(page: Page): Promise<void> {
  await frames(page, 3)
  await page.waitForFunction(() => document.getElementById('page')!.dataset.settled === 'yes')
}

/** Does what changes the design, and waits until text and sensitivities have followed it, however soon that is. */
export async function settles(page: Page, act: () => Promise<unknown>): Promise<void> {
  const seen = await page.evaluateHandle(() => {
    const { dataset } = document.getElementById('page')!
    const seen = { change: false }
    const look = () => {
      seen.change ||= dataset.settled === 'no'
    }
    new MutationObserver(look).observe(document.getElementById('page')!, { attributeFilter: ['data-settled'] })
    return seen
  })
  await act()
  await page.waitForFunction((seen) => seen.change && document.getElementById('page')!.dataset.settled === 'yes', seen)
}
