"""The mechanism in OpenMDAO, SciPy, JAX and CasADi: exact derivatives in both directions."""

import os

import numpy as np
import pytest

import hardpoint
from conftest import MODELS

os.environ.setdefault("OPENMDAO_REPORTS", "0")

MECHANISMS = {
    "macpherson.toml": (["tie_rod_outer_z", "ball_joint_y", "lca_tilt"], ["toe", "camber"]),
    "double_wishbone.toml": (["lca_location_z", "rocker_tilt", "pushrod_inner_z"], ["toe", "rocker_angle"]),
    "rssr.toml": (["R1_z", "R2_rx", "B_y"], ["rocker_angle"]),
    "slider_crank.toml": (["J1_x", "J2_y", "J4_rz"], ["stroke", "rod_angle"]),
    "hooke.toml": (["shaft_angle"], ["output_angle"]),
}
"""Five models, each with rotations among the variables."""

AGREE = 2e-6
"""Accuracy of central differences, relative to the largest derivative."""


@pytest.fixture(params=MECHANISMS)
def function(request):
    variables, of = MECHANISMS[request.param]
    return hardpoint.Function(hardpoint.read(MODELS / request.param), variables, of)


def differences(f, x):
    steps = np.diag(f.steps)
    return np.stack([(f(x + by) - f(x - by)) / (2 * by.max()) for by in steps], axis=1)


def somewhere(f):
    """A generic design close to the nominal one."""
    return f.start + 10 * f.steps


def test_function(function):
    x = somewhere(function)
    slopes = function.jacobian(x)
    assert slopes.shape == (function.size, len(function.variables))
    assert abs(slopes - differences(function, x)).max() < AGREE * abs(slopes).max()


def test_check_partials(function):
    om = pytest.importorskip("openmdao.api")
    from openmdao.utils.assert_utils import assert_check_partials

    from hardpoint.openmdao import MechanismComp

    problem = om.Problem(reports=False)
    names = [part.of for part in function.parts]
    problem.model.add_subsystem("m", MechanismComp(model=function.model, variables=function.variables, of=names), promotes=["*"])
    problem.setup(mode="rev", force_alloc_complex=False)
    for name, value in zip(function.variables, somewhere(function)):
        problem.set_val(name, value)
    problem.run_model()
    largest = abs(function.jacobian(somewhere(function))).max()
    # Either tolerance suffices: small derivatives are compared with the largest.
    data = problem.check_partials(out_stream=None)
    assert_check_partials(data, atol=AGREE * largest, rtol=0.0)
    for mode in ("fwd", "rev"):
        problem.setup(mode=mode)
        for name, value in zip(function.variables, somewhere(function)):
            problem.set_val(name, value)
        problem.run_model()
        totals = problem.compute_totals(of=[names[0]], wrt=list(function.variables))
        for k, name in enumerate(function.variables):
            wanted = function.jacobian(somewhere(function))[function.parts[0].place, k]
            assert np.array_equal(totals[names[0], name].ravel(), wanted), mode


def test_jax(function):
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    from jax.test_util import check_grads

    from hardpoint.jax import function as of_jax

    f, x = of_jax(function), somewhere(function)
    exact = function.jacobian(x)
    assert np.array_equal(jax.jacfwd(f)(x), exact)
    assert np.allclose(jax.jit(jax.jacrev(f))(x), exact, rtol=1e-13, atol=0)
    # Differences along a random direction, as in JAX: scaled by the steps, so that all variables have the same weight.
    scale = 1 / abs(exact * function.steps).max()
    check_grads(lambda s: scale * f(x + s * function.steps), (np.zeros(len(x)),), order=1, modes=("fwd", "rev"), atol=1e-4, rtol=1e-4, eps=1.0)
    many = jax.vmap(f)(np.stack([x, x + function.steps]))
    assert np.array_equal(many[1], function(x + function.steps))


def test_casadi(function):
    casadi = pytest.importorskip("casadi")
    from hardpoint.casadi import MechanismCallback

    callback = MechanismCallback(function)
    x = casadi.MX.sym("x", len(function.variables))
    slopes = casadi.Function("slopes", [x], [casadi.jacobian(callback(x), x)])
    at = somewhere(function)
    assert np.array_equal(np.array(slopes(at)), function.jacobian(at))


def test_scipy_finds_a_known_design():
    scipy = pytest.importorskip("scipy.optimize")
    model = hardpoint.read(MODELS / "macpherson.toml")
    f = hardpoint.Function(model, ["tie_rod_outer_z", "tie_rod_inner_z", "ball_joint_z"], ["toe", "camber"])
    hidden = np.array([1.5, -2.0, 0.7])
    wanted = f(hidden)
    found = scipy.least_squares(lambda x: f(x) - wanted, f.start, jac=f.jacobian, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    assert found.x == pytest.approx(hidden, abs=1e-7)


def test_scipy_minimises_a_metric(toe):
    scipy = pytest.importorskip("scipy.optimize")
    case = toe.cases[0]
    metric = next(iter(toe.metrics(case)))
    f = hardpoint.Function(toe.case(case), of=metric)
    low, high = f.bounds
    found = scipy.minimize(f.value, f.start, jac=f.gradient, bounds=list(zip(low, high)), method="L-BFGS-B")
    assert found.fun < f.value(f.start)


def test_openmdao_backtracks_from_designs_that_lock(strut):
    om = pytest.importorskip("openmdao.api")
    from hardpoint.openmdao import MechanismComp

    problem = om.Problem(reports=False)
    problem.model.add_subsystem("m", MechanismComp(model=strut, variables=["tie_rod_outer_z"], of="toe"), promotes=["*"])
    problem.setup()
    problem.set_val("tie_rod_outer_z", 1000.0)
    with pytest.raises(om.AnalysisError, match="cannot move beyond"):
        problem.run_model()
