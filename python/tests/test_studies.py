"""Studies have the results of the command line."""

import json
import time

import numpy as np
import pytest

import hardpoint
from conftest import MODELS

TIMES = ("seconds", "files", "timings")
"""Keys that differ from run to run."""

DATA = MODELS / "studies/strut_measured.csv"


def printed(done):
    facts = json.loads(done.stdout)
    return {key: value for key, value in facts.items() if key not in TIMES}


def same(study, facts):
    """File names as they were given."""
    ours = json.loads(json.dumps({key: value for key, value in study.facts.items() if key not in TIMES}))
    assert ours == facts


def test_optimize(command):
    path = MODELS / "studies/strut_toe.toml"
    model = hardpoint.read(path)
    study = model.optimize()
    same(study, printed(command("optimize", path, "--json")))
    assert study.status == "optimal"
    better = hardpoint.parse(study.text(), folder=path.parent)
    saved = {name: v for name, v in study.rounded.items()}
    for case in model.cases:
        a, b = better.run(case=case), model.run(saved, case=case)
        for name in a.metrics:
            assert a.metric(name) == pytest.approx(b.metric(name), rel=1e-9, abs=1e-9)


def test_trade_off(command):
    path = MODELS / "studies/wishbone_trade_off.toml"
    study = hardpoint.read(path).trade_off(points=6, point=2)
    same(study, printed(command("trade-off", path, "--points", 6, "--json")))
    point = study.facts["points"][2]
    names = [v["name"] for v in study.facts["variables"]]
    assert [study.design[name] for name in names] == pytest.approx(point["variables"])
    moved = hardpoint.read(path).run(dict(zip(names, point["variables"])))
    assert [moved.metric(g["metric"]) for g in study.facts["goals"]] == pytest.approx(point["goals"], rel=1e-6)


def test_a_point_beyond_the_front_is_refused_before_the_search():
    model = hardpoint.read(MODELS / "studies/wishbone_trade_off.toml")
    with pytest.raises(hardpoint.UsageError, match="there is no point 9; the points are numbered from 0 to 3"):
        model.trade_off(points=4, point=9)


def test_studies_state_their_time(toe):
    began = time.perf_counter()
    seconds = toe.sweep(samples=8, ranges={"outer_z": (-1, 1)}).facts["seconds"] + toe.case("bump").verify().facts["seconds"]
    assert 0 < seconds < time.perf_counter() - began


def test_tolerance(command):
    path = MODELS / "studies/strut_tolerances.toml"
    study = hardpoint.read(path).tolerance(samples=1000)
    same(study, printed(command("tolerance", path, "--samples", 1000, "--json")))


def test_designs_drawn_are_those_of_the_tolerance_study(command, tmp_path):
    path = MODELS / "studies/strut_tolerances.toml"
    model = hardpoint.read(path)
    command("tolerance", path, "--samples", 600, "-o", tmp_path)
    lines = (tmp_path / "samples.csv").read_text().splitlines()
    head = [name.split(" [")[0] for name in lines[0].split(",")]
    drawn = model._native.drawn_designs([0, 1, 599], None)
    for row, number in zip(drawn, (0, 1, 599)):
        cells = lines[1 + number].split(",")
        for name, value in zip(model.variables, row):
            if name in head:
                assert float(cells[head.index(name)]) == pytest.approx(value, rel=1e-12, abs=1e-12)


CRANK = """
name = "crank"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { O = [0, 0], A = [100, 0] }
bodies = { crank = {} }
joints.O = { type = "revolute", bodies = ["ground", "crank"], at = "O" }
drivers.motor = { joint = "O", law = "30*t" }
points.A = { body = "crank", at = "A" }
metrics.y = { of = "A.y", take = "value", at = 1 }
design.longer = { move = "A", along = "x", bounds = [-20, 20] }
optimize.goals.y = { target = -55 }
time = { end = 1, steps = 10 }
"""


def test_optimize_in_the_opposite_sense(command, tmp_path):
    path = tmp_path / "crank.toml"
    path.write_text(CRANK)
    model = hardpoint.read(path)
    study = model.optimize(both_senses=True)
    same(study, printed(command("optimize", path, "--both-senses", "--json")))
    assert study.facts["starts"][study.facts["best_start"]]["reversed"]
    # The saved model is driven so, and has the goal of the optimum: a crank of 110 mm, turned by -30 deg.
    study.save(tmp_path / "found.toml")
    saved = hardpoint.read(tmp_path / "found.toml")
    assert "reversed = true" in saved.text and saved.run().metric("y") == pytest.approx(-55, abs=1e-3)
    assert study.model.run(study.design).metric("y") == pytest.approx(-55, abs=1e-6)
    # Without them, the model's own sense is searched, where the goal is out of reach.
    own = model.optimize()
    assert own.model is model and own.facts["objective"]["after"] > 1000
    assert model.optimize(other_assemblies=True).facts["assemblies"] == own.facts["assemblies"]


def test_calibrate(command, tmp_path):
    path, data = MODELS / "studies/strut_calibrate.toml", MODELS / "studies/strut_measured.csv"
    model = hardpoint.read(path)
    study = model.calibrate(data)
    same(study, printed(command("calibrate", path, data, "--json")))
    pandas = pytest.importorskip("pandas")
    again = model.calibrate(pandas.read_csv(data, comment="#"))
    assert again.design == study.design
    known = model.calibrate(data, prior={"strut_top_y": 0.2}, offsets=["half_track"])
    same(known, printed(command("calibrate", path, data, "--prior", "strut_top_y=0.2", "--offset", "half_track", "--json")))
    assert known.facts["variables"][1]["source"] == "still your prior"


def test_calibrate_with_groups():
    data = MODELS / "studies/strut_measured.csv"
    model = hardpoint.read(MODELS / "studies/strut_calibrate.toml")
    group = {"variables": ["strut_top_x", "strut_top_y"], "within": 0.05}
    found = model.calibrate(data, groups={"top": group})
    assert found.design == model.with_(calibrate={"groups": {"top": group}}).calibrate(data).design
    assert found.design != model.calibrate(data).design
    with pytest.raises(hardpoint.UsageError, match="`variables` and `within`"):
        model.calibrate(data, groups={"top": ["strut_top_x", "strut_top_y"]})
    with pytest.raises(hardpoint.UsageError, match="fewer than two different members"):
        model.calibrate(data, groups={"top": {**group, "variables": ["strut_top_x"]}})


def test_sweep(command, tmp_path):
    path = MODELS / "studies/strut_sweep.toml"
    model = hardpoint.read(path)
    found = model.sweep(samples=600)
    done = command("sweep", path, "--samples", 600, "-o", tmp_path, "--json")
    facts = printed(done)
    same(found, facts)
    lines = (tmp_path / "designs.csv").read_text().splitlines()
    assert lines[0].split(",") == list(found.columns)
    for k in (0, 311, 599):
        for cell, column in zip(lines[1 + k].split(","), found.columns.values()):
            value = column[k]
            assert cell == "" if isinstance(value, float) and np.isnan(value) else (cell == value or float(cell) == value)


def test_a_sweep_by_parts_is_the_whole():
    model = hardpoint.read(MODELS / "studies/strut_sweep.toml")
    plan = model.sweep_plan(samples=2000, curves=["toe"])
    whole, whole_curves, _ = plan.run()
    parts = [plan.part(first, first + 1024) for first in range(0, plan.count, 1024)]
    for k, (name, column) in enumerate(whole):
        joined = sum((list(designs[k][1]) for designs, _ in parts), [])
        assert np.array_equal(np.array(joined), np.array(column), equal_nan=joined and isinstance(joined[0], float)), name
    for k, (name, column) in enumerate(whole_curves):
        joined = np.concatenate([np.asarray(curves[k][1]) for _, curves in parts])
        assert (joined == np.asarray(column)).all(), name


def test_what_if_and_verify(strut, command):
    study = strut.what_if({"tie_rod_outer_z": 2.0})
    facts = printed(command("whatif", MODELS / "macpherson.toml", "--set", "tie_rod_outer_z=2", "--json"))
    assert study.facts.keys() == facts.keys()
    for key in facts.keys() - {"file"}:
        assert study.facts[key] == facts[key], key
    assert strut.what_if([*(2.0 if name == "tie_rod_outer_z" else 0.0 for name in strut.variables)]).facts == study.facts
    assert strut.what_if({"tie_rod_outer.x": 2.0}).facts["change"][0]["variable"] == "tie_rod_outer.x"
    assert strut.verify().facts["passed"] is True


def test_a_what_if_has_the_names_of_the_command(strut, command):
    for name in ("tie_rod_outer.z", "tie_rod_outer.x", "lca_pivot.tilt_y"):
        facts = printed(command("whatif", MODELS / "macpherson.toml", "--set", f"{name}=0.5", "--measure", "toe", "--json"))
        study = strut.what_if({name: 0.5})
        assert study.facts["change"] == facts["change"], name
        ours, theirs = ([m["exact"] for m in of["measures"] if m["measure"] == "toe"] for of in (study.facts, facts))
        assert ours == theirs, name


def test_studies_of_a_case_are_over_that_case(command):
    path = MODELS / "studies/strut_toe.toml"
    bump = hardpoint.read(path).case("bump")
    same(bump.optimize(), printed(command("optimize", path, "--case", "bump", "--json")))
    path = MODELS / "studies/strut_tolerances.toml"
    bump = hardpoint.read(path).case("bump")
    same(bump.tolerance(samples=500), printed(command("tolerance", path, "--case", "bump", "--samples", 500, "--json")))
    path = MODELS / "studies/strut_sweep.toml"
    model = hardpoint.read(path)
    case = model.cases[-1]
    same(model.case(case).sweep(samples=100), printed(command("sweep", path, "--case", case, "--samples", 100, "--json")))


def test_maps(command, tmp_path):
    path = MODELS / "studies/strut_map.toml"
    model = hardpoint.read(path)
    assert model.grids
    command("run", path, "-o", tmp_path)
    assert model.maps() == json.loads((tmp_path / "maps.json").read_text())


def test_display_in_a_notebook(strut, toe):
    page = strut.run().page()
    assert page.startswith("<!") and "<iframe" in page._repr_html_()
    assert "polyline" in strut.run()._repr_html_() and "toe" in strut._repr_html_()
    assert "<table>" in toe.optimize()._repr_html_()


def test_the_page_is_that_of_the_command_line(strut, command, tmp_path):
    command("run", MODELS / "macpherson.toml", "-o", tmp_path, "--no-compare")
    theirs = (tmp_path / "report.html").read_text()
    ours = strut.run().page()
    slots = lambda html: [html.split(f'id="{name}">')[1].split("</script>")[0] for name in ("engine", "code")]  # noqa: E731
    assert slots(ours) == slots(theirs)
    ours.save(tmp_path / "ours.html")
    assert (tmp_path / "ours.html").read_text() == ours


@pytest.mark.parametrize(
    ("arguments", "ask"),
    [
        (["optimize", "macpherson.toml"], lambda m: m.optimize()),
        (["tolerance", "macpherson.toml"], lambda m: m.tolerance()),
        (["trade-off", "macpherson.toml"], lambda m: m.trade_off()),
        (["trade-off", "studies/wishbone_trade_off.toml", "--goals", "track,cambr"], lambda m: m.trade_off(goals=["track", "cambr"])),
        (["optimize", "studies/strut_toe.toml", "--starts", 100001], lambda m: m.optimize(starts=100001)),
        (["calibrate", "studies/strut_calibrate.toml", "{data}", "--variable", "outer_q"], lambda m: m.calibrate(DATA, variables=["outer_q"])),
        (["calibrate", "studies/strut_calibrate.toml", "{data}", "--prior", "strut_top_x=0"], lambda m: m.calibrate(DATA, prior={"strut_top_x": 0})),
        (["calibrate", "studies/strut_calibrate.toml", "{data}", "--validate", "{data}"], lambda m: m.calibrate(DATA, validate=DATA)),
        (["calibrate", "studies/strut_calibrate.toml", "{data}", "--offset", "to"], lambda m: m.calibrate(DATA, offsets=["to"])),
        (["sweep", "studies/strut_sweep.toml", "--range", "lca_front_z=5..-5"], lambda m: m.sweep(ranges={"lca_front_z": (5, -5)})),
        (["sweep", "studies/strut_sweep.toml", "--range", "lca_fron_z=-5..5"], lambda m: m.sweep(ranges={"lca_fron_z": (-5, 5)})),
        (["sweep", "studies/strut_sweep.toml", "--curves", "tow"], lambda m: m.sweep(curves=["tow"])),
        (["sweep", "studies/strut_sweep.toml", "--method", "factorial", "--levels", 1000], lambda m: m.sweep(method="factorial", levels=1000)),
    ],
)
def test_a_study_is_refused_with_the_message_of_the_command(command, arguments, ask):
    name = arguments[1]
    paths = [str(one).format(data=DATA) if k != 1 else MODELS / name for k, one in enumerate(arguments)]
    found = json.loads(command(*paths, "--json").stdout)["diagnostics"][0]
    with pytest.raises((hardpoint.StudyError, hardpoint.UsageError)) as raised:
        ask(hardpoint.read(MODELS / name))
    assert found["code"] == "HP0602"
    assert found["message"] == f"`{MODELS / name}`: {raised.value.message}"
    assert found["help"] == raised.value.help


def test_a_list_of_designs_has_no_ranges_and_every_search_has_a_start(tmp_path, toe):
    path = tmp_path / "designs.csv"
    path.write_text("outer_z\n1\n")
    with pytest.raises(hardpoint.UsageError, match="a list of designs has no range"):
        toe.sweep(designs=path, ranges={"outer_z": (-1, 1)})
    with pytest.raises(hardpoint.UsageError, match="a list of designs has no method"):
        toe.sweep(designs=path, method="sobol")
    with pytest.raises(hardpoint.UsageError, match="the number of starts is 0"):
        toe.optimize(starts=0)
    with pytest.raises(hardpoint.UsageError, match="there is no loss function named `hubert`"):
        hardpoint.read(MODELS / "studies/strut_calibrate.toml").calibrate(DATA, loss="hubert")
