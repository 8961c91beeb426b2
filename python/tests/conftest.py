"""Fixtures of the tests."""

import json
import os
import subprocess
from pathlib import Path

import pytest

import hardpoint

ROOT = Path(__file__).resolve().parents[2]
MODELS = ROOT / "models"
K_AND_C = ROOT / "crates/hardpoint-cli/templates/k-and-c.toml"
REFERENCE = json.loads((ROOT / "crates/hardpoint-file/tests/reference.json").read_text())
"""Reference cases in SI, shared with the Rust tests."""


@pytest.fixture(scope="session")
def command():
    """Runs the command line. The tests that compare with it are skipped if it is neither built nor named."""
    named = os.environ.get("HARDPOINT")
    program = Path(named or ROOT / "target/release/hardpoint")
    if not named and not program.exists():
        pytest.skip(f"there is no program {program}: `cargo build --release`, or name it in HARDPOINT")

    def run(*arguments):
        return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)

    return run


@pytest.fixture(scope="session")
def strut():
    return hardpoint.read(MODELS / "macpherson.toml")


@pytest.fixture(scope="session")
def toe():
    """Strut with variables, metrics, and two cases."""
    return hardpoint.read(MODELS / "studies/strut_toe.toml")
