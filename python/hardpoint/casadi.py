"""A mechanism as a function of CasADi (`pip install 'hardpoint[casadi]'`)."""

from __future__ import annotations

import casadi
import numpy as np

from .function import Function


class _Jacobian(casadi.Callback):
    def __init__(self, name: str, of: Function, options: dict):
        casadi.Callback.__init__(self)
        self.of = of
        self.construct(name, options)

    def get_n_in(self):
        return 2

    def get_n_out(self):
        return 1

    def get_sparsity_in(self, k):
        return casadi.Sparsity.dense(self.of.size if k else len(self.of.variables), 1)

    def get_sparsity_out(self, k):
        return casadi.Sparsity.dense(self.of.size, len(self.of.variables))

    def eval(self, given):
        return [casadi.DM(self.of.jacobian(np.array(given[0]).ravel()))]


class MechanismCallback(casadi.Callback):
    """Function for CasADi's expressions and solvers, with the exact Jacobian of the engine. Keep a reference to the object as long as
    expressions use it."""

    def __init__(self, of: Function, name: str = "mechanism", options: dict | None = None):
        casadi.Callback.__init__(self)
        self.of = of
        self.construct(name, options or {})

    def get_n_in(self):
        return 1

    def get_n_out(self):
        return 1

    def get_sparsity_in(self, k):
        return casadi.Sparsity.dense(len(self.of.variables), 1)

    def get_sparsity_out(self, k):
        return casadi.Sparsity.dense(self.of.size, 1)

    def eval(self, given):
        return [casadi.DM(self.of(np.array(given[0]).ravel()))]

    def has_jacobian(self):
        return True

    def get_jacobian(self, name, inputs, outputs, options):
        # CasADi does not keep a reference to it.
        self._slopes = _Jacobian(name, self.of, options)
        return self._slopes
