#!/usr/bin/env bash
# Passes all the tests, from a fresh clone on a fresh machine with a Rust toolchain: format, lints, Rust tests,
# instruction counts, the Python package as a wheel in an environment of its own, and the page: its own tests, and the report of
# every model in a real browser.
set -euo pipefail
cd "$(dirname "$0")"

install() { # Debian package
    local sudo=""
    [ "$(id -u)" = 0 ] || sudo=sudo
    echo "installing $1 ..."
    $sudo apt-get update -qq
    $sudo apt-get install -y -qq --no-install-recommends "$1" >/dev/null
}
need() { # command, Debian package
    command -v "$1" >/dev/null || install "$2"
}
need node nodejs
need npm npm
command -v chromium-headless-shell >/dev/null || install chromium-headless-shell || need chromium chromium
need valgrind valgrind
need clang clang
need python3 python3
python3 -c 'import ensurepip' 2>/dev/null || install python3-venv

phase() { # name
    echo "== $1 (after $((SECONDS / 60)) min $((SECONDS % 60)) s)"
}

phase "format and lints"
cargo fmt --all --check
cargo clippy --release --workspace --all-targets --quiet -- -D warnings
cargo fmt --manifest-path web/engine/Cargo.toml -p hardpoint-wasm -p web-time --check
cargo clippy --manifest-path web/engine/Cargo.toml --workspace --locked --target-dir target/engine --quiet -- -D warnings

phase "Rust tests"
.ci/rust-tests --release --workspace

phase "instruction counts"
bench/instructions

phase "Python"
work=target/python
rm -rf "$work"
python3 -m venv "$work"
python="$PWD/$work/bin/python"
pip() { "$python" -m pip install --quiet --disable-pip-version-check "$@"; }
pip 'maturin>=1.16,<2'
"$work/bin/maturin" build --quiet --release --features shared --manifest-path python/Cargo.toml --out "$work/wheel"
# The wheel alone: nothing of the sources is beside it, and no toolchain is at hand.
wheel=$(echo "$work"/wheel/*.whl)
# Python compiles what the tests import, which is a small part of what is installed.
PATH="$PWD/$work/bin:/usr/bin:/bin" pip --no-compile "$PWD/$wheel[test]"
PATH="$PWD/$work/bin:/usr/bin:/bin" HARDPOINT="$PWD/target/release/hardpoint" "$python" -m pytest -q -p no:cacheprovider python/tests

phase "the page"
cd web
npm ci --silent --no-audit --no-fund
npm test
