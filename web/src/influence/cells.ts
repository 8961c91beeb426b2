import {
  derivativeName,
  derivativeUnit,
  groups,
  ranking,
  type Order,
  type Quantity,
  type Report,
  type Variable,
} from '../report'
import { figure } from '../format'

/** A row of the map: the heading of a unit, or a variable. */
export type Row = { unit: string; variable?: Variable }

/** Cell of the map for a quantity and a variable. */
interface Cell {
  /** The value that is largest in magnitude over time, with its sign. */
  extreme: number
  /** The same as part of the column's largest among variables of one unit, -1 to 1. */
  share: number
}

/** Rows and columns of the map. */
export interface Grid {
  rows: Row[]
  quantities: Quantity[]
}

/** The groups with quantities that some sensitivity is known of. */
export function knownGroups(report: Report): [name: string, members: Quantity[]][] {
  const known = new Set(report.variables.flatMap(({ sensitivities }) => [...sensitivities.keys()]))
  const members = groups(report).map(([name, all]): [string, Quantity[]] => [
    name,
    all.filter(({ index }) => known.has(index)),
  ])
  return members.filter(([, found]) => found.length > 0)
}

/** Variables by unit and the quantities offered; of either those that the words name, where they name any. */
export function grid(report: Report, offered: Quantity[], words: string): Grid {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean)
  const named = <T extends { name: string }>(things: T[]) => {
    const found = things.filter(({ name }) => wanted.some((word) => name.toLowerCase().includes(word)))
    return found.length > 0 ? found : things
  }
  const quantities = named(offered)
  const variables = named(report.variables.filter(({ sensitivities }) => sensitivities.size > 0))
  const units = [...new Set(variables.map(({ unit }) => unit))]
  const rows = units.flatMap((unit): Row[] => [
    { unit },
    ...variables.filter((variable) => variable.unit === unit).map((variable) => ({ unit, variable })),
  ])
  return { rows, quantities }
}

/** The cells of one order, ranked once per quantity. */
export class Cells {
  /** By the indices of quantity and variable: those of a design changed since are the same. */
  readonly #columns = new Map<number, Map<number, Cell>>()

  constructor(
    readonly report: Report,
    readonly order: Order,
  ) {}

  /** Nothing where the sensitivity is not known. */
  at(quantity: Quantity, variable: Variable): Cell | undefined {
    return this.#column(quantity).get(variable.index)
  }

  /** The largest magnitude of a column among variables of a unit. */
  largest(quantity: Quantity, unit: string): number {
    let largest = 0
    for (const [variable, { extreme }] of this.#column(quantity)) {
      if (this.report.variables[variable].unit === unit) largest = Math.max(largest, Math.abs(extreme))
    }
    return largest
  }

  /** `d toe / d lca_x: -0.31 deg/mm`. */
  text(quantity: Quantity, variable: Variable): string {
    const cell = this.at(quantity, variable)
    const name = derivativeName(quantity, this.order, variable)
    if (!cell) return `${name}: not known`
    const unit = derivativeUnit(quantity, this.order, variable)
    return `${name}: ${cell.share === 0 ? '≈ 0' : figure(cell.extreme, unit)}`
  }

  #column({ index }: Quantity): Map<number, Cell> {
    const known = this.#columns.get(index)
    if (known) return known
    const column = new Map<number, Cell>()
    for (const peers of ranking(this.report, this.report.quantities[index], this.order).values()) {
      for (const { variable, sensitivity, share } of peers) {
        const extreme = sensitivity.extremes[this.order]
        column.set(variable.index, { extreme: share === 0 ? 0 : extreme, share: Math.sign(extreme) * share })
      }
    }
    this.#columns.set(index, column)
    return column
  }
}
