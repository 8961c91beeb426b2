import type { Report } from '../report'

/** Joints that couplers turn: their shafts and bearings are drawn instead of pins and feet. */
export function shaftJoints({ joints, couplers }: Report): Set<number> {
  const turned = couplers.flatMap(({ terms }) => terms.filter(({ turns }) => turns).map(({ joint }) => joint))
  return new Set(turned.filter((joint) => joints[joint]?.kind === 'revolute'))
}

/** Slides that a rack moves: a bar in a tube instead of a block on a rail. */
export function rackJoints({ couplers }: Report): Set<number> {
  return new Set(
    couplers
      .filter(({ kind }) => kind === 'rack')
      .flatMap(({ terms }) => terms.filter(({ turns }) => !turns).map(({ joint }) => joint)),
  )
}
