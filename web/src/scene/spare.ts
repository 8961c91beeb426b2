/** Names of renderers that draw with the processor. */
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i

/** True if a context draws without a graphics card. */
export function isSoftware(context: WebGLRenderingContext | WebGL2RenderingContext): boolean {
  const plain = String(context.getParameter(context.RENDERER))
  // Some browsers name the renderer by this extension only, others warn of it.
  const info = /^webkit/i.test(plain) ? context.getExtension('WEBGL_debug_renderer_info') : null
  return SOFTWARE.test(info ? String(context.getParameter(info.UNMASKED_RENDERER_WEBGL)) : plain)
}

/** Calls back with true when something in `area`, or a slider, is dragged, and with false when it is let go. */
export function whileDragged(area: Element, call: (isDragged: boolean) => void, signal: AbortSignal): void {
  let isHeld = false
  let isDragged = false
  const change = (to: boolean) => {
    if (isDragged === to) return
    isDragged = to
    call(to)
  }
  const listen = (name: 'pointerdown' | 'pointermove' | 'pointerup' | 'pointercancel', run: (event: Event) => void) =>
    addEventListener(name, run, { capture: true, signal })
  listen('pointerdown', ({ target }) => {
    isHeld = target instanceof Element && (area.contains(target) || target.matches('input[type=range]'))
  })
  listen('pointermove', () => isHeld && change(true))
  for (const name of ['pointerup', 'pointercancel'] as const)
    listen(name, () => {
      isHeld = false
      change(false)
    })
}
