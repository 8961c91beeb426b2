#!/usr/bin/env bash
# Passes all the tests, from a fresh clone on a fresh machine with a Rust toolchain: format, lints, Rust tests,
# instruction counts, the page's own tests, and the reports of both of the paper's examples in a real browser.
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
for model in slider_crank macpherson; do
    cargo run --release --quiet -- run "models/$model.toml" -o "target/reports/$model" >/dev/null
done
cd web
npm ci --silent --no-audit --no-fund
npm test
for model in slider_crank macpherson; do
    HARDPOINT_REPORT="$PWD/../target/reports/$model/report.html" npx vitest run test/page.browser.test.ts
done
