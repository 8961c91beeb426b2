import { EditorView } from '@codemirror/view'
import type { Extension } from '@codemirror/state'

const MONOSPACE = 'ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace'
const wavy = (colour: string) => ({
  backgroundImage: 'none',
  paddingBottom: '0',
  textDecoration: `underline wavy var(${colour}) 1px`,
  textDecorationSkipInk: 'none',
  textUnderlineOffset: '3px',
})

/** The editor in the page's own colours, which follow the screen's scheme by themselves. */
export function theme(): Extension {
  return EditorView.theme({
    '&': { height: '100%', color: 'var(--ink)', backgroundColor: 'var(--page)', fontSize: '1rem' },
    '&.cm-focused': { outline: '2px solid var(--accent)', outlineOffset: '-2px' },
    '.cm-scroller': { fontFamily: MONOSPACE, lineHeight: '1.5' },
    '.cm-content': { caretColor: 'var(--accent)', padding: '6px 0' },
    '.cm-cursor, .cm-dropCursor': { borderLeftColor: 'var(--accent)', borderLeftWidth: '2px' },
    '.cm-selectionBackground, &.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground': {
      backgroundColor: 'color-mix(in oklab, var(--heat) 28%, transparent)',
    },
    '.cm-activeLine': { backgroundColor: 'color-mix(in oklab, var(--track) 30%, transparent)' },
    '.cm-gutters': { backgroundColor: 'var(--panel)', color: 'var(--muted)', borderRight: '1px solid var(--rule)' },
    '.cm-activeLineGutter': { backgroundColor: 'var(--track)', color: 'var(--ink)' },
    '.cm-lineNumbers .cm-gutterElement': { padding: '0 8px 0 4px', minWidth: '30px' },
    '.cm-gutter-lint': { width: '14px' },
    '.cm-gutter-lint .cm-gutterElement': { padding: '0 2px' },
    '.cm-lint-marker': { width: '10px', height: '10px', marginTop: '5px', borderRadius: '50%', content: 'normal' },
    '.cm-lint-marker-error': { background: 'var(--bad)' },
    '.cm-lint-marker-warning': { background: 'var(--hue-4)' },
    '.cm-lint-marker-info': { background: 'var(--heat)' },
    '.cm-lintRange-error': wavy('--bad'),
    '.cm-lintRange-warning': wavy('--hue-4'),
    '.cm-lintRange-info': wavy('--heat'),
    '.cm-lintRange-active': { backgroundColor: 'var(--warn-wash)' },
    '.cm-lintPoint::after': { display: 'none' },
    '&.cm-focused .cm-matchingBracket': { backgroundColor: 'color-mix(in oklab, var(--good) 25%, transparent)' },
    '&.cm-focused .cm-nonmatchingBracket': { backgroundColor: 'var(--stop-wash)', color: 'var(--stop)' },
    '.cm-searchMatch': { backgroundColor: 'color-mix(in oklab, var(--hue-4) 35%, transparent)' },
    '.cm-searchMatch-selected': { backgroundColor: 'color-mix(in oklab, var(--hue-1) 55%, transparent)' },
    '.cm-selectionMatch': { backgroundColor: 'color-mix(in oklab, var(--hue-4) 18%, transparent)' },
    '.cm-tooltip': {
      border: '1px solid var(--rule)',
      borderRadius: '6px',
      backgroundColor: 'var(--page)',
      color: 'var(--ink)',
      boxShadow: '0 6px 24px rgb(0 0 0 / 0.18)',
      maxWidth: 'min(560px, 92vw)',
      zIndex: '20',
    },
    '.cm-tooltip-lint': { padding: '2px' },
    '.cm-diagnostic': { padding: '5px 10px', borderLeftWidth: '3px', whiteSpace: 'normal', fontFamily: 'inherit' },
    '.cm-diagnostic-error': { borderLeftColor: 'var(--bad)' },
    '.cm-diagnostic-warning': { borderLeftColor: 'var(--hue-4)' },
    '.cm-diagnostic-info': { borderLeftColor: 'var(--heat)' },
    '.cm-tooltip.cm-tooltip-autocomplete > ul': { fontFamily: MONOSPACE, maxHeight: '14em' },
    '.cm-tooltip.cm-tooltip-autocomplete > ul > li': { padding: '2px 8px' },
    '.cm-tooltip.cm-tooltip-autocomplete > ul > li[aria-selected]': {
      backgroundColor: 'var(--accent-wash)',
      color: 'var(--ink)',
    },
    '.cm-completionMatchedText': { textDecoration: 'none', fontWeight: '700' },
    '.cm-completionDetail': { color: 'var(--muted)', fontStyle: 'normal' },
    '.cm-tooltip.cm-completionInfo': { padding: '6px 10px', maxWidth: '340px' },
    '.cm-panels': { backgroundColor: 'var(--panel)', color: 'var(--ink)' },
    '.cm-panels-top': { borderBottom: '1px solid var(--rule)' },
    '.cm-panels-bottom': { borderTop: '1px solid var(--rule)' },
    '.cm-panel.cm-search': { padding: '5px 34px 5px 8px' },
    '.cm-panel.cm-search input, .cm-panel.cm-search button, .cm-panel.cm-search label': { fontSize: '12px' },
    '.cm-panel.cm-search input[type=checkbox]': { accentColor: 'var(--accent)', minHeight: 'auto' },
    '.cm-textfield': {
      border: '1px solid var(--rule)',
      borderRadius: '6px',
      backgroundColor: 'var(--page)',
      minHeight: '26px',
    },
    '.cm-button': {
      border: '1px solid var(--rule)',
      borderRadius: '6px',
      backgroundColor: 'var(--page)',
      backgroundImage: 'none',
    },
    '.cm-panel.cm-search [name=close]': { fontSize: '16px', padding: '0 8px', top: '5px', right: '4px' },
  })
}
