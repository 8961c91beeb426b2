import {
  AnimationMixer,
  BoxGeometry,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  Quaternion,
  SphereGeometry,
  Vector3,
} from 'three'
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js'
import { Line2 } from 'three/addons/lines/Line2.js'
import { LineGeometry } from 'three/addons/lines/LineGeometry.js'
import { describe, expect, test, vi } from 'vitest'
import { decimal, csvText, noFormula } from '../src/export/csv'
import { motionGltf } from '../src/export/gltf'
import { escaped } from '../src/export/markup'
import { plotSvg } from '../src/export/plot_svg'
import { fileName } from '../src/export/save'
import { viewSvg } from '../src/export/view_svg'
import type { Content } from '../src/content'
import type { Drawable } from '../src/scene/drawable'
import { Mechanism } from '../src/scene/mechanism'
import { crank } from './mechanisms'

const curve = (...values: number[]) => Float32Array.from(values)
const PAPER = { page: '#ffffff', text: '#000000', muted: '#555555', rule: '#dddddd' }

describe('CSV', () => {
  test('has units in its heading, all digits that the page holds, and empty fields where there is no number', () => {
    const columns = [
      { label: 'time', unit: 's', curve: curve(0, 0.1) },
      { label: 'toe, "left"', unit: 'deg/s^2', curve: curve(NaN, 1 / 3) },
      { label: 'ratio', unit: '1', curve: curve(-2) },
    ]
    expect(csvText(columns)).toBe('time [s],"toe, ""left"" [deg/s²]",ratio\r\n0,,-2\r\n0.1,0.33333334,\r\n')
  })

  test('writes every single-precision number so that it reads back', () => {
    for (const value of [0.1, 1 / 3, 1e-42, 3.4028235e38, -123456.79, 16777215, 5e-7]) {
      expect(Math.fround(Number(decimal(Math.fround(value))))).toBe(Math.fround(value))
    }
    expect(decimal(Math.fround(0.1))).toBe('0.1')
    expect([decimal(NaN), decimal(Infinity), decimal(undefined)]).toEqual(['', '', ''])
  })

  test('has no formula in its heading', () => {
    expect(noFormula('=1+1')).toBe("'=1+1")
    expect(['+x', '-x', '@x', '\tx', '\rx', 'x-y'].map(noFormula)).toEqual(["'+x", "'-x", "'@x", "'\tx", "'\rx", 'x-y'])
  })

  test('of nothing is a heading', () => {
    expect(csvText([{ label: 'time', unit: 's', curve: curve() }])).toBe('time [s]\r\n')
  })
})

describe('SVG of a plot', () => {
  const content: Content = {
    title: 'toe <left> & "right"',
    unit: 'deg',
    lines: [
      { label: 'present', color: '#0b62b8', curve: curve(0, 1, NaN, 3, 2) },
      { label: 'former', color: '#2a323a', curve: curve(0, 2, 4, 6, 4), dash: [6, 4] },
    ],
  }
  const times = curve(0, 1, 2, 3, 4)

  test('has the curves with their gaps, the axes with their numbers, and the legend as text', async () => {
    const text = await plotSvg(content, times, 's', PAPER).text()
    expect(text).toContain('toe &lt;left&gt; &amp; &quot;right&quot; [deg]')
    expect(text).toContain('>time [s]<')
    for (const label of ['present', 'former', '0', '2', '4', '6']) expect(text).toContain(`>${label}</text>`)
    const paths = [...text.matchAll(/<path d="(M[^"]+)" fill="none" stroke="#0b62b8"/g)].map(([, path]) => path)
    expect(paths[0].match(/M/g)).toHaveLength(2)
    expect(text).toContain('stroke-dasharray="6 4"')
    expect(text).not.toContain('NaN')
  })

  test('of one moment, of a constant, of nothing and of decades has no number that is none', async () => {
    const line = (...values: number[]) => [{ label: 'x', color: '#000', curve: curve(...values) }]
    const all = [
      plotSvg({ ...content, lines: line(5) }, curve(2), 's', PAPER),
      plotSvg({ ...content, lines: line(3, 3, 3, 3, 3) }, times, 's', PAPER),
      plotSvg({ ...content, lines: line(NaN, NaN, NaN, NaN, NaN) }, times, 's', PAPER),
      plotSvg({ ...content, lines: [] }, times, 's', PAPER),
      plotSvg({ ...content, lines: line(0, 1e-9, 1, 10, 1e4), logarithmic: true }, times, 's', PAPER),
    ]
    for (const blob of all) {
      const text = await blob.text()
      expect(text).not.toMatch(/NaN|Infinity|undefined/)
    }
  })

  test('of a part has the axes of that part', async () => {
    const whole = await plotSvg(content, times, 's', PAPER).text()
    const part = await plotSvg({ ...content, part: [0, 1] }, times, 's', PAPER).text()
    const numbers = (text: string) =>
      [...text.matchAll(/>([\d.−]+)<\/text>/g)].map(([, number]) => Number(number.replace('−', '-')))
    expect(Math.max(...numbers(whole))).toBe(6)
    // Up to 1 s and 2 deg; an axis adds its margin.
    expect(Math.max(...numbers(part))).toBeLessThan(2.2)
    expect(numbers(part)).toContain(0.5)
    expect(part).not.toMatch(/NaN|undefined/)
  })

  test('over another quantity follows it back and forth', async () => {
    const over = { label: 'travel', unit: 'mm', curve: curve(0, 10, 20, 10, 0) }
    const text = await plotSvg({ ...content, over }, times, 's', PAPER).text()
    const [, path] = /<path d="(M[^"]+)" fill="none" stroke="#2a323a"/.exec(text)!
    const lefts = [...path.matchAll(/[ML]([\d.]+) /g)].map(([, left]) => Number(left))
    expect(lefts[0]).toBe(lefts[4])
    expect(text).toContain('travel [mm]')
  })
})

describe('SVG of the view', () => {
  const picture = {
    width: 400,
    height: 300,
    title: 'a & b',
    view: '#ffffff',
    ground: '#66717c',
    outline: '#2a323a',
    label: '#000000',
  }
  const camera = new PerspectiveCamera(22, 4 / 3, 1, 100)
  camera.position.set(6, 8, 10)
  camera.lookAt(0, 0, 0)
  camera.updateMatrixWorld()

  test('draws the nearer thing later, shades faces and outlines them', async () => {
    const near = new Mesh(new BoxGeometry(1, 1, 1), new MeshLambertMaterial({ color: '#ff0000' }))
    near.position.set(3, 4, 5)
    const far = new Mesh(new SphereGeometry(1, 12, 8), new MeshLambertMaterial({ color: '#0000ff' }))
    const text = await viewSvg([new Group().add(near, far)], camera, picture).text()
    const reds = [...text.matchAll(/fill="#(..)0000"/g)]
    // Three sides of the cube are seen, each in a shade of its own.
    expect(new Set(reds.map(([, red]) => red)).size).toBe(3)
    expect(text.lastIndexOf('fill="#0000')).toBeLessThan(reds[0].index)
    expect(text).toContain('stroke="#2a323a"')
    expect(text).not.toMatch(/NaN|Infinity|undefined/)
  })

  test('leaves out what is hidden or behind the camera, and puts overlays on top', async () => {
    const hidden = new Mesh(new BoxGeometry(1, 1, 1), new MeshLambertMaterial({ color: '#00ff00' }))
    hidden.visible = false
    const behind = new Mesh(new BoxGeometry(1, 1, 1), new MeshLambertMaterial({ color: '#00ffff' }))
    behind.position.set(12, 16, 20)
    const over = new Mesh(
      new BoxGeometry(0.5, 0.5, 0.5),
      new MeshBasicMaterial({ color: '#c2185b', depthTest: false, transparent: true }),
    )
    over.position.set(-3, -4, -5)
    const front = new Mesh(new BoxGeometry(2, 2, 2), new MeshLambertMaterial({ color: '#ff0000' }))
    const text = await viewSvg([hidden, behind, over, front], camera, picture).text()
    expect(text).not.toMatch(/fill="#00..00"|fill="#00..(?!00)/)
    expect(text.indexOf('#c2185b')).toBeGreaterThan(text.lastIndexOf('stroke="#2a323a"'))
  })

  test('has the labels as text', async () => {
    const placed = [{ spot: { x: 10, y: 10, text: 'a<b' }, x: 40, y: 20, width: 30, height: 16 }]
    expect(await viewSvg([], camera, { ...picture, labels: placed }).text()).toContain('>a&lt;b</text>')
  })
})

test('text in XML has no control characters', () => {
  expect(escaped('a\u0000\u0007<b>')).toBe('a&lt;b&gt;')
})

test('file names keep what any system takes', () => {
  expect(fileName('front axle, 4x4/V23: "toe".svg')).toBe('front-axle-4x4-V23-toe.svg')
  expect(fileName('../../x.csv')).not.toContain('/')
  expect(fileName('***')).toBe('hardpoint')
  expect(fileName('Übersetzung.csv')).toBe('Übersetzung.csv')
})

/** Reader of blobs for GLTFExporter; browsers have one, Node has none. */
class Reader {
  result: ArrayBuffer | null = null
  onloadend?: () => void

  readAsArrayBuffer(blob: Blob): void {
    void blob.arrayBuffer().then((read) => {
      this.result = read
      this.onloadend?.()
    })
  }
}

describe('glTF of the motion', () => {
  Object.assign(globalThis, { FileReader: Reader, self: globalThis })
  const mechanism = new Mechanism(crank())
  const block = () => new Mesh(new BoxGeometry(1, 1, 1), new MeshLambertMaterial({ color: '#57b893' }))
  const rod = block()
  rod.add(new Line2(new LineGeometry().setFromPoints([new Vector3(), new Vector3(1, 0, 0)])))
  const drawn: Drawable[] = [
    { body: 1, object: block(), part: { kind: 'body', index: 1, name: 'crank', about: '' } },
    {
      object: rod,
      part: { kind: 'joint', index: 0, name: 'rod', about: '' },
      follow: (frame) => rod.position.copy(frame.at(1, new Vector3(2, 0, 0))),
    },
    { object: block(), part: { kind: 'mark', index: 0, name: 'arrow', about: '' }, overlay: true },
  ]

  test('loads again with every body at its pose at any time', async () => {
    const words = vi.spyOn(console, 'warn')
    const blob = await motionGltf(mechanism, drawn, 0)
    expect(words).not.toHaveBeenCalled()
    const { scene, animations } = await new GLTFLoader().parseAsync(await blob.arrayBuffer(), '')
    expect(animations).toHaveLength(1)
    const { times } = mechanism.report
    expect(animations[0].duration).toBeCloseTo(times[times.length - 1] - times[0])
    expect(scene.getObjectByName('arrow')).toBeUndefined()

    const mixer = new AnimationMixer(scene)
    mixer.clipAction(animations[0]).play()
    const crankBody = scene.getObjectByName('crank')!
    const rodBody = scene.getObjectByName('rod')!
    for (const step of [0, 2, 3]) {
      mixer.setTime(times[step] - times[0])
      scene.updateMatrixWorld(true)
      // In metres, y up.
      const want = (place: Vector3) => new Vector3(place.x, place.z, -place.y).multiplyScalar(1e-3)
      const tip = new Vector3(2, 0, 0)
      expect(crankBody.localToWorld(tip.clone()).distanceTo(want(mechanism.worldAt(1, tip, step)))).toBeLessThan(1e-7)
      expect(rodBody.getWorldPosition(new Vector3()).distanceTo(want(mechanism.worldAt(1, tip, step)))).toBeLessThan(
        1e-7,
      )
    }
    // Half way between two times it is half way turned.
    mixer.setTime((times[1] + times[2]) / 2 - times[0])
    const half = mechanism.poseAt(1, 1.5)!.turn
    expect(Math.abs(new Quaternion().copy(crankBody.quaternion).dot(half))).toBeGreaterThan(1 - 1e-6)
  })

  test('leaves the drawing at the moment shown', async () => {
    await motionGltf(mechanism, drawn, 1)
    expect(rod.position.distanceTo(mechanism.worldAt(1, new Vector3(2, 0, 0), 1))).toBeLessThan(1e-6)
  })
})
