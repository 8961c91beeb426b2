"""Long work: its end is noticed at once, and Ctrl-C long before."""

import os
import signal
import threading

import numpy as np
import pytest

import hardpoint
from conftest import MODELS
from hardpoint import _native

HOUR = 3_600_000
"""Milliseconds: a listener that notices the end only after this interval exceeds the time limit of a test."""


@pytest.fixture
def patience():
    """Sets the check interval of long work."""
    before = _native.set_patience(HOUR)
    yield _native.set_patience
    _native.set_patience(before)


def woken(work):
    """Number of wake-ups of the listener of some work."""
    before = _native.wake_ups()
    work()
    return _native.wake_ups() - before


def test_every_call_of_a_function_wakes_its_listener_once(strut, patience):
    f = hardpoint.Function(strut, ["tie_rod_outer_z"], ["toe"])
    designs = [f.start + 1e-3 * k for k in range(50)]
    assert woken(lambda: [f(x) for x in designs]) == 50
    assert woken(lambda: [f.jacobian(x) for x in designs]) == 50


LONG = {
    "designs": lambda toe: toe.designs(np.array([[v.drawn for v in toe.variables.values()]] * 3), "toe", case="bump"),
    "gradients": lambda toe: toe.gradients("toe", case="bump"),
    "second_derivatives": lambda toe: toe.second_derivatives("toe", next(iter(toe.variables)), case="bump"),
    "jerk": lambda toe: toe.jerk(case="bump"),
    "what_if": lambda toe: toe.what_if({next(iter(toe.variables)): 0.5}, case="bump"),
    "validity": lambda toe: toe.validity(case="bump"),
    "verify": lambda toe: toe.verify(case="bump"),
    "optimize": lambda toe: toe.optimize(starts=1, iterations=1),
    "sweep": lambda toe: hardpoint.read(MODELS / "studies/strut_sweep.toml").sweep(samples=4),
    "tolerance": lambda toe: hardpoint.read(MODELS / "studies/strut_tolerances.toml").tolerance(samples=4),
    "maps": lambda toe: hardpoint.read(MODELS / "studies/strut_map.toml").maps(),
}


@pytest.mark.parametrize("name", LONG)
def test_the_end_of_long_work_wakes_its_listener(name, toe, patience):
    assert woken(lambda: LONG[name](toe)) == 1


def test_progress_of_short_work_is_reported_once(strut, patience):
    reported = []
    strut.designs(np.zeros((5, 1)), "toe", variables=["tie_rod_outer_z"], progress=lambda *of: reported.append(of))
    assert reported == [(5, 5)]


def test_an_exception_of_the_callback_ends_the_work(strut, patience):
    class Enough(Exception):
        pass

    def enough(done, total):
        raise Enough

    patience(1)
    with pytest.raises(Enough):
        strut.designs(np.zeros((5000, 1)), "toe", variables=["tie_rod_outer_z"], at=[0], progress=enough)


@pytest.fixture(scope="module")
def slow():
    """A motion with enough output times that each study takes minutes."""
    text = (MODELS / "macpherson.toml").read_text()
    before, after = text.split("[time]")
    lines = [line if not line.startswith("steps") else "steps = 20000" for line in after.splitlines()]
    model = hardpoint.parse(before + "[time]" + "\n".join(lines), folder=MODELS)
    assert len(model.times()) == 20001
    return model


MINUTES = {
    "verify": lambda model: model.verify(),
    "validity": lambda model: [model.validity() for _ in range(1000)],
    "second_derivatives": lambda model: [model.second_derivatives("toe") for _ in range(1000)],
    "designs": lambda model: model.designs(np.zeros((512, 1)), "toe", variables=["tie_rod_outer_z"], at=[0]),
    "designs_in_batch": lambda model: model.designs(
        np.zeros((5120, 1)), "toe", variables=["tie_rod_outer_z"], at=[0], sensitivities=False
    ),
    "what_if": lambda model: [model.what_if({"tie_rod_outer_z": float(k)}) for k in range(1000)],
    "jerk": lambda model: [model.jerk() for _ in range(1000)],
    "gradients": lambda model: [model.gradients("toe") for _ in range(1000)],
    "run": lambda model: [model.run() for _ in range(1000)],
}


@pytest.mark.timeout(60)
@pytest.mark.parametrize("after", [0.05, 1.0])
@pytest.mark.parametrize("name", MINUTES)
def test_an_interruption_is_heard_between_two_output_times(name, after, slow):
    """Within the time limit of the test, although the complete work takes longer."""
    ended = threading.Event()
    timer = threading.Timer(after, lambda: ended.is_set() or os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            MINUTES[name](slow)
    finally:
        ended.set()
        timer.cancel()
