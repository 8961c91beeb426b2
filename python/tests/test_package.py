"""Editing and building, plots, stored runs, loads by name, tables, and the command's jobs from Python."""

import copy
import json
import math
import pickle
import subprocess
import sys

import numpy as np
import pytest

import hardpoint
from conftest import K_AND_C, MODELS, ROOT


@pytest.fixture(scope="module")
def press():
    return hardpoint.read(MODELS / "press.toml")


# Editing and building


def test_with_merges_entries_and_keeps_comments(strut):
    changed = strut.with_(hardpoints={"tie_rod_outer": [-200.0, 580.0, 40.0]}, measures={"height": {"type": "position", "point": "contact_point", "along": "z"}})
    assert changed.hardpoints["tie_rod_outer"].tolist() == [-200, 580, 40] and "height" in changed.measures
    assert strut.hardpoints["tie_rod_outer"].tolist() != [-200, 580, 40] and "height" not in strut.measures
    comments = [line for line in strut.to_toml().splitlines() if line.startswith("#")]
    assert comments and all(line in changed.to_toml() for line in comments)
    again = hardpoint.parse(changed.to_toml(), folder=MODELS)
    assert (again.run().values("height") == changed.run().values("height")).all()
    assert changed.with_(measures={"height": None}).to_dict() == strut.with_(hardpoints={"tie_rod_outer": [-200.0, 580.0, 40.0]}).to_dict()


def test_with_takes_masses_forces_and_cases(toe):
    model = toe.with_(
        gravity={"along": "-z"},
        masses={"wheel": {"type": "rigid", "centre": {"body": "knuckle", "at": [0, 750, 0]}, "mass": 20}},
        cases={"both": {"laws": {"strut_drive": "10 * t", "rack_drive": "5 * t"}, "time": {"at": [0, 1]}}},
    )
    assert model.cases == ("bump", "steer", "both") and len(model.run(case="both")) == 2
    assert np.isfinite(model.run(case="bump").driver("strut_drive").force).all()
    assert model.case("steer").with_(description="x").run().case == "steer"


def test_diagnostics_name_keys_of_the_change(strut):
    with pytest.raises(hardpoint.ModelError, match="did you mean `distance`") as raised:
        strut.with_(joints={"tie_rod": {"type": "distnce"}})
    assert raised.value.file.endswith("macpherson.toml (changed)") and raised.value.line
    with pytest.raises(hardpoint.ModelError, match="hardpionts"):
        strut.with_(hardpionts={"A": [0, 0, 0]})
    with pytest.raises(hardpoint.UsageError, match="infinite or not a number"):
        strut.with_(hardpoints={"tie_rod_outer": [math.nan, 0, 0]})
    with pytest.raises(hardpoint.UsageError, match="empty entry in a list"):
        strut.with_(hardpoints={"tie_rod_outer": [None, 0, 0]})


@pytest.mark.parametrize("name", ["macpherson", "four_bar", "stewart", "press", "front_axle", "studies/strut_toe"])
def test_a_model_from_its_contents_is_the_model(name):
    model = hardpoint.read(MODELS / f"{name}.toml")
    again = hardpoint.Model.from_dict(model.to_dict(), folder=MODELS)
    case = model.cases[0] if model.cases else None
    one, other = model.run(case=case), again.run(case=case)
    for output in model.outputs:
        assert np.array_equal(one.values(output), other.values(output), equal_nan=True), output


def test_a_model_from_nothing():
    arm = hardpoint.Model.new(
        "arm",
        units={"length": "mm", "angle": "deg"},
        hardpoints={"O": [0, 0, 0], "tip": [100, 0, 0]},
        bodies={"arm": {}},
        joints={"O": {"type": "revolute", "bodies": ["ground", "arm"], "at": "O", "axis": "z"}},
        drivers={"turn": {"joint": "O", "law": "90 * t"}},
        points={"tip": {"body": "arm", "at": "tip"}},
        time={"end": 1, "steps": 2},
    )
    assert arm.run().values("tip.y")[-1] == pytest.approx(100)
    assert arm.at(turn=30)["tip.y"] == pytest.approx(50) and arm.at(turn=30).derivative("tip.y", "turn") == pytest.approx(100 * math.cos(math.pi / 6) * math.pi / 180)
    assert arm.to_toml().startswith('name = "arm"\n\n[units]\n')


def test_misspelt_and_negative_arguments_are_errors_of_the_package(toe):
    for ask, says in (
        (lambda: toe.run(cas="bump"), "`run` has no argument `cas`; did you mean `case`"),
        (lambda: toe.optimize(starts=-1), "`starts` is a whole number from 0, not -1"),
        (lambda: toe.sweep(samples=-5, ranges={"outer_z": (-1, 1)}), "`samples` is a whole number"),
        (lambda: toe.designs([[0.0] * 5], workers=0, case="bump"), "`workers` is a whole number"),
        (lambda: hardpoint.Function(toe, variabels=["outer_z"]), "did you mean `variables`"),
        (lambda: hardpoint.Function(toe, stopped="nan"), "`stopped` is a number"),
        (lambda: hardpoint.new("x", "four-bar", hardpoint={}), "did you mean `hardpoints`"),
    ):
        with pytest.raises(hardpoint.UsageError, match=says):
            ask()
    with pytest.raises(TypeError):
        toe.run(cas="bump")


# Plots and stored runs


def test_plots_have_units_and_the_numbers_of_the_run(toe):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    run = toe.run(case="bump")
    axes = run.plot("toe", over="wheel_travel")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("wheel_travel [mm]", "toe [deg]")
    x, y = axes.lines[0].get_data()
    assert (x == run.values("wheel_travel")).all() and (y == run.values("toe")).all()
    several = hardpoint.plot(toe.runs(), ["toe", "camber"], by="outer_z")
    assert len(several) == 2 and [text.get_text() for text in several[0].get_legend().get_texts()] == ["bump", "steer"]
    assert several[1].get_ylabel() == "d camber / d outer_z [deg / mm]" and several[1].get_xlabel() == "time [s]"
    assert len(run.plot("toe", others={"moved": toe.run({"outer_z": 3}, case="bump")}, order="rate").lines) == 2
    with pytest.raises(hardpoint.UsageError, match="did you mean `toe`"):
        run.plot("tow")
    pyplot.close("all")
    # Arguments that matplotlib does not know are errors of the package, which leave no figure.
    for wrong, says in (({"colour": "r"}, "`plot` with `colour`"), ({"ordr": 1}, "did you mean `order`"), ({"lw": "x"}, "with `lw`")):
        with pytest.raises(hardpoint.UsageError, match=says):
            run.plot("toe", **wrong)
    assert not pyplot.get_fignums()
    assert run.plot("toe", c="r", ls="--", marker="o", alpha=0.5).lines[0].get_linestyle() == "--"
    pyplot.close("all")


def test_an_animation_moves_the_skeleton_and_is_written(strut, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    player = strut.run().animate(frames=4)
    player.save(tmp_path / "motion.gif", writer="pillow")
    assert (tmp_path / "motion.gif").read_bytes()[:6] == b"GIF89a"
    with pytest.raises(hardpoint.FileError, match="No such file or directory"):
        player.save(tmp_path / "none" / "motion.gif", writer="pillow")
    with pytest.raises(hardpoint.UsageError, match="cannot be written by matplotlib: unknown file extension"):
        player.save(tmp_path / "motion.abc", writer="pillow")
    assert "<script" in player._repr_html_() and repr(player).startswith("<hardpoint animation of 'MacPherson strut")
    with pytest.raises(hardpoint.UsageError, match="positive"):
        strut.run().animate(seconds=0)


def test_stored_runs_have_the_same_numbers(toe, tmp_path):
    run = toe.run({"outer_z": 1.5}, case="bump")
    path = tmp_path / "bump.npz"
    run.save(path)
    again = hardpoint.load_run(path)
    assert again.case == "bump" and again.design == run.design and (again.times == run.times).all()
    assert again.model.to_toml() == toe.to_toml() and repr(again) == repr(run)
    for name in toe.outputs:
        for order in range(len(toe.outputs[name].columns)):
            assert np.array_equal(again.values(name, order), run.values(name, order), equal_nan=True)
            assert np.array_equal(again.sensitivities(name, order=order), run.sensitivities(name, order=order), equal_nan=True)
    assert (again.body("knuckle").quaternion == run.body("knuckle").quaternion).all()
    assert (again.body_sensitivity("knuckle", "outer_z").rotation == run.body_sensitivity("knuckle", "outer_z").rotation).all()
    assert again.metrics == run.metrics and again.summary() == run.summary() and again.diagnostics == run.diagnostics
    assert not again.values("toe").flags.writeable and list(tmp_path.iterdir()) == [path]


def test_runs_are_pickled_with_their_numbers(toe, strut):
    run = toe.run({"outer_z": 1.5}, case="bump")
    again = pickle.loads(pickle.dumps(run))
    assert again.case == "bump" and again.design == run.design and repr(again) == repr(run) and again.metrics == run.metrics
    assert (again.values("toe") == run.values("toe")).all()
    assert (again.sensitivity("toe", "outer_z") == run.sensitivity("toe", "outer_z")).all()
    assert (pickle.loads(pickle.dumps(again)).times == run.times).all()
    selected = pickle.loads(pickle.dumps(toe.case("steer").run()))
    assert selected.case == selected.model.run().case == "steer"
    many = toe.designs([[0.0] * 5], "toe", case="bump")
    assert (pickle.loads(pickle.dumps(many)).values == many.values).all()


def test_positions_are_pickled_with_their_numbers(strut, press):
    for position in (
        strut.at(rack_drive=[0.0, 1000.0, 10.0], partial=True),
        strut.at(rack_drive=3.0, sensitivities=False),
        press.at(motor=[10, 20], forces={"work": 300.0}),
    ):
        again = pickle.loads(pickle.dumps(position))
        assert repr(again) == repr(position) and again.stops == position.stops
        body, name = position.model.bodies[0], position.model.measures[0]
        assert np.array_equal(again[name], position[name], equal_nan=True)
        assert np.array_equal(again.position(body), position.position(body), equal_nan=True)
        if position._slopes is not None:
            driver = next(iter(position.drivers))
            assert np.array_equal(again.derivative(name, driver), position.derivative(name, driver), equal_nan=True)
            assert not again[name].flags.writeable


def test_a_stored_part_of_a_motion_has_its_reason(strut, tmp_path):
    run = strut.run({"tie_rod_outer_z": 1000.0}, partial=True)
    run.save(tmp_path / "part.npz")
    again = hardpoint.load_run(tmp_path / "part.npz")
    assert again.stop == run.stop and len(again) == len(run)


def test_other_files_are_not_runs(tmp_path):
    (tmp_path / "no.npz").write_text("no")
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    for name in ("no.npz", "other.npz"):
        with pytest.raises(hardpoint.UsageError, match="is not a run of this package"):
            hardpoint.load_run(tmp_path / name)
    with pytest.raises(hardpoint.FileError, match="there is no file"):
        hardpoint.load_run(tmp_path / "none.npz")


# Loads


def test_loads_by_name_are_those_of_the_measures_and_of_the_table(press, command, tmp_path):
    run = press.run()
    motor = run.driver("motor")
    assert motor.force == pytest.approx(run.values("torque"), abs=1e-12) and motor.unit == "N*m"
    assert motor.power == pytest.approx(motor.force * np.deg2rad(motor.speed) if press.units["angle"] == "deg" else motor.force * motor.speed)
    done = command("run", MODELS / "press.toml", "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    rows = [line.split(",") for line in (tmp_path / "loads.csv").read_text().splitlines()]
    head = {name.split(" [")[0]: k for k, name in enumerate(rows[0])}
    for joint in press.joints:
        reaction = run.reaction(joint["name"])
        assert reaction.body == joint["bodies"][1]
        of = [row for row in rows[1:] if row[head["joint"]] == joint["name"]]
        assert len(of) == len(run)
        for k, axis in enumerate("xyz"):
            found = [float(row[head[f"force.{axis}"]] or "nan") for row in of]
            assert np.array_equal(found, reaction.force[:, k], equal_nan=True), joint["name"]
    with pytest.raises(hardpoint.UsageError, match="no joint named"):
        run.reaction("nothing")


def test_deflections_and_the_rigid_mechanism_of_a_run():
    axle = hardpoint.read(K_AND_C)
    run = axle.run(case="parallel_travel")
    found = run.deflection("left_lca_rear", "z")
    assert (found.unit, found.force_unit) == ("mm", "N")
    # 300 N/mm, against the displacement.
    assert found.force == pytest.approx(-300 * found.displacement, rel=1e-9)
    assert np.abs(found.displacement).max() > 0.01
    rigid = run.rigid_values("left.toe")
    of_range = {metric["name"]: metric["rigid"] for metric in run.summary()["metrics"]}["toe_over_travel"]
    assert np.ptp(rigid) == pytest.approx(of_range, rel=1e-3) and np.abs(rigid - run.values("left.toe")).max() > 1e-3
    assert np.isnan(run.rigid_values("left_toe_per_side")).all()
    with pytest.raises(hardpoint.UsageError, match="left_lca_rear"):
        run.deflection("left_lca_rea", "z")
    with pytest.raises(hardpoint.UsageError, match="along"):
        run.deflection("left_lca_rear", "along")


def test_a_model_without_loads_has_no_reactions(strut):
    with pytest.raises(hardpoint.UsageError, match=r"add `\[masses\]` or `\[forces\]`"):
        strut.run().reaction(strut.joints[0]["name"])


# Tables


def test_studies_are_tables(toe):
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    found = toe.optimize()
    frame = found.to_pandas()
    assert frame["name"].tolist() == [v["name"] for v in found.facts["variables"]] and "end" in frame
    assert found.to_xarray("goals")["after"].sel(name="toe_error").item() == found.facts["goals"][0]["after"]
    with pytest.raises(hardpoint.UsageError, match="did you mean `goals`"):
        found.to_pandas("goal")
    swept = hardpoint.read(MODELS / "studies/strut_sweep.toml").sweep(samples=4, curves=["toe"])
    assert swept.to_xarray().sizes["design"] == 4
    curves = swept.to_xarray("curves")
    assert np.isfinite(curves["toe [deg]"]).any() and curves.sizes["design"] == 4
    map = hardpoint.read(MODELS / "studies/strut_map.toml").maps()[0]
    labelled = map.to_xarray()
    measure = map["measures"][0]
    assert np.array_equal(labelled[measure["name"]].values, np.array(measure["values"], dtype=float), equal_nan=True)
    assert len(map.to_pandas()) == labelled[measure["name"]].size


def test_functions_of_many_designs(toe):
    f = hardpoint.Function(toe.case("bump"), of="toe_error")
    rows = f.start + np.linspace(-1, 1, 5)[:, None]
    assert f.many(rows)[:, 0] == pytest.approx([f.value(row) for row in rows], rel=1e-12)
    assert f.value(rows.T) == pytest.approx(f.many(rows)[:, 0]) and f.value(rows.T).shape == (5,)
    assert f.many_jacobians(rows)[2] == pytest.approx(f.jacobian(rows[2]), rel=1e-9)
    both = hardpoint.Function(toe, of="toe").many(rows)
    assert both.shape == (5, hardpoint.Function(toe, of="toe").size)


def test_designs_that_stop_are_a_number_or_an_exception(strut):
    rows = [[0.0], [1000.0], [1.0]]
    with pytest.raises(hardpoint.MotionStopped):
        hardpoint.Function(strut, ["tie_rod_outer_z"], ["toe"]).many(rows)
    f = hardpoint.Function(strut, ["tie_rod_outer_z"], ["toe"], stopped=math.nan)
    values, slopes = f.many(rows), f.many_jacobians(rows)
    assert np.isnan(values[1]).all() and np.isnan(slopes[1]).all() and np.isfinite(values[[0, 2]]).all() and np.isfinite(slopes[[0, 2]]).all()
    infinite = hardpoint.Function(strut, ["tie_rod_outer_z"], ["toe"], stopped=math.inf)
    assert (infinite([1000.0]) == math.inf).all()


def test_differential_evolution_takes_whole_populations(toe):
    scipy = pytest.importorskip("scipy.optimize")
    f = hardpoint.Function(toe.case("bump"), of="toe_error", stopped=math.inf)
    found = scipy.differential_evolution(
        f.value, bounds=list(zip(*f.bounds)), vectorized=True, updating="deferred", maxiter=4, popsize=6, seed=1, polish=False
    )
    assert found.fun < 0.25 * f.value(f.start)


def test_torch_has_the_exact_gradient(strut):
    torch = pytest.importorskip("torch", exc_type=ImportError)
    from hardpoint.torch import function

    f = hardpoint.Function(strut, ["tie_rod_outer_z", "ball_joint_y"], ["toe"])
    toe_of = function(f)
    x = torch.tensor(np.stack([f.start, f.start + 0.5]), requires_grad=True)
    weights = torch.linspace(-1, 1, f.size, dtype=torch.float64)
    (toe_of(x) * weights).sum().backward()
    for k in range(2):
        assert x.grad[k].numpy() == pytest.approx(f.jacobian(x[k].detach().numpy()).T @ weights.numpy(), rel=1e-9)
    for wrong in (x.float(), x.int(), x.detach().numpy(), [0.0, 0.0]):
        with pytest.raises(hardpoint.UsageError, match="float64"):
            toe_of(wrong)
    with pytest.raises(hardpoint.UsageError, match=r"hardpoint\.Function"):
        function(toe_of)
    # Second derivatives are an error, not zero.

    def total(x):
        return (toe_of(x) * weights).sum()

    with pytest.raises(hardpoint.UsageError, match="second order"):
        torch.autograd.functional.hessian(total, x[0].detach())
    assert torch.autograd.functional.jacobian(total, x[0].detach()).numpy() == pytest.approx(x.grad[0].numpy(), rel=1e-12)


# The command's jobs


def test_the_command_is_in_the_package(tmp_path):
    done = subprocess.run([sys.executable, "-m", "hardpoint", "check", MODELS / "four_bar.toml", "--json"], capture_output=True, text=True)
    assert done.returncode == 0 and json.loads(done.stdout)["status"], done.stderr
    done = subprocess.run([sys.executable, "-m", "hardpoint", "nonsense"], capture_output=True, text=True)
    assert done.returncode == 2 and "nonsense" in done.stderr


def test_export_import_and_templates(tmp_path):
    assert {"urdf", "c"} <= set(hardpoint.export_formats()) and {"urdf", "mjcf"} <= set(hardpoint.import_formats())
    assert "double-wishbone" in hardpoint.templates()
    front = hardpoint.new(tmp_path / "front", "double-wishbone")
    assert (tmp_path / "front.toml").exists() and front.metrics(front.cases[0])
    with pytest.raises(hardpoint.HardpointError, match="front.toml"):
        hardpoint.new(tmp_path / "front", "double-wishbone")
    with pytest.raises(hardpoint.HardpointError, match="no template"):
        hardpoint.new(tmp_path / "rear", "nonsense")
    model = hardpoint.read(MODELS / "slider_crank.toml").with_(description="written from memory")
    facts = model.export(tmp_path / "crank.xml", format="mjcf")
    assert facts["status"] == "complete" and (tmp_path / "crank.xml").exists()
    again, facts = hardpoint.import_model(tmp_path / "crank.xml", tmp_path / "again.toml")
    assert len(again.bodies) == len(model.bodies) and facts["model"]
    with pytest.raises(hardpoint.UsageError, match="does not identify a format"):
        model.export(tmp_path / "crank.nonsense")


def test_own_hardpoints_of_a_template(tmp_path):
    four_bar = hardpoint.new(tmp_path / "first.toml", "four-bar")
    moved = {name: place + [0, 0, 0] for name, place in four_bar.hardpoints.items()}
    name = next(iter(moved))
    moved[name] = moved[name] + [1, 0, 0]
    own = hardpoint.new(tmp_path / "own.toml", "four-bar", hardpoints=moved, units=four_bar.units["length"], axes="iso")
    assert own.hardpoints[name].tolist() == moved[name].tolist()


def test_compare_clearance_envelope_synthesis_and_schema(strut, tmp_path):
    moved = strut.with_(hardpoints={"tie_rod_outer": (strut.hardpoints["tie_rod_outer"] + [0, 0, 2]).tolist()})
    compared = hardpoint.compare(strut, moved)
    assert any(row.get("measure") == "toe" for row in compared.facts["measures"]) and len(compared.to_pandas("measures"))
    knee = hardpoint.read(MODELS / "studies/knee.toml")
    near = knee.clearance(case=knee.cases[0] if knee.cases else None)
    assert near.facts["pairs"]
    shape = near.facts["pairs"][0]["shapes"][0]
    swept = knee.envelope(shape, tmp_path / "shape.stl", case=knee.cases[0] if knee.cases else None)
    assert (tmp_path / "shape.stl").stat().st_size > 84 and swept.facts
    answers = hardpoint.synthesize(MODELS / "tasks/tailgate.toml", answers=1)
    assert answers.facts["status"] == "found" and len(answers.to_pandas("answers")) == 1
    assert hardpoint.schema() == json.loads((MODELS / "hardpoint.schema.json").read_text())
    assert str(ROOT) not in repr(answers) and "Study" in repr(answers)


def test_clearances_of_a_changed_model_read_its_shapes(tmp_path):
    corners = [[x, y, z] for x in (-10, 10) for y in (-10, 10) for z in (-10, 10)]
    faces = [(1, 5, 7, 3), (5, 6, 8, 7), (6, 2, 4, 8), (2, 1, 3, 4), (3, 7, 8, 4), (1, 2, 6, 5)]
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join("f {} {} {} {}\n".format(*face) for face in faces)
    (tmp_path / "shapes").mkdir()
    (tmp_path / "shapes/cube.obj").write_text(text)
    model = hardpoint.Model.new(
        "cube",
        folder=tmp_path,
        units={"length": "mm", "angle": "deg"},
        bodies={"ball": {}},
        joints={"slide": {"type": "translational", "bodies": ["ground", "ball"], "at": [0, 0, 0], "axis": "x"}},
        drivers={"motor": {"joint": "slide", "law": "10*t"}},
        shapes={
            "cube": {"body": "ground", "mesh": {"file": "shapes/cube.obj", "scale": 1}},
            "ball": {"body": "ball", "sphere": [30, 0, 0], "radius": 5},
        },
        clearances={"c": {"between": ["cube", "ball"]}},
        time={"end": 1, "steps": 4},
    )
    changed = model.with_(shapes={"ball": {"radius": 6}})
    for one, radius in ((model, 5), (changed, 6)):
        (pair,) = one.clearance(proof=False).facts["pairs"]
        assert pair["least"] == pytest.approx(20 - radius, abs=1e-9)
        assert one.envelope("ball", tmp_path / "ball.stl").facts


def test_everything_has_a_repr_that_says_what_it_is(toe, press):
    run = press.run()
    for thing in (toe, run, run.driver("motor"), run.reaction("A"), run.body(press.bodies[0]), toe.at(), hardpoint.Function(toe), toe.designs([[0.0] * 5], case="bump"), toe.optimize()):
        text = repr(thing)
        assert text.startswith("<hardpoint.") and " at 0x" not in text, text
    one = hardpoint.Function(toe.case("bump"), of="toe", variables=list(toe.variables)[:1])
    assert repr(one).endswith("of 1 variable>"), repr(one)


TABULATED = """
name = "tabulated"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [40, 200], C = [360, 600], D = [400, 0] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }
drivers.motor = { joint = "A", law = { type = "table", file = "law.csv" } } # measured
measures.r = { type = "coordinate", joint = "D" }
time = { end = 1, steps = 4 }
"""


def test_a_model_saved_in_another_folder_reads_the_same_files(tmp_path):
    own, other = tmp_path / "models", tmp_path / "other"
    own.mkdir()
    other.mkdir()
    (own / "m.toml").write_text(TABULATED)
    (own / "law.csv").write_text("0,0\n0.5,20\n1,30\n")
    model = hardpoint.read(own / "m.toml").with_(time={"end": 1.0, "steps": 10})
    expected = model.run().values(model.measures[0])
    model.save(tmp_path / "above.toml")
    assert (tmp_path / "above.toml").read_text() == model.text.replace('"law.csv"', '"models/law.csv"')
    assert (hardpoint.read(tmp_path / "above.toml").run().values(model.measures[0]) == expected).all()
    model.save(own / "again.toml")
    assert (own / "again.toml").read_text() == model.text
    for make, why in ((lambda: None, "which is not there"), (lambda: (other / "law.csv").write_text("0,0\n1,300\n"), "other contents")):
        make()
        with pytest.raises(hardpoint.ModelError, match=why) as raised:
            model.save(other / "m.toml")
        assert raised.value.code == "HP0505" and not (other / "m.toml").exists()
    (other / "law.csv").write_bytes((own / "law.csv").read_bytes())
    for of in (model, pickle.loads(pickle.dumps(model))):
        of.save(other / "m.toml")
        assert (hardpoint.read(other / "m.toml").run().values(model.measures[0]) == expected).all()


def test_a_planar_template_has_points_with_two_coordinates(tmp_path):
    places = {"A": [0, 0], "B": [1.5, 2], "C": [9, 0.5], "rail": [14, 0.5]}
    model = hardpoint.new(tmp_path / "p", "slider-crank", hardpoints=places, units="in")
    for name, place in places.items():
        assert model.hardpoints[name][:2] == pytest.approx([25.4 * x for x in place], rel=1e-12), name


def cube_and_ball(folder):
    corners = [[x, y, z] for x in (-10, 10) for y in (-10, 10) for z in (-10, 10)]
    faces = [(1, 5, 7, 3), (5, 6, 8, 7), (6, 2, 4, 8), (2, 1, 3, 4), (3, 7, 8, 4), (1, 2, 6, 5)]
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join("f {} {} {} {}\n".format(*face) for face in faces)
    (folder / "cube.obj").write_text(text)
    return hardpoint.Model.new(
        "cube",
        folder=folder,
        units={"length": "mm", "angle": "deg"},
        bodies={"ball": {}},
        joints={"slide": {"type": "translational", "bodies": ["ground", "ball"], "at": [0, 0, 0], "axis": "x"}},
        drivers={"motor": {"joint": "slide", "law": "10*t"}},
        shapes={
            "cube": {"body": "ground", "mesh": {"file": "cube.obj", "scale": 1.1}},
            "ball": {"body": "ball", "sphere": [30, 0, 0], "radius": 5},
        },
        clearances={"c": {"between": ["cube", "ball"]}},
        time={"end": 1, "steps": 4},
    )


def test_copies_of_a_model_have_its_shapes(tmp_path):
    model = cube_and_ball(tmp_path)
    run = model.run()
    run.save(tmp_path / "run.npz")
    for copied in (copy.deepcopy(model), pickle.loads(pickle.dumps(model)), hardpoint.load_run(tmp_path / "run.npz").model):
        again = copied.run()
        assert again.metric("c.min") == run.metric("c.min") == pytest.approx(14)
        assert (again.values("c") == run.values("c")).all()
        assert "cube.obj as a surface" not in again.page()


@pytest.fixture(scope="module")
def locking():
    """A bar that reaches the end of the crank's way at half of the time, in a case of two."""
    return hardpoint.Model.new(
        "bars",
        units={"length": "mm", "angle": "deg"},
        planar="xy",
        hardpoints={"A": [0, 0], "B": [50, 0], "C": [80, 0], "D": [80, 60]},
        bodies={"ground": ["A", "D"], "crank": ["A", "B"], "coupler": ["B", "C"], "rocker": ["C", "D"]},
        drivers={"motor": {"joint": "A", "law": "180*t"}},
        shapes={"rod": {"body": "coupler", "capsule": ["B", "C"], "radius": 3}, "post": {"body": "ground", "sphere": [0, 300, 0], "radius": 5}},
        clearances={"gap": {"between": ["rod", "post"]}},
        time={"end": 1, "steps": 20},
    )


def test_motions_that_stop_have_a_message_in_every_job(locking, tmp_path):
    with_cases = locking.with_(cases={"far": {"laws": {"motor": "180*t"}}, "near": {"laws": {"motor": "t"}}})
    for model in (locking, with_cases):
        jobs = (
            lambda: model.clearance(),
            lambda: model.compare(model),
            lambda: model.envelope("rod", tmp_path / "rod.stl"),
        )
        for job in jobs:
            with pytest.raises(hardpoint.MotionStopped, match="cannot move beyond") as raised:
                job()
            assert raised.value.code.startswith("HP04") and raised.value.diagnostics[0].severity == "error"


def test_a_model_does_not_change_with_its_files(tmp_path):
    (tmp_path / "law.csv").write_text("0,0\n0.5,10\n1,20\n")
    model = hardpoint.Model.new(
        "arm",
        folder=tmp_path,
        units={"length": "mm", "angle": "deg"},
        bodies={"arm": {}},
        joints={"hinge": {"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0], "axis": "z"}},
        drivers={"motor": {"joint": "hinge", "law": {"type": "table", "file": "law.csv", "ends": "natural"}}},
        measures={"angle": {"type": "coordinate", "joint": "hinge"}},
        time={"end": 1, "steps": 2},
    )
    (tmp_path / "law.csv").write_text("0,0\n0.5,50\n1,100\n")
    for run in (model.run(), model.run(times=[0, 0.5, 1]), model.with_(description="arm").run()):
        assert run.values("angle") == pytest.approx([0, 10, 20])
