import {
  Color,
  DoubleSide,
  Mesh,
  NearestFilter,
  Object3D,
  OrthographicCamera,
  PlaneGeometry,
  type Scene,
  ShaderMaterial,
  Vector2,
  Vector4,
  type WebGLRenderer,
  WebGLRenderTarget,
} from 'three'
import type { Camera } from './camera'
import type { Palette } from './palette'

/** Layers of the picture of part numbers, and of overlays. */
const PARTS = 1
export const OVER = 2

/** Emphasis of a part's outline. */
export type Emphasis = 'none' | 'hovered' | 'chosen'

const LEVELS: Record<Emphasis, number> = { none: 0, hovered: 0.5, chosen: 1 }

/**
 * Ink between parts: a second picture holds every part's number, and where two numbers meet there is a line.
 */
export class Outlines {
  #target = new WebGLRenderTarget(1, 1, { minFilter: NearestFilter, magFilter: NearestFilter })
  #numbers = new ShaderMaterial({
    side: DoubleSide,
    uniforms: { part: { value: new Vector4() } },
    vertexShader: 'void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.); }',
    fragmentShader: 'uniform vec4 part; void main() { gl_FragColor = part; }',
  })
  #ink = new ShaderMaterial({
    transparent: true,
    depthTest: false,
    depthWrite: false,
    uniforms: {
      parts: { value: this.#target.texture },
      texel: { value: new Vector2() },
      pixel: { value: new Vector2() },
      ink: { value: new Color() },
      chosen: { value: new Color() },
      emphasis: { value: 0 },
    },
    vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0., 1.); }',
    fragmentShader: INK,
  })
  #sheet = new Mesh(new PlaneGeometry(2, 2), this.#ink)
  #eye = new OrthographicCamera()
  #emphasis = new Map<number, Emphasis>()

  constructor() {
    this.#sheet.frustumCulled = false
  }

  /** Assigns the number of its part to a mesh. */
  number(mesh: Object3D, number: number): void {
    mesh.layers.enable(PARTS)
    mesh.onBeforeRender = (_renderer, _scene, _camera, _geometry, material) => {
      if (material !== this.#numbers) return
      const level = LEVELS[this.#emphasis.get(number) ?? 'none']
      this.#numbers.uniforms.part.value.set((number & 255) / 255, (number >> 8) / 255, level, 1)
      this.#numbers.uniformsNeedUpdate = true
    }
  }

  /** Draws these parts with a thicker line. */
  emphasise(parts: Map<number, Emphasis>): void {
    this.#emphasis = parts
    this.#ink.uniforms.emphasis.value = parts.size > 0 ? 1 : 0
  }

  colour(palette: Palette): void {
    this.#ink.uniforms.ink.value.set(palette.outline)
    this.#ink.uniforms.chosen.value.set(palette.chosen)
  }

  /** `width` and `height` of the view in pixels of the page, `ratio` of the screen's to them. */
  resize(width: number, height: number, ratio: number): void {
    // Two numbers or so for every pixel of the page, so that lines are smooth.
    const density = ratio < 1.5 ? 2 : ratio
    this.#target.setSize(Math.round(width * density), Math.round(height * density))
    this.#ink.uniforms.texel.value.set(1 / this.#target.width, 1 / this.#target.height)
    this.#ink.uniforms.pixel.value.set(1 / width, 1 / height)
  }

  /** Draws the lines over the picture that was just made of the scene. */
  draw(renderer: WebGLRenderer, scene: Scene, camera: Camera): void {
    const colour = renderer.getClearColor(new Color())
    const mask = camera.layers.mask
    camera.layers.set(PARTS)
    scene.overrideMaterial = this.#numbers
    renderer.setRenderTarget(this.#target)
    renderer.setClearColor(0x000000, 0)
    renderer.clear()
    renderer.render(scene, camera)
    renderer.setRenderTarget(null)
    renderer.setClearColor(colour, 1)
    scene.overrideMaterial = null
    camera.layers.mask = mask
    renderer.render(this.#sheet, this.#eye)
  }

  dispose(): void {
    this.#target.dispose()
    this.#numbers.dispose()
    this.#ink.dispose()
    this.#sheet.geometry.dispose()
  }
}

/** Nine numbers half a pixel apart: the more neighbours differ, the nearer is the border. */
const INK = `
varying vec2 at;
uniform sampler2D parts;
uniform vec2 texel, pixel;
uniform vec3 ink, chosen;
uniform float emphasis;
float differ(vec4 a, vec4 b) { return step(.001, abs(a.r - b.r) + abs(a.g - b.g)); }
vec4 read(float x, float y) { return texture2D(parts, at + vec2(x, y) * .5 * pixel); }
void main() {
  vec4 a = read(-1., -1.), b = read(0., -1.), c = read(1., -1.);
  vec4 d = read(-1., 0.), e = read(0., 0.), f = read(1., 0.);
  vec4 g = read(-1., 1.), h = read(0., 1.), i = read(1., 1.);
  float across = differ(a, b) + differ(b, c) + differ(d, e) + differ(e, f) + differ(g, h) + differ(h, i);
  float along = differ(a, d) + differ(d, g) + differ(b, e) + differ(e, h) + differ(c, f) + differ(f, i);
  float line = .9 * min(1., max(across, along) / 3.);
  vec3 colour = ink;
  if (emphasis > .5) {
    float hovered = 0., selected = 0.;
    for (int k = 0; k < 12; k++) {
      float t = float(k) * .5236;
      float near = texture2D(parts, at + pixel * vec2(cos(t), sin(t))).b;
      float far = texture2D(parts, at + 1.5 * pixel * vec2(cos(t), sin(t))).b;
      hovered += step(.25, abs(near - e.b)) / 3.;
      selected += step(.25, abs(far - e.b)) * step(.75, max(far, e.b)) / 3.;
    }
    line = max(line, min(1., hovered));
    if (selected > 0.) { colour = mix(ink, chosen, min(1., selected)); line = max(line, min(1., selected)); }
  }
  if (line < .01) discard;
  gl_FragColor = vec4(colour, line);
  #include <colorspace_fragment>
}`
