"""Atomic writing of files."""

from __future__ import annotations

import os
from pathlib import Path


def write(path: str | os.PathLike, text: str) -> None:
    """Writes a text atomically."""
    write_bytes(path, text.encode())


def write_bytes(path: str | os.PathLike, contents: bytes) -> None:
    """Writes a file atomically."""
    path = Path(path)
    beside = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        with open(beside, "wb") as out:
            out.write(contents)
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)
