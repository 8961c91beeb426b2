"""Errors have a class, code, element, file and line, as on the command line."""

import pickle
import signal
import threading

import numpy as np
import pytest

import hardpoint
from conftest import MODELS


def test_a_model_with_errors_has_them_all(command, tmp_path):
    path = tmp_path / "strut.toml"
    text = (MODELS / "macpherson.toml").read_text().replace('type = "spherical"', 'type = "sperical"', 1)
    path.write_text(text)
    with pytest.raises(hardpoint.ModelError) as raised:
        hardpoint.read(path)
    error = raised.value
    assert error.code == "HP0204" and error.line == 1 + text[: text.index("sperical")].count("\n") and error.file == str(path)
    assert "did you mean `spherical`?" in str(error)
    assert error.rendered.strip() in command("check", path).stderr
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is hardpoint.ModelError and again.diagnostics == error.diagnostics


def test_a_mechanism_without_a_driver_is_a_topology_error(strut):
    text = strut.text.split("[drivers")[0] + "[time]" + strut.text.split("[time]")[1].split("\n[")[0]
    with pytest.raises(hardpoint.TopologyError) as raised:
        hardpoint.parse(text)
    assert raised.value.code.startswith("HP03") or raised.value.code.startswith("HP04")


def test_a_motion_that_locks_keeps_what_it_solved(strut):
    far = {"tie_rod_outer_z": 1000.0}
    with pytest.raises(hardpoint.MotionStopped) as raised:
        strut.run(far)
    error = raised.value
    assert error.code.startswith("HP04") and "cannot move beyond" in str(error)
    part = strut.run(far, partial=True)
    assert part.stop.code == error.code and 0 < len(part) < len(strut.run())
    assert (error.run.values("toe") == part.values("toe")).all() and np.isfinite(part.values("toe")).all()


def test_designs_that_lock_raise_or_are_listed(strut):
    designs = [{"tie_rod_outer_z": x} for x in (0.0, 1000.0, 1.0)]
    with pytest.raises(hardpoint.MotionStopped):
        strut.designs(designs, "toe")
    found = strut.designs(designs, "toe", partial=True)
    assert list(found.stops) == [1] and np.isnan(found.sensitivities[1]).all()
    assert np.isfinite(found.values[[0, 2]]).all() and np.isnan(found.values[1, 0, -1])


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda m: m.run().values("toee"), "did you mean `toe`"),
        (lambda m: m.run().sensitivity("toe", "ball_joint_zz"), "did you mean `ball_joint_z`"),
        (lambda m: m.run().values("toe", 3), "unknown order"),
        (lambda m: m.run().body("knuckel"), "did you mean `knuckle`"),
        (lambda m: m.run(case="bump"), "no case named `bump`"),
        (lambda m: m.run([1.0, 2.0]), "14 design variables"),
        (lambda m: m.run({"ball_joint_z": float("inf")}), "infinite"),
        (lambda m: m.designs(np.zeros((2, 3))), "14 variables"),
        (lambda m: m.gradients("toe", method="both"), "unknown method"),
        (lambda m: m.run(sensitivities=False).sensitivity("toe", "ball_joint_z"), "solved without sensitivities"),
        (lambda m: m.sweep(ranges={"ball_joint_q": (0, 1)}), "did you mean"),
        (lambda m: m.sweep(colour="red"), "unknown field"),
        (lambda m: hardpoint.Function(m, ["ball_joint_z"], ["nothing"]), "no metric or measure"),
        (lambda m: hardpoint.build(name="x", units={1, 2}), "consists of numbers"),
    ],
)
def test_invalid_requests_are_reported(strut, ask, says):
    with pytest.raises(hardpoint.UsageError, match=says) as raised:
        ask(strut)
    assert isinstance(raised.value, ValueError)


def test_impossible_studies_report_what_is_missing(strut):
    with pytest.raises(hardpoint.StudyError, match=r"\[optimize.goals\]"):
        strut.optimize()
    with pytest.raises(hardpoint.StudyError, match="tolerance"):
        strut.tolerance()


def test_a_model_with_cases_is_asked_for_one(toe):
    with pytest.raises(hardpoint.UsageError, match="has the cases"):
        toe.run()
    assert set(toe.runs()) == set(toe.cases)


def test_an_exception_of_a_callback_ends_the_work(toe):
    def report(done, total):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        toe.sweep(samples=1_000_000, ranges={"outer_z": (-1, 1)}, progress=report)


def test_control_c_ends_long_work(toe):
    """The signal is sent while work is known to run, and there is more work than could finish before it is noticed."""

    def report(done, total):
        if done:
            signal.raise_signal(signal.SIGINT)

    assert threading.current_thread() is threading.main_thread()
    with pytest.raises(KeyboardInterrupt):
        toe.sweep(samples=100_000_000, ranges={"outer_z": (-1, 1)}, progress=report)


def test_warnings_of_the_reader_are_warnings():
    text = (MODELS / "slider_crank.toml").read_text().replace('angle = "rad"', 'angle = "deg"')
    text = text.split("[drivers")[0] + '[drivers.motor]\njoint = "J1"\nlaw = "30 * sin(360 * t)"\n\n[time]\nend = 1\nsteps = 10\n'
    with pytest.warns(hardpoint.HardpointWarning, match="functions take radians"):
        hardpoint.parse(text)
