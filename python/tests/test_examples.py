"""The example jobs run, and the types of examples and package are sound."""

import importlib.util
import os
import re
import subprocess
import sys

import numpy as np
import pytest

import hardpoint
from conftest import ROOT

EXAMPLES = sorted((ROOT / "python/examples").glob("*.py"))


def example(name):
    spec = importlib.util.spec_from_file_location(name, ROOT / f"python/examples/{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_wishbone_is_built_in_code(capsys):
    module = example("wishbone")
    module.main()
    shown = capsys.readouterr().out
    toe = float(re.search(r"toe (-?[\d.]+) deg,", shown)[1])
    moved = float(re.search(r"moved: toe (-?[\d.]+) deg", shown)[1])
    assert abs(moved) < 0.1 * abs(toe), "one step of Newton leaves a small part"
    assert module.wishbone().run().values("wheel_centre.z")[-1] == pytest.approx(230 + 50)


def test_openmdao_removes_the_bump_steer():
    pytest.importorskip("openmdao.api")
    assert example("openmdao_toe").main() < 0.05


def test_a_monte_carlo_of_twenty_thousand_designs(capsys):
    ratio = example("monte_carlo").main()
    assert "20000 motions" in capsys.readouterr().out
    # Of N samples the deviation is known to 1/sqrt(2N); four times that, and the second order.
    assert np.abs(ratio - 1).max() < 4 / np.sqrt(2 * 20_000) + 0.01


def checked(*command):
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT / "python")
    assert done.returncode == 0, done.stdout + done.stderr


def test_mypy_finds_nothing_in_the_examples():
    pytest.importorskip("mypy")
    checked(sys.executable, "-m", "mypy", "--config-file", "pyproject.toml", "--strict", "--follow-imports=silent", f"--cache-dir={os.devnull}", *map(str, EXAMPLES))


USER = """
import numpy as np
import numpy.typing as npt

import hardpoint

model = hardpoint.read("model.toml")
run = model.run(times=np.linspace(0, 1, 5), laws={"travel": np.array([0.0, 1.0])})
toe: npt.NDArray[np.float64] = run.values("toe")
run.to_pandas(), run.to_arrow(), run.to_xarray(), run.animate(), run.plot("toe"), model.runs(sensitivities=False)
position = model.at(travel=12)
position["toe"], position.derivative("toe", "travel"), position.to_pandas(), position.to_xarray()
designs = model.designs([[0.0]], "toe")
designs.to_pandas(), designs.to_xarray(), designs.metric("toe_error")
function = hardpoint.Function(model, of=["toe"], stopped=np.nan)
function(function.start), function.jacobian(function.start), function.value(function.start), function.gradient([0.0])
function.many(np.zeros((2, 1))), function.many_jacobians(np.zeros((2, 1))), function.design(function.start)
study = model.optimize()
study.to_pandas("variables"), study.to_xarray(), model.sweep().to_arrow(), model.maps()[0].to_pandas(), model.maps()[0].to_xarray()
table = model.table({"travel": (0, 1)}, of="toe", error="1deg")
table("toe", travel=[0, 1]), table.to_xarray(), table.proved_error
hardpoint.build(name="empty").with_(description="changed").export("model.c", design=True)
try:
    model.trade_off(points=4).save("better.toml")
except hardpoint.MotionStopped as error:
    print(error.code, error.run)
"""
"""A user's code that calls what has tables, and what takes arrays."""


def test_mypy_finds_nothing_in_code_of_a_user(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "user.py").write_text(USER)
    options = ["--config-file", "pyproject.toml", "--strict", "--follow-imports=silent", f"--cache-dir={os.devnull}"]
    checked(sys.executable, "-m", "mypy", *options, str(tmp_path / "user.py"))


def test_pyright_finds_nothing_in_the_examples():
    pytest.importorskip("pyright")
    checked(sys.executable, "-m", "pyright", "--pythonpath", sys.executable, *map(str, EXAMPLES))


def test_stubs_are_those_of_the_engine():
    """Every name of the native module and its classes is declared, and nothing else."""
    text = (ROOT / "python/hardpoint/_native.pyi").read_text()
    declared = {None: set(re.findall(r"^def (\w+)|^class (\w+)|^(version):", text, re.M))}
    names = {name for found in declared[None] for name in found if name}
    assert names == {name for name in vars(hardpoint._native) if not name.startswith("_")}
    for kind in ("Model", "Run", "Sweep"):
        body = re.search(rf"^class {kind}:\n((?:    .*\n|\n)*)", text, re.M)[1]
        methods = set(re.findall(r"^    def (\w+)", body, re.M))
        assert methods == {name for name in vars(getattr(hardpoint._native, kind)) if not name.startswith("_")}, kind
