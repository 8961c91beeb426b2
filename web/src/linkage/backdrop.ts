import './linkage.css'
import { el, prose } from '../dom'
import { NumberField } from '../page/number_field'
import { type Alignment, calibrated, fitted, type PictureMap, pixelOf, placeOf } from './backdrop_map'
import { length, type Place } from './linkage'

/** A picture behind a plane, in the unit of length; it is kept in memory only. */
export interface Picture {
  image?: HTMLImageElement
  map?: PictureMap
  opacity?: number
}

/** The plane that a picture is shown behind. */
export interface Surface {
  /** Takes the picture, and files that are dropped on it. */
  element: HTMLElement
  unit: string
  /** Point of the element where a place is seen, px. */
  project(place: Place): { x: number; y: number }
  /** Middle and size of what is seen. */
  seen(): { middle: Place; size: Place }
  /** Shows all of the picture, where that is possible. */
  fit?(corners: Place[]): void
}

/** Opacity of a new picture. */
const OPACITY = 0.6

/** A picture for drawing over, with its controls: opacity, and its scale by two clicks and their real distance. */
export class Backdrop {
  readonly tools = el('fieldset', { class: 'backdrop-tools', 'data-testid': 'backdrop-tools' })
  #clicks?: Place[]
  #marks = [0, 1].map(() => el('span', { class: 'backdrop-mark', hidden: true }))
  #distance?: number
  #alignment: Alignment = { isOrigin: false, isHorizontal: false }
  #words = el('output', { 'data-testid': 'backdrop-status' })
  #loaded: HTMLElement
  #calibration: HTMLElement

  constructor(
    private readonly surface: Surface,
    private readonly picture: Picture,
  ) {
    const choose = el('input', {
      type: 'file',
      accept: 'image/*',
      hidden: true,
      'data-testid': 'backdrop-file',
      onchange: () => void this.#load(choose.files?.[0]),
    })
    const button = (name: string, testId: string, run: () => void) =>
      el('button', { type: 'button', 'data-testid': testId, onclick: run }, name)
    const box = (name: string, key: keyof Alignment) => {
      const input = el('input', { type: 'checkbox', onchange: () => (this.#alignment[key] = input.checked) })
      return el('label', {}, input, ' ', name)
    }
    const opacity = el('input', {
      type: 'range',
      min: 0.1,
      max: 1,
      step: 0.05,
      value: picture.opacity ?? OPACITY,
      'aria-label': 'opacity of the picture',
      oninput: () => {
        picture.opacity = opacity.valueAsNumber
        this.follow()
      },
    })
    const distance = new NumberField({
      label: 'distance of the two points',
      testId: 'backdrop-distance',
      unit: surface.unit,
      step: 1,
      plus: 'adds',
      apply: (value) => ((this.#distance = value), undefined),
    })
    this.#calibration = el(
      'span',
      { hidden: true },
      el('label', {}, 'distance ', distance.input, ` ${surface.unit}`),
      box('first point is the origin', 'isOrigin'),
      box('second to its right', 'isHorizontal'),
      button('Apply', 'backdrop-apply', () => this.#apply()),
      button('Cancel', 'backdrop-cancel', () => this.#end('')),
    )
    this.#loaded = el(
      'span',
      {},
      el('label', {}, 'opacity ', opacity),
      button('Set scale…', 'backdrop-scale', () => this.#begin()),
      button('Remove', 'backdrop-remove', () => this.#remove()),
    )
    this.tools.append(
      el('legend', {}, 'Picture'),
      choose,
      button('Choose a file…', 'backdrop-choose', () => choose.click()),
      this.#loaded,
      this.#calibration,
      this.#words,
    )
    const { element } = surface
    element.append(...this.#marks)
    element.addEventListener('dragover', (event) => event.preventDefault())
    element.addEventListener('drop', (event) => {
      event.preventDefault()
      event.stopPropagation()
      void this.#load(event.dataTransfer?.files[0])
    })
    this.follow()
  }

  /** True while it takes the clicks. */
  get isCalibrating(): boolean {
    return this.#clicks !== undefined
  }

  /** Takes a click for the scale; false if none is wanted. */
  click(place: Place): boolean {
    if (!this.#clicks) return false
    // A third click begins anew.
    this.#clicks = this.#clicks.length > 1 ? [place] : [...this.#clicks, place]
    this.#say(this.#clicks.length > 1 ? 'Enter their real distance, then Apply.' : 'Click the second point.')
    this.follow()
    return true
  }

  /** Puts the picture where its plane is seen. */
  follow(): void {
    const { image, map, opacity = OPACITY } = this.picture
    if (image && image.parentElement !== this.surface.element) this.surface.element.prepend(image)
    this.#loaded.hidden = !image
    this.#calibration.hidden = !this.#clicks
    this.#marks.forEach((mark, k) => {
      const place = this.#clicks?.[k]
      mark.hidden = !place
      if (!place) return
      const { x, y } = this.surface.project(place)
      mark.style.transform = `translate(${x}px, ${y}px)`
    })
    if (!image || !map) return
    const [width, height] = [image.naturalWidth, image.naturalHeight]
    const [o, right, down] = [[0, 0] as Place, [width, 0] as Place, [0, height] as Place].map((pixel) =>
      this.surface.project(placeOf(map, pixel)),
    )
    const across = [(right.x - o.x) / width, (right.y - o.y) / width]
    const along = [(down.x - o.x) / height, (down.y - o.y) / height]
    image.style.opacity = String(opacity)
    image.style.transform = `matrix(${[...across, ...along, o.x, o.y].join(', ')})`
  }

  async #load(file: File | undefined): Promise<void> {
    if (!file) return
    const image = el('img', { class: 'backdrop', alt: '', draggable: 'false', 'data-testid': 'backdrop' })
    image.src = URL.createObjectURL(file)
    try {
      await image.decode()
    } catch {
      URL.revokeObjectURL(image.src)
      return this.#say(
        `\`${file.name}\` is not a picture that this browser reads. Choose a PNG, JPEG, SVG or WebP file.`,
      )
    }
    if (!(image.naturalWidth > 0 && image.naturalHeight > 0))
      return this.#say(`\`${file.name}\` has no size in pixels.`)
    this.#remove()
    const { middle, size } = this.surface.seen()
    const map = fitted([image.naturalWidth, image.naturalHeight], middle, size)
    Object.assign(this.picture, { image, map })
    this.#say('Set its scale by two points of known distance.')
    this.follow()
  }

  #remove(): void {
    const { image } = this.picture
    if (image) URL.revokeObjectURL(image.src)
    image?.remove()
    this.picture.image = this.picture.map = undefined
    this.#end('')
  }

  #begin(): void {
    this.#clicks = []
    this.#say('Click the first of two points whose distance you know.')
    this.follow()
  }

  #end(words: string): void {
    this.#clicks = undefined
    this.#say(words)
    this.follow()
  }

  #apply(): void {
    const { image, map } = this.picture
    const [first, second] = this.#clicks ?? []
    if (!image || !map) return
    if (!first || !second) return this.#say('Click two points of the picture first.')
    if (this.#distance === undefined) return this.#say('Enter the real distance of the two points.')
    const made = calibrated(map, [first, second], this.#distance, this.#alignment)
    if (typeof made === 'string') return this.#say(made)
    // A corner of the picture in pixels that is not finite would put it nowhere.
    const corner = placeOf(made, [image.naturalWidth, image.naturalHeight])
    if (!corner.every(Number.isFinite)) return this.#say('This distance is too large.')
    this.picture.map = made
    const [a, b] = [pixelOf(map, first), pixelOf(map, second)].map((pixel) => placeOf(made, pixel))
    const corners = (
      [
        [0, 0],
        [image.naturalWidth, 0],
        [0, image.naturalHeight],
      ] as Place[]
    ).map((one) => placeOf(made, one))
    this.surface.fit?.([...corners, corner])
    this.#end(`The scale is set: ${Number(length(a, b).toPrecision(6))} ${this.surface.unit} between the points.`)
  }

  #say(words: string): void {
    this.#words.replaceChildren(...prose(words))
  }
}
