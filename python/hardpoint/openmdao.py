"""A mechanism as a component of OpenMDAO (`pip install 'hardpoint[openmdao]'`)."""

from __future__ import annotations

from collections.abc import Iterable

import openmdao.api as om

from .errors import CannotFollow, MotionStopped, StudyError
from .function import Function
from .model import Model


def plain(name: str) -> str:
    """Converts a name to one that OpenMDAO allows."""
    return "".join(c if c.isalnum() or c == "_" else "_" for c in name)


class MechanismComp(om.ExplicitComponent):
    """Inputs are design variables, outputs metrics (a number each) and curves (a number for each output time), partials exact.

    Options: `model`, `variables` (those with bounds), `of` (all metrics; see `hardpoint.Function`). Names are those of the model, what is
    neither letter, digit nor underscore replaced by an underscore: `bump.toe` is `bump_toe`. Inputs are in the units of the model file.
    A design that does not move to its end raises `om.AnalysisError`, from which drivers step back.
    """

    def initialize(self):
        self.options.declare("model", types=Model, desc="the mechanism")
        self.options.declare("variables", default=None, desc="names of design variables")
        self.options.declare("of", default=None, desc="names of metrics, measures and point coordinates")

    def setup(self):
        variables, of = self.options["variables"], self.options["of"]
        self.function = Function(self.options["model"], _list(variables), _list(of))
        model = self.function.model
        for name, value in zip(self.function.variables, self.function.start):
            self.add_input(plain(name), val=value, desc=f"design variable `{name}` [{model.variables[name].unit}]")
        for part in self.function.parts:
            self.add_output(plain(part.name), shape=part.place.stop - part.place.start, desc=f"`{part.name}` [{part.unit}]")
        self.declare_partials("*", "*")
        # The engine does not support complex steps.
        for name, step in zip(self.function.variables, self.function.steps):
            self.set_check_partial_options(plain(name), method="fd", form="central", step=step, step_calc="abs")

    def _x(self, inputs):
        return [inputs[plain(name)].item() for name in self.function.variables]

    def compute(self, inputs, outputs):
        values = _solved(self.function, self._x(inputs))
        for part in self.function.parts:
            outputs[plain(part.name)] = values[part.place]

    def compute_partials(self, inputs, partials):
        jacobian = _solved(self.function.jacobian, self._x(inputs))
        for part in self.function.parts:
            for column, name in enumerate(self.function.variables):
                partials[plain(part.name), plain(name)] = jacobian[part.place, column]


def _list(names: str | Iterable[str] | None):
    return [names] if isinstance(names, str) else names


def _solved(function, x):
    try:
        return function(x)
    except (MotionStopped, StudyError) as error:
        raise om.AnalysisError(str(error)) from error
    except CannotFollow as error:
        raise RuntimeError(f"{error}\nleave this variable out of `variables`") from error
