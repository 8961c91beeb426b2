"""Arrays of results."""

from __future__ import annotations

from collections.abc import Container

import numpy as np


def frozen(array: np.ndarray) -> np.ndarray:
    """Makes the array read-only, so that no reader changes shared results."""
    array.flags.writeable = False
    return array


def free(name: str, *taken: Container[str]) -> str:
    """A name, or the first one with `_` after it that is not taken."""
    while any(name in names for names in taken):
        name += "_"
    return name
