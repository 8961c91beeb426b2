"""Motions and sensitivities: the reference cases of the Rust tests, and the command line's numbers to the last bit."""

import json
import pickle
import threading

import numpy as np
import pytest

import hardpoint
from conftest import MODELS, REFERENCE

NEAR = 1e-9
"""Tolerance as in the Rust tests: the output time has a rounding error, which changes the accelerations."""
LENGTHS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
ANGLES = {"deg": np.pi / 180, "rad": 1.0}
BODY = {"": "position", "v": "velocity", "omega_": "angular_velocity", "a": "acceleration", "alpha_": "angular_acceleration"}
"""Letters of the columns of a body."""


def si(model, unit):
    """Size of a unit of a model in SI."""
    factor = 1.0
    over = 1
    for part in unit.replace("/", " / ").split():
        if part == "/":
            over = -1
            continue
        name, _, power = part.partition("^")
        factor *= {**LENGTHS, **ANGLES, "s": 1.0, "1": 1.0}[name] ** (over * int(power or 1))
    return factor


@pytest.mark.parametrize("name", REFERENCE)
def test_reference(name):
    model = hardpoint.read(MODELS / name)
    run, expected = model.run(), REFERENCE[name]
    k = int(np.argmin(abs(run.times - expected["time"])))
    for measure, of in expected["measures"].items():
        value, _, acceleration = (si(model, unit) for unit in model.outputs[measure].units)
        assert run.values(measure)[k] * value == pytest.approx(of["value"], rel=NEAR, abs=NEAR)
        assert run.values(measure, "acceleration")[k] * acceleration == pytest.approx(of["acceleration"], rel=NEAR, abs=NEAR)
        for variable, d in of["sensitivities"].items():
            found = run.sensitivity(measure, variable, order=2)[k] * acceleration / si(model, model.variables[variable].unit)
            assert found == pytest.approx(d, rel=NEAR, abs=NEAR), (measure, variable)


@pytest.mark.parametrize("name", sorted(path.name for path in MODELS.glob("*.toml")))
def test_numbers_are_those_of_the_command_line_to_the_last_bit(name, command, tmp_path):
    done = command("run", MODELS / name, "-o", tmp_path, "--format", "npy", "--no-compare")
    assert done.returncode == 0, done.stderr
    model = hardpoint.read(MODELS / name)
    for case in model.cases or [None]:
        folder = tmp_path / case if case else tmp_path
        columns = json.loads((folder / "columns.json").read_text())
        motion = np.load(folder / "motion.npy")
        run = model.run(case=case)
        names = [column["name"] for column in columns["motion"]]
        assert (motion[:, names.index("t")] == run.times).all()
        for output in model.outputs.values():
            for order, column in enumerate(output.columns):
                assert np.array_equal(motion[:, names.index(column)], run.values(output.name, order), equal_nan=True), column
        for body in model.bodies:
            for letters, of in BODY.items():
                found = np.stack([motion[:, names.index(f"{body}.{letters}{c}")] for c in "xyz"], axis=1)
                assert np.array_equal(found, getattr(run.body(body), of)), (body, of)
        if not model.variables:
            continue
        d, of_d = np.load(folder / "sensitivity.npy"), [column["name"] for column in columns["sensitivity"]["columns"]]
        for b, variable in enumerate(v["name"] for v in columns["sensitivity"]["variables"]):
            if variable not in run.followed:
                with pytest.raises(hardpoint.CannotFollow) as raised:
                    run.sensitivity(next(iter(model.outputs)), variable)
                assert raised.value.code == "HP0501" and raised.value.element == variable
                continue
            for output in model.outputs.values():
                for order, column in enumerate(output.columns):
                    found = d[:, b, of_d.index(f"d {column}")]
                    assert np.array_equal(found, run.sensitivity(output.name, variable, order), equal_nan=True), (variable, column)


def test_arrays_are_made_once_and_slices_are_views(strut):
    run = strut.run()
    assert run.values("toe").base is run.values("camber").base is not None
    assert run.sensitivity("toe", "ball_joint_z").base is run.sensitivities("toe").base


def test_a_design_equals_the_changed_model(strut):
    by = 1e-3
    there, back, here = (strut.run({"tie_rod_outer_z": x}) for x in (by, -by, 0.0))
    slope = (there.values("toe") - back.values("toe")) / (2 * by)
    assert slope == pytest.approx(here.sensitivity("toe", "tie_rod_outer_z"), abs=1e-8)
    assert there.design["tie_rod_outer_z"] == by
    whole = np.zeros(len(strut.variables))
    whole[list(strut.variables).index("tie_rod_outer_z")] = by
    assert (strut.run(whole).values("toe") == there.values("toe")).all()


def test_second_derivatives_are_differences_of_first(strut):
    by, names = 1e-3, ["tie_rod_outer_z", "ball_joint_y", "lca_tilt"]
    second = strut.second_derivatives("toe", names)[:, 0]
    for k, name in enumerate(names):
        there, back = (strut.run({name: x}).sensitivities("toe", names) for x in (by, -by))
        assert second[:, :, k].T == pytest.approx((there - back) / (2 * by), abs=1e-8)


def test_second_derivatives_by_an_inadmissible_variable_are_undefined():
    model = hardpoint.read(MODELS / "slider_crank.toml")
    names = list(model.variables)
    second, first = model.second_derivatives("stroke"), model.gradients("stroke")
    follows = np.isin(names, model.run().followed)
    assert not follows[names.index("J4_ry")] and follows.any()
    assert (np.isnan(first[:, 0]) == ~follows).all()
    assert (np.isnan(second[:, 0]) == ~(follows[:, None] & follows)).all()
    assert np.isnan(model.second_derivatives("stroke", "J4_ry")).all()


def test_quaternions_are_continuous_over_turns():
    run = hardpoint.read(MODELS / "four_bar.toml").run()
    for name in run.model.bodies:
        body = run.body(name)
        w, q = body.quaternion[:, :1], body.quaternion[:, 1:]
        assert w[0] >= 0 and (np.sum(body.quaternion[1:] * body.quaternion[:-1], axis=1) > 0).all()
        # Euler parameters have the rate omega q / 2; a difference over a step is second-order accurate at its middle.
        omega = np.deg2rad(body.angular_velocity)
        rate = 0.5 * np.hstack([-np.sum(omega * q, axis=1, keepdims=True), w * omega + np.cross(omega, q)])
        step = np.diff(run.times)[:, None]
        middle = (rate[1:] + rate[:-1]) / 2
        assert np.diff(body.quaternion, axis=0) / step == pytest.approx(middle, abs=1e-3 * max(abs(rate).max(), 1e-3))
    assert abs(run.body("crank").quaternion).min(axis=0)[0] < 0.05, "the crank turns by more than half a turn"


def test_labelled_designs_go_by_their_names(strut):
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    one = {"tie_rod_outer_z": 2.0, "ball_joint_y": -1.0}
    expected = strut.run(one).values("toe")
    series = pandas.Series({name: one.get(name, 0.0) for name in reversed(list(strut.variables))})
    assert (strut.run(series).values("toe") == expected).all()
    assert (strut.run(pandas.Series(one)).values("toe") == expected).all()
    array = xarray.DataArray(series.to_numpy(), {"variable": list(series.index)}, ["variable"])
    assert (strut.run(array).values("toe") == expected).all()
    # Numbers from 0 are no names.
    plain = pandas.Series([one.get(name, 0.0) for name in strut.variables])
    assert (strut.run(plain).values("toe") == expected).all()
    with pytest.raises(hardpoint.UsageError, match="did you mean `ball_joint_y`"):
        strut.run(pandas.Series({"ball_joint_yy": 1.0}))

    rows = [one, {"tie_rod_outer_z": 0.5, "ball_joint_y": 1.0}]
    expected = strut.designs(rows, "toe").values
    frame = pandas.DataFrame(rows).assign(note=["first", "second"])
    names = ["ball_joint_y", "tie_rod_outer_z"]
    assert (strut.designs(frame[names], "toe").values == expected).all()
    assert (strut.designs(frame, "toe", variables=names).values == expected).all()
    assert (strut.designs([frame.iloc[k][names].astype(float) for k in range(2)], "toe").values == expected).all()
    assert (strut.designs(strut.designs(rows).to_xarray()["designs"][:, ::-1], "toe").values == expected).all()
    assert (strut.designs(frame[names].to_numpy(), "toe", variables=names).values == expected).all()
    with pytest.raises(hardpoint.UsageError, match="no design variable named `note`"):
        strut.designs(frame, "toe")
    with pytest.raises(hardpoint.UsageError, match="`ball_joint_z` is missing"):
        strut.designs(frame, "toe", variables=["ball_joint_z"])

    f = hardpoint.Function(strut, ["tie_rod_outer_z", "ball_joint_y"], "toe")
    assert (f(pandas.Series(one)[names]) == f([2.0, -1.0])).all()
    assert (f.many(frame) == f.many([[2.0, -1.0], [0.5, 1.0]])).all()


def test_a_coordinate_is_another_name_of_its_variable(strut):
    assert (strut.run({"tie_rod_outer.z": 2.0}).values("toe") == strut.run({"tie_rod_outer_z": 2.0}).values("toe")).all()
    run = strut.run()
    assert (run.sensitivity("toe", "tie_rod_outer.z") == run.sensitivity("toe", "tie_rod_outer_z")).all()
    with pytest.raises(hardpoint.UsageError, match="no design variable named `tie_rod_outer.x`"):
        strut.run({"tie_rod_outer.x": 2.0})


def test_gradients_either_way_are_those_of_the_run(strut):
    run = strut.run()
    for method in ("direct", "adjoint", "auto"):
        found = strut.gradients(["toe", "camber"], order="rate", method=method)
        for k, name in enumerate(["toe", "camber"]):
            assert found[:, k].T == pytest.approx(run.sensitivities(name, order=1), rel=1e-9, abs=1e-9)


def test_many_designs_equal_single_runs(strut):
    rng = np.random.default_rng(7)
    designs = rng.normal(scale=0.5, size=(30, 3))
    names = ["tie_rod_outer_z", "ball_joint_y", "lca_tilt"]
    seen = []
    found = strut.designs(designs, ["toe", "camber"], variables=names, at=slice(0, None, 50), progress=lambda done, of: seen.append((done, of)))
    assert found.values.shape == (30, 2, 11) and found.sensitivities.shape == (30, 2, 14, 11)
    assert seen[-1] == (30, 30)
    for k in (0, 17, 29):
        run = strut.run(dict(zip(names, designs[k])))
        assert found.values[k, 1] == pytest.approx(run.values("camber")[::50], rel=1e-11)
        assert found.sensitivities[k, 0] == pytest.approx(run.sensitivities("toe")[:, ::50], rel=1e-9, abs=1e-12)


def test_metrics_have_their_gradients(toe):
    by = 1e-4
    for case in toe.cases:
        run = toe.run(case=case)
        for metric in run.metrics.values():
            for name in run.followed:
                there, back = (toe.run({name: x}, case=case).metric(metric.name) for x in (by, -by))
                assert (there - back) / (2 * by) == pytest.approx(metric.sensitivities[name], rel=1e-4, abs=1e-6), (metric.name, name)


def test_models_pickle_with_their_case_and_added_variables(toe):
    model = toe.case(toe.cases[1]).with_coordinates(tilts=True)
    again = pickle.loads(pickle.dumps(model))
    assert list(again.variables) == list(model.variables) and len(again.variables) > len(toe.variables)
    name = model.measures[0]
    assert (again.run().values(name) == model.run().values(name)).all()


def test_threads_run_models_side_by_side(strut):
    expected, found = strut.run().values("toe"), {}
    threads = [threading.Thread(target=lambda k=k: found.__setitem__(k, strut.run().values("toe"))) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all((values == expected).all() for values in found.values()) and len(found) == 8


def test_tables_have_labels_and_units(strut):
    run = strut.run()
    frame = run.to_pandas()
    assert (frame["toe [deg]"] == run.values("toe")).all() and (frame["time [s]"] == run.times).all()
    arrow = run.to_arrow()
    assert arrow.schema.field("toe").metadata == {b"unit": b"deg"}
    labelled = run.to_xarray()
    slope = labelled["d toe"].sel(variable="tie_rod_outer_z")
    assert (slope.values == run.sensitivity("toe", "tie_rod_outer_z")).all()
    assert labelled["toe"].attrs["units"] == "deg"


TAKEN = """
name = "taken"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [40, 200], C = [360, 600], D = [400, 0] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }
drivers.motor = { joint = "A", law = "10*t" }
design.C_x = { move = "C", along = "x" }
measures.r = { type = "coordinate", joint = "D" }
measures."d r" = { type = "coordinate", joint = "B" }
measures.time = { type = "coordinate", joint = "C" }
measures.variable = { type = "coordinate", joint = "A" }
time = { end = 1, steps = 4 }
"""


def test_names_in_a_data_set_are_unique():
    pytest.importorskip("xarray")
    run = hardpoint.parse(TAKEN).run()
    data = run.to_xarray()
    assert (data["d r"].values == run.values("d r")).all() and data["d r"].dims == ("time",)
    assert (data["d r_"].sel(variable="C_x").values == run.sensitivity("r", "C_x")).all() and data["d r_"].attrs["of"] == "r"
    assert (data["d d r"].sel(variable="C_x").values == run.sensitivity("d r", "C_x")).all()
    for name in ("time", "variable"):
        assert (data[f"{name}_"].values == run.values(name)).all() and data[f"{name}_"].attrs["of"] == name
        assert (data[f"d {name}"].sel(variable="C_x").values == run.sensitivity(name, "C_x")).all()
    assert list(data.coords) == ["time", "variable", "variable_unit"]


def test_columns_of_an_arrow_table_are_unique():
    run = hardpoint.parse(TAKEN).run()
    arrow = run.to_arrow()
    assert len(set(arrow.column_names)) == arrow.num_columns
    assert (arrow["time"].to_numpy() == run.times).all() and (arrow["time_"].to_numpy() == run.values("time")).all()


def test_designs_without_metrics_are_a_data_set(toe):
    pytest.importorskip("xarray")
    bump = toe.case("bump")
    found = bump.designs([[0.0] * len(bump.variables)], "toe", metrics=False)
    assert found.to_xarray()["values"].shape == found.values.shape and found.metric_names == ()
    with pytest.raises(hardpoint.UsageError, match="solved without metrics"):
        found.metric("toe_error")


def test_a_model_built_in_code_is_that_of_the_file():
    built = hardpoint.build(
        name="slider-crank",
        units={"length": "mm", "angle": "deg"},
        hardpoints={"O": np.zeros(3), "A": np.array([0.0, 30.0, 0.0]), "B": [40, 0, 0]},
        bodies={"crank": {}, "rod": {}, "slider": {}},
        joints={
            "O": {"type": "revolute", "bodies": ["ground", "crank"], "at": "O", "axis": "z"},
            "A": {"type": "revolute", "bodies": ["crank", "rod"], "at": "A", "axis": "z"},
            "B": {"type": "revolute", "bodies": ["rod", "slider"], "at": "B", "axis": "z"},
            "slide": {"type": "translational", "bodies": ["ground", "slider"], "at": "B", "axis": "x"},
        },
        drivers={"motor": {"joint": "O", "law": "-360 * t"}},
        measures={"stroke": {"type": "coordinate", "joint": "slide"}},
        design={"O_y": {"move": "O", "along": "y"}},
        time={"end": 1.0, "steps": 100},
    )
    assert built.hardpoints["A"].tolist() == [0, 30, 0]
    again = hardpoint.parse(built.text)
    run = built.run()
    assert (again.run().values("stroke") == run.values("stroke")).all()
    # The slider's speed follows from the height of the pin: 2 pi rad/s * 30 mm when upright.
    assert run.values("stroke", "rate")[0] == pytest.approx(2 * np.pi * 30, rel=1e-12)
    assert run.sensitivity("stroke", "O_y", order=1)[0] == pytest.approx(-2 * np.pi, rel=1e-12)
