"""Positions as functions of the drivers."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native, arguments
from .arrays import free, frozen
from .errors import CannotFollow, Diagnostic, MotionStopped, UsageError, diagnostics, index_of

if TYPE_CHECKING:
    import pandas
    import xarray

    from .model import Model, Progress

Forces = tuple[tuple[str, float], ...]
"""Values of forces by name, in the order of the names."""
TOO_FAR = "HP0408"
"""Code of a driver that moves farther than the program follows it."""
LAST = 2
"""Output time of the engine at which the mechanism is at rest in the position."""


class Positions:
    """The mechanism at rest with its drivers at given values, as `model.at(travel=12)` returns it.

    A driver may have an array of values: results then have its shape. Single values give numbers. Results that need a motion,
    such as velocities, are not available. Positions that cannot be reached are NaN, if they were permitted with `partial`.
    """

    def __init__(
        self,
        model: Model,
        forces: Forces,
        drivers: dict[str, np.ndarray],
        shape: tuple[int, ...],
        rows: np.ndarray,
        values: np.ndarray,
        slopes: np.ndarray | None,
        stops: dict[int, Diagnostic],
    ):
        self.model = model
        self._solver = model._solver(forces)
        self._shape = shape
        self._rows = rows
        self._values = frozen(values)
        self._slopes = None if slopes is None else frozen(slopes)
        self._bodies: dict[int, _native.Run] = {}
        self.drivers: dict[str, np.ndarray] = {name: frozen(array) for name, array in drivers.items()}
        """Values of all drivers."""
        self.stops: dict[int, Diagnostic] = stops
        """Positions that cannot be reached, by their number in order, with the reason."""

    def __reduce__(self) -> Any:
        forces = self._solver.forces
        return Positions, (self.model, forces, self.drivers, self._shape, self._rows, self._values, self._slopes, self.stops)

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

    def to_pandas(self) -> pandas.DataFrame:
        """Table with a row for each position: the drivers, then all measures and points, with their units."""
        import pandas

        columns = {f"{name} [{self._solver.units[name]}]": np.ravel(values) for name, values in self.drivers.items()}
        for name, unit, values in self._outputs():
            columns[free(name if unit == "1" else f"{name} [{unit}]", columns)] = values
        return pandas.DataFrame(columns)

    def to_xarray(self) -> xarray.Dataset:
        """Values of every measure and point over the drivers, and with sensitivities their derivatives by the design variables and by the
        drivers: `toe`, `d toe`.

        A dimension over which a single driver changes has its name; others are `position`, or `position_0`, `position_1`, ... A name that
        is taken ends in `_`, as in `run.to_xarray()`.
        """
        import xarray

        units = self._solver.units
        dims = self._dimensions()
        coordinates: dict[str, Any] = {}
        for name, values in self.drivers.items():
            # A driver along a dimension has one value at each of its places.
            along = (name,) if name in dims else dims if np.ptp(values) else ()
            keep = tuple(slice(None) if dim in along else 0 for dim in dims)
            coordinates[name] = (along, values[keep], {"units": units[name]})
        if self._slopes is not None:
            by = {name: variable.unit for name, variable in self.model.variables.items()}
            for name in self.drivers:
                by[free(name, by)] = units[name]
            coordinates["variable"] = ("variable", list(by))
            coordinates["variable_unit"] = ("variable", list(by.values()))
        data: dict[str, Any] = {}
        for name, unit, values in self._outputs():
            data[free(name, coordinates, dims, data)] = (dims, values.reshape(self._shape), {"units": unit, "of": name})
        if self._slopes is not None:
            for name, unit, _ in self._outputs():
                slopes = self._slopes[:, self.model._output(name)].T.reshape(-1, *self._shape)
                attributes = {"units": f"{unit} per unit of the variable", "of": name}
                data[free(f"d {name}", coordinates, dims, data)] = (("variable", *dims), slopes, attributes)
        return xarray.Dataset(data, coordinates, {"model": self.model.name})

    def _outputs(self) -> Iterator[tuple[str, str, np.ndarray]]:
        """Name, unit and values of every output that has a value at rest."""
        for name, output in self.model.outputs.items():
            if output.at_rest:
                yield name, output.units[0], self._values[:, self.model._output(name)]

    def _dimensions(self) -> tuple[str, ...]:
        """Names of the dimensions of the results."""
        found: list[str] = []
        changing = {name: [k for k in range(len(self._shape)) if np.ptp(values, axis=k).any()] for name, values in self.drivers.items()}
        for k in range(len(self._shape)):
            own = [name for name, axes in changing.items() if k in axes]
            is_axis = len(own) == 1 and changing[own[0]] == [k]
            found.append(own[0] if is_axis else free("position" if len(self._shape) == 1 else f"position_{k}", self.drivers, found))
        return tuple(found)


def spread(values: np.ndarray) -> str:
    """Formats one value, or the range of several."""
    low, high = float(np.min(values, initial=np.inf)), float(np.max(values, initial=-np.inf))
    return f"{low:.6g}" if low == high else f"{low:.6g} to {high:.6g}" if low < high else "none"


class Solver:
    """The model whose design variables are those of another model, and then its drivers."""

    def __init__(self, model: Model, forces: Forces):
        self.model = model
        self.forces = forces
        self.native = model._native.positioned(list(forces))
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
        drivers = {name: np.broadcast_to(value, shape).copy() for name, value in values.items()}
        own = self.model._values(design) or [np.nan] * len(self.model.variables)
        moved = [np.ravel(drivers[name]) - start for name, start in self.nominal.items()]
        rows = np.column_stack([np.tile(own, (int(np.prod(shape)), 1)), *moved])
        outputs = list(range(len(self.model.outputs)))
        found = self.native.designs(0, rows, outputs, 0, [LAST], sensitivities, False, workers, listener(progress))
        d = found["sensitivities"]
        slopes = d[..., 0] if d.size or not len(rows) else None
        stops = {number: self.stop(rows[number], diagnostics(why)[0]) for number, why in found["stops"]}
        solved = Positions(self.model, self.forces, drivers, shape, rows, found["values"][:, :, 0], slopes, stops)
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
        is_too_far = why.code == TOO_FAR
        end = "the limit of the program, not of the mechanism, is" if is_too_far else "on the way from the design configuration it stops at"
        place = f": {end} {', '.join(reached)}" if reached else ""
        message = f"the mechanism cannot be moved to {', '.join(asked) or 'the design configuration'}{place}"
        limit = "within 100,000 rad, or 100,000 sizes of the mechanism" if is_too_far else "before that, or change the design"
        help = f"ask for a position {limit}; `partial=True` returns the positions that can be reached"
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


