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
        (lambda m: m.sweep(smaples=3), "`sweep` has no argument `smaples`; did you mean `samples`"),
        (lambda m: m.sweep(samples="8"), "`samples` is a whole number"),
        (lambda m: m.sweep(method=3), "`method` is a text"),
        (lambda m: m.sweep(ranges={"ball_joint_z": (-1, float("inf"))}), "both of its ends, finite numbers"),
        (lambda m: hardpoint.Function(3), "`model` is a `hardpoint.Model`, not 3"),
        (lambda m: m.compare(3), "`other` is a `hardpoint.Model`, not 3"),
        (lambda m: hardpoint.Model.from_dict([]), "the contents of a model file are a dictionary"),
        (lambda m: hardpoint.synthesize(3), "a path is a text"),
        (lambda m: m.run().values(["toe"]), "the name of a measure or point is a text"),
        (lambda m: m.run().values("toe", [1]), "unknown order"),
        (lambda m: m.run().metric(["toe"]), "the name of a metric is a text"),
        (lambda m: m.run().sensitivity("toe", ["ball_joint_z"]), "the name of a design variable is a text"),
        (lambda m: m.run().animate(frames="3"), "`frames` is a whole number"),
        (lambda m: m.run().animate(seconds="3"), "`seconds`: '3' is not a number"),
        (lambda m: m.at(progress=1), "`progress` is `True`, or a function"),
        (lambda m: m.at(strut_drive=[1, 2], rack_drive=[1, 2, 3]), r"different shapes: `rack_drive` \(3,\), `strut_drive` \(2,\)"),
        (lambda m: m.run({"ball_joint_z": 1.0, "ball_joint.z": 1.0}), "are the same design variable; give it once"),
        (lambda m: m.run(np.ma.masked_array([1.0] * 14, [True] + [False] * 13)), "some values are masked"),
        (lambda m: m.designs(np.ma.masked_less(np.zeros((2, 14)), 1)), "some values are masked"),
        (lambda m: hardpoint.Function(m, ["ball_joint_z"], ["nothing"]), "no metric or measure"),
        (lambda m: hardpoint.build(name="x", units={1, 2}), "consists of numbers"),
        (lambda m: m.run(times="abc"), "output times: 'abc' is not a number"),
        (lambda m: m.run({"ball_joint_z": np.array([1.0, 2.0])}), "design variable `ball_joint_z`: .* is not a single number"),
        (lambda m: m.run({"ball_joint_z": "1"}), "design variable `ball_joint_z`: '1' is not a number"),
        (lambda m: m.run(["a"] * 14), "design: .* is not a number"),
        (lambda m: m.designs([["a"] * 14]), "designs: .* is not a number"),
        (lambda m: m.designs(np.zeros((1, 14)), "toe", at=[0, 5000]), r"`at` has indices of output times, of which there are 501 \(0 to 500\)"),
        (lambda m: m.designs(np.zeros((1, 14)), "toe", at=True), "`at` has indices"),
        (lambda m: m.designs(5), "14 variables"),
        (lambda m: m.run().plot(5), "`names` is a name or a list of names, not 5"),
        (lambda m: m.run().plot([]), "`names` is empty"),
        (lambda m: hardpoint.plot([m], "toe"), "is not a run"),
        (lambda m: hardpoint.Function(m, metrics=["toe"]), "`Function` has no argument `metrics`; there are `model`"),
        (lambda m: m.run(times=[]), "output times are a list of increasing numbers"),
        (lambda m: hardpoint.Function(m, of=[], variables=["ball_joint_z"]), "`of` is empty"),
        (lambda m: hardpoint.Function(m, of="toe", variables=[]), "`variables` is empty"),
        (lambda m: hardpoint.Function(m, of="toe", variables=["ball_joint_z"])("a"), "is not a number"),
        (lambda m: m.table({"strut_drive": (-1, 1)}, of="toe", error=["0.01deg"]), "`error` is a number, a text"),
        (lambda m: m.at(forces=5), "`forces` has values by name"),
        (lambda m: m.calibrate("measured.csv", sigma=1.0), "`sigma` has values by name"),
        (lambda m: m.calibrate(5), "measured data are"),
        (lambda m: m.calibrate("measured.csv", loss=5), "`calibrate`: .*'loss'"),
        (lambda m: m.sweep(ranges={"ball_joint_z": 1}), "both of its ends"),
        (lambda m: hardpoint.read(None), "a path is a text"),
        (lambda m: hardpoint.parse(b"name"), "the text of a model is a `str`"),
        (lambda m: hardpoint.new("x.toml", "four-bar", hardpoints={"A": 5}), "hardpoint `A` has coordinates"),
    ],
)
def test_invalid_requests_are_reported(strut, ask, says):
    with pytest.raises(hardpoint.UsageError, match=says) as raised:
        ask(strut)
    assert isinstance(raised.value, ValueError)


TWO = ["ball_joint_z", "ball_joint_z"]


@pytest.mark.parametrize(
    "ask",
    [
        lambda m: hardpoint.Function(m, TWO, "toe"),
        lambda m: hardpoint.Function(m, of=["toe", "camber", "toe"], variables=["ball_joint_z"]),
        lambda m: m.designs([[0.1, 0.2]], "toe", variables=TWO),
        lambda m: m.designs([[0.0] * 14], ["toe", "toe"]),
        lambda m: m.run().sensitivities("toe", TWO),
        lambda m: m.second_derivatives("toe", TWO),
        lambda m: m.gradients(["toe", "toe"]),
        lambda m: m.run().plot(["toe", "toe"]),
        lambda m: m.trade_off(goals=["one", "one"]),
        lambda m: m.calibrate("measured.csv", variables=TWO),
        lambda m: m.calibrate("measured.csv", offsets=["toe", "toe"]),
        lambda m: m.sweep(samples=2, curves=["toe", "toe"]),
        lambda m: m.table({"strut_drive": (-1, 1)}, of=["toe", "toe"], error="0.01deg"),
        lambda m: hardpoint.compare(m, m, measures=["toe", "toe"]),
        lambda m: m.at({"strut_drive": 1.0}, strut_drive=2.0),
        lambda m: m.with_({"time": {"steps": 4}}, time={"steps": 5}),
        lambda m: m.run().plot("toe", others={"this run": m.run()}),
    ],
)
def test_a_name_that_is_given_twice_is_refused(strut, ask):
    with pytest.raises(hardpoint.UsageError, match="(has `.+` twice; name|is given twice, .*; give) it once"):
        ask(strut)


def test_an_output_of_a_case_has_one_name_in_a_function(toe):
    with pytest.raises(hardpoint.UsageError, match="`of` has `bump.toe` twice"):
        hardpoint.Function(toe, of=["toe", "bump.toe"], variables=["outer_z"])
    with pytest.raises(hardpoint.UsageError, match="runs every case"):
        toe.runs(case="bump")


def test_a_single_name_needs_no_list(strut):
    found = strut.designs([[0.1]], "toe", variables="ball_joint_z")
    assert (found.values == strut.designs([[0.1]], ["toe"], variables=["ball_joint_z"]).values).all()
    assert hardpoint.Function(strut, "ball_joint_z", "toe").variables == ("ball_joint_z",)


def test_errors_of_files_name_the_file_of_the_user(strut, tmp_path):
    path = tmp_path / "none" / "strut.npz"
    run = strut.run(times=[0.0, 0.1])
    for write in (run.save, strut.save, run.page().save):
        with pytest.raises(hardpoint.FileError) as raised:
            write(path)
        assert str(raised.value) == f"error: `{path}` cannot be written: No such file or directory"
        assert isinstance(raised.value, OSError) and isinstance(raised.value, hardpoint.HardpointError)
        assert type(pickle.loads(pickle.dumps(raised.value))) is hardpoint.FileError
    with pytest.raises(hardpoint.FileError, match="cannot be read: Is a directory"):
        hardpoint.load_run(tmp_path)
    with pytest.raises(hardpoint.UsageError, match="a path is a text"):
        run.save(5)


def test_errors_of_the_command_name_a_changed_model_as_its_own_errors_do(strut):
    changed = strut.with_(description="changed")
    with pytest.raises(hardpoint.UsageError, match="is empty") as raised:
        changed.table({"strut_drive": (1, -1)}, of="toe", error="0.01deg")
    assert f"`{changed.file}`: the range of `strut_drive` is empty" in str(raised.value) and raised.value.element == changed.file


def test_every_file_that_cannot_be_written_is_an_error_of_files(strut, tmp_path):
    # The command makes the folders of its files.
    none = tmp_path / "none"
    none.write_text("a file, no folder")
    strut.export(tmp_path / "strut.xml", format="mjcf")
    ranges = {"strut_drive": (-1, 1), "rack_drive": (-1, 1)}
    for write in (
        lambda: strut.export(none / "strut.xml", format="mjcf"),
        lambda: hardpoint.import_model(tmp_path / "strut.xml", none / "strut.toml"),
        lambda: strut.table(ranges, "toe", error="1deg", path=none / "toe.csv"),
    ):
        with pytest.raises(hardpoint.FileError, match="cannot be written") as raised:
            write()
        assert isinstance(raised.value, OSError) and raised.value.code == "HP0601"


@pytest.mark.parametrize("path", ["", ".", "/", "a\0b"])
def test_a_path_without_the_name_of_a_file_is_an_error_of_files(strut, path):
    run = strut.run(times=[0.0, 0.1])
    for write in (
        run.save,
        strut.save,
        run.page().save,
        lambda path: strut.export(path, format="mjcf"),
        lambda path: hardpoint.import_model("strut.xml", path),
        lambda path: hardpoint.new(path, "four-bar"),
        lambda path: strut.table({"strut_drive": (-1, 1)}, "toe", error="1deg", path=path),
    ):
        with pytest.raises(hardpoint.FileError, match="cannot be written: it does not name a file"):
            write(path)


def test_a_damaged_run_is_refused(strut, tmp_path):
    path = tmp_path / "strut.npz"
    strut.run(times=[0.0, 0.1]).save(path)
    whole = path.read_bytes()
    middle = len(whole) // 2
    with np.load(path) as found:
        arrays = {name: found[name] for name in found.files}
    np.savez(tmp_path / "part.npz", **{name: arrays[name] for name in arrays if name != "values"})
    damaged = [b"PK\x03\x04junk", whole[:middle], whole[:middle] + bytes(64) + whole[middle + 64 :], (tmp_path / "part.npz").read_bytes(), b""]
    for contents in damaged:
        path.write_bytes(contents)
        with pytest.raises(hardpoint.UsageError, match="is not a run of this package, or is damaged"):
            hardpoint.load_run(path)


def test_an_error_of_the_command_has_its_code_and_help(tmp_path):
    with pytest.raises(hardpoint.UsageError) as raised:
        hardpoint.new(tmp_path / "x.toml", "nope")
    error = raised.value
    assert error.code == "HP0605" and error.message == "there is no template `nope`" and error.help
    assert str(error).startswith("error[HP0605]: there is no template `nope`")


def test_impossible_studies_report_what_is_missing(strut):
    with pytest.raises(hardpoint.StudyError, match=r"\[optimize.goals\]"):
        strut.optimize()
    with pytest.raises(hardpoint.StudyError, match="tolerance"):
        strut.tolerance()


def test_a_model_with_cases_is_asked_for_one(toe):
    with pytest.raises(hardpoint.UsageError, match="has the cases"):
        toe.run()
    for call in ("what_if", "verify", "validity", "designs"):
        with pytest.raises(hardpoint.UsageError, match=rf"select one, as in `model.case\('bump'\).{call}\(...\)`"):
            getattr(toe, call)(*([{}] if call in ("what_if", "designs") else []))
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


def test_positions_in_a_table_have_one_shape():
    table = hardpoint.read(MODELS / "double_wishbone.toml").table({"spring_drive": (-1, 1), "rack_drive": (-1, 1)}, "toe", error="0.1deg")
    with pytest.raises(hardpoint.UsageError, match=r"different shapes: `spring_drive` \(2,\), `rack_drive` \(3,\)"):
        table("toe", spring_drive=[0, 1], rack_drive=[0, 0.5, 1])
