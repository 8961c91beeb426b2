"""Atomic writing of files."""

from __future__ import annotations

import os
from pathlib import Path


def write(path: str | os.PathLike, text: str) -> None:
    """Writes a text atomically."""
    path = Path(path)
    beside = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        with open(beside, "w", encoding="utf-8", newline="\n") as out:
            out.write(text)
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)
