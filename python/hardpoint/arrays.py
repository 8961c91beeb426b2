"""Arrays of results."""

from __future__ import annotations

import numpy as np


def frozen(array: np.ndarray) -> np.ndarray:
    """Makes the array read-only, so that no reader changes shared results."""
    array.flags.writeable = False
    return array
