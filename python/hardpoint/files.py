"""Atomic writing of files."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from .errors import FileError, UsageError


def where(path: str | os.PathLike) -> str:
    """A path as a text."""
    try:
        return os.fsdecode(path)
    except TypeError:
        raise UsageError.saying(f"a path is a text or a `pathlib.Path`, not {path!r}") from None


def target(path: str | os.PathLike) -> Path:
    """The path of a file that is written."""
    name = where(path)
    if not Path(name).name or "\0" in name:
        raise FileError.saying(f"`{name}` cannot be written: it does not name a file")
    return Path(name)


def write(path: str | os.PathLike, text: str) -> None:
    """Writes a text atomically."""
    write_bytes(path, text.encode())


def write_bytes(path: str | os.PathLike, contents: bytes) -> None:
    """Writes a file atomically."""
    path = target(path)
    beside = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        with open(beside, "wb") as out:
            out.write(contents)
        os.replace(beside, path)
    except OSError as error:
        raise FileError.of_system("written", path, error) from error
    finally:
        with contextlib.suppress(OSError):
            beside.unlink()
