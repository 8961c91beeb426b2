"""A mechanism as a function of JAX (`pip install 'hardpoint[jax]'`)."""

from __future__ import annotations

from collections.abc import Callable

import jax
import numpy as np

from .errors import UsageError
from .function import Function


def function(of: Function) -> Callable[[jax.Array], jax.Array]:
    """Function for `jax.jit`, `jax.grad`, `jax.jacfwd`, `jax.jacrev` and `jax.vmap`, with the exact derivatives of the engine in
    both directions. It takes and gives an array of double precision, as `of` does; `jax.config.update("jax_enable_x64", True)` is
    needed, since single precision is not enough for a mechanism.
    """
    if not jax.config.jax_enable_x64:
        raise UsageError.saying('JAX computes in single precision; say `jax.config.update("jax_enable_x64", True)` first')
    shape = jax.ShapeDtypeStruct((of.size,), np.float64)
    slopes = jax.ShapeDtypeStruct((of.size, len(of.variables)), np.float64)

    @jax.custom_jvp
    def solved(x):
        return jax.pure_callback(lambda x: of(np.asarray(x)), shape, x, vmap_method="sequential")

    @solved.defjvp
    def along(at, way):
        (x,), (dx,) = at, way
        # Linear in the direction, so that JAX can transpose it.
        jacobian = jax.pure_callback(lambda x: of.jacobian(np.asarray(x)), slopes, x, vmap_method="sequential")
        return solved(x), jacobian @ dx

    return solved
