#!/usr/bin/env bash
# Passes all the tests, from a fresh clone on a fresh machine with a Rust toolchain: format, lints, Rust tests,
# instruction counts, and the page: its own tests, and the report of every model in a real browser.
set -euo pipefail
cd "$(dirname "$0")"

need() { # command, Debian package
    command -v "$1" >/dev/null && return
    local sudo=""
    [ "$(id -u)" = 0 ] || sudo=sudo
    echo "installing $2 ..."
    $sudo apt-get update -qq
    $sudo apt-get install -y -qq --no-install-recommends "$2" >/dev/null
}
need node nodejs
need npm npm
need chromium chromium
need valgrind valgrind
need python3 python3

echo "== format and lints"
cargo fmt --all --check
cargo clippy --workspace --all-targets --quiet -- -D warnings

echo "== Rust tests"
cargo test --workspace

echo "== instruction counts"
bench/instructions

echo "== the page"
cd web
npm ci --silent --no-audit --no-fund
npm test
