"""Positions as functions of the drivers, and runs with other times and laws."""

import numpy as np
import pytest

import hardpoint
from conftest import MODELS

SAME = 1e-9
"""Relative difference of one position that is reached on two ways: the tolerance of the solver."""
AGREE = 2e-6
"""Accuracy of central differences, relative to the derivative."""


@pytest.mark.parametrize(
    ("name", "drivers"),
    [
        ("macpherson.toml", {"rack_drive": 12.0, "strut_drive": -20.0}),
        ("double_wishbone.toml", None),
        ("rssr.toml", None),
        ("stewart.toml", None),
        ("excavator.toml", None),
        ("front_axle.toml", None),
    ],
)
def test_a_position_is_that_of_a_run_through_it(name, drivers):
    """A run's laws tell where its drivers are; the position there has the same measures and the same derivatives by the design."""
    model = hardpoint.read(MODELS / name)
    if model.cases:
        model = model.case(model.cases[0])
    names = [driver["name"] for driver in model.drivers]
    drivers = drivers or {name: 0.02 * (1 + k) for k, name in enumerate(names)}
    laws = {name: f"{driver['nominal']} + {drivers.get(name, 0.0)!r} * t" for name, driver in zip(names, model.drivers)}
    at = {name: driver["nominal"] + drivers.get(name, 0.0) for name, driver in zip(names, model.drivers)}
    run = model.run(times=[0.0, 1.0], laws=laws)
    position = model.at(at)
    compared = 0
    for output in model.outputs.values():
        if not output.by_position:
            continue
        assert position[output.name] == pytest.approx(run.values(output.name)[-1], rel=SAME, abs=SAME * 100, nan_ok=True)
        for variable in run.followed[:3]:
            expected = run.sensitivity(output.name, variable)[-1]
            assert position.sensitivity(output.name, variable) == pytest.approx(expected, rel=1e-6, abs=1e-7, nan_ok=True)
            compared += 1
    assert compared or not model.variables
    for body in model.bodies:
        assert position.position(body) == pytest.approx(run.body(body).position[-1], rel=SAME, abs=SAME * 100)


def test_a_reversed_driver_counts_like_its_laws(tmp_path):
    plain, path = MODELS / "four_bar.toml", tmp_path / "reversed.toml"
    path.write_text(plain.read_text().replace('law = "', 'reversed = true, law = "'))
    plain, model = hardpoint.read(plain), hardpoint.read(path)
    there, back = model.at(motor=10), plain.at(motor=-10)
    run = model.run(times=[0, 1], laws={"motor": "10*t"})
    table = model.table({"motor": (0, 10)}, of=["rocker_angle"], error="0.01deg")
    assert there["crank_angle"] == pytest.approx(-10, rel=SAME) and there.derivative("crank_angle", "motor") == pytest.approx(-1, rel=SAME)
    assert there["rocker_angle"] == pytest.approx(back["rocker_angle"], rel=SAME)
    assert there["rocker_angle"] == pytest.approx(run.values("rocker_angle")[-1], rel=SAME)
    assert table("rocker_angle", motor=10) == pytest.approx(there["rocker_angle"], abs=0.01)


def test_derivatives_by_drivers_are_differences(strut):
    at, by = {"rack_drive": 5.0, "strut_drive": 10.0}, 1e-3
    position = strut.at(at)
    for driver in at:
        there, back = (strut.at({**at, driver: at[driver] + sign * by}) for sign in (1, -1))
        for name in ("toe", "camber", "wheel_travel"):
            slope = (there[name] - back[name]) / (2 * by)
            assert position.derivative(name, driver) == pytest.approx(slope, rel=AGREE, abs=1e-8), (name, driver)
    assert abs(position.derivative("toe", "rack_drive")) > 0.1


def test_arrays_of_drivers_give_arrays_of_results(strut):
    rack = np.linspace(-20, 20, 5)[:, None]
    travel = np.linspace(-30, 30, 7)
    grid = strut.at(rack_drive=rack, strut_drive=travel)
    assert grid["toe"].shape == grid.derivative("toe", "rack_drive").shape == (5, 7) and len(grid) == 35
    assert grid.position("knuckle").shape == (5, 7, 3) and grid.quaternion("knuckle").shape == (5, 7, 4)
    one = strut.at(rack_drive=float(rack[3, 0]), strut_drive=float(travel[2]))
    assert isinstance(one["toe"], float) and one["toe"] == pytest.approx(grid["toe"][3, 2], rel=1e-12)
    assert not grid["toe"].flags.writeable
    frame = grid.to_pandas()
    assert frame.shape[0] == 35 and (frame["toe [deg]"] == grid["toe"].ravel()).all()
    assert "rack_drive = -20 to 20 mm" in repr(grid)


def test_a_changed_design_has_its_own_positions(strut):
    design = {"tie_rod_outer_z": 2.0}
    changed, nominal = strut.at(strut_drive=10, design=design), strut.at(strut_drive=10)
    predicted = nominal["toe"] + 2.0 * nominal.sensitivity("toe", "tie_rod_outer_z")
    assert changed["toe"] == pytest.approx(predicted, abs=0.02 * abs(changed["toe"] - nominal["toe"])) and changed["toe"] != nominal["toe"]


def test_what_cannot_be_reached_is_reported_in_terms_of_the_drivers(strut):
    with pytest.raises(hardpoint.MotionStopped, match="cannot be moved to `rack_drive` = 1000 mm.*it stops at `rack_drive` = 961") as raised:
        strut.at(rack_drive=1000)
    assert raised.value.code == "HP0401" and " t = " not in str(raised.value)
    some = strut.at(rack_drive=[0.0, 1000.0, 10.0], partial=True)
    assert list(some.stops) == [1] and np.isnan(some["toe"]).tolist() == [False, True, False]
    assert np.isnan(some.position("knuckle")[1]).all() and "1 not reached" in repr(some)


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda m: m.at(rack_drve=1), "did you mean `rack_drive`"),
        (lambda m: m.at({"rack_drive": "far"}), "driver `rack_drive`: .far. is not a number"),
        (lambda m: m.at(rack_drive=float("nan")), "finite"),
        (lambda m: m.at(rack_drive=[1, 2], strut_drive=[1, 2, 3]), "different shapes"),
        (lambda m: m.at(3), "drivers are named"),
        (lambda m: m.at(rack_drive=1, workers=-2), "whole number from 1"),
        (lambda m: m.at(rack_drive=1, forces={"wind": 3.0}), "no force with a law"),
        (lambda m: m.at(rack_drive=1).value("toee"), "did you mean `toe`"),
        (lambda m: m.at(rack_drive=1).derivative("toe", "rack"), "no driver named"),
        (lambda m: m.at(rack_drive=1, sensitivities=False).sensitivity("toe", "tie_rod_outer_z"), "without sensitivities"),
        (lambda m: m.run(laws={"rack_drve": "t"}), "did you mean `rack_drive`"),
        (lambda m: m.run(laws="t"), "laws are named"),
        (lambda m: m.run(times=[1, 0]), "increasing"),
        (lambda m: m.run(times=[0, 1], laws={"rack_drive": [1, 2, 3]}), "each of the 2 output times"),
        (lambda m: m.run(tmes=[0, 1]), "did you mean `times`"),
    ],
)
def test_invalid_positions_and_laws_are_reported(strut, ask, says):
    with pytest.raises(hardpoint.UsageError, match=says):
        ask(strut)


def test_static_loads_of_a_position(press):
    """The torque at rest is that of a run with static loads there; the force that changes over time is given."""
    with pytest.raises(hardpoint.UsageError, match='force `work` changes over time.*forces={"work": 100.0}'):
        press.at(motor=30)
    here = press.with_(loads="static").at(motor=30, forces={"work": 300.0})
    still = press.with_(loads="static", forces={"work": {"law": 1}}).at(motor=30)
    assert here["torque"] == pytest.approx(still["torque"], rel=1e-9) and here["torque"] != 0
    by = 1e-3
    there, back = (press.at(motor=30 + sign * by, forces={"work": 300.0})["torque"] for sign in (1, -1))
    assert here.derivative("torque", "motor") == pytest.approx((there - back) / (2 * by), rel=1e-5)


@pytest.fixture(scope="module")
def press():
    return hardpoint.read(MODELS / "press.toml")


def test_a_driver_of_a_measure_has_the_value_of_the_measure(strut):
    start = strut.at()["wheel_travel"]
    model = strut.with_(drivers={"strut_drive": {"joint": None, "measure": "wheel_travel", "law": f"{start} + t"}})
    position = model.at(strut_drive=12)
    assert position["wheel_travel"] == pytest.approx(12, abs=1e-9)
    assert position.derivative("wheel_travel", "strut_drive") == pytest.approx(1, abs=1e-9)
    assert position.derivative("toe", "strut_drive") != 0


def test_laws_as_arrays_pass_through_their_values(strut):
    times = np.linspace(0, 2, 9)
    values = 10 * np.sin(times)
    run = strut.run(times=times, laws={"strut_drive": values, "rack_drive": 0})
    assert (run.times == times).all()
    for k in (0, 4, 8):
        assert run.values("toe")[k] == pytest.approx(strut.at(strut_drive=values[k])["toe"], rel=1e-9)
    # A single output time
    single = strut.run(times=[0.5], laws={"strut_drive": values[:1] + 3, "rack_drive": [0]})
    assert single.values("toe").tolist() == strut.run(times=[0.5], laws={"strut_drive": 3, "rack_drive": 0}).values("toe").tolist()
    assert strut.run(times={"end": 1, "steps": 4}).times.tolist() == [0, 0.25, 0.5, 0.75, 1]


def test_positions_are_a_data_set(strut):
    pytest.importorskip("xarray")
    rack, travel = np.linspace(-20, 20, 5), np.linspace(-30, 30, 7)
    grid = strut.at(rack_drive=rack[:, None], strut_drive=travel)
    data = grid.to_xarray()
    assert data["toe"].dims == ("rack_drive", "strut_drive") and data["toe"].attrs["units"] == "deg"
    assert (data["toe"].sel(rack_drive=rack[3], strut_drive=travel[2]).values == grid["toe"][3, 2]).all()
    assert (data["d toe"].sel(variable="rack_drive").values == grid.derivative("toe", "rack_drive")).all()
    assert (data["d toe"].sel(variable="tie_rod_outer_z").values == grid.sensitivity("toe", "tie_rod_outer_z")).all()
    assert data["rack_drive"].attrs["units"] == "mm" and set(data["toe"].coords) == {"rack_drive", "strut_drive"}
    # Along a path both drivers change.
    path = strut.at(rack_drive=rack, strut_drive=0.5 * rack, sensitivities=False).to_xarray()
    assert path["toe"].dims == ("position",) and (path["strut_drive"].values == 0.5 * rack).all() and "d toe" not in path
    one = strut.at(strut_drive=3)
    assert float(one.to_xarray()["toe"]) == one["toe"] and float(one.to_xarray()["strut_drive"]) == 3


def test_a_limit_of_the_program_is_named_as_such():
    model = hardpoint.read(MODELS / "four_bar.toml")
    with pytest.raises(hardpoint.MotionStopped, match="limit of the program, not of the mechanism, is `motor` = 5.72") as raised:
        model.at(motor=1e9)
    assert "100,000 rad" in raised.value.help and "it stops" not in str(raised.value)


def test_a_loop_over_forces_has_few_solvers(press):
    values = [press.at(motor=30, forces={"work": float(force)})["torque"] for force in range(10)]
    assert values == sorted(values) or values == sorted(values, reverse=True)
    assert press._solver.cache_info().currsize <= press._solver.cache_info().maxsize < 10


def test_laws_as_arrays_are_at_rest_at_their_ends(strut):
    times = np.linspace(0, 2, 9)
    clamped = strut.run(times=times, laws={"strut_drive": 10 * times, "rack_drive": 0}).values("wheel_travel", "rate")
    assert clamped[[0, -1]] == pytest.approx(0, abs=1e-9) and abs(clamped[4]) > 1
    table = {"type": "table", "points": np.column_stack([times, 10 * times]), "ends": "natural"}
    natural = strut.run(times=times, laws={"strut_drive": table, "rack_drive": 0}).values("wheel_travel", "rate")
    straight = strut.run(times=times, laws={"strut_drive": "10 * t", "rack_drive": 0}).values("wheel_travel", "rate")
    assert natural == pytest.approx(straight, rel=1e-9)


def test_laws_hold_in_their_case_only(toe):
    run = toe.run(case="bump", laws={"strut_drive": "20 * t"}, times=[0, 1])
    assert run.case == "bump" and run.metrics and len(run) == 2
    assert len(toe.run(case="bump")) == 81
    assert "20 * t" in run.model.to_toml() and "20 * t" not in toe.to_toml()
    assert len(run.model.run(case="steer")) == len(toe.run(case="steer"))


ARM = """name = "arm"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 300, 0], W = [0, 700, 0] }
bodies.arm = {}
joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "x" }
drivers.bump = { joint = "hinge", law = "5*t" }
wheels.w = { body = "arm", centre = "W", toe = 0, camber = 0, radius = 300 }
measures.torque = { type = "driver_force" }
time = { end = 1, steps = 4 }
forces.load = { LOAD, law = "t" }
"""


@pytest.mark.parametrize(
    ("load", "value", "torque"),
    [
        ('type = "force", at = { body = "arm", at = "W" }, force = 250, along = "z"', 100.0, -40.0),
        ('type = "force", at = { body = "arm", at = "W" }, force = -250, along = "z"', 100.0, -40.0),
        ('type = "moment", body = "arm", moment = 20, about = "x"', 10.0, -10.0),
        ('type = "wheel_force", wheel = "w", at = "centre", up = 250', 100.0, -40.0),
        ('type = "wheel_force", wheel = "w", at = "centre", up = 3, outboard = 4', 100.0, -24.0),
        ('type = "tyre", wheel = "w", stiffness = 200, height = 10', 5.0, -400.0),
    ],
)
def test_forces_of_a_position_do_not_depend_on_their_size_in_the_file(load, value, torque):
    """Forces are in N, moments in N m, and the road of a tyre in mm; the arm is 0.4 m long."""
    model = hardpoint.parse(ARM.replace("LOAD", load))
    assert model.at(bump=0, forces={"load": value})["torque"] == pytest.approx(torque, rel=1e-9)


def test_a_force_of_zero_has_no_value_in_a_position():
    load = 'type = "force", at = { body = "arm", at = "W" }, force = 0, along = "z"'
    with pytest.raises(hardpoint.UsageError, match="`load` is zero in the file"):
        hardpoint.parse(ARM.replace("LOAD", load)).at(bump=0, forces={"load": 100.0})


CORNER = """name = "corner"
units = { length = "mm", angle = "deg" }
hardpoints = { left_A = [0, 300, 0], left_B = [0, 600, 0] }
bodies.left_arm = {}
joints.left_hinge = { type = "revolute", bodies = ["ground", "left_arm"], at = "left_A", axis = "x" }
drivers.left_bump = { point = "left_wheel", along = "z", law = "20*sin(t)" }
points.left_wheel = { body = "left_arm", at = "left_B" }
forces.left_load = { type = "force", at = "left_wheel", force = 100, along = "z", law = "t" }
measures.left_push = { type = "driver_force", driver = "left_bump" }
time = { end = 1, steps = 4 }
"""
CASES = """
[cases.left_up]
laws = { left_bump = "30*t" }
[cases.both]
laws = { left_bump = "30*t" }
[mirror]
"""


@pytest.fixture(scope="module")
def axle(tmp_path_factory):
    folder = tmp_path_factory.mktemp("axle")
    (folder / "corner.toml").write_text(CORNER)
    (folder / "axle.toml").write_text('name = "axle"\ninclude = ["corner.toml"]\nmirror = {}\ntime = { end = 1, steps = 4 }\n')
    return hardpoint.read(folder / "axle.toml")


def ends(run, *names):
    return [float(run.values(name)[-1]) for name in names]


def test_laws_of_one_side_leave_the_other_side_alone(axle):
    left, right = ends(axle.run(), "left_wheel.z", "right_wheel.z")
    assert ends(axle.run(laws={"left_bump": "5*t"}), "left_wheel.z", "right_wheel.z") == pytest.approx([5.0, right])
    assert ends(axle.run(laws={"right_bump": "5*t"}), "left_wheel.z", "right_wheel.z") == pytest.approx([left, 5.0])
    assert ends(axle.run(laws={"left_bump": "5*t", "right_bump": 0}), "left_wheel.z", "right_wheel.z") == pytest.approx([5.0, 0.0])


def test_laws_of_included_and_mirrored_forces_are_replaced(axle):
    assert ends(axle.run(laws={"left_load": "5*t"}), "left_push", "right_push") == pytest.approx([-500.0, -100.0])
    assert ends(axle.run(laws={"right_load": "5*t"}), "left_push", "right_push") == pytest.approx([-100.0, -500.0])
    with pytest.raises(hardpoint.UsageError, match="did you mean `left_load`"):
        axle.run(laws={"left_loda": "5*t"})


def test_cases_of_the_mirror_have_other_times_and_laws():
    model = hardpoint.parse(CORNER + CASES)
    assert set(model.cases) == {"left_up", "right_up", "both"}
    sides = ("left_wheel.z", "right_wheel.z")
    own = {case: ends(model.run(case=case), *sides) for case in model.cases}
    for case in model.cases:
        assert ends(model.run(case=case, times=[0, 0.5, 1]), *sides) == pytest.approx(own[case])
        run = model.run(case=case, laws={"left_bump": "5*t"})
        assert ends(run, *sides) == pytest.approx([5.0, own[case][1]])
        others = [other for other in model.cases if other != case]
        assert all(ends(run.model.run(case=other), *sides) == pytest.approx(own[other]) for other in others)
