"""A mechanism as a function of its design, with exact derivatives, for optimisers and other programs."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .arguments import amount, checked, count, instance, listed, ordered
from .errors import CannotFollow, StudyError, UsageError, index_of, unknown
from .model import Model

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

STEP = 1e-5
"""Step of differences relative to the size of the mechanism or to a radian: the cube root of round-off."""


@dataclass(frozen=True)
class Part:
    """One output of a function: a metric or a curve."""

    name: str
    """Name: `toe`, or `bump.toe` for a model with cases."""
    case: int
    of: str
    is_metric: bool
    unit: str
    place: slice
    """Indices of its values in those of the function."""


@checked
class Function:
    """Metrics and curves of a mechanism, one after the other, as a function of the values of some design variables.

        >>> f = hardpoint.Function(model, ["tie_rod_outer_y", "tie_rod_outer_z"], ["toe"])
        >>> scipy.optimize.least_squares(lambda x: f(x) - wanted, f.start, jac=f.jacobian, bounds=f.bounds)

    `of` names metrics (a number each) and measures or point coordinates (a number for each output time); of a model with cases,
    `case.name`, or a name alone for all cases that have it. A function remembers its last design, so that value and derivatives of the
    same design are solved once.

    Raises `MotionStopped` where a design does not move to its end, `CannotFollow` by a variable that the mechanism cannot follow,
    `StudyError` where a metric has no number. With `stopped`, a number such as `math.nan` or `math.inf`, the values of such designs are
    that number instead, and their derivatives are NaN.

    `many(designs)` solves a row for each design on all cores, and `value` of several designs suits methods that ask for populations:

        >>> f = hardpoint.Function(model, of="toe_error", stopped=math.inf)
        >>> scipy.optimize.differential_evolution(f.value, bounds=list(zip(*f.bounds)), vectorized=True)
    """

    def __init__(
        self,
        model: Model,
        variables: Iterable[str] | None = None,
        of: str | Iterable[str] | None = None,
        *,
        stopped: float | None = None,
        workers: int | None = None,
    ):
        instance("model", model, Model, "hardpoint.Model")
        self.model = model
        if isinstance(stopped, (bool, str, bytes)) or (stopped is not None and not np.isscalar(stopped)):
            raise UsageError.saying(f"`stopped` is a number for designs that do not move to their end, such as `math.nan`, not {stopped!r}")
        self.stopped: float | None = None if stopped is None else float(stopped)
        """Value of designs that do not move to their end; `None` if they raise an exception."""
        self._workers = count("workers", workers)
        chosen = [v.name for v in model.variables.values() if v.bounds] if variables is None else listed("variables", variables)
        if not chosen:
            what = "the model has no design variables with bounds" if variables is None else "`variables` is empty"
            raise UsageError.saying(f"{what}; name the variables")
        self.variables: tuple[str, ...] = tuple(chosen)
        self._columns = [model._variable(name) for name in chosen]
        cases = [model._case or 0] if model._case is not None or not model.cases else list(range(len(model.cases)))
        self._names = {k: model.cases[k] if model.cases else None for k in cases}
        metrics = {k: model.metrics(self._names[k]) for k in cases}
        wanted = [m for k in cases for m in self._known(k, metrics[k])] if of is None else listed("of", of)
        self.parts: tuple[Part, ...] = tuple(self._parts(wanted, cases, metrics))
        self.size: int = self.parts[-1].place.stop if self.parts else 0
        if not self.parts:
            raise UsageError.saying(f"{'the model has no metrics' if of is None else '`of` is empty'}; name measures")
        self._last: tuple[bytes, bool, np.ndarray, np.ndarray | None] | None = None

    def _known(self, case: int, metrics: dict[str, str]) -> list[str]:
        return [self._title(case, name) for name in metrics]

    def _title(self, case: int, name: str) -> str:
        return f"{self._names[case]}.{name}" if self._names[case] is not None and len(self._names) > 1 else name

    def _parts(self, wanted, cases, metrics):
        first, taken = 0, set()
        known = [self._title(k, name) for k in cases for name in [*metrics[k], *self.model.outputs]]
        for asked in wanted:
            found = False
            for k in cases:
                for name, unit in [*metrics[k].items(), *((o.name, o.units[0]) for o in self.model.outputs.values())]:
                    if asked not in (name, self._title(k, name)):
                        continue
                    # A name alone may be that of a case's output, which is also named with its case.
                    if (k, name) in taken:
                        raise UsageError.saying(f"`of` has `{self._title(k, name)}` twice; name it once")
                    taken.add((k, name))
                    is_metric = name in metrics[k]
                    size = 1 if is_metric else len(self.model._info["motions"][k]["times"])
                    yield Part(self._title(k, name), k, name, is_metric, unit, slice(first, first + size))
                    first, found = first + size, True
                    break
            if not found:
                raise unknown("metric or measure", asked, known)

    @property
    def start(self) -> np.ndarray:
        """Nominal values of the variables."""
        return np.array([self.model.variables[name].drawn for name in self.variables])

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds, infinite if the model has none."""
        bounds = [self.model.variables[name].bounds or (-np.inf, np.inf) for name in self.variables]
        return np.array([b[0] for b in bounds]), np.array([b[1] for b in bounds])

    @property
    def steps(self) -> np.ndarray:
        """Suitable steps for central differences: round-off and truncation errors are both small."""
        places = np.array(list(self.model.hardpoints.values()) or [[0.0], [1.0]])
        size = float((places.max(axis=0) - places.min(axis=0)).max()) or 1.0
        radian = 1.0 if self.model.units["angle"] == "rad" else 180 / np.pi
        kinds = {self.model.units["length"]: size, self.model.units["angle"]: radian}
        return np.array([STEP * kinds.get(self.model.variables[name].unit, 1.0) for name in self.variables])

    def design(self, x: ArrayLike) -> dict[str, float]:
        """Design with these values."""
        return dict(zip(self.variables, ordered("design", x, self.variables).ravel()))

    def __call__(self, x: ArrayLike) -> np.ndarray:
        """Values of all outputs, `[size]`."""
        return self._solved(x, False)[0].copy()

    def jacobian(self, x: ArrayLike) -> np.ndarray:
        """Derivatives of all outputs, `[size, variable]`."""
        return self._solved(x, True)[1].copy()

    def value(self, x: ArrayLike) -> Any:
        """Value of a scalar function; of several designs, one per column as SciPy passes them, an array of values."""
        if np.ndim(x) == 2:
            return self._one(self.many(np.transpose(x)).T)[0]
        return float(self._one(self(x))[0])

    def gradient(self, x: ArrayLike) -> np.ndarray:
        """Gradient of a scalar function."""
        return self._one(self.jacobian(x))[0]

    def many(self, designs: ArrayLike) -> np.ndarray:
        """Values for many designs, one per row, solved on all cores: `[design, size]`."""
        return self._batch(designs, False)[0]

    def many_jacobians(self, designs: ArrayLike) -> np.ndarray:
        """Derivatives for many designs, one per row: `[design, size, variable]`."""
        found = self._batch(designs, True)[1]
        assert found is not None
        return found

    def __repr__(self) -> str:
        parts = ", ".join(part.name for part in self.parts[:4]) + (", ..." if len(self.parts) > 4 else "")
        return f"<hardpoint.Function of {self.model.name!r}: {parts} ({amount(self.size, 'output')}) of {amount(len(self.variables), 'variable')}>"

    def _one(self, found: np.ndarray) -> np.ndarray:
        if self.size != 1:
            raise UsageError.saying(f"the function has {self.size} outputs; name a single metric for a value and its gradient")
        return found

    def part(self, name: str, numbers: np.ndarray) -> np.ndarray:
        """Values of one of its parts."""
        return np.asarray(numbers)[self.parts[index_of("part", name, [part.name for part in self.parts])].place]

    def _solved(self, x: Any, derivatives: bool) -> tuple[np.ndarray, np.ndarray | None]:
        x = np.ascontiguousarray(ordered("design", x, self.variables)).ravel()
        key = x.tobytes()
        if self._last and self._last[0] == key and (self._last[1] or not derivatives):
            return self._last[2], self._last[3]
        values, jacobians = self._batch(x[None], derivatives, 1)
        self._last = (key, derivatives, values[0], None if jacobians is None else jacobians[0])
        return self._last[2], self._last[3]

    def _batch(self, designs: Any, derivatives: bool, workers: int | None = None) -> tuple[np.ndarray, np.ndarray | None]:
        rows = ordered("designs", designs, self.variables)
        if rows.ndim != 2 or rows.shape[1] != len(self.variables) or not np.isfinite(rows).all():
            given = rows.shape[1:] if rows.ndim > 1 and len(rows) == 1 else rows.shape
            raise UsageError.saying(
                f"the function takes {len(self.variables)} finite numbers, one for each variable, or rows of them; given are {given}"
            )
        values = np.empty((len(rows), self.size))
        jacobians = np.empty((len(rows), self.size, len(self.variables))) if derivatives else None
        for case in {part.case for part in self.parts}:
            parts = [part for part in self.parts if part.case == case]
            curves = [part for part in parts if not part.is_metric]
            found = self.model.designs(
                rows,
                [part.of for part in curves],
                variables=self.variables,
                case=self._names[case],
                sensitivities=derivatives,
                metrics=any(part.is_metric for part in parts),
                partial=self.stopped is not None,
                workers=workers or self._workers,
            )
            for part in parts:
                k = found.metric_names.index(part.of) if part.is_metric else curves.index(part)
                values[:, part.place] = found.metrics[:, k, None] if part.is_metric else found.values[:, k]
                if jacobians is not None:
                    if part.is_metric:
                        jacobians[:, part.place] = found.metric_sensitivities[:, k, None, :][..., self._columns]
                    else:
                        jacobians[:, part.place] = found.sensitivities[:, k][:, self._columns].transpose(0, 2, 1)
            if found.stops:
                assert self.stopped is not None
                stops = list(found.stops)
                for part in parts:
                    values[stops, part.place] = self.stopped
                    if jacobians is not None:
                        jacobians[stops, part.place] = np.nan
            moving = np.array([k for k in range(len(rows)) if k not in found.stops], dtype=int)
            for part in parts:
                self._check(part, values, jacobians, moving)
        return values, jacobians

    def _check(self, part: Part, values: np.ndarray, jacobians: np.ndarray | None, moving: np.ndarray) -> None:
        undefined = np.isnan(values[moving, part.place]).any(axis=1)
        if undefined.any():
            if self.stopped is None:
                raise StudyError.saying(f"`{part.name}` is undefined in this design" + ("" if part.is_metric else " at some output times"))
            values[moving[undefined], part.place] = self.stopped
        if jacobians is None:
            return
        for column, name in enumerate(self.variables):
            if np.isnan(jacobians[moving[~undefined], part.place, column]).any():
                raise CannotFollow.saying(f"there is no derivative of `{part.name}` by `{name}`: the variable is inadmissible")
