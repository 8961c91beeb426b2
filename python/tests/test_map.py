"""Tables of `hardpoint map`, read back by SciPy: its interpolations are those whose error is proved."""

import csv
import json
import math
import re
from pathlib import Path

import numpy
import pytest

import hardpoint
from conftest import MODELS

interpolate = pytest.importorskip("scipy.interpolate")

ERROR = 1e-3
"""Permitted error, deg."""
OVER = ["--over", "spring_drive=-16..24", "--over", "rack_drive=-12..12"]


@pytest.fixture
def model():
    return Path(__file__).resolve().parents[2] / "models/double_wishbone.toml"


@pytest.fixture
def solved(command, model, tmp_path):
    """Drivers and toe at the output times of a run, mm and deg."""
    assert command("run", model, "-o", tmp_path / "run", "--no-sensitivities").returncode == 0
    with open(tmp_path / "run/motion.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    time, toe = (next(name for name in rows[0] if name.startswith(start)) for start in ("t [", "toe ["))
    turns = [2 * math.pi * float(row[time]) for row in rows]
    # The laws of the model file.
    drivers = numpy.array([[4 + 20 * math.sin(t), 12 * math.sin(0.5 * t)] for t in turns])
    return drivers, numpy.array([float(row[toe]) for row in rows])


def table(command, model, path, *options):
    done = command("map", model, *OVER, "--of", "toe", "--error", f"{ERROR}deg", "-o", path, *options)
    assert done.returncode == 0, done.stderr
    return path


def test_hermite_interpolation_of_the_json_file_is_within_the_proved_error(command, model, solved, tmp_path, monkeypatch):
    found = json.loads(table(command, model, tmp_path / "toe.json").read_text())
    assert found["proved"] is True and found["interpolation"] == "hermite"
    x, y = (numpy.array(axis["knots"]) for axis in found["drivers"])
    (toe,) = found["outputs"]
    assert toe["unit"] == "deg" and 0 < toe["proved_error"] <= toe["permitted_error"] == pytest.approx(ERROR)
    by = {tuple(n["by"]): numpy.reshape(n["values"], (x.size, y.size)) for n in toe["numbers"]}
    # The interpolation is that of the document.
    document = (Path(__file__).resolve().parents[2] / "docs/maps.md").read_text()
    (block,) = re.findall(r"^```python\n(.*?)^```", document, re.M | re.S)
    names = {}
    monkeypatch.chdir(tmp_path)
    exec(compile(block, "maps.md", "exec"), names)
    drivers, exact = solved
    got = [names["toe"](a, b) for a, b in drivers]
    errors = numpy.abs(got - exact)
    assert errors.max() <= toe["proved_error"]
    # The derivatives count: linear interpolation of the same values is worse.
    linear = interpolate.RegularGridInterpolator((x, y), by[()])(numpy.clip(drivers, [x[0], y[0]], [x[-1], y[-1]]))
    assert numpy.abs(linear - exact).max() > 2 * toe["proved_error"]


def test_linear_interpolation_of_the_csv_file_is_within_the_permitted_error(command, model, solved, tmp_path):
    path = table(command, model, tmp_path / "toe.csv", "--interpolation", "linear")
    with open(path, newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["spring_drive [mm]", "rack_drive [mm]", "toe [deg]"]
    numbers = numpy.array(rows, dtype=float)
    x, y = numpy.unique(numbers[:, 0]), numpy.unique(numbers[:, 1])
    at = interpolate.RegularGridInterpolator((x, y), numbers[:, 2].reshape(x.size, y.size))
    drivers, exact = solved
    errors = numpy.abs(at(numpy.clip(drivers, [x[0], y[0]], [x[-1], y[-1]])) - exact)
    assert ERROR / 100 < errors.max() <= ERROR


@pytest.mark.parametrize("interpolation", ["hermite", "linear"])
def test_a_table_of_python_is_within_the_proved_error(model, solved, interpolation, tmp_path):
    ranges = {"spring_drive": (-16, 24), "rack_drive": (-12, 12)}
    found = hardpoint.read(model).table(ranges, of=["toe"], error=f"{ERROR}deg", interpolation=interpolation, path=tmp_path / "toe.json")
    assert found == json.loads((tmp_path / "toe.json").read_text())
    drivers, exact = solved
    spring, rack = (numpy.clip(x, *ends) for x, ends in zip(drivers.T, ranges.values()))
    errors = numpy.abs(found("toe", spring_drive=spring, rack_drive=rack) - exact)
    assert 0 < errors.max() <= found.proved_error["toe"] <= ERROR
    assert found("toe", rack_drive=0, spring_drive=spring).shape == spring.shape
    knots = found.to_xarray()["toe"]
    assert knots.dims == ("spring_drive", "rack_drive") and knots.attrs["units"] == "deg"
    first = {name: float(knots[name][-1]) for name in knots.dims}
    assert found("toe", **first) == float(knots[-1, -1])


def test_a_table_over_one_driver_is_that_of_scipy(model):
    found = hardpoint.read(model).table({"spring_drive": (-16, 24)}, of="wheel_centre.z", error={"wheel_centre.z": "0.01mm"})
    (numbers,) = found["outputs"]
    value, slope = (numpy.array(n["values"]) for n in numbers["numbers"])
    x = numpy.linspace(-16, 24, 1001)
    expected = interpolate.CubicHermiteSpline(found.drivers["spring_drive"], value, slope)(x)
    assert found("wheel_centre.z", spring_drive=x) == pytest.approx(expected, abs=1e-11)


def test_a_table_has_values_at_the_ends_that_were_asked_for():
    model = hardpoint.read(Path(__file__).resolve().parents[2] / "models/four_bar.toml")
    for ends in ((-30, 30), (-0.1, 12.3), (numpy.nextafter(0.3, 1), 7)):
        table = model.table({"motor": ends}, of="midpoint_x", error=1)
        exact = model.at(motor=numpy.array(ends))["midpoint_x"]
        assert table("midpoint_x", motor=ends) == pytest.approx(exact, abs=1e-9)
        assert table.drivers["motor"][[0, -1]] == pytest.approx(ends, rel=1e-15)


def test_mistakes_with_tables_are_named(model):
    of = hardpoint.read(model)
    table = of.table({"spring_drive": (-16, 24)}, of="toe", error=0.1)
    for wrong, message in (
        (lambda: table("camber", spring_drive=0), "camber"),
        (lambda: table("toe", spring_driv=0), "spring_drive"),
        (lambda: table("toe"), "give `spring_drive`"),
        (lambda: table("toe", spring_drive=25), "outside of the table's range -16 .. 24"),
        (lambda: table("toe", spring_drive=math.nan), "outside"),
        (lambda: of.table({}, error=1), "`over` names no driver"),
        (lambda: of.table({"spring_drive": (0, 1)}, of="toe", error={}), "`error` names no output"),
        (lambda: of.table({"spring_drive": 3}, error=1), "both of its ends"),
        (lambda: of.table({"spring": (0, 1)}, error=1), "spring"),
        (lambda: of.table({"spring_drive": (0, 1)}, of="toe", error="1 furlong"), "furlong"),
    ):
        with pytest.raises(hardpoint.HardpointError, match=re.escape(message)):
            wrong()


def test_tables_of_modelica_are_in_si_with_both_grids(command, model, tmp_path):
    text = table(command, model, tmp_path / "toe.txt").read_text()
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    assert text.startswith("#1\n") and lines[0].startswith("double toe(")
    rows, columns = map(int, lines[0][len("double toe(") : -1].split(","))
    numbers = numpy.array([[float(x) for x in line.split()] for line in lines[1:]])
    assert numbers.shape == (rows, columns)
    assert numbers[0, 1] == pytest.approx(-0.012) and numbers[0, -1] == pytest.approx(0.012)
    assert numbers[1, 0] == pytest.approx(-0.016) and numbers[-1, 0] == pytest.approx(0.024)
    assert numpy.abs(numbers[1:, 1:]).max() < 0.5


def test_a_range_that_is_not_reached_names_the_place(command, model, tmp_path):
    path = tmp_path / "toe.json"
    done = command("map", model, "--over", "spring_drive=-160..24", "--of", "toe", "--error", "1deg", "-o", path)
    assert done.returncode == 5 and not path.exists()
    assert "HP0606" in done.stderr and "spring_drive = -160 mm is not reached" in done.stderr


def hermite(knots, numbers, at):
    """The interpolation of docs/maps.md: cubic along the first driver, of values and of derivatives by the next, then along the next.
    `numbers` has an axis of value and derivative for each driver, then the knots of each."""
    cells = [numpy.clip(numpy.searchsorted(x, a, side="right") - 1, 0, len(x) - 2) for x, a in zip(knots, at)]
    total = 0.0
    for corner in numpy.ndindex(*(2,) * len(knots)):
        place = tuple(cell + end for cell, end in zip(cells, corner))
        for order in numpy.ndindex(*(2,) * len(knots)):
            weight = 1.0
            for x, a, cell, end, k in zip(knots, at, cells, corner, order):
                width = x[cell + 1] - x[cell]
                # Distance from the corner in widths of the cell.
                u = abs(a - x[cell + end]) / width
                weight = weight * ((1 + 2 * u) * (1 - u) ** 2 if k == 0 else (1 - 2 * end) * width * u * (1 - u) ** 2)
            total = total + weight * numbers[order][place]
    return total


def test_the_proved_error_holds_at_a_million_positions(tmp_path):
    """The stroke of a slider crank has a closed form, so that every position of the written table can be compared."""
    model = hardpoint.read(MODELS / "slider_crank.toml")
    found = model.table({"crank_drive": (-4, 4)}, of="stroke", error="1e-5m", path=tmp_path / "stroke.csv")
    with open(tmp_path / "stroke.csv", newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["crank_drive [rad]", "stroke [m]", "stroke by crank_drive [m/rad]"]
    x, value, slope = numpy.array(rows, dtype=float).T
    at = numpy.random.default_rng(40).uniform(-4, 4, 1_000_000)
    (cx, cy, _), (px, py, _) = model.hardpoints["P2"], model.hardpoints["P3"]
    turned = numpy.arctan2(cy, cx) + at
    crank, rod = numpy.hypot(cx, cy), numpy.hypot(px - cx, py - cy)
    exact = crank * numpy.cos(turned) + numpy.sqrt(rod**2 - (py - crank * numpy.sin(turned)) ** 2) - px
    errors = numpy.abs(hermite([x], {(0,): value, (1,): slope}, [at]) - exact)
    assert 0.01 * found.proved_error["stroke"] < errors.max() <= found.proved_error["stroke"] <= 1e-5


def test_the_proved_error_over_two_drivers_holds_at_random_positions(model, tmp_path):
    of = hardpoint.read(model)
    ranges = {"spring_drive": (-16, 24), "rack_drive": (-12, 12)}
    of.table(ranges, of="toe", error="0.01deg", path=tmp_path / "toe.json")
    table = json.loads((tmp_path / "toe.json").read_text())
    knots = [numpy.array(axis["knots"]) for axis in table["drivers"]]
    names = [axis["name"] for axis in table["drivers"]]
    (toe,) = table["outputs"]
    shape = [len(x) for x in knots]
    numbers = {tuple(int(name in one["by"]) for name in names): numpy.reshape(one["values"], shape) for one in toe["numbers"]}
    random = numpy.random.default_rng(41)
    at = [random.uniform(*ranges[name], 10_000) for name in names]
    exact = of.at(dict(zip(names, at)), sensitivities=False)["toe"]
    errors = numpy.abs(hermite(knots, numbers, at) - exact)
    assert 1e-9 < errors.max() <= toe["proved_error"]
