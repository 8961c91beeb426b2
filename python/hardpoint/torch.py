"""A mechanism as a function of PyTorch (`pip install 'hardpoint[torch]'`)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import torch

from .arguments import instance
from .errors import UsageError
from .function import Function


class _Mechanism(torch.autograd.Function):
    @staticmethod
    def forward(ctx, x, of):
        ctx.of = of
        ctx.save_for_backward(x)
        values = torch.from_numpy(of.many(_rows(x)))
        return values.reshape(*x.shape[:-1], of.size).to(x)

    @staticmethod
    def backward(ctx, along):
        return _Gradient.apply(*ctx.saved_tensors, along, ctx.of), None


class _Gradient(torch.autograd.Function):
    """Rows times Jacobians, dL/dx = J' dL/dy. It depends on the design too: without a node in the graph, second derivatives would be
    zero instead of an error."""

    @staticmethod
    def forward(ctx, x, along, of):
        jacobians = torch.from_numpy(of.many_jacobians(_rows(x))).to(along)
        return torch.einsum("ki,kij->kj", along.reshape(-1, of.size), jacobians).reshape(x.shape)

    @staticmethod
    def backward(ctx, *_):
        raise UsageError.saying("derivatives of second order of a mechanism are not available in PyTorch: differentiate it once")


def _rows(x: torch.Tensor) -> np.ndarray:
    return x.detach().reshape(-1, x.shape[-1]).to("cpu", torch.float64).numpy()


def function(of: Function) -> Callable[[torch.Tensor], torch.Tensor]:
    """Function of tensors of double precision, `[..., variable]` to `[..., size]`, with the exact derivatives of the engine in backward
    mode. Leading dimensions are a batch, which is solved on all cores; derivatives of second order are an error.
    """
    instance("of", of, Function, "hardpoint.Function")

    def solved(x: torch.Tensor) -> torch.Tensor:
        if not isinstance(x, torch.Tensor):
            raise UsageError.saying(f"a function of PyTorch takes a tensor of `torch.float64`, not `{type(x).__name__}`")
        if x.dtype != torch.float64:
            raise UsageError.saying(f"a mechanism needs double precision: pass a tensor of `torch.float64`, not `{x.dtype}`")
        if x.ndim < 1 or x.shape[-1] != len(of.variables):
            raise UsageError.saying(f"the last dimension has the {len(of.variables)} variables; the shape given is {tuple(x.shape)}")
        return _Mechanism.apply(x, of)  # type: ignore[no-any-return, no-untyped-call]

    return solved
