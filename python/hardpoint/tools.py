"""Jobs of the command line: import, export, templates, comparisons, envelopes, clearances, synthesis.

They run the command of this package, `python -m hardpoint`, in a process of its own, and return the facts that it prints with `--json`.
"""

from __future__ import annotations

import contextlib
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native, files
from .arguments import by_name, count, instance, listed, named, number, numbers
from .errors import Diagnostic, FileError, HardpointError, ModelError, MotionStopped, StudyError, TopologyError, UsageError
from .studies import DriverTable, Study

if TYPE_CHECKING:
    from .model import Model

CODES: dict[int, type[HardpointError]] = {2: UsageError, 3: ModelError, 4: TopologyError, 5: MotionStopped, 6: FileError}
"""Classes of errors by the command's exit codes."""
WITH_DESIGN = ("c", "fmu")
"""Formats that contain the motion as a function of the design, by name and extension."""
FELL_SHORT = 1
"""Exit code of a command that has a result, but not the requested one."""


def command(*arguments: Any) -> subprocess.CompletedProcess[str]:
    """Runs the command; its output is text."""
    words = [sys.executable, "-m", "hardpoint", *(os.fspath(a) if isinstance(a, os.PathLike) else str(a) for a in arguments)]
    # The package is that of this process, wherever it was found.
    path = os.pathsep.join([str(Path(__file__).parents[1]), *filter(None, [os.environ.get("PYTHONPATH")])])
    environment = {**os.environ, "PYTHONPATH": path, "NO_COLOR": "1"}
    return subprocess.run(words, capture_output=True, text=True, encoding="utf-8", env=environment, stdin=subprocess.DEVNULL)


def facts(*arguments: Any) -> dict[str, Any]:
    """Facts that the command prints with `--json`; raises its errors."""
    done = command(*arguments, "--json")
    try:
        found = json.loads(done.stdout)
    except ValueError:
        found = {}
    if done.returncode in (0, FELL_SHORT) and found:
        return found
    of_cases = [case["result"] for case in found.get("cases", [])]
    reported = [one for document in (found, *of_cases) for one in document.get("diagnostics", [])]
    # Remarks on the model do not say why there is no result.
    raise _error(done, [one for one in reported if one["severity"] == "error"] or reported)


def _error(done: subprocess.CompletedProcess[str], found: list[dict]) -> HardpointError:
    of = CODES.get(done.returncode, StudyError)
    if not found:
        return of((_diagnostic(done.stderr.strip() or f"error: the command ended with code {done.returncode}"),))
    return of(tuple(Diagnostic.of({**one, "rendered": _rendered(one)}) for one in found))


def _diagnostic(rendered: str) -> Diagnostic:
    """Diagnostic of a text as on the command line."""
    found = re.match(r"error(?:\[(\w+)\])?: (.*)", rendered)
    code, message = found.groups() if found else (None, rendered)
    help = re.search(r"^ *= help: (.*)", rendered, re.MULTILINE)
    facts = {"severity": "error", "code": code, "message": message, "notes": (), "help": help and help[1]}
    return Diagnostic.of({**dict.fromkeys(("file", "line", "column", "length", "label")), **facts, "rendered": rendered})


def _rendered(one: dict) -> str:
    code = f"[{one['code']}]" if one.get("code") else ""
    place = f"\n  --> {one['file']}:{one['line']}:{one['column']}" if one.get("file") and one.get("line") else ""
    notes = "".join(f"\n  = note: {note}" for note in one.get("notes", []))
    return f"{one['severity']}{code}: {one['message']}{place}{notes}" + (f"\n  = help: {one['help']}" if one.get("help") else "")


@contextlib.contextmanager
def saved(model: Model) -> Iterator[Path]:
    """The model as a file: its own one if that has the same text, or else one in a temporary folder, with the files that it names."""
    own = Path(model.file)
    is_current = False
    with contextlib.suppress(OSError, UnicodeDecodeError):
        is_current = own.read_bytes().decode() == model.text
    # Errors of the caller about its own files are not suppressed.
    if is_current:
        yield own
        return
    with tempfile.TemporaryDirectory() as folder:
        texts = model._native.files
        for name in {*texts, *model._native.file_names}:
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            if name in texts:
                path.write_text(texts[name], encoding="utf-8", newline="\n")
            elif model._whereabouts is not None:
                # The contents of shapes are not kept as texts.
                with contextlib.suppress(FileNotFoundError):
                    shutil.copyfile(Path(model._whereabouts, name), path)
        path = Path(folder, "model.toml")
        path.write_bytes(model.text.encode())
        try:
            yield path
        except HardpointError as error:
            raise _renamed(error, str(path), model.file) from None


def _renamed(error: HardpointError, old: str, new: str) -> HardpointError:
    """The error with another name of a file."""

    def named(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(named(one) for one in value)
        return value.replace(old, new) if isinstance(value, str) else value

    return type(error)(tuple(Diagnostic(**{key: named(value) for key, value in vars(one).items()}) for one in error.diagnostics))


def _case(model: Model, case: str | None) -> list[str]:
    name = case if case is not None else model.cases[model._case] if model._case is not None and model.cases else None
    if name is not None:
        model._named(name)
    return [] if name is None else ["--case", name]


def _study(model: Model, found: dict[str, Any]) -> Study:
    return Study(model, found, [], None, None)


def export(model: Model, path: str | os.PathLike, format: str | None, design: bool) -> dict[str, Any]:
    to = files.target(path)
    options = [] if format is None else ["--format", format]
    options += ["--design"] if design else []
    # The file does not have the variables of `with_coordinates`. Other formats have no variables.
    if (format or to.suffix[1:].lower()) in WITH_DESIGN:
        options += [option for option, added in zip(("--coordinates", "--tilts"), model._added) if added]
    with saved(model) as file:
        return facts("export", file, "-o", os.path.abspath(to), *options)


def clearance(model: Model, case: str | None, proof: bool) -> Study:
    with saved(model) as file:
        return _study(model, facts("clearance", file, *_case(model, case), *([] if proof else ["--no-proof"])))


def envelope(
    model: Model,
    shape: str,
    path: str | os.PathLike,
    case: str | None,
    relative_to: str | None,
    error: float | None,
    margin: float | None,
) -> Study:
    options = [] if relative_to is None else [f"--relative-to={relative_to}"]
    for name, value in (("error", error), ("margin", margin)):
        options += [] if value is None else [f"--{name}={number(f'`{name}`', value)}"]
    with saved(model) as file:
        return _study(model, facts("envelope", file, shape, *_case(model, case), *options, "-o", os.path.abspath(files.target(path))))


def table(
    model: Model,
    over: Mapping[str, tuple[float, float]],
    of: Iterable[str],
    error: float | str | Mapping[str, float | str],
    interpolation: str | None,
    path: str | os.PathLike | None,
) -> DriverTable:
    ranges = by_name("over", over)
    if not ranges:
        raise UsageError.saying("`over` names no driver; give both ends of one to three of them, such as `{'travel': (-40, 40)}`")
    if isinstance(error, Mapping):
        if not error:
            raise UsageError.saying("`error` names no output; give the permitted error of each, or a number for all of them")
        options = [f"--error={name}={_permitted(value)}" for name, value in error.items()]
    else:
        options = [f"--error={_permitted(error)}"]
    for name, ends in ranges.items():
        try:
            first, last = ends
        except (TypeError, ValueError):
            raise UsageError.saying(f"the range of `{name}` is both of its ends, not {ends!r}") from None
        options.append(f"--over={name}={first}..{last}")
    options += [f"--of={name}" for name in listed("of", of)]
    options += [] if interpolation is None else [f"--interpolation={interpolation}"]
    with saved(model) as file, tempfile.TemporaryDirectory() as folder:
        to = Path(folder, "table.json") if path is None else os.path.abspath(files.target(path))
        return DriverTable(facts("map", file, *options, "-o", to)["map"])


def _permitted(error: Any) -> str:
    """A permitted error: a number, or a text with a unit."""
    if isinstance(error, str):
        return error
    if np.ndim(error) or isinstance(error, (bool, bytes)):
        raise UsageError.saying(
            f"`error` is a number, a text such as `\"0.001deg\"`, or one of them for each output by its name, not {error!r}"
        )
    return str(number("`error`", error))


@named
def compare(model: Model, other: Model, case: str | None = None, measures: Iterable[str] = ()) -> Study:
    """Compares the motions of two models: hardpoints, measures, metrics, as `hardpoint compare` does."""
    from .model import Model

    instance("model", model, Model, "hardpoint.Model")
    instance("other", other, Model, "hardpoint.Model")
    chosen = [f"--measure={name}" for name in listed("measures", measures)]
    with saved(model) as first, saved(other) as second:
        return _study(model, facts("compare", first, second, *_case(model, case), *chosen))


@named
def synthesize(task: str | os.PathLike | Mapping[str, Any], *, answers: int | None = None, folder: str | os.PathLike | None = None) -> Study:
    """Finds four-bars and slider-cranks for a task (docs/synthesis.md): a task file, or its contents. `facts["answers"]` lists them;
    with `folder`, their models and pages are written there."""
    from .model import written

    options = [] if answers is None else [f"--answers={count('answers', answers)}"]
    options += [] if folder is None else ["-o", os.path.abspath(files.where(folder))]
    with tempfile.TemporaryDirectory() as place:
        if isinstance(task, Mapping):
            path = Path(place, "task.toml")
            path.write_text(_native.to_toml(written(task)), encoding="utf-8")
        else:
            path = Path(files.where(task))
        found = facts("synthesize", path, *options)
    return Study(None, found, [], None, None)


@named
def templates() -> dict[str, str]:
    """Templates of `hardpoint.new`, with their descriptions."""
    return _listed("new", "--list")


@named
def export_formats() -> dict[str, str]:
    """Formats of `model.export`, with their descriptions."""
    return _listed("export", "--list")


@named
def import_formats() -> dict[str, str]:
    """Formats of `hardpoint.import_model`, with their descriptions."""
    return {one["name"]: one["about"] for one in facts("import", "--list")["formats"]}


def _listed(*arguments: str) -> dict[str, str]:
    done = command(*arguments)
    if done.returncode:
        raise _error(done, [])
    pairs = (line.strip().split("  ", 1) for line in done.stdout.splitlines() if line.strip())
    return {pair[0]: pair[-1].strip() for pair in pairs}


@named
def new(
    path: str | os.PathLike,
    template: str,
    *,
    hardpoints: Mapping[str, Iterable[float]] | str | os.PathLike | None = None,
    units: str | None = None,
    axes: str | None = None,
) -> Model:
    """Writes a commented model file from a template (`hardpoint.templates()`), and reads it. An existing file is not overwritten.

    `hardpoints` are your own ones by the names of the template, or a table (CSV, .xlsx) of them. Their `units` are `mm`, `cm`, `m` or
    `in`, their `axes` `iso`, `sae`, `adams`, `lotus`, or like `"x back, y right, z up"`. Neither is guessed: give both, unless the headings of
    the table have the units, or the template is planar.
    """
    from .model import read

    path = files.target(path)
    target = path if path.suffix == ".toml" else path.with_name(path.name + ".toml")
    with tempfile.TemporaryDirectory() as folder:
        options = ["--template", template]
        if isinstance(hardpoints, Mapping):
            table = Path(folder, "hardpoints.csv")
            with open(table, "w", newline="", encoding="utf-8") as out:
                rows = csv.writer(out, lineterminator="\n")
                places = {name: _place(name, place) for name, place in hardpoints.items()}
                # Points of a planar mechanism have two coordinates.
                rows.writerow(["name", "x", "y", "z"][: 1 + max((len(place) for place in places.values()), default=3)])
                rows.writerows([name, *place] for name, place in places.items())
            options += ["--hardpoints", os.fspath(table)]
        elif hardpoints is not None:
            options += ["--hardpoints", os.path.abspath(files.where(hardpoints))]
        for name, value in (("--units", units), ("--axes", axes)):
            options += [] if value is None else [name, value]
        done = command("new", os.path.abspath(target), *options)
    if done.returncode:
        raise _error(done, [])
    return read(target)


def _place(name: str, place: Any) -> list[float]:
    found = numbers(f"hardpoint `{name}`", place)
    if found.shape not in ((2,), (3,)):
        raise UsageError.saying(f"hardpoint `{name}` has coordinates x, y and z (x and y in a plane), not {place!r}")
    return found.tolist()


@named
def import_model(
    source: str | os.PathLike, path: str | os.PathLike, *, format: str | None = None, close: Iterable[str] = ()
) -> tuple[Model, dict[str, Any]]:
    """Writes another program's mechanism (`hardpoint.import_formats()`) as a model file, and reads it. Returns the model and the facts
    of `hardpoint import --json`: `report` lists what was not taken. `close` closes loops of a robot, such as `"A=B:revolute:x"`."""
    from .model import read

    options = [] if format is None else ["--format", format]
    closings = listed("close", close)
    found = facts("import", os.path.abspath(files.where(source)), "-o", os.path.abspath(files.target(path)), *options, *(f"--close={one}" for one in closings))
    return read(path), found


@named
def schema() -> dict[str, Any]:
    """JSON Schema of model files."""
    return json.loads(_native.schema())
