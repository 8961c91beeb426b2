import { Curve, Vector3 } from 'three'

/** A helix about y from y = 0 to y = `height`. */
export class Helix extends Curve<Vector3> {
  constructor(
    readonly radius: number,
    readonly height: number,
    readonly turns: number,
  ) {
    super()
  }

  override getPoint(share: number, target = new Vector3()): Vector3 {
    const angle = 2 * Math.PI * this.turns * share
    return target.set(this.radius * Math.cos(angle), this.height * share, this.radius * Math.sin(angle))
  }
}
