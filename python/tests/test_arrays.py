"""Results are read-only, so that readers cannot change shared arrays."""

import inspect

import numpy as np
import pytest

import hardpoint
from conftest import K_AND_C, MODELS

DESIGNS = [[0.1], [0.2]]
NAMES = ["tie_rod_outer_z"]

ASKED = {
    "Model": {
        "times": (),
        "gradients": ("toe",),
        "second_derivatives": ("toe", NAMES),
        "jerk": (),
    },
    "Run": {
        "values": ("toe",),
        "sensitivity": ("toe", NAMES[0]),
        "sensitivities": ("toe", NAMES),
        "rigid_values": ("toe",),
    },
    "Positions": {"position": ("knuckle",), "quaternion": ("knuckle",)},
    "Reaction": {},
    "DriverLoad": {},
    "Deflection": {},
    "Body": {},
    "BodySensitivity": {},
    "Designs": {"metric": (next(iter(hardpoint.read(MODELS / "studies/strut_toe.toml").metrics("bump"))),)},
    "SweepResult": {},
}
"""Arguments for the methods that return arrays; a test fails if one is missing."""


@pytest.fixture(scope="module")
def results(strut):
    toe = hardpoint.read(MODELS / "studies/strut_toe.toml")
    run = strut.run()
    press = hardpoint.read(MODELS / "press.toml").run()
    return {
        "Model": strut,
        "Run": run,
        "Positions": strut.at(rack_drive=[1.0, 2.0]),
        "Reaction": press.reaction("A"),
        "DriverLoad": press.driver("motor"),
        "Deflection": hardpoint.read(K_AND_C).run(case="steer").deflection("left_lca_rear", "z"),
        "Body": run.body("knuckle" if "knuckle" in strut.bodies else strut.bodies[0]),
        "BodySensitivity": run.body_sensitivity(strut.bodies[0], NAMES[0]),
        "Designs": toe.designs([[v.drawn for v in toe.variables.values()]] * 2, "toe", case="bump"),
        "SweepResult": hardpoint.read(MODELS / "studies/strut_sweep.toml").sweep(samples=4, curves=["toe"]),
    }


def inside(value):
    """Arrays in a value."""
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, dict):
        for item in value.values():
            yield from inside(item)
    elif isinstance(value, (list, tuple)):
        for item in value:
            yield from inside(item)


def returning_arrays(of):
    """Public methods that return arrays, by their annotations."""
    for name, method in inspect.getmembers(of, inspect.isfunction):
        if not name.startswith("_") and "ndarray" in str(inspect.signature(method).return_annotation):
            yield name


def arrays(result, asked):
    """All arrays of an object, by source."""
    for name in dir(result):
        if name.startswith("_") or callable(getattr(type(result), name, None)):
            continue
        for array in inside(getattr(result, name)):
            yield name, array
    for name, arguments in asked.items():
        for array in inside(getattr(result, name)(*arguments)):
            yield name, array


@pytest.mark.parametrize("kind", ASKED)
def test_arrays_are_read_only(kind, results):
    result, asked = results[kind], ASKED[kind]
    assert set(returning_arrays(type(result))) == set(asked), "a method that returns arrays is not tested"
    found = list(arrays(result, asked))
    assert found
    for name, array in found:
        before = array.copy()
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
        with pytest.raises(ValueError, match="read-only"):
            array *= 2
        assert np.array_equal(array, before, equal_nan=array.dtype.kind == "f"), name


def test_results_of_the_engine_stay_read_only(results):
    """Neither shared arrays nor their bases can be made writeable."""
    run, designs = results["Run"], results["Designs"]
    for array in (run.times, run.values("toe"), run.sensitivities("toe"), run.body(run.model.bodies[0]).position, designs.values):
        while array is not None and isinstance(array, np.ndarray):
            with pytest.raises(ValueError):
                array.flags.writeable = True
            array = array.base


def test_numbers_of_a_function_belong_to_the_caller(strut):
    f = hardpoint.Function(strut, NAMES, ["toe"])
    for ask in (f, f.jacobian):
        first = ask(f.start)
        kept = first.copy()
        first[...] = 0
        assert np.array_equal(ask(f.start), kept) and kept.any()
