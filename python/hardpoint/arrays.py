"""Arrays that are handed out."""

from __future__ import annotations

import numpy as np


def frozen(array: np.ndarray) -> np.ndarray:
    """The array, read-only: results that several readers share are not changed by one of them."""
    array.flags.writeable = False
    return array
