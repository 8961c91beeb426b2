/** Contents of a canvas, as a file. */
function canvasPng(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) =>
    canvas.toBlob(
      (blob) => (blob ? resolve(blob) : reject(new Error('the picture is too large for this browser'))),
      'image/png',
    ),
  )
}

/** A plot's canvas on the page's colour with its title above: a canvas is clear where nothing is drawn. */
export function plotPng(
  plot: HTMLCanvasElement,
  title: string,
  { page, text }: { page: string; text: string },
): Promise<Blob> {
  const scale = devicePixelRatio
  const head = 26 * scale
  const canvas = document.createElement('canvas')
  canvas.width = plot.width
  canvas.height = plot.height + head
  const brush = canvas.getContext('2d')!
  brush.fillStyle = page
  brush.fillRect(0, 0, canvas.width, canvas.height)
  brush.fillStyle = text
  brush.font = `600 ${14 * scale}px system-ui, sans-serif`
  brush.fillText(title, 12 * scale, 18 * scale, canvas.width - 24 * scale)
  brush.drawImage(plot, 0, head)
  return canvasPng(canvas)
}
