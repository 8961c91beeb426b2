import type { Page } from 'playwright-core'

/** Pixels along each side of a picture of the view where only background and floor may be seen. */
const BORDER = 3
/** How much a channel of 255 may differ and still be the same colour: rounding, and the smoothing of thin lines. */
const ROUNDING = 10

/** How much the greys of a scheme lean to blue, of 255. */
const LEAN = 18

/** Greys of a view without a mechanism, from 0 to 255. */
export interface Paper {
  darkest: number
  lightest: number
}

/** What a picture shows beside paper. */
export interface Seen {
  /** Share of its pixels. */
  drawn: number
  /** Pixels of the border, at least one where something is cut off. */
  border: number
  /** Share of the picture's width or height, whichever is larger, that is covered. */
  reach: number
}

/** The greys between the background, the lines of the floor, and the shadow on both. */
export function paper(page: Page): Promise<Paper> {
  return page.evaluate(() => {
    const style = getComputedStyle(document.documentElement)
    const channels = (name: string) => [1, 3, 5].map((at) => parseInt(style.getPropertyValue(name).trim().slice(at, at + 2), 16))
    const greys = ['--view', '--grid', '--grid-main'].flatMap(channels)
    const lit = 1 - Number(style.getPropertyValue('--shadow'))
    return { darkest: Math.min(...greys) * lit, lightest: Math.max(...greys) }
  })
}

/** What is to be seen in a PNG; worked out in a page, because Node does not decode pictures. */
export function examine(desk: Page, png: Buffer, { darkest, lightest }: Paper): Promise<Seen> {
  return desk.evaluate(
    async ({ data, low, high, spread, border }) => {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob())
      const { width, height } = bitmap
      const context = new OffscreenCanvas(width, height).getContext('2d')!
      context.drawImage(bitmap, 0, 0)
      const { data: pixels } = context.getImageData(0, 0, width, height)
      const seen = { drawn: 0, border: 0, left: width, right: 0, top: height, bottom: 0 }
      for (let y = 0; y < height; y++) {
        for (let x = 0; x < width; x++) {
          const [r, g, b] = pixels.subarray(4 * (y * width + x))
          const [least, most] = [Math.min(r, g, b), Math.max(r, g, b)]
          if (least >= low && most <= high && most - least <= spread) continue
          seen.drawn++
          if (x < border || y < border || x >= width - border || y >= height - border) seen.border++
          seen.left = Math.min(seen.left, x)
          seen.right = Math.max(seen.right, x)
          seen.top = Math.min(seen.top, y)
          seen.bottom = Math.max(seen.bottom, y)
        }
      }
      const reach = Math.max((seen.right - seen.left) / width, (seen.bottom - seen.top) / height)
      return { drawn: seen.drawn / (width * height), border: seen.border, reach }
    },
    { data: png.toString('base64'), low: darkest - ROUNDING, high: lightest + ROUNDING, spread: LEAN + ROUNDING, border: BORDER },
  )
}

/** Some places of a PNG where the mechanism is, each well within something drawn. */
export function places(desk: Page, png: Buffer, { darkest, lightest }: Paper): Promise<{ x: number; y: number }[]> {
  return desk.evaluate(
    async ({ data, low, high, spread }) => {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob())
      const { width, height } = bitmap
      const context = new OffscreenCanvas(width, height).getContext('2d')!
      context.drawImage(bitmap, 0, 0)
      const { data: pixels } = context.getImageData(0, 0, width, height)
      const inked = (x: number, y: number) => {
        const [r, g, b] = pixels.subarray(4 * (y * width + x))
        const [least, most] = [Math.min(r, g, b), Math.max(r, g, b)]
        return least < low || most > high || most - least > spread
      }
      const found: { x: number; y: number }[] = []
      for (let y = 4; y < height - 4; y++)
        for (let x = 4; x < width - 4; x++)
          if ([-2, 0, 2].every((right) => [-2, 0, 2].every((down) => inked(x + right, y + down)))) found.push({ x, y })
      const count = 20
      return found.filter((_, k) => k % Math.ceil(found.length / count) === 0)
    },
    { data: png.toString('base64'), low: darkest - ROUNDING, high: lightest + ROUNDING, spread: LEAN + ROUNDING },
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
export async function sheet(desk: Page, pictures: [name: string, png: Buffer][], colours: { background: string; text: string }): Promise<Buffer> {
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
