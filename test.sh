#!/usr/bin/env bash
# Passes all the tests, from a fresh clone on a fresh machine with a Rust toolchain: format, lints, Rust tests,
# instruction counts, the Python package as a wheel in an environment of its own, and the page: its own tests, and the report of
# every model in a real browser.
set -euo pipefail
cd "$(dirname "$0")"

phase() { # name
    times > target/times
    local cpu
    cpu=$(awk -F '[ms ]+' 'NR == 2 { printf "%d", 60 * $1 + $2 + 60 * $3 + $4 }' target/times)
    echo "== $1 (after $((SECONDS / 60)) min $((SECONDS % 60)) s, $cpu CPU seconds)"
}
has() { # command
    command -v "$1" >/dev/null
}
as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}
install() { # Debian packages
    echo "installing $* ..."
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}
work=$PWD/target/python
python=$work/bin/python
pip() { "$python" -m pip install --quiet --disable-pip-version-check "$@"; }

# Installs what comes from registries.
prepare() {
    local packages=()
    has node || packages+=(nodejs)
    has npm || packages+=(npm)
    has valgrind || packages+=(valgrind)
    has clang || packages+=(clang)
    python3 -c 'import ensurepip' 2>/dev/null || packages+=(python3 python3-venv)
    if [ ${#packages[@]} -gt 0 ] || ! has chromium-headless-shell; then
        as_root apt-get update -qq
        [ ${#packages[@]} = 0 ] || install "${packages[@]}"
        has chromium-headless-shell || install chromium-headless-shell || has chromium || install chromium
    fi
    rm -rf "$work"
    python3 -m venv "$work"
    # What the wheel's tests import, before there is a wheel; compiled when it is imported, which is a small part of it.
    "$python" - > "$work/requirements.txt" <<'END'
try:
    import tomllib
except ImportError:
    from pip._vendor import tomli as tomllib
with open("python/pyproject.toml", "rb") as file:
    project = tomllib.load(file)["project"]
print(*project["dependencies"], *project["optional-dependencies"]["test"], sep="\n")
END
    pip --no-compile 'maturin>=1.16,<2' -r "$work/requirements.txt"
    (cd web && npm ci --silent --no-audit --no-fund)
}

# While Rust compiles, since installing is waiting for the most part.
mkdir -p target
prepare > target/prepare.log 2>&1 &
prepared=$!
trap 'kill $prepared 2>/dev/null || true' EXIT

# Features of the dependencies of some packages.
features() { # packages
    cargo tree --prefix none --format '{p} {f}' "$@" | sed 's/ (\*)$//' | sort -u
}
# What the README's first command and the wheel ask for is what the tests ask for, so that nothing is compiled twice.
same_features() {
    local tests others
    tests=$(features --workspace)
    others=$(features --edges normal,build; features --edges normal,build --package hardpoint-python --features shared)
    others=$(echo "$others" | grep --invert-match '^hardpoint-python ')
    if others=$(echo "$others" | grep --line-regexp --fixed-strings --invert-match "$tests"); then
        echo "these are compiled twice; add the features that the tests ask for to shared/Cargo.toml:" >&2
        echo "$others" >&2
        return 1
    fi
}

phase "format and lints"
same_features
cargo fmt --all --check
cargo clippy --release --workspace --all-targets --quiet -- -D warnings

if ! wait $prepared; then
    cat target/prepare.log >&2
    exit 1
fi

# The page's tests wait for a browser most of the time: they run beside what follows, and are shown at the end.
phase "compiling the Rust tests"
cargo test --release --workspace --no-run --quiet
set -m
(cd web && npm test) > target/page.log 2>&1 &
page=$!
set +m
trap 'kill -- -$page 2>/dev/null || true' EXIT

phase "Rust tests"
.ci/rust-tests --release --workspace

phase "instruction counts"
bench/instructions

phase "Python"
"$work/bin/maturin" build --quiet --release --features shared --manifest-path python/Cargo.toml --out "$work/wheel"
# The wheel alone: nothing of the sources is beside it, and no toolchain is at hand.
wheel=$(echo "$work"/wheel/*.whl)
PATH="$work/bin:/usr/bin:/bin" pip "$wheel[test]"
PATH="$work/bin:/usr/bin:/bin" HARDPOINT="$PWD/target/release/hardpoint" "$python" -m pytest -q -p no:cacheprovider python/tests

phase "the page"
if ! wait $page; then
    cat target/page.log
    exit 1
fi
cat target/page.log

phase "all passed"
