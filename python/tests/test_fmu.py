"""FMUs that the command exports, in an importer of other authors (FMPy): validity, values, derivatives, states, failures."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import hardpoint
from conftest import MODELS, ROOT
from test_motion import si

fmpy = pytest.importorskip("fmpy")
from fmpy.fmi1 import FMICallException  # noqa: E402
from fmpy.fmi3 import FMU3Model, FMU3Slave, fmi3Discard, fmi3Error  # noqa: E402
from fmpy.validation import validate_fmu  # noqa: E402

SAME = 1e-12
"""Largest difference from the engine, relative to the largest number of its kind: as in the Rust tests of the C export."""
NEAR_POLE = 1e-11
"""The same for measures that have a pole in the motion (Ackermann measures straight ahead), which magnifies round-off."""
DERIVATIVE = 1e-11
"""The same for derivatives by the design: those of accelerations divide by the Jacobian three times."""
REVERSED = "_reversed"
"""A model of the gallery whose drivers are reversed has this after its name."""
NAMES = ["slider_crank", "four_bar", "double_wishbone", "front_axle", "stewart", "delta", f"four_bar{REVERSED}"]
"""One and several drivers, planar and spatial, whole turns, measures of single drivers (`front_axle`), reversed drivers."""
DESIGNS = ["double_wishbone", "four_bar", "macpherson", "front_axle"]


class Unit:
    """An FMU with the model that it was exported from."""

    def __init__(self, source, path):
        self.model = hardpoint.read(source)
        self.path = str(path)
        self.description = fmpy.read_model_description(self.path)
        self.folder = fmpy.extract(self.path, str(path.with_suffix("")))
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.drivers = [d["name"] for d in self.model.drivers]
        text = source.read_text()
        self.laws = [re.search(rf"{driver}\]?[^\[]*?law = \"([^\"]+)\"", text).group(1) for driver in self.drivers]

    def reference(self, name):
        return self.variables[name].valueReference

    def inputs(self, orders=3):
        of = ["position", "velocity", "acceleration"][:orders]
        return [self.reference(f"drivers.{d}.{order}") for d in self.drivers for order in of]

    def instance(self, kind=FMU3Model, **options):
        interface = self.description.modelExchange if kind is FMU3Model else self.description.coSimulation
        fmu = kind(guid=self.description.guid, unzipDirectory=self.folder, modelIdentifier=interface.modelIdentifier, instanceName="one")
        fmu.instantiate(**options)
        return fmu

    def started(self, start=None, **options):
        """A Model Exchange instance in Continuous-Time Mode."""
        fmu = self.instance(**options)
        fmu.enterInitializationMode()
        if start:
            fmu.setFloat64(list(start), list(start.values()))
        fmu.exitInitializationMode()
        fmu.enterContinuousTimeMode()
        return fmu

    def drive(self, times):
        """Position, velocity and acceleration of every driver at these times, SI: one row per time, in the order of `inputs`."""
        casadi = pytest.importorskip("casadi")
        t = casadi.SX.sym("t")
        columns = []
        for driver, law in zip(self.drivers, self.laws):
            variable = self.variables[f"drivers.{driver}.position"]
            size = 1 / display_factor(self.description, variable)
            x = eval(law, {"t": t, "pi": np.pi, **{f: getattr(casadi, f) for f in ("sin", "cos", "exp", "sqrt")}})
            rate = casadi.jacobian(x, t)
            of = casadi.Function("law", [t], [size * x, size * rate, size * casadi.jacobian(rate, t)])
            columns += np.array([[float(y) for y in of(at)] for at in times]).T.tolist()
        return np.array(columns).T

    def outputs(self):
        """Measures of the FMU with their orders, and the engine's name."""
        found = []
        for name in self.variables:
            parts = re.fullmatch(r"measures\.(.+)\.(value|rate|acceleration)", name)
            if parts:
                found.append((name, parts.group(1), ["value", "rate", "acceleration"].index(parts.group(2))))
        return found


def display_factor(description, variable):
    """Number of display units per SI unit."""
    if variable.displayUnit is None:
        return 1.0
    unit = next(u for u in description.unitDefinitions if u.name == variable.unit)
    return next(d.factor for d in unit.displayUnits if d.name == variable.displayUnit)


def engine(unit, run, measure, order):
    """Numbers of the engine in SI."""
    return run.values(measure, order) * si_of(unit.model, measure, order)


def si_of(model, measure, order):
    return si(model, model.outputs[measure].units[order])


def difference(found, expected):
    """Largest difference, relative to the largest number, or to one. Both may be undefined."""
    found, expected = np.asarray(found), np.asarray(expected)
    known = np.isfinite(expected)
    size = max(1.0, np.max(np.abs(expected[known]), initial=0.0))
    return np.max(np.abs(found - expected)[known], initial=0.0) / size


@pytest.fixture(scope="module")
def units(command, tmp_path_factory):
    if not (shutil.which("cc") or shutil.which("gcc")):
        pytest.skip("there is no C compiler")
    made = {}

    def unit(name):
        if name not in made:
            path = tmp_path_factory.mktemp(name) / f"{name}.fmu"
            source = MODELS / f"{name}.toml"
            if name.endswith(REVERSED):
                text = (MODELS / f"{name.removesuffix(REVERSED)}.toml").read_text()
                source = path.with_suffix(".toml")
                source.write_text(text.replace('law = "', 'reversed = true, law = "'))
            done = command("export", source, "-o", path)
            assert done.returncode == 0, done.stderr
            assert "compiled for" in done.stdout
            made[name] = Unit(source, path)
        return made[name]

    return unit


@pytest.mark.parametrize("name", NAMES)
def test_description_and_sources_are_valid(name, units):
    from lxml import etree

    unit = units(name)
    assert validate_fmu(unit.path) == []
    schema = Path(fmpy.__file__).parent / "schema/fmi3/fmi3BuildDescription.xsd"
    build = etree.parse(Path(unit.folder) / "sources/buildDescription.xml")
    schema = etree.XMLSchema(etree.parse(schema))
    assert schema.validate(build), schema.error_log
    sources = {file.get("name") for file in build.iter("SourceFile")}
    assert sources == {f"{name}.c", "fmi3.c"} and all((Path(unit.folder) / "sources" / s).exists() for s in sources)
    for variable in unit.variables.values():
        assert variable.unit in {u.name for u in unit.description.unitDefinitions}, variable.name


def test_functions_are_declared_as_in_the_header_of_the_standard(units):
    unit = units("slider_crank")
    folder = Path(fmpy.__file__).parent / "c-code"
    # The standard's declarations in place of those of the FMU.
    options = ["-I", folder, "-include", "fmi3Functions.h", "-D", "SLIDER_CRANK_FMI3_H", "-D", "FMI3_EXPORT="]
    done = subprocess.run(
        ["cc", "-std=c11", "-Wall", "-Werror", "-fsyntax-only", *options, "fmi3.c"],
        cwd=Path(unit.folder) / "sources", capture_output=True, text=True,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", NAMES)
def test_model_exchange_has_the_numbers_of_the_engine(name, units):
    unit = units(name)
    run = unit.model.run()
    fmu, inputs, outputs = unit.started(), unit.inputs(), unit.outputs()
    assert outputs
    references = [unit.reference(of) for of, _, _ in outputs]
    body = next(iter(unit.model.bodies))
    pose = [unit.reference(f"bodies.{body}.{of}") for of in ("position", "rotation")]
    found, poses = [], []
    for t, row in zip(run.times, unit.drive(run.times)):
        fmu.setTime(t)
        fmu.setFloat64(inputs, row)
        found.append(fmu.getFloat64(references))
        poses.append(fmu.getFloat64(pose, nValues=12))
    found, poses = np.array(found), np.array(poses)
    for column, (of, measure, order) in enumerate(outputs):
        values = found[:, column]
        expected = engine(unit, run, measure, order)
        if measure.endswith(("ackermann", "ackermann_error")):
            # Formulas that take another case on the other side are undefined there.
            assert np.isfinite(values).any() and np.isnan(values).any()
            assert difference(values, np.where(np.isnan(values), np.nan, expected)) < NEAR_POLE, of
        else:
            assert (np.isfinite(values) == np.isfinite(expected)).all(), of
            assert difference(values, expected) < SAME, of
    length = 1 / display_factor(unit.description, unit.variables[f"bodies.{body}.position"])
    assert difference(poses[:, :3], run.body(body).position * length) < SAME
    rotation = poses[:, 3:].reshape(-1, 3, 3)
    assert difference(rotation @ rotation.transpose(0, 2, 1), np.tile(np.eye(3), (len(rotation), 1, 1))) < SAME


@pytest.mark.parametrize("kind", ["ModelExchange", "CoSimulation"])
@pytest.mark.parametrize("name", ["slider_crank", "double_wishbone", f"four_bar{REVERSED}"])
def test_simulations_follow_the_inputs(name, kind, units):
    unit = units(name)
    run = unit.model.run()
    step = run.times[1] - run.times[0]
    names = [f"drivers.{d}.{of}" for d in unit.drivers for of in ("position", "velocity", "acceleration")]
    signals = np.array([(t, *row) for t, row in zip(run.times, unit.drive(run.times))], dtype=[(n, float) for n in ["time", *names]])
    result = fmpy.simulate_fmu(
        unit.path, fmi_type=kind, start_time=run.times[0], stop_time=run.times[-1], input=signals, output_interval=step, step_size=step,
    )
    # A step of Co-Simulation holds the inputs of its beginning.
    late = 1 if kind == "CoSimulation" else 0
    at = [int(np.argmin(abs(result["time"] - t))) for t in run.times[late:]]
    for of, measure, order in unit.outputs():
        expected = engine(unit, run, measure, order)
        assert difference(result[of][at], expected[: len(expected) - late]) < 1e-9, of
        # 1e-9: the importer interpolates the inputs at times with a rounding error.


def test_it_runs_without_inputs(units):
    unit = units("stewart")
    for kind in ("ModelExchange", "CoSimulation"):
        result = fmpy.simulate_fmu(unit.path, fmi_type=kind, stop_time=0.1)
        run = unit.model.run()
        of, measure, _ = unit.outputs()[0]
        assert abs(result[of] - engine(unit, run, measure, 0)[0]).max() < SAME


@pytest.mark.parametrize("name", NAMES)
def test_directional_derivatives_along_the_motion_are_its_rates(name, units):
    unit = units(name)
    run = unit.model.run()
    fmu, inputs = unit.started(), unit.inputs()
    outputs = [o for o in unit.outputs() if not o[1].endswith(("ackermann", "ackermann_error"))]
    # d(value)/dt = rate, d(rate)/dt = acceleration, for d(q, qd)/dt = (qd, qdd): the acceleration does not matter.
    pairs = [(of, of.removesuffix(a) + b) for of, _, _ in outputs for a, b in [("value", "rate"), ("rate", "acceleration")] if of.endswith(a)]
    pairs = [(of, rate) for of, rate in pairs if rate in unit.variables]
    assert pairs
    for row in unit.drive(run.times)[:: len(run.times) // 7]:
        fmu.setFloat64(inputs, row)
        seed = np.array([[qd, qdd, 0.0] for _, qd, qdd in row.reshape(-1, 3)]).ravel()
        found = fmu.getDirectionalDerivative([unit.reference(of) for of, _ in pairs], inputs, seed)
        expected = fmu.getFloat64([unit.reference(rate) for _, rate in pairs])
        for (of, _), x, y in zip(pairs, found, expected):
            assert np.isnan(x) == np.isnan(y) and (np.isnan(x) or abs(x - y) < 1e-10 * max(1, abs(y))), of


@pytest.mark.parametrize("name", ["double_wishbone", "front_axle", "stewart"])
def test_directional_derivatives_agree_with_differences(name, units):
    """All outputs by all inputs, the acceleration by the position included, and the design."""
    unit = units(name)
    run = unit.model.run(sensitivities=False)
    row = unit.drive(run.times)[len(run.times) // 3]
    design = [v.valueReference for v in unit.variables.values() if v.causality == "parameter"]
    start = dict.fromkeys(design, 0.0)
    outputs = [of for of, measure, _ in unit.outputs() if not measure.endswith(("ackermann", "ackermann_error"))]
    references = [unit.reference(of) for of in outputs]
    knowns = unit.inputs() + design
    at = np.array([*row, *start.values()])
    seed = np.random.default_rng(7).normal(size=len(at)) * np.where(np.arange(len(at)) < len(row), 1.0, 0.02)

    def values(x):
        fmu = unit.started(dict(zip(knowns, x)))
        return np.array(fmu.getFloat64(references)), fmu

    _, fmu = values(at)
    found = np.array(fmu.getDirectionalDerivative(references, knowns, seed))
    errors = []
    for h in (1e-3, 5e-4):
        differences = (values(at + h * seed)[0] - values(at - h * seed)[0]) / (2 * h)
        size = np.maximum(1.0, abs(differences))
        errors.append(np.nanmax(abs(found - differences) / size))
    # Central differences: the error falls by four when the step halves.
    assert errors[0] < 0.05 and errors[1] < 0.3 * errors[0], errors
    weights = np.random.default_rng(8).normal(size=len(references))
    weights[np.isnan(found)] = 0.0
    known = ~np.isnan(found)
    adjoint = fmu.getAdjointDerivative(list(np.array(references)[known]), knowns, weights[known], nSensitivity=len(knowns))
    assert np.dot(adjoint, seed) == pytest.approx(np.dot(weights[known], found[known]), rel=1e-12)


@pytest.mark.parametrize("name", DESIGNS)
def test_design_parameters_have_the_values_and_sensitivities_of_the_engine(name, units):
    unit = units(name)
    parameters = {v.name.removeprefix("design."): v for v in unit.variables.values() if v.causality == "parameter"}
    assert parameters and all(v.variability == "tunable" for v in parameters.values())
    in_si = {v: si(unit.model, unit.model.variables[v].unit) for v in parameters}
    # A millimetre, or a thousandth of a radian or a number.
    design = {v: 1e-3 / in_si[v] for v in parameters}
    run = unit.model.run(design)
    row = unit.drive(run.times)
    start = {parameters[v].valueReference: x * in_si[v] for v, x in design.items()}
    fmu = unit.started(start)
    outputs = [o for o in unit.outputs() if not o[1].endswith(("ackermann", "ackermann_error"))]
    references = [unit.reference(of) for of, _, _ in outputs]
    found, slopes = [], {v: [] for v in parameters}
    for drivers in row:
        fmu.setFloat64(unit.inputs(), drivers)
        found.append(fmu.getFloat64(references))
        for v, parameter in parameters.items():
            slopes[v].append(fmu.getDirectionalDerivative(references, [parameter.valueReference], [1.0]))
    for column, (of, measure, order) in enumerate(outputs):
        assert difference(np.array(found)[:, column], engine(unit, run, measure, order)) < 2 * SAME, of
        for v in parameters:
            expected = run.sensitivity(measure, v, order) * si_of(unit.model, measure, order) / in_si[v]
            assert difference(np.array(slopes[v])[:, column], expected) < DERIVATIVE, (of, v)


def test_a_parameter_is_tuned_during_a_simulation(units):
    unit = units("double_wishbone")
    fmu = unit.instance(FMU3Slave)
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    fmu.doStep(0.0, 0.1)
    parameter = next(v for v in unit.variables.values() if v.causality == "parameter")
    toe = unit.reference("measures.toe.value")
    before = fmu.getFloat64([toe])[0]
    fmu.setFloat64([parameter.valueReference], [2e-3])
    fmu.doStep(0.1, 0.1)
    tuned = fmu.getFloat64([toe])[0]
    assert tuned != before
    assert tuned == pytest.approx(unit.started({parameter.valueReference: 2e-3}).getFloat64([toe])[0], rel=SAME)
    fmu.setFloat64([parameter.valueReference], [0.0])
    assert fmu.getFloat64([toe])[0] == pytest.approx(before, rel=SAME)
    # In Continuous-Time Mode parameters are constant.
    running = unit.started()
    with pytest.raises(FMICallException) as raised:
        running.setFloat64([parameter.valueReference], [1e-3])
    assert raised.value.status == fmi3Error
    running.enterEventMode()
    running.setFloat64([parameter.valueReference], [2e-3])
    assert running.getFloat64([toe])[0] == pytest.approx(tuned, rel=SAME)


def test_states_are_stored_and_restored(units):
    unit = units("front_axle")
    rows = unit.drive(unit.model.run(sensitivities=False).times)
    references = [unit.reference(of) for of, _, _ in unit.outputs()]
    fmu, other = unit.started(), unit.started()
    fmu.setFloat64(unit.inputs(), rows[3])
    state, expected = fmu.getFMUState(), np.array(fmu.getFloat64(references))
    bytes_of = fmu.serializeFMUState(state)
    fmu.setFloat64(unit.inputs(), rows[40])
    assert not np.array_equal(np.array(fmu.getFloat64(references)), expected, equal_nan=True)
    fmu.setFMUState(state)
    assert np.array_equal(np.array(fmu.getFloat64(references)), expected, equal_nan=True)
    fmu.freeFMUState(state)
    state = other.deserializeFMUState(bytes_of)
    other.setFMUState(state)
    assert np.array_equal(np.array(other.getFloat64(references)), expected, equal_nan=True)
    with pytest.raises(FMICallException):
        other.deserializeFMUState(bytes_of[:-1])


@pytest.mark.parametrize("kind", [FMU3Model, FMU3Slave])
def test_positions_that_cannot_be_reached_are_named(kind, units):
    unit = units("stewart")
    said = []
    fmu = unit.instance(kind, loggingOn=True, logMessage=lambda _, status, category, text: said.append((status, category, text.decode())))
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    leg = unit.reference("drivers.leg_1.position")
    output = [unit.reference(unit.outputs()[0][0])]
    start, before = fmu.getFloat64([leg]), fmu.getFloat64(output)
    fmu.setFloat64([leg], [10.0])
    with pytest.raises(FMICallException) as raised:
        fmu.doStep(0.0, 0.1) if kind is FMU3Slave else fmu.getFloat64(output)
    assert raised.value.status == fmi3Discard
    assert said[-1][:2] == (fmi3Discard, b"logStatusDiscard") and "t = 0 s" in said[-1][2] and "leg_1 = 10 m" in said[-1][2]
    # The last position is kept.
    fmu.setFloat64([leg], start)
    assert fmu.getFloat64(output) == pytest.approx(before, rel=SAME)
    with pytest.raises(FMICallException) as raised:
        fmu.setFloat64([leg], [float("nan")])
    assert raised.value.status == fmi3Error
    with pytest.raises(FMICallException) as raised:
        fmu.setFloat64(output, [0.0])
    assert raised.value.status == fmi3Error and "is not an input" in said[-1][2]


def test_a_wrong_token_is_refused(units):
    unit = units("slider_crank")
    fmu = FMU3Model(guid="{0}", unzipDirectory=unit.folder, modelIdentifier="slider_crank", instanceName="one")
    with pytest.raises(Exception, match="instantiate"):
        fmu.instantiate()


def test_the_example_of_the_page_runs(command, monkeypatch, tmp_path):
    (example,) = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/export-fmi.md").read_text(), re.M | re.S)
    monkeypatch.chdir(tmp_path)
    assert command("export", MODELS / "double_wishbone.toml", "-o", "corner.fmu").returncode == 0
    names = {}
    exec(compile(example, "docs/export-fmi.md", "exec"), names)
    assert np.isfinite(names["result"]["measures.camber.value"]).all()


def test_every_coordinate_is_a_parameter_on_request(tmp_path):
    model = hardpoint.read(MODELS / "double_wishbone.toml")
    whole = model.with_coordinates(tilts=True)
    whole.export(tmp_path / "corner.fmu")
    description = fmpy.read_model_description(str(tmp_path / "corner.fmu"))
    parameters = {v.name: v for v in description.modelVariables if v.causality == "parameter"}
    added = [name for name in whole.variables if name not in model.variables]
    assert added and {f"design.{name}" for name in added} <= set(parameters)
    # Tuned to a millimetre and a thousandth of a radian, 20 mm from the design configuration.
    chosen = {name: 1e-3 / si(whole, whole.variables[name].unit) for name in (added[0], added[-1])}
    start = {"drivers.spring_drive.position": 0.02, **{f"design.{name}": 1e-3 for name in chosen}}
    result = fmpy.simulate_fmu(str(tmp_path / "corner.fmu"), stop_time=0.1, start_values=start, output=["measures.toe.value"])
    at = next(driver["nominal"] for driver in model.drivers if driver["name"] == "spring_drive") + 20
    expected, nominal = (of["toe"] * si_of(model, "toe", 0) for of in (whole.at(spring_drive=at, design=chosen), model.at(spring_drive=at)))
    assert result["measures.toe.value"] == pytest.approx(expected, abs=1e-9) and abs(expected - nominal) > 1e-6


def test_variables_of_the_design_are_arguments_in_c(tmp_path):
    model = hardpoint.read(MODELS / "double_wishbone.toml")
    plain, design, whole = (tmp_path / f"{name}.c" for name in ("plain", "design", "whole"))
    facts = model.export(plain)
    assert "design variables" in [one["kind"] for one in facts["unsaid"]]
    model.export(design, design=True)
    model.with_coordinates().export(whole)
    headers = [path.with_suffix(".h").read_text() for path in (plain, design, whole)]
    assert [f"{path.stem}_gradient".lower() in text for path, text in zip((plain, design, whole), headers)] == [False, True, True]
    assert all(f"WHOLE_DESIGN_{name.replace('.', '_').upper()} " in headers[2] for name in model.with_coordinates().variables)
    # Formats without a design ignore the added variables, and refuse the option.
    model.with_coordinates().export(tmp_path / "corner.urdf")
    with pytest.raises(hardpoint.UsageError, match="--design"):
        model.export(tmp_path / "corner.urdf", design=True)
