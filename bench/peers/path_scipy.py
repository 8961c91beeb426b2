"""CPU time per hit of three path syntheses of `models/synthesis`, beside scipy's `least_squares`, in one run.

    python -m venv venv && venv/bin/pip install -r bench/peers/requirements.txt
    cargo build --release
    venv/bin/python bench/peers/path_scipy.py target/release/hardpoint

Both sides have the targets, variables, bounds and first start of the model file, and the same number of starts: the
nominal design and points of a Sobol sequence within the bounds. A hit ends within a thousandth of the best error that
either side finds. scipy's trust region has tolerances of 1e-12 or less and at most 500 evaluations per start; its
designs are closed forms of the four-bar in NumPy, with derivatives by finite differences. hardpoint has its default
settings, on one thread. CPU times are those of this process, and of the command with reading the file.
"""

import argparse
import json
import os
import resource
import subprocess
import time
import tomllib
from pathlib import Path

# BLAS would use several cores, whose CPU times add up. It reads this when it is loaded.
os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import qmc

MODELS = Path(__file__).parents[2] / "models/synthesis"
HIT = 1.001


def coupler_point(ground, crank, coupler, rocker, along, across, x, y, turn, angle):
    """Coupler point of a four-bar, turned and moved with its ground link; further off where the loop does not close."""
    pin = crank * np.array([np.cos(angle), np.sin(angle)])
    dx, dy = ground - pin[0], -pin[1]
    far = np.hypot(dx, dy)
    cos = (coupler**2 + far**2 - rocker**2) / (2 * coupler * far)
    tilt = np.arctan2(dy, dx) + np.arccos(np.clip(cos, -1, 1))
    gap = 100 * np.maximum(0, np.abs(cos) - 1)
    px = pin[0] + along * np.cos(tilt) - across * np.sin(tilt)
    py = pin[1] + along * np.sin(tilt) + across * np.cos(tilt)
    return x + px * np.cos(turn) - py * np.sin(turn) + gap, y + px * np.sin(turn) + py * np.cos(turn) + gap


def arc(links):
    return coupler_point(*links, 0, 0, 0, np.radians(30 + 15 * np.arange(5)))


def loop(links):
    *lengths, turn, start = links
    return coupler_point(*lengths, np.radians(turn), np.radians(start + 20 * np.arange(18)))


def circle(links):
    *lengths, turn, start = links[:10]
    # The first angle and the last are given.
    free = np.concatenate([[0], links[10:], [0]])
    return coupler_point(*lengths, np.radians(turn), np.radians(start + 40 * np.arange(10) + free))


PROBLEMS = {"arc_five_points": arc, "loop_eighteen_points": loop, "circle_ten_points": circle}


def problem(name: str):
    """Misfits at the target points as a function of the variables, bounds, and the nominal design."""
    model = tomllib.loads((MODELS / f"{name}.toml").read_text())
    targets = [np.array([y for _, y in model["metrics"][axis]["target"]]) for axis in ("x", "y")]
    path = PROBLEMS[name]
    variables = [p for p in model["parameters"].values() if "bounds" in p]
    variables += [{"value": 0, **angle} for angle in model.get("design", {}).values()]
    low, high = np.array([p["bounds"] for p in variables], dtype=float).T
    misfits = lambda links: np.concatenate([a - b for a, b in zip(path(links), targets)])
    return misfits, low, high, np.array([p["value"] for p in variables], dtype=float)


def of_scipy(name: str, starts: int) -> tuple[list[float], int, float]:
    misfits, low, high, nominal = problem(name)
    designs = low + qmc.Sobol(len(low), seed=1).random(starts) * (high - low)
    designs[0] = np.clip(nominal, low, high)
    begin = time.process_time()
    errors, evaluated = [], 0
    for design in designs:
        found = least_squares(
            misfits, design, bounds=(low, high), x_scale=high - low, max_nfev=500, xtol=1e-12, ftol=1e-14, gtol=1e-14
        )
        errors.append(2 * found.cost)
        # Each derivative takes a design for every variable.
        evaluated += found.nfev + len(low) * found.njev
    return errors, evaluated, time.process_time() - begin


def of_hardpoint(command: str, name: str, starts: int) -> tuple[list[float], int, float]:
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    begin = used()
    arguments = ["--starts", str(starts), "--threads", "1", "--json"]
    found = subprocess.run([command, "optimize", MODELS / f"{name}.toml", *arguments], capture_output=True)
    seconds = used() - begin
    facts = json.loads(found.stdout)
    objectives = [start["objective"] for start in facts["starts"]]
    return [np.inf if x is None else x for x in objectives], facts["evaluations"]["designs"], seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", help="path of hardpoint")
    parser.add_argument("--starts", type=int, default=32)
    options = parser.parse_args()
    for name in PROBLEMS:
        results = {
            "scipy": of_scipy(name, options.starts),
            "hardpoint": of_hardpoint(options.command, name, options.starts),
        }
        best = min(min(errors) for errors, *_ in results.values())
        print(f"{name}: best error {best:.6g}")
        for side, (errors, designs, seconds) in results.items():
            hits = sum(error <= HIT * best for error in errors)
            per_hit = f"{1000 * seconds / hits:.3g} ms and {designs / hits:.0f} designs" if hits else "no hit"
            print(
                f"  {side}: {hits} hits of {len(errors)} starts, {designs} designs, {seconds:.3f} s of CPU, "
                f"{per_hit} per hit",
                flush=True,
            )


if __name__ == "__main__":
    main()
