import { PCFShadowMap, type Ray, Raycaster, Scene, Vector2, Vector3 } from 'three'
import { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import { valueAt } from '../curve'
import { el, onSchemeChange, setText } from '../dom'
import { motionGltf } from '../export/gltf'
import { viewSvg } from '../export/view_svg'
import { number } from '../format'
import type { State } from '../state'
import { Assembly } from './assembly'
import {
  axisLooksOf,
  type Camera,
  cameraFor,
  fit,
  type Insets,
  type Look,
  looksOf,
  pixelsPerLength,
  shapeTo,
  STRAIGHT,
} from './camera'
import { marks, matter } from './draw'
import { changeText, shownChange } from './draw/design_velocity'
import { forceText } from './draw/load'
import { type Part, samePart } from './drawable'
import { Floor } from './floor'
import { Graphics } from './graphics'
import { clearanceLabels, distanceLabels, hardpointLabels, LabelLayer, partLabels } from './label_layer'
import { Mechanism } from './mechanism'
import { MotionDrag } from './motion_drag'
import { type Emphasis, Outlines, OVER } from './outlines'
import { Overview } from './overview'
import { paletteOf } from './palette'
import { Pointer } from './pointer'
import { present } from './shape'
import { isSoftware, whileDragged } from './spare'
import { Stock } from './stock'
import { Triad } from './triad'

/** Room round every place that the motion visits, in units. */
const ROOM = 2
/** Numbers of marks start here, far above those of matter. */
const MARK_NUMBERS = 1 << 15

/** Position of the camera, to be taken again. */
export interface Pose {
  look: string
  position?: number[]
  target?: number[]
  zoom?: number
}

export function hasWebGL(): boolean {
  const context = document.createElement('canvas').getContext('webgl2')
  // Browsers limit the number of contexts.
  context?.getExtension('WEBGL_lose_context')?.loseContext()
  return context !== null
}

/** The mechanism in 3D. Draws only when something changed, so that an idle page costs nothing. */
export class View {
  readonly element: HTMLElement
  readonly canvas: HTMLCanvasElement
  /** The standard views offered; the first is that of the start. */
  readonly looks: readonly Look[]
  /** These, and the views along the axes. */
  readonly #all: readonly Look[]
  readonly scene = new Scene()
  /** Camera of the present view: of perspective, or of parallel projection. */
  camera: Camera
  /** The design as loaded. */
  readonly original: Mechanism
  readonly #renderer
  #outlines = new Outlines()
  #controls: OrbitControls
  #pointer: Pointer
  #triad: Triad
  #labels = new LabelLayer()
  #paper = el('canvas', { class: 'paper' })
  #grid = el('span')
  #arrows = el('span', { 'data-testid': 'arrows' })
  #caption = el('span', { class: 'scale' }, this.#arrows, this.#grid)
  #lost = el(
    'p',
    { class: 'message', hidden: true },
    'The graphics context was lost. The view returns when the browser restores it.',
  )
  #palette = paletteOf()
  /** Geometries and materials that designs drawn one after another have in common. */
  readonly #stock = new Stock()
  #matter: Assembly
  #marks: Assembly
  #floor: Floor
  #overview?: Overview
  /** Key of the drawn design. */
  #drawn: string
  #look: Look
  #cameras: Camera[]
  /** The look whose direction the camera has. */
  #seen?: Look
  #onLook: ((look: Look | undefined) => void)[] = []
  /** True if the reader turned or moved the view since it was fitted. */
  #turned = false
  #buttons?: HTMLElement
  /** True while something is dragged and the processor draws: once, without outlines and shadows, in fewer pixels. */
  #isLight = false
  /** Position to take as soon as the view has a size. */
  #wanted?: Pose
  #stale = false
  #moved = true
  #pending = false
  /** Size of the element, px, from its observer; reading it from the element would force a layout in a frame. */
  #extent = { width: 0, height: 0 }
  #onDrawn: (() => void)[] = []

  /** `graphics` is that of a view that has ended. */
  constructor(
    private readonly state: State,
    private readonly graphics = new Graphics(),
  ) {
    this.#renderer = graphics.renderer
    this.original = new Mechanism(state.report)
    this.looks = looksOf(this.original)
    const along = axisLooksOf(this.original, this.looks)
    this.#all = [...this.looks, ...along.map(({ look }) => look)]
    this.#triad = new Triad(this.original.vehicle, along, ({ name }) => this.look(name))
    this.#look = this.looks[0]
    this.#cameras = [false, true].map((parallel) => cameraFor(this.original, parallel))
    this.camera = this.#cameras[Number(this.#look.parallel)]
    this.canvas = this.#renderer.domElement
    this.canvas.setAttribute('data-testid', 'view-canvas')
    this.canvas.setAttribute('role', 'img')
    this.canvas.setAttribute('aria-label', `3D view of ${state.report.title}`)
    this.#renderer.autoClear = false
    this.#renderer.shadowMap.enabled = this.original.plane === undefined
    this.#renderer.shadowMap.type = PCFShadowMap
    this.#renderer.shadowMap.autoUpdate = false
    this.#controls = new OrbitControls(this.camera, this.canvas)
    // A click alone leaves the view as it is.
    let isHeld = false
    this.#controls.addEventListener('start', () => (isHeld = true))
    this.#controls.addEventListener('end', () => (isHeld = false))
    this.#controls.addEventListener('change', () => {
      this.#turned ||= isHeld
      this.#draw()
      this.#reportLook()
    })
    this.#pointer = new Pointer(
      this.canvas,
      () => this.camera,
      () => [...this.#marks.groups, ...this.#matter.groups],
      () => (this.#emphasise(), this.#draw()),
      (selected) => state.choose({ selected }),
      state.ended,
    )
    new MotionDrag(this.canvas, this.#controls, state, {
      find: (x, y) => this.#pointer.hit(x, y),
      mechanism: () => this.mechanism,
      project: (place) => this.project(place),
    })
    this.element = el(
      'div',
      { class: 'view' },
      this.canvas,
      this.#labels.element,
      this.#paper,
      this.#lost,
      this.#pointer.tip,
      this.#caption,
    )
    this.element.append(this.#triad.element)
    this.#overview = Overview.of(this.original, this.#look, (place) => this.#visit(place))
    if (this.#overview) this.element.append(this.#overview.element)

    this.#drawn = state.edition
    this.#matter = this.#assembleMatter()
    this.#marks = this.#assembleMarks()
    this.#floor = this.#lay()
    this.#emphasise()
    this.#draw()
    state.onTime(() => this.#move())
    const remark = () => {
      this.#stale = true
      this.#draw()
    }
    state.onChoice(remark)
    state.onPoint(remark)
    onSchemeChange(() => this.#repaint(), state.ended)
    addEventListener('beforeprint', () => this.#still(), { signal: state.ended })
    if (isSoftware(this.#renderer.getContext()))
      whileDragged(this.element, (isDragged) => this.#lighten(isDragged), state.ended)
    new ResizeObserver(([{ contentRect }]) => {
      this.#extent = { width: Math.round(contentRect.width), height: Math.round(contentRect.height) }
      this.#resize()
    }).observe(this.element)
    const signal = state.ended
    this.canvas.addEventListener('webglcontextlost', () => (this.#lost.hidden = false), { signal })
    this.canvas.addEventListener(
      'webglcontextrestored',
      () => {
        this.#lost.hidden = true
        this.#move()
      },
      { signal },
    )
  }

  /** The design drawn solid; its `former` is the one drawn dashed. */
  get mechanism(): Mechanism {
    return this.#matter.mechanism
  }

  /** Objects of the mechanism itself, in groups that move with the bodies. */
  get assembly(): Assembly {
    return this.#matter
  }

  /** Called after each picture, when places on the screen may be others. */
  onDrawn(listener: () => void): void {
    this.#onDrawn.push(listener)
  }

  /** Position on the screen of a point of the world, px from the corner of the view. */
  project(place: Vector3): { x: number; y: number; seen: boolean } {
    const { width, height } = this.#extent
    const { x, y, z } = place.clone().project(this.camera)
    return {
      x: ((x + 1) * width) / 2,
      y: ((1 - y) * height) / 2,
      seen: Math.abs(z) <= 1 && Math.abs(x) <= 1 && Math.abs(y) <= 1,
    }
  }

  /** Puts an element where a point of the world is seen, and hides it where it is not. */
  put(element: HTMLElement, place: Vector3): void {
    const { x, y, seen } = this.project(place)
    element.hidden = !seen || !Number.isFinite(x + y)
    element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`
  }

  /** The line of sight through a point of the screen, px from the corner of the view. */
  sight(x: number, y: number): Ray {
    const { width, height } = this.#extent
    const ray = new Raycaster()
    ray.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.camera)
    return ray.ray
  }

  /** Ends the view before the page is rebuilt; the next view draws with what is returned. */
  end(): Graphics {
    this.#controls.dispose()
    this.graphics.free(this.#matter, this.#marks, this.#floor, this.#outlines)
    return this.graphics
  }

  /** Position of the camera, if the reader turned or moved it; and the standard view. */
  get pose(): Pose {
    const free = { position: this.camera.position.toArray(), target: this.#controls.target.toArray() }
    return { look: this.#look.name, ...(this.#turned && { ...free, zoom: this.camera.zoom }) }
  }

  /** Takes the position of another view of the same mechanism. */
  restore(pose: Pose): void {
    const { look, position, target, zoom } = pose
    this.#look = this.#named(look)
    this.#takeCamera()
    // Without a size there is nothing to fit into yet.
    this.#wanted = this.#extent.width === 0 ? pose : undefined
    if (this.#wanted) return
    this.fit()
    if (!position || !target) return
    this.camera.position.fromArray(position)
    this.#controls.target.fromArray(target)
    this.camera.zoom = zoom ?? 1
    this.camera.updateProjectionMatrix()
    this.#turned = true
    this.#controls.update()
    this.#draw()
  }

  #named(name: string): Look {
    return this.#all.find((look) => look.name === name) ?? this.looks[0]
  }

  /** Shows a standard view, or one along an axis, by its name. */
  look(name: string): void {
    this.#look = this.#named(name)
    this.#takeCamera()
    this.fit()
    this.#reportLook()
  }

  /** Takes the camera of the present view. */
  #takeCamera(): void {
    this.camera = this.#cameras[Number(this.#look.parallel)]
    this.#controls.object = this.camera
  }

  /** Calls back with the standard view that the camera has, or none after it was turned. */
  onLook(listener: (look: Look | undefined) => void): void {
    this.#onLook.push(listener)
  }

  #reportLook(): void {
    const eye = this.camera.position.clone().sub(this.#controls.target).normalize()
    const { direction, parallel } = this.#look
    const same = eye.dot(direction) > 1 - STRAIGHT && this.camera === this.#cameras[Number(parallel)]
    const seen = same ? this.#look : undefined
    if (seen === this.#seen) return
    this.#seen = seen
    for (const listener of this.#onLook) listener(seen)
  }

  /**
   * Fits the whole motion into the picture, seen from the standard view of the moment or from where the reader turned
   * it.
   */
  fit(): void {
    const { width, height } = this.#extent
    if (width === 0 || height === 0) return
    this.#update()
    this.#frame(width, height)
    // Unit and scale of the picture depend on each other.
    if (this.#rescale(height)) this.#frame(width, height)
    this.#turned = false
    this.#draw()
  }

  /** Buttons over the top of the view, below which the mechanism is fitted; they may wrap into several rows. */
  set buttons(element: HTMLElement) {
    this.#buttons = element
    new ResizeObserver(() => this.#turned || this.fit()).observe(element)
  }

  #frame(width: number, height: number): void {
    const room = ROOM * this.original.unit
    const padded = [0, 1, 2].flatMap((k) => [-room, room].map((by) => new Vector3().setComponent(k, by)))
    const swept =
      this.mechanism === this.original ? this.original.sweep : [...this.original.sweep, ...this.mechanism.sweep]
    const points = [
      ...swept.flatMap((point) => padded.map((by) => point.clone().add(by))),
      ...this.#matter.reach,
      ...this.#marks.reach,
    ]
    this.#overview?.resize(points, width, height)
    const seen = this.#overview?.part(points, this.#focus(), width / height) ?? points
    const place = (insets: Insets) =>
      this.#controls.target.copy(fit(this.camera, seen, this.original.size, this.#look, width, height, insets))
    const top = this.#overview?.strip(height)
    place({ top })
    // Below one row of buttons first; below all of them, and above the caption, where these would hide something.
    const covered = this.#covered(seen, height)
    if (covered) place({ ...covered, top: top ?? covered.top })
    this.#controls.update()
  }

  /** Insets of those, buttons and caption, that are over one of these points; undefined if none is. */
  #covered(points: readonly Vector3[], height: number): Insets | undefined {
    const { left, top } = this.element.getBoundingClientRect()
    const seen = points.map((point) => this.project(point))
    const isOver = (element: Element) => {
      const box = element.getBoundingClientRect()
      const [x, y] = [box.left - left, box.top - top]
      return seen.some((at) => at.x > x && at.x < x + box.width && at.y > y && at.y < y + box.height)
    }
    const above = [...(this.#buttons?.children ?? [])].some(isOver)
    const below = isOver(this.#caption)
    if (!above && !below) return undefined
    return {
      ...(above && { top: this.#buttons!.getBoundingClientRect().bottom - top }),
      ...(below && { bottom: height + top - this.#caption.getBoundingClientRect().top }),
    }
  }

  /** The picture as vectors. */
  vectors(): Blob {
    const { width, height } = this.#extent
    const { view, ground, outline, label } = this.#palette
    const groups = [...this.#matter.groups, ...this.#marks.groups]
    const title = this.state.report.title
    return viewSvg(groups, this.camera, {
      width,
      height,
      title,
      view,
      ground,
      outline,
      label,
      labels: this.#labels.placed,
    })
  }

  /** The whole motion as a binary glTF file. */
  motion(): Promise<Blob> {
    return motionGltf(this.mechanism, this.#matter.drawn, this.state.step)
  }

  /** Focus in a long mechanism: the selection, or else the point that the chosen variable moves. */
  #focus(): Vector3 {
    const { selected, variable } = this.state.choice
    const { report, sweep } = this.original
    const joint = selected?.kind === 'joint' ? report.joints[selected.index] : undefined
    const arrow = report.variables[variable]?.arrows[0]
    if (selected?.kind === 'body' && selected.index > 0)
      return this.original.worldAt(selected.index, this.original.shapePoints(selected.index)[0] ?? new Vector3(), 0)
    if (joint) return this.original.worldAt(joint.body_i, new Vector3(...joint.at_i), 0)
    if (arrow) return this.original.worldAt(arrow.body, new Vector3(...arrow.at), 0)
    return sweep[0] ?? new Vector3()
  }

  /** Moves the view so that a place is in its middle from left to right. */
  #visit(place: Vector3): void {
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0)
    const by = right.multiplyScalar(place.clone().sub(this.#controls.target).dot(right))
    this.#controls.target.add(by)
    this.camera.position.add(by)
    this.#turned = true
    this.#controls.update()
    this.#draw()
  }

  /** The picture as a PNG file, with this number of pixels per pixel of the page. */
  async picture(scale: number): Promise<Blob> {
    const usual = this.#renderer.getPixelRatio()
    this.#size(scale)
    this.#render()
    const blob = await new Promise<Blob | null>((done) => this.canvas.toBlob(done, 'image/png'))
    this.#size(usual)
    this.#render()
    if (!blob) throw new Error('the browser returned no picture of the view')
    return blob
  }

  #assembleMatter(): Assembly {
    const assembly = new Assembly(
      present(this.original, this.state),
      this.#palette,
      this.state.choice,
      matter,
      this.#outlines,
      0,
      this.#stock,
    )
    this.scene.add(...assembly.groups)
    return assembly
  }

  #assembleMarks(): Assembly {
    const variable = this.original.report.variables[this.state.choice.variable]
    const change = variable && shownChange(this.original, variable)
    const forces = this.state.choice.forces && forceText(this.#matter.mechanism)
    const texts = [forces, change !== undefined && `Arrows: effect of ${changeText(change, variable)}`].filter(
      (words) => words,
    )
    setText(this.#arrows, texts.map((words) => `${words}, `).join(''))
    const assembly = new Assembly(
      this.#matter.mechanism,
      this.#palette,
      this.state.choice,
      marks,
      this.#outlines,
      MARK_NUMBERS,
      this.#stock,
    )
    this.scene.add(...assembly.groups)
    return assembly
  }

  #lay(): Floor {
    const { up, report } = this.original
    const heights = [...this.#matter.reach, ...this.original.sweep].map((point) => point.dot(up))
    const floor = new Floor(
      this.original,
      this.#palette,
      heights.length > 0 ? heights.reduce((a, b) => Math.min(a, b)) : 0,
    )
    this.scene.add(floor.object)
    const road = report.wheels.length > 0 ? 'road, ' : ''
    this.#grid.textContent = `${road}grid ${number(floor.cell)} ${report.units.length}`
    this.#outlines.colour(this.#palette)
    this.#renderer.setClearColor(this.#palette.view)
    return floor
  }

  /** Everything anew: there is nothing whose colour the scheme does not decide. */
  #repaint(): void {
    this.#palette = paletteOf()
    this.#assemble()
    this.#floor.object.removeFromParent()
    this.#floor.dispose()
    this.#floor = this.#lay()
    this.#render()
  }

  #assemble(): void {
    for (const one of [this.#matter, this.#marks]) this.#discard(one)
    this.#matter = this.#assembleMatter()
    this.#marks = this.#assembleMarks()
    this.#emphasise()
    this.#moved = true
  }

  /** Makes all anew where it would be drawn too thin or too thick. */
  #rescale(height: number): boolean {
    const changed = this.original.sizeTo(pixelsPerLength(this.camera, this.#controls.target, height))
    if (changed) this.#assemble()
    return changed
  }

  /** Rebuilds the parts that the last choice changed. */
  #update(): void {
    if (!this.#stale) return
    this.#stale = false
    const design = this.state.edition
    if (design !== this.#drawn) {
      this.#drawn = design
      this.#discard(this.#matter)
      this.#matter = this.#assembleMatter()
    }
    this.#discard(this.#marks)
    this.#marks = this.#assembleMarks()
    this.#moved = true
    this.#emphasise()
  }

  #emphasise(): void {
    const { selected } = this.state.choice
    const level = (part: Part): Emphasis =>
      samePart(part, selected) ? 'chosen' : samePart(part, this.#pointer.hovered) ? 'hovered' : 'none'
    const parts = [...this.#matter.numbers, ...this.#marks.numbers]
    this.#outlines.emphasise(
      new Map(parts.map(({ part, number }) => [number, level(part)] as const).filter(([, to]) => to !== 'none')),
    )
  }

  #move(): void {
    this.#moved = true
    this.#draw()
  }

  #draw(): void {
    if (this.#pending) return
    this.#pending = true
    requestAnimationFrame(() => {
      this.#pending = false
      if (!this.state.ended.aborted) this.#render()
    })
  }

  #render(): void {
    const { width, height } = this.#extent
    if (width === 0 || height === 0) return
    this.#update()
    this.#rescale(height)
    if (this.#moved) {
      const frame = this.mechanism.frame(this.state.step)
      this.#matter.pose(frame)
      this.#marks.pose(frame)
      // Shadows stay where they are while only the reader moves.
      this.#renderer.shadowMap.needsUpdate = !this.#isLight
      this.#moved = false
    }
    if (this.#matter.refine(pixelsPerLength(this.camera, this.#controls.target, height)))
      this.#renderer.shadowMap.needsUpdate = !this.#isLight
    const { layers } = this.camera
    layers.set(0)
    this.#renderer.clear()
    if (this.#isLight) {
      layers.enable(OVER)
      this.#renderer.render(this.scene, this.camera)
    } else {
      this.#renderer.render(this.scene, this.camera)
      this.#outlines.draw(this.#renderer, this.scene, this.camera)
      layers.set(OVER)
      this.#renderer.render(this.scene, this.camera)
    }
    layers.set(0)
    this.#overview?.draw(this.#renderer, this.scene, width, height)
    this.graphics.drawn()
    this.#triad.update(this.camera)
    this.#label()
    for (const listener of this.#onDrawn) listener()
  }

  #discard(one: Assembly): void {
    for (const group of one.groups) group.removeFromParent()
    this.graphics.free(one)
  }

  #label(): void {
    const { width, height } = this.#extent
    const frame = this.mechanism.frame(this.state.step)
    const { selected } = this.state.choice
    const { hovered } = this.#pointer
    const parts = [selected, samePart(selected, hovered) ? undefined : hovered].filter((part) => part !== undefined)
    const labels = this.state.choice.labels
      ? hardpointLabels(this.mechanism, frame)
      : parts.flatMap((part) => partLabels(this.mechanism, frame, part))
    if (this.state.choice.shapes) labels.unshift(...clearanceLabels(this.mechanism, this.state.step))
    const value = (quantity: number) => valueAt(this.state.curve(quantity, 0), this.state.step)
    labels.unshift(...distanceLabels(this.mechanism, frame, this.state.choice.distance, value))
    this.#labels.show(labels, this.camera, this.mechanism.centre, width, height)
  }

  /** Prints a copy: a printer does not wait for the frame in which a WebGL canvas would show its new picture. */
  #still(): void {
    this.#paper.width = this.canvas.width
    this.#paper.height = this.canvas.height
    this.#paper.getContext('2d')!.drawImage(this.canvas, 0, 0)
  }

  #resize(): void {
    const { width, height } = this.#extent
    if (width === 0 || height === 0) return
    this.#size(this.#ratio)
    if (this.#wanted) this.restore(this.#wanted)
    else if (this.#turned) shapeTo(this.camera, width / height)
    else this.fit()
    this.#render()
  }

  /** Pixels of the picture per pixel of the page. */
  get #ratio(): number {
    return this.#isLight ? 1 : Math.min(devicePixelRatio, 2)
  }

  #lighten(isLight: boolean): void {
    this.#isLight = isLight
    this.element.classList.toggle('light', isLight)
    if (this.#floor.shadow) this.#floor.shadow.visible = !isLight
    this.#size(this.#ratio)
    this.#move()
  }

  #size(ratio: number): void {
    const { width, height } = this.#extent
    this.#renderer.setPixelRatio(ratio)
    this.#renderer.setSize(width, height, false)
    this.#outlines.resize(width, height, ratio)
  }
}
