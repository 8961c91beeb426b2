"""Positions as functions of the drivers."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native, arguments
from .arrays import frozen
from .errors import CannotFollow, Diagnostic, MotionStopped, UsageError, diagnostics, index_of

if TYPE_CHECKING:
    from .model import Model, Progress

LAST = 2
"""Output time of the engine at which the mechanism is at rest in the position."""


class Positions:
    """The mechanism at rest with its drivers at given values, as `model.at(travel=12)` returns it.

    A driver may have an array of values: results then have its shape. Single values give numbers. Results that need a motion,
    such as velocities, are not available. Positions that cannot be reached are NaN, if they were permitted with `partial`.
    """

    def __init__(self, model: Model, solver: Solver, drivers: dict[str, np.ndarray], shape: tuple[int, ...], rows: np.ndarray, found: dict):
        self.model = model
        self._solver = solver
        self._shape = shape
        self._rows = rows
        self._values: np.ndarray = found["values"][:, :, 0]
        self._slopes: np.ndarray | None = found["sensitivities"][..., 0] if found["sensitivities"].size or not len(rows) else None
        self._bodies: dict[int, _native.Run] = {}
        self.drivers: dict[str, np.ndarray] = drivers
        """Values of all drivers."""
        self.stops: dict[int, Diagnostic] = {number: solver.stop(rows[number], diagnostics(why)[0]) for number, why in found["stops"]}
        """Positions that cannot be reached, by their number in order, with the reason."""

    def __len__(self) -> int:
        return len(self._rows)

    def __repr__(self) -> str:
        units = self._solver.units
        named = ", ".join(f"{name} = {spread(values)} {units[name]}" for name, values in self.drivers.items())
        stopped = f", {len(self.stops)} not reached" if self.stops else ""
        return f"<hardpoint.Positions of {self.model.name!r}: {len(self)} at {named}{stopped}>"

    def __getitem__(self, name: str) -> Any:
        return self.value(name)

    def value(self, name: str) -> Any:
        """Value of a measure, or of a coordinate of a point (`wheel.x`)."""
        return self._shaped(self._values[:, self._solver.output(name)])

    def derivative(self, name: str, driver: str) -> Any:
        """Exact derivative of a measure or point coordinate by a driver, while all other drivers and the design stay as they are."""
        return self._derivative(name, len(self.model.variables) + index_of("driver", driver, self.drivers), driver)

    def sensitivity(self, name: str, variable: str) -> Any:
        """Exact derivative of a measure or point coordinate by a design variable, while the drivers stay as they are."""
        return self._derivative(name, self.model._variable(variable), variable)

    def _derivative(self, name: str, column: int, by: str) -> Any:
        output = self._solver.output(name)
        if self._slopes is None:
            raise UsageError.saying("the position was solved without sensitivities; leave `sensitivities=False` out")
        found = self._slopes[:, output, column]
        if np.isnan(found).any() and not np.isnan(self._values[np.isnan(found), output]).all():
            raise CannotFollow.saying(f"there is no derivative of `{name}` by `{by}`: the variable is inadmissible")
        return self._shaped(found)

    def _shaped(self, numbers: np.ndarray) -> Any:
        return frozen(np.array(numbers).reshape(self._shape)) if self._shape else float(numbers[0])

    def position(self, body: str) -> np.ndarray:
        """Position of a body's frame in the world, `[..., 3]`."""
        return self._of_body(body, slice(0, 3))

    def quaternion(self, body: str) -> np.ndarray:
        """Orientation of a body's frame, `[..., 4]`: w x y z, unit, w >= 0."""
        found = self._of_body(body, slice(3, 7))
        # That of a motion is continuous instead.
        return frozen(np.where(found[..., :1] < 0, -found, found))

    def _of_body(self, body: str, place: slice) -> np.ndarray:
        number = 1 + index_of("body", body, self.model.bodies)
        rows = np.full((len(self), place.stop - place.start), np.nan)
        for k in range(len(self)):
            if k not in self.stops:
                if k not in self._bodies:
                    self._bodies[k] = self._solver.native.run(0, self._rows[k].tolist(), False)
                rows[k] = self._bodies[k].body(number)[LAST, place]
        return frozen(rows.reshape((*self._shape, rows.shape[1])))

    def to_pandas(self):
        """Table with a row for each position: the drivers, then all measures and points, with their units."""
        import pandas

        columns = {f"{name} [{self._solver.units[name]}]": np.ravel(values) for name, values in self.drivers.items()}
        for name, output in self.model.outputs.items():
            if output.at_rest:
                unit = output.units[0]
                columns[name if unit == "1" else f"{name} [{unit}]"] = self._values[:, self.model._output(name)]
        return pandas.DataFrame(columns)


def spread(values: np.ndarray) -> str:
    """Formats one value, or the range of several."""
    low, high = float(np.min(values, initial=np.inf)), float(np.max(values, initial=-np.inf))
    return f"{low:.6g}" if low == high else f"{low:.6g} to {high:.6g}" if low < high else "none"


class Solver:
    """The model whose design variables are those of another model, and then its drivers."""

    def __init__(self, model: Model, forces: Mapping[str, float]):
        self.model = model
        self.native = model._native.positioned(list(forces.items()))
        self.nominal = {driver["name"]: float(driver["nominal"]) for driver in model.drivers}
        self.units = {driver["name"]: driver["unit"] for driver in model.drivers}

    def output(self, name: str) -> int:
        """Index of an output that has a value at rest."""
        index = self.model._output(name)
        if not self.model._declared(name).at_rest:
            raise UsageError.saying(f"`{name}` needs a motion: it has no value in a position; ask `model.run()` for it")
        return index

    def solve(
        self, given: Mapping[str, Any], design: Any, sensitivities: bool, partial: bool, workers: int | None, progress: Progress
    ) -> Positions:
        from .model import listener

        for name in given:
            index_of("driver", name, self.nominal)
        values = {name: number(name, given[name]) if name in given else np.array(start) for name, start in self.nominal.items()}
        shape = next(iter(arguments.same_shape("drivers", values).values()), np.empty(())).shape
        drivers = {name: frozen(np.broadcast_to(value, shape).copy()) for name, value in values.items()}
        own = self.model._values(design) or [np.nan] * len(self.model.variables)
        moved = [np.ravel(drivers[name]) - start for name, start in self.nominal.items()]
        rows = np.column_stack([np.tile(own, (int(np.prod(shape)), 1)), *moved])
        outputs = list(range(len(self.model.outputs)))
        found = self.native.designs(0, rows, outputs, 0, [LAST], sensitivities, False, workers, listener(progress))
        solved = Positions(self.model, self, drivers, shape, rows, found)
        if solved.stops and not partial:
            raise MotionStopped((next(iter(solved.stops.values())),))
        return solved

    def stop(self, row: np.ndarray, why: Diagnostic) -> Diagnostic:
        """The reason why a position is not reached, in terms of the drivers."""
        first = len(self.model.variables)
        asked, reached = [], []
        last = self.native.run(0, row.tolist(), False).stopped_at or []
        for k, (name, start) in enumerate(self.nominal.items()):
            unit = self.units[name]
            if row[first + k] != 0.0 or len(self.nominal) == 1:
                asked.append(f"`{name}` = {start + row[first + k]:.6g} {unit}")
                reached += [f"`{name}` = {start + last[k]:.6g} {unit}"] if k < len(last) else []
        place = f": on the way from the design configuration it stops at {', '.join(reached)}" if reached else ""
        message = f"the mechanism cannot be moved to {', '.join(asked) or 'the design configuration'}{place}"
        help = "ask for a position before that, or change the design; `partial=True` returns the positions that can be reached"
        # The motion there is ours; its times and steps mean nothing to the reader.
        notes = tuple(note for note in why.notes if " time is t = " not in note and " steps of the changed design " not in note)
        lines = [f"error[{why.code}]: {message}", *(f"  = note: {note}" for note in notes), f"  = help: {help}"]
        return dataclasses.replace(why, message=message, notes=notes, help=help, rendered="\n".join(lines), element=next(iter(self.nominal), None))


def number(name: str, value: Any, what: str = "driver") -> np.ndarray:
    """Values of a driver or force."""
    values = arguments.numbers(f"{what} `{name}`", value)
    if not np.isfinite(values).all():
        raise UsageError.saying(f"{what} `{name}` takes finite numbers, not {value!r}")
    return values


def names(values: Mapping[str, Any] | None, more: Mapping[str, Any]) -> dict[str, Any]:
    """All given drivers, by name."""
    if values is not None and not isinstance(values, Mapping):
        raise UsageError.saying(f"drivers are named: `model.at(travel=12)` or `model.at({{'travel': 12}})`, not {values!r}")
    return arguments.together(values or {}, more)


