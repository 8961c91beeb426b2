"""Models: read, parsed, or built in code."""

from __future__ import annotations

import contextlib
import json
import os
import tempfile
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import _native, display, files, tools
from .arguments import amount, by_name, checked, count, labels, listed, number, numbers, ordered, together, word
from .arrays import frozen
from .designs import Designs
from .errors import Diagnostic, HardpointWarning, MotionStopped, UsageError, index_of, unknown
from .positions import Forces, Positions, Solver, names
from .run import Run
from .studies import DriverTable, Map, Study, SweepResult, outcome, timed

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Design = Union[Mapping[str, float], "ArrayLike", None]
"""A design: values by the names of design variables, in a mapping or a labelled array such as a series of pandas, or all of them in
order. Missing values, and NaN, are nominal."""
Progress = Union[Callable[[int, int], Any], bool, None]
"""Receives the amount done and the total; `True` writes them to the standard error."""

CHANGED = " (changed)"
"""Ends the name of a file whose text was changed by `with_`."""
MOST_SOLVERS = 4
"""Maximum number of solvers of positions that a model keeps, one for each choice of forces."""
MOST_RANKED = 200
"""Maximum number of hardpoints whose coordinates are variables of a what-if."""

ORDERS = {0: 0, 1: 1, 2: 2, "value": 0, "rate": 1, "acceleration": 2}


@dataclass(frozen=True)
class Variable:
    """A design variable. Its value is that of the parameter, or for all others a change, zero in the nominal design."""

    name: str
    unit: str
    drawn: float
    """Value in the nominal design."""
    bounds: tuple[float, float] | None
    """Lower and upper bound."""
    typical: float | None
    """Typical size of a change."""
    tolerance: float | None
    """Manufacturing tolerance, plus or minus."""
    is_parameter: bool


@dataclass(frozen=True)
class Output:
    """A measure, or a coordinate of a point, that is solved at every output time."""

    name: str
    kind: str
    """`measure` or `point`."""
    columns: tuple[str, ...]
    """Names of value, rate and acceleration, up to the highest order available."""
    units: tuple[str, ...]
    """Their units."""
    by_position: bool
    """True if it depends on the position only; then it has second derivatives by the design."""
    at_rest: bool
    """True if it has a value in a position at rest: in `model.at()`."""


@checked
class Model:
    """A mechanism, read and checked, with its plan of solution.

    A model is immutable; all methods are thread-safe, and long ones release the interpreter lock. Models can be pickled. For a model
    with cases, select one: `model.case("bump").run()` or `model.run(case="bump")`. Searches, tolerances and sweeps are over all cases, and
    those of `model.case("bump")` over that case, as with `--case`; a fit (`calibrate`) and maps do not depend on cases.

    `hardpoint.read`, `hardpoint.parse`, `Model.new` and `Model.from_dict` make models, and `model.with_(...)` a changed one.
    """

    def __init__(
        self,
        native: _native.Model,
        case: int | None = None,
        variables: tuple[bool, bool] = (False, False),
        folder: str | None = None,
    ):
        self._native = native
        self._case = case
        self._folder = folder
        # A loop over forces has a solver for each value.
        self._solver: Callable[[Forces], Solver] = lru_cache(maxsize=MOST_SOLVERS)(lambda forces: Solver(self, forces))
        self._added = variables
        info = self._info = json.loads(native.info())
        self.name: str = info["name"]
        self.description: str | None = info["description"]
        self.units: dict[str, str] = {"length": info["length"], "angle": info["angle"], "time": "s"}
        self.bodies: tuple[str, ...] = tuple(info["bodies"])
        self.joints: tuple[dict, ...] = tuple(info["joints"])
        self.drivers: tuple[dict, ...] = tuple(info["drivers"])
        self.hardpoints: dict[str, np.ndarray] = {h["name"]: frozen(np.array(h["place"], dtype=float)) for h in info["hardpoints"]}
        self.variables: dict[str, Variable] = {
            v["name"]: Variable(**{**v, "bounds": v["bounds"] and tuple(v["bounds"])}) for v in info["variables"]
        }
        self.outputs: dict[str, Output] = {
            o["name"]: Output(**{**o, "columns": tuple(o["columns"]), "units": tuple(o["units"])}) for o in info["outputs"]
        }
        self.cases: tuple[str, ...] = tuple(m["case"] for m in info["motions"] if m["case"] is not None)
        self.grids: tuple[str, ...] = tuple(info["grids"])
        self.diagnostics: tuple[Diagnostic, ...] = tuple(Diagnostic.of(d) for d in info["remarks"])
        self._variable_index = {name: k for k, name in enumerate(self.variables)}
        self._output_index = {name: k for k, name in enumerate(self.outputs)}

    # Contents

    @property
    def text(self) -> str:
        """Text of the model file."""
        return self._native.text

    @property
    def file(self) -> str:
        """Name of the model file."""
        return self._native.file

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of the measures."""
        return tuple(o.name for o in self.outputs.values() if o.kind == "measure")

    def times(self, case: str | None = None) -> np.ndarray:
        """Output times of a case, s."""
        return frozen(np.array(self._info["motions"][self._index(case, "times")]["times"], dtype=float))

    def metrics(self, case: str | None = None) -> dict[str, str]:
        """Metrics of a case, with their units."""
        return {m["name"]: m["unit"] for m in self._info["motions"][self._index(case, "metrics")]["metrics"]}

    def case(self, name: str) -> Model:
        """Returns the model in one of its cases."""
        return Model(self._native, self._named(name), self._added, self._folder)

    def with_coordinates(self, tilts: bool = False) -> Model:
        """Returns the model with additional design variables: every coordinate of its hardpoints (`A.x`) that is not a variable already,
        and with `tilts` every tilt of its joint axes (`hinge.tilt_x`). Of a coordinate that is a variable, `A.x` is another name."""
        return Model(self._native.with_variables(True, tilts), self._case, (True, tilts or self._added[1]), self._folder)

    def __repr__(self) -> str:
        case = f", case {self.cases[self._case]!r}" if self._case is not None and self.cases else ""
        return f"<hardpoint.Model {self.name!r}{case}: {amount(len(self.bodies), 'body', 'bodies')}, {amount(len(self.joints), 'joint')}, {amount(len(self.variables), 'design variable')}>"

    def _repr_html_(self) -> str:
        return display.model(self)

    def __reduce__(self) -> Any:
        named = tuple(sorted(self._native.files.items()))
        return _restored, (self.text, self.file, named, self._added, self._case)

    # Contents of the file

    @classmethod
    def new(cls, name: str, *, folder: str | os.PathLike | None = None, **sections: Any) -> Model:
        """Builds a model from nothing; the sections are those of the file (docs/file-format.md): `hardpoints`, `bodies`, `joints`, ...

            >>> hardpoint.Model.new(
            ...     "pendulum",
            ...     units={"length": "mm", "angle": "deg"},
            ...     hardpoints={"pivot": [0, 0, 500], "bob": [0, 0, 0]},
            ...     bodies={"arm": {}},
            ...     joints={"hinge": {"type": "revolute", "bodies": ["ground", "arm"], "at": "pivot", "axis": "y"}},
            ...     drivers={"swing": {"joint": "hinge", "law": "30 * sin(t)"}},
            ...     points={"bob": {"body": "arm", "at": "bob"}},
            ...     time={"end": 6.0, "steps": 100},
            ... )

        `model.to_toml()` is the equivalent file; diagnostics refer to it.
        """
        return cls.from_dict({"name": name, **sections}, folder=folder)

    @classmethod
    def from_dict(cls, document: Mapping[str, Any], *, folder: str | os.PathLike | None = None) -> Model:
        """Builds a model from the contents of a file, such as `model.to_dict()` of another model; files that it names are in `folder`."""
        where = None if folder is None else files.where(folder)
        if not isinstance(document, Mapping):
            raise UsageError.saying(f"the contents of a model file are a dictionary, such as `model.to_dict()`, not {document!r}")
        name = f"{document.get('name', 'model')}.toml"
        return _opened(_native.parse(written(document), name, folder=where, is_json=True), where)

    def to_dict(self) -> dict[str, Any]:
        """Contents of the model file, with the names of the file; a copy."""
        return json.loads(self._native.document())

    def to_toml(self, design: Design = None) -> str:
        """Text of the model file, with a design written into it; comments and layout are preserved."""
        return self.text if design is None else self.edited(design)

    def with_(self, changes: Mapping[str, Any] | None = None, /, **sections: Any) -> Model:
        """Returns the model with other entries in its file.

        The changes are nested mappings by the names of the file, which are merged into it; `None` removes an entry, anything that is
        not a mapping replaces it. Comments and all other entries stay.

            >>> stiffer = model.with_(hardpoints={"tie_rod_outer": [0, 680, 50]}, forces={"spring": {"stiffness": 32}})
            >>> free = model.with_(joints={"tie_rod": None}, bodies={"tie_rod": None})
            >>> faster = model.with_(cases={"bump": {"time": {"end": 0.5, "steps": 40}}})

        Files that the model has read are not read again; `hardpoint.read` does that. Raises `ModelError` with all errors of the changed
        file. Changed design variables go with `run(design)` instead, which does not read a file.
        """
        return self._changed(together(by_name("changes", changes), sections))

    def _changed(self, changes: Mapping[str, Any]) -> Model:
        text = self._native.merged(written(changes))
        name = self.file if self.file.endswith(CHANGED) else self.file + CHANGED
        folder = self._whereabouts
        if folder is None:
            native = _native.parse(text, name, files=dict(self._native.files))
        else:
            # Files that the model has read already are not read again.
            native = _native.parse(text, name, files=dict(self._native.files), folder=folder)
        whole = _opened(native, folder, 5)
        if any(self._added):
            whole = Model(whole._native.with_variables(*self._added), None, self._added, folder)
        if self._case is None or not self.cases or self.cases[self._case] not in whole.cases:
            return whole
        return whole.case(self.cases[self._case])

    @property
    def _whereabouts(self) -> str | None:
        """Folder of the model file, if it still exists."""
        return self._folder if self._folder is not None and os.path.isdir(self._folder) else None

    def _moved(self, index: int, times: Any, laws: Mapping[str, Any] | None) -> tuple[Model, int]:
        """Model with other output times and laws in a case, and the index of the case in it."""
        if laws is not None and not isinstance(laws, Mapping):
            raise UsageError.saying(f"laws are named: `laws={{'travel': '10 * t'}}`, not {laws!r}")
        case = self.cases[index] if self.cases else None
        # With the entries of included files and the mirror images.
        composed = json.loads(self._native.composed())
        target = {key: composed.get(key, {}) for key in ("drivers", "forces", "cases", "time")}
        moved = target if case is None else target["cases"][case]
        at = np.array(self._info["motions"][index]["times"], dtype=float)
        if times is not None:
            if not isinstance(times, Mapping):
                at = _increasing(times)
                times = {"at": at.tolist()}
            moved["time"] = times
        for name, law in (laws or {}).items():
            section = "drivers" if name in target["drivers"] else "forces"
            if name not in target[section]:
                raise unknown("driver or force", name, [*target["drivers"], *target["forces"]])
            if case is None:
                target[section][name]["law"] = _law(name, law, at)
            else:
                moved.setdefault("laws", {})[name] = _law(name, law, at)
        target = json.loads(written(target))
        changes: dict[str, Any] = {}
        document = self.to_dict()
        if case is None:
            if times is not None:
                changes["time"] = _instead(document.get("time"), target["time"])
            _set_laws(changes, document, target, list(laws or {}))
        else:
            changes["cases"] = {case: _change(document.get("cases", {}).get(case), target["cases"][case])}
        found = self._changed(changes)
        if any(key in document for key in ("include", "mirror")):
            # Laws that a mirror copies from the changed ones remain those of this model.
            made = json.loads(found._native.composed())
            copied = _copied(made, target) if case is None else []
            cases = _cases_of_their_own(made, target)
            if copied or cases:
                _set_laws(changes, document, target, copied)
                of_text = document.get("cases", {})
                changes.setdefault("cases", {}).update({name: _change(of_text.get(name), own) for name, own in cases.items()})
                found = self._changed({key: value for key, value in changes.items() if value})
        return found, found.cases.index(case) if case is not None else 0

    # Positions

    def at(
        self,
        drivers: Mapping[str, ArrayLike] | None = None,
        /,
        *,
        design: Design = None,
        forces: Mapping[str, float] | None = None,
        sensitivities: bool = True,
        partial: bool = False,
        workers: int | None = None,
        progress: Progress = None,
        **values: ArrayLike,
    ) -> Positions:
        """Positions at rest as a function of the drivers, by their names and in the units of the file: `model.at(travel=12)`.

        Values count as the driver's laws do: from the design configuration, unless the driver prescribes a measure or has
        `counted_from = "zero"`. Drivers that are not named stay in the design configuration. Arrays are broadcast:
        `model.at(travel=np.linspace(-40, 40, 81))`. Every position is reached from the design configuration by moving all drivers
        together, on the branch of the design configuration; output times, laws and cases do not matter.

            >>> position = model.at(travel=12)
            >>> position["toe"], position.derivative("toe", "travel"), position.sensitivity("toe", "tie_rod_outer_z")

        Loads are static. A force whose law changes over time needs a value in `forces`: the force or moment, N or N m, along its
        direction in the file; the resultant of a `wheel_force` with several components; and for a `tyre` the height of the road, in the
        file's length unit. It is the value in the nominal design. Raises `MotionStopped` where a position cannot be reached; with
        `partial` its values are NaN, and `stops` has the reason. Names that are not Python's go into a mapping:
        `model.at({"rack drive": 5})`.
        """
        given = {name: number(f"force `{name}`", value) for name, value in by_name("forces", forces).items()}
        solver = self._solver(tuple(sorted(given.items())))
        return solver.solve(names(drivers, values), design, sensitivities, partial, count("workers", workers), progress)

    # Motions

    def run(
        self,
        design: Design = None,
        *,
        case: str | None = None,
        times: ArrayLike | Mapping[str, Any] | None = None,
        laws: Mapping[str, Any] | None = None,
        sensitivities: bool = True,
        partial: bool = False,
    ) -> Run:
        """Solves the motion of a design: position, velocity, acceleration, and their sensitivities by all design variables.

        `times` are other output times, s, or a table as `[time]` has it (`{"end": 2, "steps": 100}`). `laws` are other laws of drivers
        and forces by name: a text (`"10 * sin(t)"`), a number, a table as in the file, or an array of values at the output times: a table
        with `ends = "clamped"`, a smooth curve through the values that begins and ends at rest. Other ends need the table itself,
        `{"type": "table", "points": [[0, 0], ...], "ends": "natural"}`. Both hold for this run only; `run.model` has them.

        Raises `MotionStopped` if the motion ends before its last output time; with `partial`, the solved part is returned, and
        `run.stop` has the reason.
        """
        index = self._index(case)
        if times is not None or laws:
            moved, index = self._moved(index, times, laws)
            return moved._run(index, design, sensitivities, partial)
        return self._run(index, design, sensitivities, partial)

    def _run(self, index: int, design: Design, sensitivities: bool, partial: bool) -> Run:
        run = Run(self, index, self._native.run(index, self._values(design), sensitivities))
        if run.stop and not partial:
            error = MotionStopped((run.stop,))
            error.run = run
            raise error
        return run

    def runs(self, design: Design = None, **options: Any) -> dict[str, Run]:
        """Runs every case."""
        if "case" in options:
            raise UsageError.saying("`model.runs()` runs every case; for a single one, `model.run(case=...)`")
        return {case: self.run(design, case=case, **options) for case in self.cases}

    def designs(
        self,
        designs: ArrayLike | Sequence[Mapping[str, float]],
        outputs: str | Iterable[str] = (),
        *,
        variables: Sequence[str] | None = None,
        case: str | None = None,
        order: int | str = 0,
        at: ArrayLike | slice | None = None,
        sensitivities: bool = True,
        metrics: bool = True,
        partial: bool = False,
        workers: int | None = None,
        progress: Progress = None,
    ) -> Designs:
        """Solves many designs in one call, without a Python object per design or step.

        `designs` has a row for each design, with values of `variables`, or of all design variables; or it is a list of dictionaries, or
        a table such as one of pandas, whose columns are the variables of their names (with `variables`, these columns only). The result
        has `outputs` of an `order` at the output times with the indices `at` (all), the `metrics`, and the `sensitivities` of both.
        Raises `MotionStopped` if a motion ends early; with `partial` its values are NaN, and `stops` has the reason.
        """
        index = self._index(case, "designs")
        rows = self._rows(designs, variables)
        names = listed("outputs", outputs)
        order = self._order(order, names)
        stored = _places(at, len(self._info["motions"][index]["times"]))
        solved = self._native.designs(
            index, rows, [self._output(name) for name in names], order, stored.tolist(), sensitivities, metrics, count("workers", workers), listener(progress)
        )
        found = Designs(self, index, rows, names, order, stored, solved, sensitivities)
        if found.stops and not partial:
            number, why = next(iter(found.stops.items()))
            error = MotionStopped((why,))
            error.add_note(f"design {number} of {len(rows)}; `partial=True` returns the others") if hasattr(error, "add_note") else None
            raise error
        return found

    def gradients(
        self, outputs: str | Iterable[str], design: Design = None, *, case: str | None = None, order: int | str = 0, method: str = "auto"
    ) -> np.ndarray:
        """Derivatives of some outputs by all design variables, `[time, output, variable]`: by direct differentiation, the adjoint method,
        or (`auto`) the cheaper of both; with `[equilibrium]` always by direct differentiation. NaN for inadmissible variables."""
        names = listed("outputs", outputs)
        order = self._order(order, names)
        found = self._native.gradients(self._index(case, "gradients"), self._values(design), [self._output(name) for name in names], word("method", method))
        followed = np.array(found["followed"], dtype=bool)
        return frozen(np.where(followed, found["gradients"][..., order], np.nan))

    def second_derivatives(
        self, outputs: str | Iterable[str], variables: str | Iterable[str] | None = None, design: Design = None, *, case: str | None = None
    ) -> np.ndarray:
        """Second derivatives of the values of some outputs by some design variables (all): `[time, output, variable, variable]`. NaN for
        inadmissible variables."""
        names = listed("outputs", outputs)
        chosen = list(self.variables) if variables is None else listed("variables", variables)
        for name in names:
            if not self._declared(name).by_position:
                raise UsageError.saying(f"`{name}` does not depend on the position only: it has no second derivatives")
        return self._native.second(
            self._index(case, "second_derivatives"), self._values(design), [self._output(n) for n in names], [self._variable(v) for v in chosen]
        )

    def jerk(self, design: Design = None, *, case: str | None = None) -> dict[str, np.ndarray]:
        """Third time derivatives of all bodies: per body `[time, 6]`, linear and angular."""
        found = self._native.jerk(self._index(case, "jerk"), self._values(design))
        return {body: found["jerk"][:, k] for k, body in enumerate(self.bodies)}

    def maps(self, *, progress: Progress = None) -> list[Map]:
        """Solves the cases that sweep two drivers over a grid; the result is that of `maps.json` of the command line, and has
        `to_xarray()` and `to_pandas()`."""
        return [Map(found) for found in json.loads(self._native.maps(listener(progress)))]

    # Studies

    def what_if(self, design: Design, *, case: str | None = None) -> Study:
        """Effect of a changed design on every measure and metric: exact, and predicted to first and second order.

        As on the command line, coordinates of hardpoints and tilts of joints are also variables:
        `{"tie_rod_outer.z": 2.0, "lca_pivot.tilt_y": 0.5}`.
        """
        whole = self._whole
        given = self._named_values(design)
        if given is None:
            given = dict(zip(self.variables, self._values(design)))
        if any(isinstance(name, str) and whole._known(name) is None for name in given):
            whole = self.with_coordinates(tilts=True)
        return outcome(whole, whole._native.what_if(self._index(case, "what_if"), whole._values(given)))

    @cached_property
    def _whole(self) -> Model:
        """Model with a variable for every coordinate, up to a maximum number."""
        return self.with_coordinates() if len(self.hardpoints) <= MOST_RANKED else self

    @timed
    def verify(self, *, case: str | None = None, progress: Progress = None) -> Study:
        """Compares all sensitivities with re-solved designs."""
        return outcome(self, self._native.verify(self._index(case, "verify"), listener(progress)))

    def validity(self, *, case: str | None = None) -> list[dict]:
        """Linear range of each sensitivity."""
        return json.loads(self._native.validity(self._index(case, "validity")))

    @timed
    def optimize(
        self,
        *,
        starts: int | None = None,
        iterations: int | None = None,
        other_assemblies: bool | None = None,
        both_senses: bool | None = None,
        workers: int | None = None,
        progress: Progress = None,
    ) -> Study:
        """Optimises the design for the goals of `[optimize]` in the model, in all cases.

        With `other_assemblies` the searches start from the other assemblies of the mechanism as well, with `both_senses` also with all
        drivers in the opposite sense (docs/optimisation.md); by default as in the file. The study's `model` is in the assembly and
        sense of the optimum.
        """
        found, other = self._native.optimize(
            self._studied,
            0,
            count("starts", starts, 0),
            count("iterations", iterations, 0),
            count("workers", workers),
            listener(progress),
            other_assemblies,
            both_senses,
        )
        return outcome(self if other is None else self._assembled(other), *found)

    def _assembled(self, native: _native.Model) -> Model:
        """This model in another assembly or sense."""
        if any(self._added):
            native = native.with_variables(*self._added)
        return Model(native, self._case, self._added, self._folder)

    @timed
    def trade_off(
        self,
        *,
        goals: Iterable[str] = (),
        points: int | None = None,
        point: int | None = None,
        starts: int | None = None,
        iterations: int | None = None,
        workers: int | None = None,
        progress: Progress = None,
    ) -> Study:
        """Trades two or three goals of `[optimize]` against each other, in all cases (docs/trade-off.md).

        `facts["points"]` lists the front; the study's design is that of `point`, by default the balanced compromise.
        """
        named = listed("goals", goals)
        text, design, exact = self._native.trade_off(
            named,
            self._studied,
            count("points", points, 0),
            count("point", point, 0),
            count("starts", starts, 0),
            count("iterations", iterations, 0),
            count("workers", workers),
            listener(progress),
        )
        return outcome(self, text, design, exact)

    @timed
    def tolerance(
        self,
        *,
        samples: int | None = None,
        seed: int | None = None,
        allocate: str | None = None,
        workers: int | None = None,
        progress: Progress = None,
    ) -> Study:
        """Analyses the tolerances of the design variables; `allocate` (`rss`, `worst_case`) finds the loosest tolerances that keep the limits."""
        rule = None if allocate is None else word("allocate", allocate)
        found = self._native.tolerance(
            self._studied, count("samples", samples, 0), count("seed", seed, 0), rule, count("workers", workers), listener(progress)
        )
        return outcome(self, found)

    @timed
    def calibrate(
        self,
        measured: Any,
        *,
        sigma: Mapping[str, float] | None = None,
        variables: Iterable[str] = (),
        loss: str = "squares",
        iterations: int | None = None,
        prior: Mapping[str, float] | None = None,
        priors: str | None = None,
        groups: Mapping[str, Mapping[str, Any]] | None = None,
        offsets: Iterable[str] = (),
        validate: Any = None,
        progress: Progress = None,
    ) -> Study:
        """Fits the design to measured data: a CSV file (docs/calibration.md lists its columns), or a pandas table with
        the same columns.

        `prior` has standard deviations of variables about their nominal values, `priors="tolerances"` takes their
        tolerances, `offsets` names drivers and measures with an unknown offset, and `validate` is a table that is
        compared, but not fitted. `groups` are as in the file: `{"rods": {"variables": ["rod_1", "rod_2"], "within": 0.05}}`.
        """
        with contextlib.ExitStack() as stack:
            text, design = self._native.calibrate(
                _table(measured, stack),
                [(name, number(f"sigma of `{name}`", value)) for name, value in by_name("sigma", sigma).items()],
                listed("variables", variables),
                loss,
                count("iterations", iterations, 0),
                [(name, number(f"prior of `{name}`", value)) for name, value in by_name("prior", prior).items()],
                priors,
                [_group(name, group) for name, group in by_name("groups", groups).items()],
                listed("offsets", offsets),
                None if validate is None else _table(validate, stack),
                listener(progress),
            )
        return outcome(self, text, design, design)

    @timed
    def sweep(
        self,
        *,
        method: str | None = None,
        samples: int | None = None,
        seed: int | None = None,
        levels: int | None = None,
        ranges: Mapping[str, tuple[float, float]] | None = None,
        curves: str | Iterable[str] | None = None,
        designs: str | os.PathLike | None = None,
        workers: int | None = None,
        progress: Progress = None,
    ) -> SweepResult:
        """Solves many designs in all cases, like `hardpoint sweep`: `method` (`sobol`, `latin_hypercube`, `factorial`, `sobol_indices`),
        `samples`, `seed`, `levels`, `ranges` (`{"lca_front_z": (-5, 5)}`), `curves` (names of measures whose curves are stored),
        `designs` (a CSV file of designs)."""
        plan = self.sweep_plan(method=method, samples=samples, seed=seed, levels=levels, ranges=ranges, curves=curves, designs=designs)
        columns, found, text = plan.run(count("workers", workers), listener(progress))
        return SweepResult(self, dict(columns), dict(found), json.loads(text))

    def sweep_plan(
        self,
        *,
        method: str | None = None,
        samples: int | None = None,
        seed: int | None = None,
        levels: int | None = None,
        ranges: Mapping[str, tuple[float, float]] | None = None,
        curves: str | Iterable[str] | None = None,
        designs: str | os.PathLike | None = None,
    ) -> _native.Sweep:
        """Returns the sweep, to be solved in parts."""
        asked = {
            "method": None if method is None else word("method", method),
            "samples": count("samples", samples, 0),
            "seed": count("seed", seed, 0),
            "levels": count("levels", levels, 0),
            "ranges": {name: list(ends(name, both)) for name, both in by_name("ranges", ranges).items()},
            "curves": None if curves is None else listed("curves", curves),
            "designs": None if designs is None else files.where(designs),
            "case": self._studied,
        }
        return self._native.sweep(json.dumps({key: value for key, value in asked.items() if value is not None}))

    # The command's other jobs

    def export(self, path: str | os.PathLike, format: str | None = None, *, design: bool = False) -> dict[str, Any]:
        """Writes the model as a file of another program (`hardpoint.export_formats()`), by default in the format of the file's name.
        Returns the facts of `hardpoint export --json`; `unsaid` lists what the format cannot express.

        `design` makes the design variables arguments of the motion in C, as `--design` does; in an FMU they are parameters anyway, unless
        that is impossible, which is an error with `design`. The variables of `model.with_coordinates()` are arguments in both formats.
        """
        return tools.export(self, path, format, design)

    def clearance(self, *, case: str | None = None, proof: bool = True) -> Study:
        """Distances between the model's shapes over the motion, and the proof that nothing is nearer between output times."""
        return tools.clearance(self, case, proof)

    def envelope(
        self,
        shape: str,
        path: str | os.PathLike,
        *,
        case: str | None = None,
        relative_to: str | None = None,
        error: float | None = None,
        margin: float | None = None,
    ) -> Study:
        """Writes the space that a shape sweeps as a closed surface (STL), in the frame of the body `relative_to` (ground)."""
        return tools.envelope(self, shape, path, case, relative_to, error, margin)

    def table(
        self,
        over: Mapping[str, tuple[float, float]],
        of: Iterable[str] = (),
        *,
        error: float | str | Mapping[str, float | str],
        interpolation: str | None = None,
        path: str | os.PathLike | None = None,
    ) -> DriverTable:
        """Outputs as functions of one to three drivers, with a proved error of the interpolation (docs/maps.md): `over` has both ends
        of each driver, `error` the permitted one (`"0.001deg"`), of all outputs or by name. With `path` the table is a file as well:
        `.csv`, `.json`, `.txt` for Modelica, which is linear and in SI, or `.adm` for splines of Adams."""
        return tools.table(self, over, of, error, interpolation, path)

    def compare(self, other: Model, *, case: str | None = None, measures: Iterable[str] = ()) -> Study:
        """Compares the motion with that of another model: hardpoints, measures, metrics."""
        return tools.compare(self, other, case, measures)

    # Designs

    def edited(self, design: Design) -> str:
        """Returns the text of the model file with a design written into it; comments and layout are preserved."""
        return self._native.edited(self._values(design))

    def save(self, path: str | os.PathLike, design: Design = None) -> None:
        """Writes the model file with a design in it, atomically. In another folder, the files that the model reads are named from
        there; raises `ModelError` if they are not in that folder or below it."""
        to = os.path.dirname(os.path.abspath(files.where(path)))
        files.write(path, self._native.edited(self._values(design), self._whereabouts, to))

    def _named_values(self, design: Any) -> dict[Any, Any] | None:
        """Values by name, of a mapping or of a labelled array; `None` of an array in order."""
        if design is None or isinstance(design, Mapping):
            return dict(design or {})
        own = labels(design)
        if own is None or np.ndim(design) != 1:
            return None
        listed("names of the design", own)
        return dict(zip(own, numbers("design", design).tolist()))

    def _values(self, design: Design) -> list[float]:
        if design is None:
            return []
        given = self._named_values(design)
        if given is not None:
            values = np.full(len(self.variables), np.nan)
            names: dict[int, Any] = {}
            for name, value in given.items():
                index = self._variable(name)
                if index in names:
                    raise UsageError.saying(f"`{names[index]}` and `{name}` are the same design variable; give it once")
                names[index] = name
                # None is nominal.
                values[index] = np.nan if value is None else number(f"design variable `{name}`", value)
            return values.tolist()
        values = numbers("design", design)
        if values.shape != (len(self.variables),):
            raise UsageError.saying(
                f"a design has one value for each of the {len(self.variables)} design variables, or is a dictionary; the shape given is {values.shape}"
            )
        return values.tolist()

    def _rows(self, designs: Any, variables: Sequence[str] | None) -> np.ndarray:
        designs = list(designs) if not hasattr(designs, "shape") and hasattr(designs, "__iter__") else designs
        if isinstance(designs, list) and any(isinstance(design, Mapping) or labels(design) is not None for design in designs):
            return np.array([self._values(design) for design in designs])
        own = labels(designs)
        if own is not None and np.ndim(designs) == 1:
            return np.array([self._values(designs)])
        if own is not None and variables is None:
            variables = own
        names = list(self.variables) if variables is None else listed("variables", variables)
        chosen = [self._variable(name) for name in names]
        given = np.atleast_2d(ordered("designs", designs, names))
        if given.ndim != 2 or given.shape[1] != len(chosen):
            raise UsageError.saying(f"designs have a column for each of {len(chosen)} variables; the shape given is {given.shape}")
        rows = np.full((len(given), len(self.variables)), np.nan)
        rows[:, chosen] = given
        return rows

    # Names

    def _index(self, case: str | None, call: str = "run") -> int:
        """Index of a case; `call` is the method that needs one."""
        if case is not None:
            return self._named(case)
        if self._case is not None:
            return self._case
        if len(self.cases) > 1:
            names = ", ".join(f"`{name}`" for name in self.cases)
            raise UsageError.saying(f"the model has the cases {names}; select one, as in `model.case({self.cases[0]!r}).{call}(...)`")
        return 0

    def _named(self, case: str) -> int:
        return index_of("case", case, self.cases)

    @property
    def _studied(self) -> int | None:
        """Case of studies, if a single one is selected."""
        return self._case if self.cases else None

    def _known(self, name: str) -> int | None:
        """Index of a design variable, by its name or as a coordinate of a hardpoint."""
        return self._variable_index[name] if name in self._variable_index else self._native.variable(name)

    def _variable(self, name: str) -> int:
        index = self._known(name) if isinstance(name, str) else None
        if index is None:
            raise unknown("design variable", name, self.variables)
        return index

    def _declared(self, name: str) -> Output:
        return self.outputs[list(self.outputs)[self._output(name)]]

    def _output(self, name: str) -> int:
        if not isinstance(name, str) or name not in self._output_index:
            raise unknown("measure or point", name, self.outputs)
        return self._output_index[name]

    def _order(self, order: int | str, names: Iterable[str]) -> int:
        if not isinstance(order, (int, str, np.integer)) or order not in ORDERS:
            raise UsageError.saying(f"unknown order `{order}`; there are value (0), rate (1), acceleration (2)")
        for name in names:
            if ORDERS[order] >= len(self._declared(name).columns):
                raise UsageError.saying(f"`{name}` has no {('value', 'rate', 'acceleration')[ORDERS[order]]}")
        return ORDERS[order]


def listener(progress: Progress) -> Callable[[int, int], Any] | None:
    """Receiver of progress reports."""
    if progress is None or isinstance(progress, bool):
        return display.counter() if progress else None
    if not callable(progress):
        raise UsageError.saying(f"`progress` is `True`, or a function of the amount done and the total, not {progress!r}")
    return progress


def _opened(native: _native.Model, folder: str | None = None, stacklevel: int = 3) -> Model:
    native.plan()
    model = Model(native, folder=folder)
    for remark in model.diagnostics:
        if remark.severity == "warning":
            warnings.warn(remark.rendered, HardpointWarning, stacklevel=stacklevel)
    return model


def read(path: str | os.PathLike) -> Model:
    """Reads a model file. Raises `ModelError` with all its errors, and `TopologyError` if it cannot be driven."""
    file = files.where(path)
    return _opened(_native.read(file), os.path.dirname(os.path.abspath(file)))


def parse(text: str, name: str = "model.toml", folder: str | os.PathLike | None = None) -> Model:
    """Reads a model from a text; files that it names are in `folder`."""
    if not isinstance(text, str):
        raise UsageError.saying(f"the text of a model is a `str`, not {type(text).__name__}")
    name = word("name", name)
    where = None if folder is None else files.where(folder)
    return _opened(_native.parse(text, name, folder=where), where)


def build(folder: str | os.PathLike | None = None, **sections: Any) -> Model:
    """Builds a model in code; the names are those of the file (docs/file-format.md), as for `Model.new`."""
    return Model.from_dict(sections, folder=folder)


def written(sections: Mapping[str, Any]) -> str:
    """Converts contents of a file to JSON."""
    try:
        return json.dumps(dict(sections), default=_plain, allow_nan=False)
    except UsageError:
        raise
    except ValueError:
        raise UsageError.saying("a number of the model is infinite or not a number") from None


def _instead(old: Any, new: Any) -> Any:
    """Change that replaces a table, instead of merging into it."""
    return {**dict.fromkeys(old), **new} if isinstance(old, Mapping) and isinstance(new, Mapping) else new


def _change(old: Any, new: Any) -> Any:
    """Change that makes an entry of the file another one."""
    if not isinstance(old, Mapping) or not isinstance(new, Mapping):
        return new
    gone = {key: None for key in old if key not in new}
    return {**gone, **{key: _change(old.get(key), value) for key, value in new.items() if key not in old or old[key] != value}}


def _set_laws(changes: dict[str, Any], document: Mapping[str, Any], target: Mapping[str, Any], names: Iterable[str]) -> None:
    """Adds laws of drivers and forces to changes of the file."""
    for name in names:
        section = "drivers" if name in target["drivers"] else "forces"
        old = document.get(section, {}).get(name, {}).get("law")
        # A force without a law has the factor 1.
        changes.setdefault(section, {})[name] = {"law": _instead(old, target[section][name].get("law", 1))}


def _copied(made: Mapping[str, Any], target: Mapping[str, Any]) -> list[str]:
    """Drivers and forces whose laws are not those of the target."""
    sections = ("drivers", "forces")
    return [name for section in sections for name, entry in target[section].items() if made[section][name].get("law") != entry.get("law")]


def _cases_of_their_own(made: Mapping[str, Any], target: Mapping[str, Any]) -> dict[str, Any]:
    """Cases that are not those of the target; drivers and forces that only the made ones name move as in the target."""
    found = {}
    for name, own in target["cases"].items():
        other = made["cases"][name]
        if other == own:
            continue
        laws = dict(own.get("laws", {}))
        for one in other.get("laws", {}):
            if one not in laws and one in target["drivers"]:
                laws[one] = target["drivers"][one]["law"] if own.get("other_drivers") == "as_in_model" else 0
            elif one not in laws:
                laws[one] = target["forces"][one].get("law", 1)
        found[name] = {**own, "laws": laws} if laws else own
    return found


def _increasing(times: Any) -> np.ndarray:
    """Output times."""
    at = np.atleast_1d(numbers("output times", times))
    if at.ndim != 1 or not at.size or not np.isfinite(at).all() or not (np.diff(at) > 0).all():
        raise UsageError.saying("output times are a list of increasing numbers, s, or a table such as `{'end': 2, 'steps': 100}`")
    return at


def _places(at: Any, count: int) -> np.ndarray:
    """Indices of stored output times."""
    every = np.arange(count)
    try:
        found = every if at is None else np.atleast_1d(every[at])
    except (IndexError, TypeError, ValueError):
        found = None
    if found is None or found.ndim != 1 or isinstance(at, bool):
        raise UsageError.saying(f"`at` has indices of output times, of which there are {count} (0 to {count - 1}), or a slice of them, not {at!r}")
    return found


def ends(name: str, both: Any) -> tuple[float, float]:
    """Both ends of a range."""
    found = numbers(f"range of `{name}`", both)
    if found.shape != (2,) or not np.isfinite(found).all():
        raise UsageError.saying(f"the range of `{name}` is both of its ends, finite numbers, not {both!r}")
    return float(found[0]), float(found[1])


def _law(name: str, law: Any, times: np.ndarray) -> Any:
    """A law as the file has it; an array of values at the output times becomes a table."""
    if isinstance(law, (str, bool, Mapping)) or np.ndim(law) == 0:
        return law
    values = numbers(f"law of `{name}`", law)
    if values.shape != times.shape:
        raise UsageError.saying(f"the law of `{name}` has a value for each of the {len(times)} output times; the shape given is {values.shape}")
    if len(values) == 1:
        # A table has at least two points.
        return float(values[0])
    return {"type": "table", "points": np.column_stack([times, values]).tolist()}


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "__fspath__"):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    raise UsageError.saying(f"a model consists of numbers, texts, lists and dictionaries, not of {value!r}")


@lru_cache(maxsize=16)
def _restored(text: str, file: str, files: tuple, added: tuple[bool, bool], case: int | None) -> Model:
    """Restores a pickled model; a model that is sent again is shared, with its plan."""
    if case is not None:
        return Model(_restored(text, file, files, added, None)._native, case, added)
    native = _native.parse(text, file, files=dict(files))
    return Model(native.with_variables(*added) if any(added) else native, None, added)


def _group(name: str, group: Any) -> tuple[str, list[str], float]:
    """Name, members and deviation of a group, from those of the file."""
    if not isinstance(group, Mapping) or group.keys() != {"variables", "within"}:
        raise UsageError.saying(f"group `{name}` has `variables` and `within`, as in the file, not {group!r}")
    return name, listed(f"groups.{name}.variables", group["variables"]), number(f"groups.{name}.within", group["within"])


def _table(data: Any, stack: contextlib.ExitStack) -> str:
    """Path of a CSV file: a given one, or a temporary one of a table of pandas."""
    if isinstance(data, (str, os.PathLike)):
        return os.fspath(data)
    if not hasattr(data, "to_csv"):
        raise UsageError.saying(f"measured data are the path of a CSV file, or a table of pandas, not {data!r}")
    handle, path = tempfile.mkstemp(suffix=".csv")
    stack.callback(os.unlink, path)
    with os.fdopen(handle, "w", encoding="utf-8", newline="") as out:
        data.to_csv(out, index=False)
    return path
