/** A picture of vectors as a PNG file, with this number of pixels per pixel of the picture. */
export async function pngOf(picture: Blob, scale: number): Promise<Blob> {
  const image = new Image()
  image.src = URL.createObjectURL(picture)
  try {
    await image.decode()
    const canvas = document.createElement('canvas')
    canvas.width = image.naturalWidth * scale
    canvas.height = image.naturalHeight * scale
    canvas.getContext('2d')!.drawImage(image, 0, 0, canvas.width, canvas.height)
    return await canvasPng(canvas)
  } finally {
    URL.revokeObjectURL(image.src)
  }
}

/** Contents of a canvas, as a file. */
function canvasPng(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) =>
    canvas.toBlob(
      (blob) => (blob ? resolve(blob) : reject(new Error('the picture is too large for this browser'))),
      'image/png',
    ),
  )
}
