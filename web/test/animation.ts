import type { Page } from 'playwright-core'

/** Pictures of a page, one after the other, as an animated WebP: `desk` is a page to draw on. */
export async function animation(desk: Page, pictures: Buffer[], milliseconds: number, width: number): Promise<Buffer> {
  const frames = await desk.evaluate(
    async ({ pictures, width }) => {
      const made: { image: string; width: number; height: number }[] = []
      for (const png of pictures) {
        const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob())
        const height = Math.round((image.height * width) / image.width)
        // Without an alpha channel, the still has one chunk.
        const canvas = new OffscreenCanvas(width, height)
        const context = canvas.getContext('2d', { alpha: false })!
        context.imageSmoothingQuality = 'high'
        context.drawImage(image, 0, 0, width, height)
        const bytes = new Uint8Array(
          await (await canvas.convertToBlob({ type: 'image/webp', quality: 0.8 })).arrayBuffer(),
        )
        made.push({ image: btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join('')), width, height })
      }
      return made
    },
    { pictures: pictures.map((png) => png.toString('base64')), width },
  )
  const { height } = frames[0]
  const size = (n: number) => [n & 255, (n >> 8) & 255, (n >> 16) & 255]
  const chunk = (name: string, data: Buffer) => {
    const head = Buffer.alloc(8)
    head.write(name, 0, 'ascii')
    head.writeUInt32LE(data.length, 4)
    return Buffer.concat([head, data, Buffer.alloc(data.length % 2)])
  }
  const ANIMATED = 2
  const head = chunk('VP8X', Buffer.from([ANIMATED, 0, 0, 0, ...size(width - 1), ...size(height - 1)]))
  const forever = chunk('ANIM', Buffer.from([255, 255, 255, 255, 0, 0]))
  const shown = frames.map(({ image }) => {
    const place = Buffer.from([
      ...size(0),
      ...size(0),
      ...size(width - 1),
      ...size(height - 1),
      ...size(milliseconds),
      0,
    ])
    return chunk('ANMF', Buffer.concat([place, still(Buffer.from(image, 'base64'))]))
  })
  const body = Buffer.concat([Buffer.from('WEBP', 'ascii'), head, forever, ...shown])
  return chunk('RIFF', body)
}

/** The chunk of a still that has its picture. */
function still(file: Buffer): Buffer {
  for (let at = 12; at < file.length; ) {
    const length = file.readUInt32LE(at + 4)
    const end = at + 8 + length + (length % 2)
    if (file.toString('ascii', at, at + 3) === 'VP8' && file.toString('ascii', at, at + 4) !== 'VP8X')
      return file.subarray(at, end)
    at = end
  }
  throw new Error('the browser gave no picture')
}
