import { expect, test } from 'vitest'
import { History, type Step } from '../src/studio/history'

const step = (by: number, label = `by ${by}`, text = 'model'): Step => ({
  text,
  settings: [{ name: 'rack_z', by }],
  label,
})
const first = (): Step => ({ text: 'model', settings: [], label: 'opened' })

test('steps are gone back and forth, and named', () => {
  const history = new History(first())
  expect([history.undoable, history.redoable, history.changed]).toEqual([undefined, undefined, false])
  expect(history.undo()).toBeUndefined()
  history.go(step(1))
  history.go(step(2))
  expect([history.undoable, history.redoable, history.changed]).toEqual(['by 2', undefined, true])
  expect(history.undo()).toEqual(step(1))
  expect([history.undoable, history.redoable]).toEqual(['by 1', 'by 2'])
  expect(history.redo()).toEqual(step(2))
  expect(history.redo()).toBeUndefined()
})

test('a new step takes the place of those that were undone', () => {
  const history = new History(first())
  history.go(step(1))
  history.go(step(2))
  history.undo()
  history.go(step(3))
  expect(history.redoable).toBeUndefined()
  expect(history.undo()).toEqual(step(1))
})

test('a whole drag is one step, the next drag another', () => {
  const history = new History(first())
  for (const by of [1, 2, 3]) history.go(step(by), 'drag')
  history.endGesture()
  for (const by of [4, 5]) history.go(step(by), 'drag')
  expect(history.undo()).toEqual(step(3))
  expect(history.undo()).toEqual(first())
})

test('another hand, an undo or what comes in between ends a drag', () => {
  const history = new History(first())
  history.go(step(1), 'a')
  history.go(step(2), 'b')
  expect(history.undo()).toEqual(step(1))
  history.go(step(3), 'a')
  expect(history.undo()).toEqual(step(1))
})

test('a drag that comes back is no step, nor is a step to where one is', () => {
  const history = new History(first())
  history.go(step(1))
  for (const by of [2, 1]) history.go(step(by), 'drag')
  expect(history.undoable).toBe('by 1')
  history.endGesture()
  history.go(step(1, 'again'))
  expect(history.undo()).toEqual(first())
  history.go({ text: 'model', settings: [{ name: 'rack_z', by: 0 }], label: 'as it was' })
  expect(history.changed).toBe(false)
})

test('a drag that begins where the design is takes nothing of what was before', () => {
  const history = new History(first())
  history.go(step(1))
  for (const by of [1, 2, 3]) history.go(step(by), 'drag')
  expect(history.undo()).toEqual(step(1))
})

test('another text is another design with the same changes', () => {
  const history = new History(first())
  history.go(step(0, 'typed', 'other'))
  expect(history.changed).toBe(true)
  expect(history.undo()).toEqual(first())
})

test('the earliest steps are forgotten, but for the first', () => {
  const history = new History(first(), 4)
  for (const by of [1, 2, 3, 4, 5]) history.go(step(by))
  const back = [history.undo(), history.undo(), history.undo(), history.undo()]
  expect(back).toEqual([step(4), step(3), first(), undefined])
})

test('reset and a design with a name are steps that can be undone', () => {
  const history = new History(first())
  history.go(step(1))
  const kept = history.save('  stiff ')
  expect(kept.name).toBe('stiff')
  history.go(step(2))
  expect(history.reset().settings).toEqual([])
  expect(history.undo()).toEqual(step(2))
  expect(history.restore(kept)).toEqual({ ...step(1), label: 'stiff' })
  expect(history.undo()).toEqual(step(2))
})

test('designs are named, renamed and forgotten', () => {
  const history = new History(first())
  let changes = 0
  history.onChange(() => changes++)
  const [one, two] = [history.save(), history.save()]
  expect(history.snapshots.map(({ name }) => name)).toEqual(['design 1', 'design 2'])
  history.rename(one, '')
  history.rename(two, 'soft')
  history.remove(one)
  expect(history.snapshots.map(({ name }) => name)).toEqual(['soft'])
  expect(history.save().name).toBe('design 1')
  expect(changes).toBe(6)
})

test('designs of the file are listed first, keep their names, and follow its text', () => {
  const history = new History(first())
  history.setFileDesigns([{ name: 'higher', changes: [{ name: 'rack_z', by: 3 }] }], 'model')
  const mine = history.save('mine', step(1))
  expect(history.snapshots.map(({ name, isOfFile }) => [name, isOfFile])).toEqual([
    ['higher', true],
    ['mine', false],
  ])
  history.compareWith([history.snapshots[0], mine])
  const changes = [{ name: 'rack_z', by: 4 }]
  history.setFileDesigns(
    [
      { name: 'lower', changes: [] },
      { name: 'higher', changes },
    ],
    'edited',
  )
  expect(history.snapshots.map(({ name }) => name)).toEqual(['lower', 'higher', 'mine'])
  expect(history.compared.map(({ name }) => name)).toEqual(['higher', 'mine'])
  expect(history.compared[0].step).toEqual({ text: 'edited', settings: changes, label: 'higher' })
  history.setFileDesigns([], 'model')
  expect(history.compared).toEqual([mine])
  expect(history.changed).toBe(false)
})

test('a design that was written to the text is listed as that of the text, and as before where the text has none', () => {
  const history = new History(first())
  const mine = history.save('stiff', step(1))
  history.compareWith([mine])
  history.markWritten(mine)
  const listed = () => history.snapshots.map(({ name, isOfFile }) => [name, isOfFile])
  const written = [{ name: 'stiff', changes: [{ name: 'rack_z', by: 1 }] }]
  history.setFileDesigns(written, 'edited')
  expect(listed()).toEqual([['stiff', true]])
  expect(history.compared).toEqual(history.snapshots)
  history.setFileDesigns([], 'model')
  expect(listed()).toEqual([['stiff', false]])
  expect(history.compared).toEqual([mine])
  history.setFileDesigns(written, 'edited')
  expect(listed()).toEqual([['stiff', true]])
})
