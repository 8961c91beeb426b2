"""Exceptions: one class for each kind, all with the diagnostics of the command line."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .run import Run


@dataclass(frozen=True)
class Diagnostic:
    """A diagnostic of the engine."""

    severity: str
    """`error`, `warning` or `note`."""
    code: str | None
    """Code, such as `HP0501`; docs/diagnostics.md lists all codes."""
    message: str
    element: str | None
    """Name of the affected element."""
    file: str | None
    line: int | None
    column: int | None
    length: int | None
    """Number of underlined characters."""
    label: str | None
    """Text at the underlined position."""
    notes: tuple[str, ...]
    help: str | None
    """Suggested fix."""
    rendered: str
    """Text as on the command line, with its position in the file."""

    @classmethod
    def of(cls, found: dict) -> Diagnostic:
        """Diagnostic from its JSON form."""
        named = re.search(r"`([^`]+)`", found["message"])
        element = found.get("element") or (named and named[1])
        return cls(**{**found, "element": element, "notes": tuple(found["notes"])})


def _plain(message: str) -> dict:
    nothing = dict.fromkeys(("code", "file", "line", "column", "length", "label", "help"))
    return {**nothing, "severity": "error", "message": message, "notes": (), "rendered": f"error: {message}"}


def diagnostics(text: str) -> tuple[Diagnostic, ...]:
    """Diagnostics of a JSON text, one or a list."""
    found = json.loads(text)
    return tuple(Diagnostic.of(one) for one in (found if isinstance(found, list) else [found]))


class HardpointError(Exception):
    """Base class of all errors. `code`, `element`, `file`, `line`, `column`, `help` and `rendered` are those of the first of its
    `diagnostics`."""

    diagnostics: tuple[Diagnostic, ...]

    def __init__(self, found: tuple[Diagnostic, ...]):
        super().__init__("\n".join(one.rendered or one.message for one in found if one.rendered) or found[0].message)
        self.diagnostics = tuple(found)

    @classmethod
    def of(cls, text: str) -> HardpointError:
        """Error with diagnostics in JSON."""
        return cls(diagnostics(text))

    @classmethod
    def saying(cls, message: str):
        """Error with a message alone."""
        return cls((Diagnostic.of(_plain(message)),))

    def __reduce__(self) -> Any:
        return type(self), (self.diagnostics,)

    def __getattr__(self, name: str) -> Any:
        if name in ("code", "element", "file", "line", "column", "help", "rendered", "message"):
            return getattr(self.diagnostics[0], name)
        raise AttributeError(name)


class ModelError(HardpointError):
    """The file cannot be read, or the text is not a valid model."""


class TopologyError(HardpointError):
    """The mechanism cannot be driven: too few or too many drivers, or constraints that contradict each other."""


class MotionStopped(HardpointError):
    """A motion ends before its last output time: it locks, does not assemble, or leaves the range of a law. `run` has the solved part."""

    run: Run | None = None


class CannotFollow(HardpointError):
    """A design variable is inadmissible: redundant constraints would contradict each other, so there is no sensitivity."""


class StudyError(HardpointError):
    """A study is impossible."""


class UsageError(HardpointError, ValueError):
    """Invalid request: a name that does not exist, an array of the wrong shape."""


class FileError(HardpointError, OSError):
    """A file cannot be written or read: its folder does not exist, or permits neither. The reason is Python's `OSError`."""

    @classmethod
    def of_system(cls, job: str, path: object, error: OSError):
        """Error of the operating system about the user's file."""
        return cls.saying(f"`{path}` cannot be {job}: {error.strerror or error}")


class HardpointWarning(UserWarning):
    """Warnings and notes of the engine."""


def index_of(what: str, name: object, known: Iterable[str]) -> int:
    """Index of a name in a list of known names."""
    names = list(known)
    if not isinstance(name, str) or name not in names:
        raise unknown(what, name, names)
    return names.index(name)


def unknown(what: str, name: object, known) -> UsageError:
    """Error for an unknown name, with the most similar known name."""
    if not isinstance(name, str):
        return UsageError.saying(f"the name of a {what} is a text, not {name!r}")
    from difflib import get_close_matches

    known = list(known)
    near = get_close_matches(name, known, 1)
    if near:
        help = f"did you mean `{near[0]}`?"
    elif known:
        help = "there are " + ", ".join(f"`{one}`" for one in known[:12]) + (", ..." if len(known) > 12 else "")
    else:
        help = "the model has none"
    return UsageError.saying(f"there is no {what} named `{name}`; {help}")
