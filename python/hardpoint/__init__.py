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
    FileError,
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
from .plots import plot
from .positions import Positions
from .run import Body, BodySensitivity, Deflection, DriverLoad, Metric, Reaction, Run
from .stored import load as load_run
from .studies import DriverTable, Map, Study, SweepResult
from .tools import (
    compare,
    export_formats,
    import_formats,
    import_model,
    new,
    schema,
    synthesize,
    templates,
)

__all__ = [
    "Body",
    "BodySensitivity",
    "CannotFollow",
    "Deflection",
    "Designs",
    "Diagnostic",
    "DriverLoad",
    "DriverTable",
    "FileError",
    "Function",
    "HardpointError",
    "HardpointWarning",
    "Map",
    "Metric",
    "Model",
    "ModelError",
    "MotionStopped",
    "Output",
    "Positions",
    "Reaction",
    "Run",
    "Study",
    "StudyError",
    "SweepResult",
    "TopologyError",
    "UsageError",
    "Variable",
    "__version__",
    "build",
    "compare",
    "export_formats",
    "import_formats",
    "import_model",
    "load_run",
    "new",
    "parse",
    "plot",
    "read",
    "schema",
    "synthesize",
    "templates",
]
