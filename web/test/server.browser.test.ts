import { type ChildProcess, execFileSync, spawn } from 'node:child_process'
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import type { Browser, Page } from 'playwright-core'
import { afterAll, afterEach, beforeAll, beforeEach, expect, inject, test } from 'vitest'
import { launch, NO_3D, visit } from './browser'
import { WAIT } from './limits'
import { frames } from './person'

const { hardpoint, models } = inject('samples')
const MODELS = join(import.meta.dirname, '../../models')
const STUDIES = join(MODELS, 'studies')
const TOKEN = 'a-token-of-this-test'

let browser: Browser
/** Without a view, for tests that do not look at it. */
let flat: Browser
let folder: string
let file: string
let text: string
let server: ChildProcess | undefined

/** Starts the studio; the address that it prints. */
function start(port = 0, name = 'strut.toml'): Promise<string> {
  const options = ['--no-browser', '--token', TOKEN, '--port', String(port)]
  const child = spawn(hardpoint, ['studio', name, ...options], {
    cwd: folder,
    stdio: ['ignore', 'pipe', 'inherit'],
  })
  server = child
  return new Promise((resolve) => child.stdout.once('data', (line) => resolve(String(line).trim())))
}

function stop(): Promise<void> {
  const child = server
  server = undefined
  return new Promise((resolve) => (child ? (child.once('exit', () => resolve()), child.kill('SIGKILL')) : resolve()))
}

/** The page at an address, and its errors other than unanswered requests. */
async function open(address: string, isModel = true, within = flat): Promise<Page> {
  const page = await within.newPage({ viewport: { width: 1400, height: 900 } })
  page.setDefaultTimeout(WAIT)
  page.on('pageerror', (error) => faults.push(error.message))
  page.on(
    'request',
    (request) =>
      new URL(request.url()).hostname === '127.0.0.1' ||
      /^(data|blob):/.test(request.url()) ||
      faults.push(request.url()),
  )
  await page.goto(address)
  if (isModel) await page.waitForFunction(() => performance.getEntriesByName('ready').length > 0)
  return page
}
const faults: string[] = []

beforeAll(async () => {
  ;[browser, flat] = await Promise.all([launch(), launch(NO_3D)])
})
afterAll(() => Promise.all([browser?.close(), flat?.close()]))
beforeEach(() => {
  folder = mkdtempSync(join(tmpdir(), 'hardpoint-studio-'))
  file = join(folder, 'strut.toml')
  copyFileSync(join(STUDIES, 'strut_toe.toml'), file)
  text = readFileSync(file, 'utf8')
  faults.length = 0
})
afterEach(async () => {
  const contexts = [browser, flat].flatMap((one) => one.contexts())
  await Promise.all(contexts.map((context) => context.close()))
  await stop()
  rmSync(folder, { recursive: true })
  expect(faults).toEqual([])
})

test('a page from a file has nothing that only a server can do', async () => {
  const { page, complaints } = await visit(flat, models.macpherson)
  expect(await page.getByTestId('server').count()).toBe(0)
  expect(complaints).toEqual([])
})

test('the token is not in the address, and the page knows its model and its cases', async () => {
  const page = await open(await start())
  expect(page.url()).not.toContain('token')
  expect(await page.getByTestId('save').isDisabled()).toBe(true)
  await page.getByTestId('case').selectOption('steer')
  await page.waitForFunction(() => document.querySelector('[data-testid=title]')!.textContent!.includes('steer'))
})

test('a result of this machine is applied and saved in place, and is no news to the page', async () => {
  const page = await open(await start())
  await page.getByTestId('server-menu').click()
  await page.getByTestId('study-optimize').click()
  await page.getByRole('button', { name: 'Apply design' }).click()
  await page.keyboard.press('Control+s')
  await page.getByText('Saved').waitFor()
  const saved = readFileSync(file, 'utf8')
  expect(saved).not.toBe(text)
  expect(saved.length).toBeGreaterThan(0.9 * text.length)
  expect(await page.getByTestId('save').isDisabled()).toBe(true)
  expect(await page.getByTestId('note-changed').count()).toBe(0)
})

test('a file that changed on disk is reported: mine is kept and saved over it, or theirs is loaded', async () => {
  const page = await open(await start())
  const theirs = `${text}# theirs\n`
  writeFileSync(file, theirs)
  await page.getByRole('button', { name: 'Keep mine' }).click()
  await page.locator('[data-testid=save]:enabled').click()
  await page.getByText('Saved').waitFor()
  expect(readFileSync(file, 'utf8')).toBe(text)

  writeFileSync(file, theirs.replace('MacPherson', 'Other'))
  await page.getByRole('button', { name: 'Reload' }).click()
  await page.waitForFunction(() => document.querySelector('[data-testid=title]')?.textContent?.includes('Other'))
})

test('a server that was killed is missed, and found again when it is back', async () => {
  const address = await start()
  const page = await open(address)
  await stop()
  const note = page.getByTestId('note-server')
  await note.waitFor()
  expect(await note.innerText()).toContain('Your changes are kept in the page')
  expect(await note.innerText()).toContain(`--token ${TOKEN}`)
  await start(Number(new URL(address).port))
  await note.waitFor({ state: 'detached' })
  writeFileSync(file, `${text}# theirs\n`)
  await page.getByTestId('note-changed').waitFor()
})

test('a kept design is written to the file, with comments and layout, and the nominal design stays', async () => {
  text = `# Measured on the bench.\n${text}`
  writeFileSync(file, text)
  const page = await open(await start())
  await page.waitForFunction(() => document.getElementById('page')!.dataset.engine === 'ready')
  await page.getByTestId('tab-variables').click()
  const row = page.locator('[data-testid^=variable-]:has([data-testid=change-value])').first()
  const name = (await row.getAttribute('data-testid'))!.slice('variable-'.length)
  await row.getByTestId('change-value').fill('3.5')
  await row.getByTestId('change-value').press('Enter')
  await page.getByTestId('designs').click()
  await page.getByTestId('snapshot-name').fill('stiff')
  await page.getByTestId('snapshot-keep').click()
  await page.getByTestId('snapshot-write').click()
  await page.getByText('is in the text of the model').waitFor()
  await page.getByText('Saved').waitFor()
  const block = `[designs.stiff]\n${name} = 3.5\n`
  expect(readFileSync(file, 'utf8')).toBe(`${text.trimEnd()}\n\n${block}`)
  // The present design is not saved, and the design of the file is listed in place of the kept one.
  expect(await page.getByTestId('save').isDisabled()).toBe(false)
  expect(await page.getByTestId('snapshot-rename').count()).toBe(1)
  expect(await page.getByTestId('snapshot-write').count()).toBe(0)
  // The command reads it back.
  const compared = execFileSync(hardpoint, ['whatif', file, '--design', 'stiff'], { encoding: 'utf8' })
  expect(compared).toContain(name)
})

test('a change that the text cannot have is not saved, and the page says why until it is undone', async () => {
  const tilt = '[design]\nlca_tilt = { tilt = "lca_pivot", about = "y", bounds = [-2, 2] }\n'
  text = text.replace('[design]\n', tilt)
  writeFileSync(file, text)
  const page = await open(await start())
  await page.waitForFunction(() => document.getElementById('page')!.dataset.engine === 'ready')
  await page.getByTestId('tab-variables').click()
  const field = page.getByTestId('variable-lca_tilt').getByTestId('change-value')
  await field.fill('1')
  await field.press('Enter')
  await page.locator('[data-testid=save]:enabled').waitFor()
  const note = page.getByTestId('note-unwritten')
  for (const save of [() => page.keyboard.press('Control+s'), () => page.getByTestId('save').click()]) {
    await save()
    await note.waitFor()
    expect(await note.innerText()).toContain('Not saved: the change of lca_tilt cannot be saved')
  }
  await page.getByTestId('server-menu').click()
  await page.getByTestId('study-optimize').click()
  const failure = page.getByTestId('server').locator('.failure')
  await expect.poll(() => failure.innerText()).toContain('the change of `lca_tilt` cannot be saved')
  await page.getByTestId('undo').click()
  await note.waitFor({ state: 'detached' })
  await expect.poll(() => failure.isVisible()).toBe(false)
  await expect.poll(() => page.getByTestId('save').isDisabled()).toBe(true)
  expect(readFileSync(file, 'utf8')).toBe(text)
})

test('a text with errors is saved after a second confirmation only, and as it is visible', async () => {
  const page = await open(await start())
  await page.waitForFunction(() => document.getElementById('page')!.dataset.engine === 'ready')
  await page.getByTestId('open-model').click()
  await page.getByTestId('model-text').click()
  const type = async (line: string) => {
    await page.keyboard.press('Control+Home')
    await page.keyboard.type(`${line}\n`)
    await page.locator('[data-testid=model-pane][aria-busy=false]').waitFor()
  }
  const asked: string[] = []
  page.on('dialog', (dialog) => {
    asked.push(dialog.type())
    void dialog.dismiss()
  })
  await type('nonsense = 1')
  expect(await page.getByTestId('model-status').innerText()).toContain('The page shows the last valid model.')
  const note = page.getByTestId('note-saving')
  for (const save of [() => page.keyboard.press('Control+s'), () => page.getByTestId('save').click()]) {
    await save()
    await expect.poll(() => note.innerText()).toContain('Not saved: the text is not a valid model.')
    expect(readFileSync(file, 'utf8')).toBe(text)
  }
  await page.evaluate(() => setTimeout(() => location.reload()))
  await expect.poll(() => asked).toEqual(['beforeunload'])
  // What is typed after the question is saved as well.
  await page.getByTestId('model-text').focus()
  await type('# unfinished')
  await page.getByRole('button', { name: 'Save anyway' }).click()
  await page.getByText('Saved').waitFor()
  expect(readFileSync(file, 'utf8')).toBe(`# unfinished\nnonsense = 1\n${text}`)
  await expect.poll(() => page.getByTestId('save').isDisabled()).toBe(true)
})

test('points that are clicked on the picture become a task, whose answers are listed with their pages', async () => {
  copyFileSync(join(MODELS, 'jansen.toml'), join(folder, 'jansen.toml'))
  const page = await open(await start(0, 'jansen.toml'), true, browser)
  await page.waitForFunction(() => document.getElementById('page')!.dataset.engine === 'ready')
  await page.getByTestId('path-points').click()
  expect(await page.getByTestId('path-run').isDisabled()).toBe(true)
  // The pane takes room of the view, which has its new size in the next frame.
  await frames(page, 3)
  const box = (await page.getByTestId('path-overlay').boundingBox())!
  const places = [
    [0.3, 0.5],
    [0.4, 0.35],
    [0.55, 0.35],
    [0.6, 0.6],
  ].map(([x, y]) => [box.x + x * box.width, box.y + y * box.height])
  for (const [x, y] of places) await page.mouse.click(x, y)
  expect(await page.locator('.path-handle').count()).toBe(4)
  // A handle follows the hand.
  const handle = async () => (await page.getByTestId('path-3').boundingBox())!
  const before = await handle()
  await page.mouse.move(before.x + 9, before.y + 9)
  await page.mouse.down()
  await page.mouse.move(before.x + 9, before.y - 21, { steps: 4 })
  await page.mouse.up()
  expect(Math.abs((await handle()).y - (before.y - 30))).toBeLessThan(2)
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByTestId('path-file').click()])
  const task = join(folder, 'path.toml')
  await download.saveAs(task)
  await page.getByTestId('path-run').click()
  const links = page.locator('[data-testid^=note-study] a')
  await links.first().waitFor()
  // The command finds the same linkages for the file.
  const facts = JSON.parse(execFileSync(hardpoint, ['synthesize', task, '--json'], { encoding: 'utf8' }))
  expect(await links.allInnerTexts()).toEqual(
    facts.answers.map(({ rank, kind }: { rank: number; kind: string }) => `Report: ${rank}: ${kind}`),
  )
  const [answer] = await Promise.all([page.waitForEvent('popup'), links.first().click()])
  await answer.waitForFunction(() => document.querySelector('[data-testid=title]')?.textContent?.includes('path 1'))
})

test('the gallery has drawings, and a new linkage is drawn, saved under a free name and opened again', async () => {
  copyFileSync(join(MODELS, 'jansen.toml'), join(folder, 'jansen.toml'))
  const page = await open(await start(0, '.'), false)
  const jansen = page.locator('.model', { hasText: 'jansen.toml' })
  await jansen.locator('svg').waitFor()
  expect(await jansen.locator('polyline').count()).toBeGreaterThan(0)
  await page.getByTestId('new-linkage').click()
  const sheet = page.getByTestId('linkage-sheet')
  await sheet.waitFor()
  // Nothing is on disk yet.
  expect(existsSync(join(folder, 'linkage.toml'))).toBe(false)
  for (const [x, y] of [
    [0.3, 0.8],
    [0.36, 0.62],
    [0.7, 0.75],
  ]) {
    const { width, height } = (await sheet.boundingBox())!
    await sheet.click({ position: { x: x * width, y: y * height } })
  }
  await page.keyboard.press('Escape')
  for (const [tool, pin] of [
    ['ground', 'A'],
    ['slider', 'C'],
    ['motor', 'A'],
  ]) {
    await page.getByTestId(`linkage-${tool}`).click()
    await page.getByTestId(`linkage-pin-${pin}`).click()
  }
  await page.locator('[data-testid=linkage-show]:enabled').click()
  await sheet.waitFor({ state: 'hidden' })
  await page.locator('[data-testid=save]:enabled').click()
  await page.getByTestId('note-saving').waitFor()
  expect(new URL(page.url()).search).toBe('?file=linkage.toml')
  const saved = readFileSync(join(folder, 'linkage.toml'), 'utf8')
  expect(saved).toContain('C_slider = ["C"]')
  execFileSync(hardpoint, ['check', join(folder, 'linkage.toml')])
  // Its page is that of the file; another linkage is drawn on a page of its own.
  await page.reload()
  await page.waitForFunction(() => document.getElementById('page')!.dataset.engine === 'ready')
  expect(await sheet.count()).toBe(0)
  await page.getByTestId('draw-linkage').click()
  await page.waitForURL(/\/new$/)
  await sheet.waitFor()
})
