import {
  AmbientLight,
  Color,
  DirectionalLight,
  GridHelper,
  Group,
  type Material,
  type Mesh,
  type Object3D,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three'
import { Line2 } from 'three/addons/lines/Line2.js'
import { LineGeometry } from 'three/addons/lines/LineGeometry.js'
import { LineMaterial } from 'three/addons/lines/LineMaterial.js'
import { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import { css, el, hue, onSchemeChange } from '../dom'
import { number, roundBelow } from '../format'
import type { State } from '../state'
import { cameraFor, Extent, fit, type Look, shapeTo } from './camera'
import { glyph, isRod, jointName } from './joints'
import { arrow, bar, groundMarks, named, overlay, ringArrow, skeleton, solid, stretch } from './parts'
import { path, poseAt, reshaped, shifted, visited } from './poses'
import { Triad } from './triad'

/** How opaque a changed design is drawn over today's. */
const GHOST = 0.45

export function hasWebGL(): boolean {
  return document.createElement('canvas').getContext('webgl2') !== null
}

/** The mechanism in 3D. Draws only when something changed, so that an idle page costs nothing. */
export class View {
  readonly element: HTMLElement
  #renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true })
  #scene = new Scene()
  #extent: Extent
  #camera
  #controls: OrbitControls
  #triad = new Triad()
  #paper = el('canvas', { class: 'paper' })
  #tip = el('div', { class: 'tip', hidden: true })
  #scale = el('span', { class: 'scale' })
  #bodies: Group[] = []
  #rods: { mesh: Mesh; from: [number, Vector3]; to: [number, Vector3] }[] = []
  #arrows: Group[] = []
  #ghosts: { body: number; group: Group }[] = []
  #trace?: Line2
  #pending = false
  #aspect?: number

  constructor(private readonly state: State) {
    this.#extent = new Extent(visited(state.report))
    this.#camera = cameraFor(this.#extent)
    const { domElement: canvas } = this.#renderer
    canvas.setAttribute('data-testid', 'view-canvas')
    canvas.setAttribute('role', 'img')
    canvas.setAttribute('aria-label', `3D view of ${state.report.title}`)
    this.#controls = new OrbitControls(this.#camera, canvas)
    this.#controls.addEventListener('change', () => this.#draw())
    this.element = el('div', { class: 'view' }, canvas, this.#paper, this.#tip, this.#scale)
    this.element.append(this.#triad.element)

    this.#build()
    state.onTime(() => this.#draw())
    state.onChoice(() => this.#annotate())
    onSchemeChange(() => {
      this.#build()
      this.#render()
    })
    addEventListener('beforeprint', () => this.#still())
    new ResizeObserver(() => this.#resize()).observe(this.element)
    canvas.addEventListener('pointermove', (event) => this.#hover(event))
    canvas.addEventListener('pointerleave', () => (this.#tip.hidden = true))
  }

  look(look: Look): void {
    this.#controls.target.copy(this.#extent.centre)
    fit(this.#camera, this.#extent, look, this.#aspect ?? 1)
    this.#controls.update()
    this.#draw()
  }

  /** Everything whose colour the scheme decides, which is everything. */
  #build(): void {
    const { report } = this.state
    const size = this.#extent.size
    dispose(this.#scene)
    this.#scene.clear()
    this.#scene.background = new Color(css('--view'))
    this.#scene.add(new AmbientLight(0xffffff, 1.7), this.#grid())
    const lamp = new DirectionalLight(0xffffff, 1.9)
    lamp.position.set(-0.5, -0.3, 1)
    const fill = new DirectionalLight(0xffffff, 0.7)
    fill.position.set(1, -1, -0.2)
    this.#scene.add(lamp, fill)

    this.#bodies = report.bodies.map((body, index) =>
      index === 0 ? groundMarks(body, size, css('--ground')) : skeleton(body, size, hue(index - 1)),
    )
    this.#scene.add(...this.#bodies)

    this.#rods = []
    for (const joint of report.joints) {
      const color = css(joint.cut ? '--cut-joint' : '--tree-joint')
      if (isRod(joint)) {
        const mesh = named(bar(size * 0.0055, solid(color)), jointName(joint))
        this.#rods.push({
          mesh,
          from: [joint.body_i, new Vector3(...joint.at_i)],
          to: [joint.body_j, new Vector3(...joint.at_j)],
        })
        this.#scene.add(mesh)
      } else {
        this.#bodies[joint.body_i].add(glyph(joint, size, color))
      }
    }
    this.#annotate()
  }

  #grid(): GridHelper {
    const { size, centre, lowest } = this.#extent
    const cell = roundBelow(size / 6)
    const cells = 2 * Math.ceil((0.75 * size) / cell)
    const grid = new GridHelper(cells * cell, cells, css('--grid-main'), css('--grid'))
    // The lines fall on round coordinates.
    const round = (value: number) => Math.round(value / cell) * cell
    grid.position.set(round(centre.x), round(centre.y), lowest - 0.05 * size)
    // GridHelper lies in xz.
    grid.rotation.x = Math.PI / 2
    this.#scale.textContent = `grid ${number(cell)} ${this.state.report.units.length}`
    return grid
  }

  /** The selected variable's design velocity and the chosen path. */
  #annotate(): void {
    const { report, choice } = this.state
    const size = this.#extent.size
    const ghosts = this.#ghosts.map(({ group }) => group)
    for (const part of [...this.#arrows, ...ghosts, ...(this.#trace ? [this.#trace] : [])]) {
      dispose(part)
      part.removeFromParent()
    }
    this.#arrows = []
    this.#ghosts = []
    this.#trace = undefined
    if (choice.change !== 0) this.#reshape()

    const material = overlay(css('--accent'))
    const arrows = report.variables[choice.variable]?.arrows ?? []
    const longest = Math.max(...arrows.map(({ v }) => Math.hypot(...v)), 0)
    for (const { body, at, v, turn } of arrows) {
      const group = new Group()
      const place = new Vector3(...at)
      const along = new Vector3(...v)
      const axis = new Vector3(...turn)
      if (along.length() > 1e-9 * longest) {
        group.add(arrow(place, along.multiplyScalar((0.14 * size) / longest), size * 0.005, material))
      }
      if (axis.length() > 0) group.add(ringArrow(place, axis, size * 0.06, size * 0.005, material))
      group.traverse((part) => {
        part.renderOrder = 10
        named(part, `design velocity of ${report.variables[choice.variable].name}`)
      })
      this.#bodies[body].add(group)
      this.#arrows.push(group)
    }

    if (choice.trace) {
      const [body, point] = choice.trace
      const track = report.bodies[body]
      const places = path(track.poses, new Vector3(...track.skeleton[point]))
      const color = body === 0 ? css('--ground') : hue(body - 1)
      this.#trace = new Line2(new LineGeometry().setFromPoints(places), new LineMaterial({ color, linewidth: 2 }))
      this.#scene.add(this.#trace)
    }
    this.#draw()
  }

  /** The bodies as the change of the selected variable makes them. */
  #reshape(): void {
    const { report, choice } = this.state
    const variable = report.variables[choice.variable]
    const size = this.#extent.size
    report.bodies.forEach((body, index) => {
      if (index === 0) return
      const points = reshaped(body.skeleton, variable.arrows, index, choice.change, size)
      const group = skeleton({ ...body, skeleton: points }, size, css('--accent'))
      group.traverse((part) => {
        const { material } = part as Partial<Mesh>
        if (material) Object.assign(material, { transparent: true, opacity: GHOST, depthWrite: false })
        if (part.userData.name) named(part, `${part.userData.name}, ${variable.name} changed`)
      })
      this.#ghosts.push({ body: index, group })
      this.#scene.add(group)
    })
  }

  #draw(): void {
    if (this.#pending) return
    this.#pending = true
    requestAnimationFrame(() => {
      this.#pending = false
      this.#render()
    })
  }

  #render(): void {
    this.#pose()
    this.#renderer.render(this.#scene, this.#camera)
    this.#triad.update(this.#camera)
  }

  #pose(): void {
    const { report, step, choice } = this.state
    this.#bodies.forEach((group, index) => {
      const pose = poseAt(report.bodies[index].poses, step)
      group.visible = pose !== undefined
      if (!pose) return
      group.position.copy(pose.place)
      group.quaternion.copy(pose.turn)
      group.updateMatrixWorld()
    })
    const shifts = report.variables[choice.variable]?.shifts
    for (const { body, group } of this.#ghosts) {
      const pose = poseAt(report.bodies[body].poses, step)
      group.visible = pose !== undefined
      if (!pose) continue
      const { place, turn } = shifted(pose, shifts?.[body], step, choice.change)
      group.position.copy(place)
      group.quaternion.copy(turn)
    }
    for (const { mesh, from, to } of this.#rods) {
      const [a, b] = [from, to].map(([body, point]) => this.#bodies[body].localToWorld(point.clone()))
      stretch(mesh, a, b)
      mesh.visible &&= this.#bodies[from[0]].visible && this.#bodies[to[0]].visible
    }
  }

  /** Prints a copy: a printer does not wait for the frame in which a WebGL canvas would show its new picture. */
  #still(): void {
    const { domElement: canvas } = this.#renderer
    this.#paper.width = canvas.width
    this.#paper.height = canvas.height
    this.#paper.getContext('2d')!.drawImage(canvas, 0, 0)
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element
    if (width === 0 || height === 0) return
    const first = this.#aspect === undefined
    this.#aspect = width / height
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2))
    this.#renderer.setSize(width, height, false)
    shapeTo(this.#camera, this.#aspect)
    if (first) this.look(this.#extent.planar ? 'z' : 'iso')
    this.#draw()
  }

  #hover(event: PointerEvent): void {
    const { left, top, width, height } = this.element.getBoundingClientRect()
    const [x, y] = [event.clientX - left, event.clientY - top]
    const ray = new Raycaster()
    ray.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.#camera)
    const hit = ray.intersectObjects(this.#scene.children).find(({ object }) => object.userData.name && object.visible)
    this.#tip.hidden = !hit
    if (!hit) return
    this.#tip.textContent = hit.object.userData.name
    // To the left of the pointer in the right half, so that the text never leaves the view.
    const toLeft = x > width / 2
    this.#tip.style.left = toLeft ? 'auto' : `${x + 14}px`
    this.#tip.style.right = toLeft ? `${width - x + 14}px` : 'auto'
    this.#tip.style.top = `${y + 10}px`
  }
}

/** Frees what the graphics card holds. */
function dispose(root: Object3D): void {
  root.traverse((object) => {
    const { geometry, material } = object as Partial<Mesh>
    geometry?.dispose()
    for (const one of [material ?? []].flat() as Material[]) one.dispose()
  })
}
