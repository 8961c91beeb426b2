"""Exact kinematics and design sensitivities of driven mechanisms.

    >>> import hardpoint
    >>> model = hardpoint.read("models/macpherson.toml")
    >>> run = model.run()
    >>> toe = run.values("toe")                                    # deg, at run.times
    >>> slope = run.sensitivity("toe", "tie_rod_outer_z")          # deg/mm, exact

All numbers are in the units of the model file, all arrays are NumPy's. `docs/python.md` has the tour.
"""

from ._native import version as __version__
from .designs import Designs
from .errors import (
    CannotFollow,
    Diagnostic,
    HardpointError,
    HardpointWarning,
    ModelError,
    MotionStopped,
    StudyError,
    TopologyError,
    UsageError,
)
from .function import Function
from .model import Model, Output, Variable, build, parse, read
from .run import Body, Metric, Run
from .studies import Study, SweepResult

__all__ = [
    "Body",
    "CannotFollow",
    "Designs",
    "Diagnostic",
    "Function",
    "HardpointError",
    "HardpointWarning",
    "Metric",
    "Model",
    "ModelError",
    "MotionStopped",
    "Output",
    "Run",
    "Study",
    "StudyError",
    "SweepResult",
    "TopologyError",
    "UsageError",
    "Variable",
    "__version__",
    "build",
    "parse",
    "read",
]
