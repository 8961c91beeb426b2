"""Build backend: maturin, after a check for a Rust toolchain."""

from __future__ import annotations

import os
import shutil

import maturin

MISSING = (
    "error: hardpoint is built from source and needs a Rust toolchain, but `cargo` was not found on the PATH: install Rust from "
    "https://rustup.rs, open a new shell, and run the same command again"
)


def _require_cargo() -> None:
    """Ends the build with a short message if Rust is missing, instead of a download or a page of output."""
    if shutil.which(os.environ.get("CARGO", "cargo")) is None:
        raise SystemExit(MISSING)


def get_requires_for_build_wheel(config_settings=None):
    _require_cargo()
    return maturin.get_requires_for_build_wheel(config_settings)


def get_requires_for_build_editable(config_settings=None):
    _require_cargo()
    return maturin.get_requires_for_build_editable(config_settings)


def get_requires_for_build_sdist(config_settings=None):
    _require_cargo()
    return maturin.get_requires_for_build_sdist(config_settings)


prepare_metadata_for_build_wheel = maturin.prepare_metadata_for_build_wheel
prepare_metadata_for_build_editable = maturin.prepare_metadata_for_build_editable
build_wheel = maturin.build_wheel
build_editable = maturin.build_editable
build_sdist = maturin.build_sdist
