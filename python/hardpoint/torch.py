"""A mechanism as a function of PyTorch (`pip install 'hardpoint[torch]'`)."""

from __future__ import annotations

from collections.abc import Callable

import torch

from .errors import UsageError
from .function import Function


class _Mechanism(torch.autograd.Function):
    @staticmethod
    def forward(ctx, x, of):
        rows = x.detach().reshape(-1, x.shape[-1]).to("cpu", torch.float64).numpy()
        ctx.of, ctx.rows = of, rows
        values = torch.from_numpy(of.many(rows))
        return values.reshape(*x.shape[:-1], of.size).to(x)

    @staticmethod
    @torch.autograd.function.once_differentiable
    def backward(ctx, along):
        # Rows times Jacobians: dL/dx = J' dL/dy.
        jacobians = torch.from_numpy(ctx.of.many_jacobians(ctx.rows)).to(along)
        found = torch.einsum("ki,kij->kj", along.reshape(-1, ctx.of.size), jacobians)
        return found.reshape(*along.shape[:-1], jacobians.shape[-1]), None


def function(of: Function) -> Callable[[torch.Tensor], torch.Tensor]:
    """Function of tensors of double precision, `[..., variable]` to `[..., size]`, with the exact derivatives of the engine in backward
    mode. Leading dimensions are a batch, which is solved on all cores; derivatives of second order are not available.
    """

    def solved(x: torch.Tensor) -> torch.Tensor:
        if x.dtype != torch.float64:
            raise UsageError.saying(f"single precision is not enough for a mechanism: pass a tensor of `torch.float64`, not {x.dtype}")
        if x.ndim < 1 or x.shape[-1] != len(of.variables):
            raise UsageError.saying(f"the last dimension has the {len(of.variables)} variables; the shape given is {tuple(x.shape)}")
        return _Mechanism.apply(x, of)  # type: ignore[no-any-return, no-untyped-call]

    return solved
