"""Results of studies."""

from __future__ import annotations

import functools
import json
import os
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from . import display
from .arguments import Called, amount, numbers, same_shape
from .arrays import free
from .errors import UsageError, index_of

if TYPE_CHECKING:
    import pandas
    import pyarrow
    import xarray

    from .model import Model


PREFERRED = ("points", "metrics", "measures", "variables")
"""Facts that a study's table has by default: the first available one."""


class Study:
    """A finished study: `facts` are those that the command line writes as JSON (docs/results.md), `tables` those that it prints."""

    def __init__(
        self, model: Model | None, facts: dict[str, Any], tables: list[dict], rounded: list[float] | None, exact: list[float] | None
    ):
        self.model = model
        """Model of the study; `None` of a synthesis, which begins with a task."""
        self.facts = facts
        self.tables = tables
        names = list(model.variables) if model else []
        self.design: dict[str, float] | None = dict(zip(names, exact)) if exact else None
        """Resulting design: the values of all design variables."""
        self.rounded: dict[str, float] | None = dict(zip(names, rounded)) if rounded else None
        """Resulting design with rounded numbers, as saved."""

    @property
    def status(self) -> str | None:
        """Status at the end."""
        return self.facts.get("status")

    @property
    def message(self) -> str | None:
        """Status as a sentence, with a suggested action."""
        return self.facts.get("message")

    def text(self) -> str:
        """Text of the model file with the resulting design."""
        model, design = self._found()
        return model.edited(design)

    def save(self, path: str | os.PathLike) -> None:
        """Writes the model file with the resulting design, atomically."""
        model, design = self._found()
        model.save(path, design)

    def _found(self) -> tuple[Model, dict[str, float]]:
        if self.model is None or self.rounded is None:
            raise UsageError.saying("the study has no resulting design")
        return self.model, self.rounded

    @property
    def _title(self) -> str:
        return self.model.name if self.model else str(self.facts.get("task", ""))

    @property
    def records(self) -> tuple[str, ...]:
        """Names of the facts that are tables, for `to_pandas` and `to_xarray`."""
        return tuple(name for name, rows in self.facts.items() if isinstance(rows, list) and rows and all(isinstance(row, dict) for row in rows))

    def to_pandas(self, name: str | None = None) -> pandas.DataFrame:
        """Table of one of the `records`, by default the first available of `points`, `metrics`, `measures` and `variables`."""
        import pandas

        return pandas.json_normalize(self.facts[self._record(name)])

    def to_xarray(self, name: str | None = None) -> xarray.Dataset:
        """Data set of one of the `records`, by the names of its rows, or else by their numbers."""
        record = self._record(name)
        frame = self.to_pandas(record)
        is_named = "name" in frame and frame["name"].is_unique
        frame = frame.set_index("name") if is_named else frame.rename_axis(record.rstrip("s"))
        return frame.to_xarray().assign_attrs(model=self._title, study=str(self.facts.get("study", "")))

    def _record(self, name: str | None) -> str:
        if name is None:
            name = next((one for one in (*PREFERRED, *self.records) if one in self.records), "")
        index_of("table of this study", name, self.records)
        return name

    def __repr__(self) -> str:
        return f"<hardpoint.Study of {self._title!r}: {self.message or self.facts.get('study', 'done')}>"

    def _repr_html_(self) -> str:
        return display.study(self)


class Map(dict[str, Any]):
    """A map over the positions of two drivers, as `maps.json` has it (docs/results.md)."""

    def to_xarray(self) -> xarray.Dataset:
        """Values and sensitivities of all measures by the positions of both drivers; NaN where a position was not reached. A measure
        with the name of a driver ends in `_`."""
        import xarray

        first, second = self["drivers"]
        axes = (second["name"], first["name"])
        data: dict[str, Any] = {}
        for measure in self["measures"]:
            values = np.array(measure["values"], dtype=float)
            data[free(measure["name"], axes, data)] = (axes, values, {"units": measure["unit"]})
            for one in measure["sensitivities"]:
                attributes = {"units": one["unit"]}
                data[free(f"d {measure['name']} / d {one['variable']}", axes, data)] = (axes, np.array(one["values"], dtype=float), attributes)
        coordinates = {d["name"]: (d["name"], np.array(d["values"], dtype=float), {"units": d["unit"]}) for d in (first, second)}
        return xarray.Dataset(data, coordinates, {"map": self["name"]})

    def to_pandas(self) -> pandas.DataFrame:
        """Table with a row for each position."""
        return self.to_xarray().to_dataframe().reset_index()


class DriverTable(dict[str, Any]):
    """A table of outputs over one to three drivers with a proved error, as `hardpoint map` writes it (docs/maps.md).

    `table("toe", bump=12.5)` is the interpolation whose error is proved; drivers may be arrays."""

    @property
    def drivers(self) -> dict[str, np.ndarray]:
        """Knots of each driver."""
        return {axis["name"]: np.array(axis["knots"], dtype=float) for axis in self["drivers"]}

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the outputs."""
        return tuple(one["name"] for one in self["outputs"])

    @property
    def proved_error(self) -> dict[str, float]:
        """Proved bound of the error of each output, in its unit."""
        return {one["name"]: one["proved_error"] for one in self["outputs"]}

    def __call__(self, output: str, /, **at: Any) -> np.ndarray:
        """Values of an output at positions of all drivers; outside of the table's ranges, an error."""
        terms = self._of(output)["numbers"]
        axes = self.drivers
        for name in at:
            index_of("driver of this table", name, axes)
        if missing := [name for name in axes if name not in at]:
            raise UsageError.saying(f"the table is over {', '.join(f'`{name}`' for name in axes)}: give `{missing[0]}` too")
        places = list(same_shape("drivers", {name: numbers(f"driver `{name}`", at[name]) for name in axes}).values())
        cells, weights = [], []
        for (name, knots), x in zip(axes.items(), places):
            # Numbers of the user that are one in SI may differ in their last bit.
            if not np.all((np.nextafter(knots[0], -np.inf) <= x) & (x <= np.nextafter(knots[-1], np.inf))):
                raise UsageError.saying(f"`{name}` is outside of the table's range {knots[0]:g} .. {knots[-1]:g}")
            x = np.clip(x, knots[0], knots[-1])
            cell = np.clip(np.searchsorted(knots, x, side="right") - 1, 0, len(knots) - 2)
            width = knots[cell + 1] - knots[cell]
            cells.append(cell)
            weights.append(_weights((x - knots[cell]) / width, width, self["interpolation"] == "hermite"))
        total = np.zeros(places[0].shape)
        for one in terms:
            values = np.reshape(one["values"], [len(knots) for knots in axes.values()])
            orders = [int(name in one["by"]) for name in axes]
            for corner in np.ndindex(*(2,) * len(axes)):
                weight = np.prod([of[end][order] for of, end, order in zip(weights, corner, orders)], axis=0)
                total += weight * values[tuple(cell + end for cell, end in zip(cells, corner))]
        return total

    def to_xarray(self) -> xarray.Dataset:
        """Values and derivatives at the knots. An output with the name of a driver ends in `_`."""
        import xarray

        axes = tuple(self.drivers)
        shape = [len(knots) for knots in self.drivers.values()]
        data: dict[str, Any] = {}
        for one in self["outputs"]:
            for term in one["numbers"]:
                name = " by ".join([one["name"], *term["by"]])
                data[free(name, axes, data)] = (axes, np.reshape(term["values"], shape), {"units": term["unit"]})
        coordinates = {axis["name"]: (axis["name"], np.array(axis["knots"], dtype=float), {"units": axis["unit"]}) for axis in self["drivers"]}
        return xarray.Dataset(data, coordinates, {"model": self["model"], "interpolation": self["interpolation"]})

    def _of(self, output: str) -> dict[str, Any]:
        return self["outputs"][index_of("output of this table", output, self.outputs)]

    def __repr__(self) -> str:
        return f"<hardpoint.DriverTable of {', '.join(self.outputs)} over {', '.join(self.drivers)}: {amount(self['cells'], 'cell')}, {self['interpolation']}>"


def _weights(u: np.ndarray, width: np.ndarray, is_cubic: bool) -> list[list[np.ndarray]]:
    """Weights of the value and of the derivative at both ends of a cell, at `u` between 0 and 1."""
    if not is_cubic:
        return [[1 - u], [u]]
    # Cubic Hermite polynomials.
    rest = 1 - u
    return [[(1 + 2 * u) * rest**2, u * rest**2 * width], [u**2 * (3 - 2 * u), -(u**2) * rest * width]]


def timed(method: Called) -> Called:
    """Method whose study states its time, s, in its facts."""

    @functools.wraps(method)
    def call(*values: Any, **given: Any) -> Any:
        began = time.perf_counter()
        found = method(*values, **given)
        found.facts["seconds"] = time.perf_counter() - began
        return found

    return call  # type: ignore[return-value]


def outcome(model: Model, text: str, rounded: list[float] | None = None, exact: list[float] | None = None) -> Study:
    found = json.loads(text)
    return Study(model, found["facts"], found["tables"], rounded, exact)


class SweepResult(Study):
    """A finished sweep."""

    def __init__(self, model: Model, columns: dict[str, Any], curves: dict[str, Any], found: dict):
        super().__init__(model, found["facts"], found["tables"], None, None)
        self.columns: dict[str, np.ndarray | list[str]] = columns
        """Table of designs: number, variables, metrics, and the reason of a failure (docs/sweep.md). Undefined values are NaN."""
        self.curves: dict[str, np.ndarray | list[str]] = curves
        """Table of curves; empty if none were requested."""

    def __len__(self) -> int:
        return len(self.columns["design"])

    def to_pandas(self, name: str | None = None) -> pandas.DataFrame:
        """Table of designs; or `curves`; or one of the `records`."""
        import pandas

        if name == "curves":
            return pandas.DataFrame(self.curves)
        return pandas.DataFrame(self.columns) if name is None else super().to_pandas(name)

    def to_xarray(self, name: str | None = None) -> xarray.Dataset:
        """Data set of designs; or `curves`, by design, case and time; or one of the `records`."""
        if name is not None and name != "curves":
            return super().to_xarray(name)
        frame = self.to_pandas(name)
        return frame.set_index([key for key in ("design", "case", "time [s]") if key in frame]).to_xarray()

    def to_arrow(self) -> pyarrow.Table:
        """Table of designs."""
        import pyarrow

        return pyarrow.table(self.columns)
