"""Solved motions."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import _native, display, plots, stored
from .arguments import amount, by_name, checked, count, listed, number, together
from .arrays import free, frozen
from .errors import CannotFollow, Diagnostic, UsageError, diagnostics, index_of

if TYPE_CHECKING:
    import pandas
    import pyarrow
    import xarray

    from .model import Model


@dataclass(frozen=True)
class Metric:
    """One number of a measure's curve."""

    name: str
    unit: str
    value: float
    """Value; NaN if the motion ends before it is defined."""
    time: float | None
    """Time of the value, s; `None` if it depends on the whole curve."""
    error: float | None
    """Error of the interpolation between output times."""
    sensitivities: dict[str, float]
    """Derivatives by the admissible design variables."""


class Body:
    """The motion of a body's frame in the world, `[time, ...]`, in the model's units."""

    def __init__(self, name: str, numbers: np.ndarray):
        self.name = name
        self.position = numbers[:, 0:3]
        """`[time, 3]`, length."""
        self.quaternion = numbers[:, 3:7]
        """`[time, 4]`, w x y z, unit; w >= 0 at the first output time, and continuous from there."""
        self.velocity = numbers[:, 7:10]
        self.angular_velocity = numbers[:, 10:13]
        self.acceleration = numbers[:, 13:16]
        self.angular_acceleration = numbers[:, 16:19]

    def __repr__(self) -> str:
        return f"<hardpoint.Body {self.name!r}: {len(self.position)} output times>"


class BodySensitivity:
    """Derivatives of a body's motion by a design variable at fixed time, `[time, 3]` each, in the model's units per unit of it."""

    def __init__(self, name: str, numbers: np.ndarray):
        self.name = name
        self.position = numbers[:, 0:3]
        self.rotation = numbers[:, 3:6]
        """Derivative of the orientation, as a rotation vector: dA/db = skew(rotation) A."""
        self.velocity = numbers[:, 6:9]
        self.angular_velocity = numbers[:, 9:12]
        self.acceleration = numbers[:, 12:15]
        self.angular_acceleration = numbers[:, 15:18]

    def __repr__(self) -> str:
        return f"<hardpoint.BodySensitivity of {self.name!r}: {len(self.position)} output times>"


class Reaction:
    """The reaction of a joint on its second body over the output times, `[time, 3]` each; forces in N, moments in N m. Components that
    redundant constraints leave undetermined are NaN."""

    def __init__(self, name: str, body: str, numbers: np.ndarray):
        self.name = name
        self.body = body
        """Second body of the joint, on which the reaction acts."""
        self.place = numbers[:, 0:3]
        """Point of application in the world, length."""
        self.force = numbers[:, 3:6]
        """Force in the world, N, with those of drivers on the joint's coordinates."""
        self.moment = numbers[:, 6:9]
        """Moment about the point in the world, N m."""
        self.force_in_body = numbers[:, 9:12]
        """Force in axes that coincide with the world's in the design configuration and turn with the body, N."""
        self.moment_in_body = numbers[:, 12:15]
        """Moment in the same axes, N m."""

    def __repr__(self) -> str:
        largest = np.sqrt(np.nansum(self.force**2, axis=1)).max(initial=0.0)
        return f"<hardpoint.Reaction of {self.name!r} on {self.body!r}: force up to {largest:.6g} N>"


class DriverLoad:
    """What a driver has to apply over the output times, `[time]` each."""

    def __init__(self, name: str, unit: str, numbers: np.ndarray):
        self.name = name
        self.unit = unit
        """Unit of the force: N, or N m of a moment."""
        self.force = numbers[:, 0]
        """Force or moment; positive if it does positive work when the driven coordinate increases."""
        self.speed = numbers[:, 1]
        """Speed of the driven coordinate, in its unit per s."""
        self.power = numbers[:, 2]
        """Power, W."""

    def __repr__(self) -> str:
        return f"<hardpoint.DriverLoad of {self.name!r}: up to {np.abs(self.force).max(initial=0.0):.6g} {self.unit}>"


class Deflection:
    """Deflection of an elastic joint or bushing in one direction over the output times, `[time]` each: displacement of the second body
    relative to the first along an axis of the joint or bushing, or rotation about it."""

    def __init__(self, name: str, direction: str, units: tuple[str, str], numbers: np.ndarray):
        self.name = name
        self.direction = direction
        """`x`, `y`, `z`, `about_x`, `about_y` or `about_z`."""
        self.unit, self.force_unit = units
        self.displacement = numbers[:, 0]
        """Displacement or angle, zero in the design configuration."""
        self.force = numbers[:, 1]
        """Elastic force or moment on the second body in this direction, N or N m."""

    def __repr__(self) -> str:
        largest = np.abs(self.displacement).max(initial=0.0)
        return f"<hardpoint.Deflection of {self.name!r}, {self.direction}: up to {largest:.6g} {self.unit}>"


@checked
class Run:
    """The motion of one design in one case. Arrays cover the solved output times; they are created on first use, and slices are views.
    They are read-only: copy them to change values."""

    def __init__(self, model: Model, case: int, native: Union[_native.Run, stored.Stored]):
        self.model = model
        self._index = case
        self._native = native
        self._by_order: dict[int, np.ndarray] = {}
        stop = native.stop
        self.stop: Diagnostic | None = diagnostics(stop)[0] if stop else None
        """Reason why the motion ends before the last output time."""

    @property
    def case(self) -> str | None:
        """Name of the case."""
        return self.model.cases[self._index] if self.model.cases else None

    @cached_property
    def times(self) -> np.ndarray:
        """Output times that were solved, s."""
        return self._native.times

    @cached_property
    def design(self) -> dict[str, float]:
        """Values of all design variables."""
        return dict(zip(self.model.variables, self._native.design))

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        end = f", stopped: {self.stop.message}" if self.stop else ""
        return f"<hardpoint.Run of {self.model.name!r}: {amount(len(self), 'output time')}{end}>"

    # Measures and points

    @cached_property
    def _values(self) -> np.ndarray:
        return self._native.values()

    def values(self, name: str, order: int | str = 0) -> np.ndarray:
        """Values of a measure, or of a coordinate of a point (`wheel.x`), over the output times; `order` 1 is its rate, 2 its acceleration.
        NaN where it is undefined, such as the curvature of the path of a point at rest."""
        index = self.model._output(name)
        return self._values[index, self.model._order(order, [name])]

    def _derivatives(self, order: int) -> np.ndarray:
        if not self._followed:
            raise UsageError.saying("the run was solved without sensitivities; leave `sensitivities=False` out")
        if order not in self._by_order:
            self._by_order[order] = self._native.sensitivities(order)
        return self._by_order[order]

    @cached_property
    def _followed(self) -> list[tuple[bool, str | None]]:
        return self._native.followed

    @property
    def followed(self) -> tuple[str, ...]:
        """Admissible design variables: those with sensitivities."""
        return tuple(name for name, (yes, _) in zip(self.model.variables, self._followed) if yes)

    def _follow(self, variable: str) -> int:
        index = self.model._variable(variable)
        if self._followed:
            yes, why = self._followed[index]
            if not yes:
                raise CannotFollow(diagnostics(why)) if why else CannotFollow.saying(f"`{variable}` is inadmissible")
        return index

    def sensitivity(self, name: str, variable: str, order: int | str = 0) -> np.ndarray:
        """Exact derivative of a measure or point coordinate by a design variable over the output times, at fixed time, in the unit of the
        output per unit of the variable. Raises `CannotFollow` if the variable is inadmissible."""
        index, order = self.model._output(name), self.model._order(order, [name])
        by = self._follow(variable)
        return self._derivatives(order)[index, by]

    def sensitivities(self, name: str | None = None, variables: Iterable[str] | None = None, order: int | str = 0) -> np.ndarray:
        """Derivatives of one output, `[variable, time]`, or of all outputs, `[output, variable, time]`, by some design variables; by
        default, by all in `followed`."""
        chosen = list(self.followed) if variables is None else listed("variables", variables)
        by = [self._follow(variable) for variable in chosen]
        order = self.model._order(order, [] if name is None else [name])
        found = self._derivatives(order)
        # If all variables are admissible, nothing is copied.
        found = found if by == list(range(found.shape[1])) else frozen(found[:, by])
        return found if name is None else found[self.model._output(name)]

    # Bodies

    def _body(self, name: str) -> int:
        return 1 + index_of("body", name, self.model.bodies)

    def body(self, name: str) -> Body:
        """Motion of a body."""
        return Body(name, self._native.body(self._body(name)))

    def body_sensitivity(self, name: str, variable: str) -> BodySensitivity:
        """Derivatives by a design variable."""
        by = self._follow(variable)
        if not self._followed:
            raise UsageError.saying("the run was solved without sensitivities; leave `sensitivities=False` out")
        return BodySensitivity(name, self._native.body_sensitivity(self._body(name), by))

    # Loads

    @cached_property
    def _loads(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        _, joints, drivers, deflections = self.model._native.loads(self._index, list(self._native.design))
        return joints, drivers, deflections

    def reaction(self, joint: str) -> Reaction:
        """Reaction of a joint, by its name (docs/loads.md). The model needs masses or forces."""
        k = index_of("joint", joint, [one["name"] for one in self.model.joints])
        return Reaction(joint, self.model.joints[k]["bodies"][1], self._loads[0][:, k])

    def driver(self, name: str) -> DriverLoad:
        """Force or moment of a driver, by its name, with its speed and power. The model needs masses or forces."""
        k = index_of("driver", name, [one["name"] for one in self.model.drivers])
        return DriverLoad(name, self.model.drivers[k]["force_unit"], self._loads[1][:, k])

    def deflection(self, force: str, direction: str) -> Deflection:
        """Deflection of an elastic joint or bushing, by the name of the force, in a direction such as `z` or `about_x`. Without
        `[equilibrium]` elastic joints are rigid. Derivatives are those of a measure of `type = "deflection"`."""
        known = self.model._info["deflections"]
        index_of("elastic joint or bushing", force, list(dict.fromkeys(one["force"] for one in known)))
        own = {one["direction"]: k for k, one in enumerate(known) if one["force"] == force}
        index_of(f"elastic direction of `{force}`", direction, list(own))
        k = own[direction]
        return Deflection(force, direction, (known[k]["unit"], known[k]["force_unit"]), self._loads[2][:, k])

    @cached_property
    def _rigid(self) -> np.ndarray | None:
        return self.model._native.rigid(self._index, list(self._native.design), list(self.times))

    def rigid_values(self, name: str) -> np.ndarray:
        """Values of a measure, or of a coordinate of a point, for the rigid mechanism over the output times: all elastic joints are closed,
        and the drivers move as in this run. NaN for loads and compliances. With `released` drivers there is none. Without `[equilibrium]`
        the mechanism is rigid, and the values are those of this run."""
        index = self.model._output(name)
        return self.values(name) if self._rigid is None else self._rigid[index]

    # Metrics and diagnostics

    @cached_property
    def metrics(self) -> dict[str, Metric]:
        """Metrics of the case, with their exact derivatives."""
        values, d = self._native.metrics()
        followed = [k for k, (yes, _) in enumerate(self._followed) if yes]
        names = list(self.model.variables)
        return {
            name: Metric(
                name,
                unit,
                float(values[k, 0]),
                None if np.isnan(values[k, 1]) else float(values[k, 1]),
                None if np.isnan(values[k, 2]) else float(values[k, 2]),
                {names[b]: float(d[k, b]) for b in followed},
            )
            for k, (name, unit) in enumerate(self.model.metrics(self.case).items())
        }

    def metric(self, name: str) -> float:
        """Value of a metric."""
        index_of("metric", name, self.metrics)
        return self.metrics[name].value

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Diagnostics of the motion: inadmissible variables, variables without effect, positions near a dead point."""
        return diagnostics(self._native.diagnostics())

    def summary(self) -> dict:
        """Contents of the command's `summary.json`."""
        return json.loads(self._native.summary())

    def page(self) -> display.Page:
        """The page that `hardpoint run` writes: a studio with the engine. Display it in a notebook, or save it."""
        return display.Page(self._native.page())

    def _repr_html_(self) -> str:
        return display.run(self)

    def plot(
        self,
        names: str | Sequence[str] | None = None,
        *,
        over: str | None = None,
        order: int | str = 0,
        by: str | None = None,
        others: Mapping[str, Run] | None = None,
        ax: Any = None,
        **style: Any,
    ) -> Any:
        """Plots curves with matplotlib: `run.plot("toe", over="wheel_travel")`.

        `names` are one or several measures or coordinates of points (all measures), each in a diagram of its own; `over` is the measure
        on the horizontal axis (the time). `order` 1 is the rate, 2 the acceleration; `by` names a design variable whose sensitivity is
        plotted. `others` are further runs by their labels. Returns the axes, an array of them for several quantities; `hardpoint.plot`
        plots any runs.
        """
        runs = self if others is None else together({"this run": self}, by_name("others", others))
        return plots.plot(runs, names, over=over, order=order, by=by, ax=ax, **style)

    def animate(self, *, seconds: float = 4.0, frames: int = 60, size: float = 5.0) -> Any:
        """Animation of the mechanism's skeleton with matplotlib, `size` inches wide: a notebook plays it, `.save("motion.gif")` writes
        it. `run.page()` has the mechanism in colour, with the engine."""
        long, wide, pictures = number("`seconds`", seconds), number("`size`", size), count("frames", frames)
        if not long > 0 or not wide > 0 or pictures is None:
            raise UsageError.saying("`seconds`, `frames` and `size` are positive")
        if not len(self):
            raise UsageError.saying("no output time was solved: there is nothing to animate")
        return plots.animation(self, long, pictures, wide)

    def save(self, path: str | os.PathLike) -> None:
        """Writes the run with its model, atomically; `hardpoint.load_run(path)` reads it without solving anything."""
        stored.save(self, path)

    def __reduce__(self) -> Any:
        return stored.unpacked, (stored.packed(self),)

    # Tables

    def _columns(self) -> dict[str, np.ndarray]:
        columns = {"time [s]": self.times}
        for name, output in self.model.outputs.items():
            for order, (column, unit) in enumerate(zip(output.columns, output.units)):
                columns[free(column if unit == "1" else f"{column} [{unit}]", columns)] = self.values(name, order)
        return columns

    def to_pandas(self) -> pandas.DataFrame:
        """Table over time with a column for each measure, point and rate."""
        import pandas

        return pandas.DataFrame(self._columns())

    def to_arrow(self) -> pyarrow.Table:
        """Arrow table, with the unit of each column in its metadata. A measure with the name `time` is `time_`."""
        import pyarrow

        columns = {"time": (self.times, "s")}
        for name, output in self.model.outputs.items():
            for order, (column, unit) in enumerate(zip(output.columns, output.units)):
                columns[free(column, columns)] = (self.values(name, order), unit)
        fields = [pyarrow.field(column, pyarrow.float64(), metadata={"unit": unit}) for column, (_, unit) in columns.items()]
        return pyarrow.Table.from_arrays([pyarrow.array(values) for values, _ in columns.values()], schema=pyarrow.schema(fields))

    def to_xarray(self) -> xarray.Dataset:
        """Values `[time]` and sensitivities `[variable, time]` of every measure and point, with their labels and units: `toe`, `d toe`.

        A name that is taken ends in `_`: a measure named `time` is `time_`, since `time`, `variable` and `variable_unit` are
        coordinates; and if there is a measure named `d toe`, the sensitivities of `toe` are `d toe_`. The attribute `of` has the name in
        the model.
        """
        import xarray

        coordinates: dict[str, Any] = {"time": ("time", self.times, {"units": "s"})}
        if self._followed:
            units = [self.model.variables[v].unit for v in self.followed]
            coordinates["variable"] = ("variable", list(self.followed))
            coordinates["variable_unit"] = ("variable", units)
        data: dict[str, Any] = {}
        slopes = []
        for name, output in self.model.outputs.items():
            for order, (column, unit) in enumerate(zip(output.columns, output.units)):
                data[free(column, coordinates, data)] = ("time", self.values(name, order), {"units": unit, "of": column})
                slopes.append((name, order, column, unit))
        for name, order, column, unit in slopes if self._followed else ():
            attributes = {"units": f"{unit} per unit of the variable", "of": column}
            data[free(f"d {column}", coordinates, data)] = (("variable", "time"), self.sensitivities(name, order=order), attributes)
        return xarray.Dataset(data, coordinates, {"model": self.model.name, "case": self.case or ""})
