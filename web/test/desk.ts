import type { Page } from 'playwright-core'

/** Pixels along each side of a picture of the view where only background and floor may be seen. */
const BORDER = 3
/** Difference of a channel of 255 up to which colours are the same: rounding, and the smoothing of thin lines. */
const ROUNDING = 10

/** Bias of a scheme's greys to blue, of 255. */
const LEAN = 18

/** Greys of a view without a mechanism, from 0 to 255. */
export interface Paper {
  darkest: number
  lightest: number
}

/** Statistics of the drawn pixels of a picture. */
export interface Seen {
  /** Share of its pixels. */
  drawn: number
  /** Pixels of the border, at least one where something is cut off. */
  border: number
  /** Share of the picture's width or height, whichever is larger, that is covered. */
  reach: number
  /** Some points well within the drawing, in pixels. */
  places: { x: number; y: number }[]
}

/** The greys between the background, the lines of the floor, and the shadow on both. */
export function paper(page: Page): Promise<Paper> {
  return page.evaluate(() => {
    const style = getComputedStyle(document.documentElement)
    const channels = (name: string) =>
      [1, 3, 5].map((at) =>
        parseInt(
          style
            .getPropertyValue(name)
            .trim()
            .slice(at, at + 2),
          16,
        ),
      )
    const greys = ['--view', '--grid', '--grid-main'].flatMap(channels)
    const lit = 1 - Number(style.getPropertyValue('--shadow'))
    return { darkest: Math.min(...greys) * lit, lightest: Math.max(...greys) }
  })
}

/** Contents of a PNG; computed in a page, because Node does not decode pictures. */
export function examine(desk: Page, png: Buffer, { darkest, lightest }: Paper): Promise<Seen> {
  return desk.evaluate(
    async ({ data, low, high, spread, band, within, sample }) => {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob())
      const { width, height } = bitmap
      const context = new OffscreenCanvas(width, height).getContext('2d')!
      context.drawImage(bitmap, 0, 0)
      const pixels = context.getImageData(0, 0, width, height).data
      const inked = (x: number, y: number) => {
        const [r, g, b] = pixels.subarray(4 * (y * width + x))
        const [least, most] = [Math.min(r, g, b), Math.max(r, g, b)]
        return least < low || most > high || most - least > spread
      }
      const solid = (x: number, y: number) =>
        within.every((right) => within.every((down) => inked(x + right, y + down)))
      const all: { x: number; y: number }[] = []
      for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) if (inked(x, y)) all.push({ x, y })
      const inner = all.filter(({ x, y }) => x >= band && y >= band && x < width - band && y < height - band)
      const places = inner.filter(({ x, y }) => solid(x, y))
      const range = (values: number[]) =>
        values.reduce((a, b) => Math.max(a, b), 0) - values.reduce((a, b) => Math.min(a, b), Infinity)
      return {
        drawn: all.length / (width * height),
        border: all.length - inner.length,
        reach: Math.max(range(all.map(({ x }) => x)) / width, range(all.map(({ y }) => y)) / height),
        places: places.filter((_, k) => k % Math.ceil(places.length / sample) === 0),
      }
    },
    {
      data: png.toString('base64'),
      low: darkest - ROUNDING,
      high: lightest + ROUNDING,
      spread: LEAN + ROUNDING,
      band: BORDER,
      within: [-2, 0, 2],
      sample: 20,
    },
  )
}

/** Size in pixels of one picture on a contact sheet. */
const TILE = { width: 320, height: 240 }
const COLUMNS = 6
/** Room for a name under each picture. */
const CAPTION = 22
/** Quality of the compression: lines stay clean, and a sheet of thirty pictures stays below 400 kB. */
const QUALITY = 0.82

/** Pictures with their names, side by side, as one WebP. */
export async function sheet(
  desk: Page,
  pictures: [name: string, png: Buffer][],
  colours: { background: string; text: string },
): Promise<Buffer> {
  const data = await desk.evaluate(
    async ({ pictures, tile, columns, caption, quality, colours }) => {
      const canvas = document.createElement('canvas')
      canvas.width = columns * tile.width
      canvas.height = Math.ceil(pictures.length / columns) * (tile.height + caption)
      const context = canvas.getContext('2d')!
      context.fillStyle = colours.background
      context.fillRect(0, 0, canvas.width, canvas.height)
      context.imageSmoothingQuality = 'high'
      context.font = '14px sans-serif'
      context.textAlign = 'center'
      for (const [k, { name, data }] of pictures.entries()) {
        const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob())
        const scale = Math.min(tile.width / bitmap.width, tile.height / bitmap.height)
        const [width, height] = [bitmap.width * scale, bitmap.height * scale]
        const left = (k % columns) * tile.width
        const top = Math.floor(k / columns) * (tile.height + caption)
        context.drawImage(bitmap, left + (tile.width - width) / 2, top + (tile.height - height) / 2, width, height)
        context.fillStyle = colours.text
        context.fillText(name, left + tile.width / 2, top + tile.height + caption - 7)
      }
      return canvas.toDataURL('image/webp', quality)
    },
    {
      pictures: pictures.map(([name, png]) => ({ name, data: png.toString('base64') })),
      tile: TILE,
      columns: COLUMNS,
      caption: CAPTION,
      quality: QUALITY,
      colours,
    },
  )
  return Buffer.from(data.slice(data.indexOf(',') + 1), 'base64')
}
