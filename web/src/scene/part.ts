import type { Part } from './drawable'
import type { Mechanism } from './mechanism'

/** A body, with the joints that hold it. */
export function bodyPart({ report }: Mechanism, index: number): Part {
  const joints = report.joints
    .filter(({ body_i, body_j }) => body_i === index || body_j === index)
    .map(({ name }) => name)
  const kind = index === 0 ? 'fixed' : 'body'
  return {
    kind: 'body',
    index,
    name: report.bodies[index].name,
    about: joints.length > 0 ? `${kind}, joints ${listed(joints)}` : kind,
  }
}

/** A joint, with the bodies that it joins. */
export function jointPart({ report }: Mechanism, index: number): Part {
  const { name, kind, body_i, body_j, cut } = report.joints[index]
  const bodies = `${report.bodies[body_i].name} and ${report.bodies[body_j].name}`
  return {
    kind: 'joint',
    index,
    name,
    about: `${kind.replaceAll('_', ' ')} joint of ${bodies}${cut ? ', closes a loop' : ''}`,
  }
}

/** More names than this are not read in a tip. */
const SHOWN = 6

function listed(names: string[]): string {
  return names.length > SHOWN
    ? `${names.slice(0, SHOWN - 1).join(', ')} and ${names.length - SHOWN + 1} more`
    : names.join(', ')
}
