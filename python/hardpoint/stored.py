"""Runs in files: a model with its results, as `run.save(path)` writes them."""

from __future__ import annotations

import io
import json
import os
import zipfile
import zlib
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native, files
from .arrays import frozen
from .errors import FileError, UsageError

if TYPE_CHECKING:
    from .run import Run

FORMAT = 1
"""Version of the file."""
ARRAYS = ("times", "values", "design", "metrics", "metrics_d")
"""Arrays of every run."""
ABOUT = ("sensitivities", "followed", "stop", "stopped_at", "diagnostics", "summary")
"""Further facts of a run, besides its model."""


def save(run: Run, path: str | os.PathLike) -> None:
    """Writes a run, atomically."""
    files.write_bytes(path, packed(run))


def packed(run: Run) -> bytes:
    """Contents of the file of a run."""
    of, model = run._native, run.model
    with_d = bool(run._followed)
    arrays: dict[str, np.ndarray] = {"times": run.times, "values": of.values(), "design": np.array(of.design, dtype=float)}
    arrays["metrics"], arrays["metrics_d"] = of.metrics()
    for b in range(1, len(model.bodies) + 1):
        arrays[f"body_{b}"] = of.body(b)
    if with_d:
        for order in range(3):
            arrays[f"sensitivities_{order}"] = of.sensitivities(order)
        for b in range(1, len(model.bodies) + 1):
            for v, (follows, _) in enumerate(run._followed):
                if follows:
                    arrays[f"body_{b}_by_{v}"] = of.body_sensitivity(b, v)
    about = {
        "format": FORMAT,
        "hardpoint": _native.version,
        "text": model.text,
        "file": model.file,
        "files": model._native.files,
        "added": model._added,
        "case": run.case,
        "selected": model._case is not None,
        "sensitivities": with_d,
        "followed": run._followed,
        "stop": of.stop,
        "stopped_at": of.stopped_at,
        "diagnostics": of.diagnostics(),
        "summary": of.summary(),
    }
    arrays["about"] = np.frombuffer(json.dumps(about).encode(), dtype=np.uint8)
    out = io.BytesIO()
    np.savez_compressed(out, **arrays)  # type: ignore[arg-type]
    return out.getvalue()


def load(path: str | os.PathLike) -> Run:
    """Reads a run that `run.save(path)` wrote, with its model. Nothing is solved again, except for its page and its loads."""
    name = files.where(path)
    try:
        with open(name, "rb") as contents:
            whole = contents.read()
    except FileNotFoundError as error:
        raise FileError.saying(f"there is no file `{name}`") from error
    except OSError as error:
        raise FileError.of_system("read", name, error) from error
    return unpacked(whole, name)


def unpacked(whole: bytes, name: str = "the pickled run") -> Run:
    """The run of a file's contents."""
    from .model import Model, _restored
    from .run import Run

    refused = UsageError.saying(f"`{name}` is not a run of this package, or is damaged; `run.save(path)` writes one")
    try:
        if not zipfile.is_zipfile(io.BytesIO(whole)):
            raise refused
        with np.load(io.BytesIO(whole), allow_pickle=False) as found:
            arrays = {key: frozen(found[key]) for key in found.files}
        about = json.loads(bytes(arrays.pop("about")))
        if about["format"] != FORMAT:
            raise UsageError.saying(f"`{name}` has format {about['format']}, of another version of the package ({about['hardpoint']})")
        missing = {"text", "file", "files", "added", "case", *ABOUT} - set(about) or set(ARRAYS) - set(arrays)
    except UsageError:
        raise
    # All that the readers of zip files, arrays and JSON raise for damaged contents.
    except (OSError, ValueError, KeyError, EOFError, TypeError, NotImplementedError, zipfile.BadZipFile, zlib.error) as error:
        raise refused from error
    if missing:
        raise refused
    added = (bool(about["added"][0]), bool(about["added"][1]))
    native = _restored(about["text"], about["file"], tuple(sorted(about["files"].items())), added, None)._native
    whole = Model(native, None, added)
    index = whole.cases.index(about["case"]) if about["case"] is not None else 0
    # Older files do not have it.
    model = Model(native, index, added) if about.get("selected") else whole
    return Run(model, index, Stored(model._native, index, arrays, about))


class Stored:
    """Results of a file, in place of the engine's."""

    def __init__(self, model: _native.Model, case: int, arrays: dict[str, np.ndarray], about: dict[str, Any]):
        self._model = model
        self._case = case
        self._arrays = arrays
        self._about = about

    @cached_property
    def _again(self) -> _native.Run:
        return self._model.run(self._case, self.design, self._about["sensitivities"])

    @property
    def times(self) -> np.ndarray:
        return self._arrays["times"]

    @property
    def design(self) -> list[float]:
        return self._arrays["design"].tolist()

    @property
    def stop(self) -> str | None:
        return self._about["stop"]

    @property
    def stopped_at(self) -> list[float] | None:
        return self._about["stopped_at"]

    @property
    def followed(self) -> list[tuple[bool, str | None]]:
        return [(bool(yes), why) for yes, why in self._about["followed"]]

    def values(self) -> np.ndarray:
        return self._arrays["values"]

    def sensitivities(self, order: int) -> np.ndarray:
        return self._arrays[f"sensitivities_{order}"]

    def body(self, body: int) -> np.ndarray:
        return self._arrays[f"body_{body}"]

    def body_sensitivity(self, body: int, variable: int) -> np.ndarray:
        return self._arrays[f"body_{body}_by_{variable}"]

    def metrics(self) -> list[np.ndarray]:
        return [self._arrays["metrics"], self._arrays["metrics_d"]]

    def summary(self) -> str:
        return self._about["summary"]

    def diagnostics(self) -> str:
        return self._about["diagnostics"]

    def page(self) -> str:
        return self._again.page()


