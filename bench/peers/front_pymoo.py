"""The front of `models/studies/wishbone_trade_off.toml` against NSGA-II of pymoo, at equal hypervolume.

    python -m venv venv && venv/bin/pip install -r bench/peers/requirements.txt
    cargo build --release
    venv/bin/python bench/peers/front_pymoo.py target/release/hardpoint

NSGA-II has pymoo's defaults (population 100, simulated binary crossover, polynomial mutation) and the limits as
constraints. `--population 0` gives it as many designs as the front has points, so that both answer with the same
number. Its designs are solved by `hardpoint sweep --designs`, without derivatives. The hypervolume is that of the
feasible non-dominated designs of a generation, below 1.1 times the ranges of the goals over a front of 200 points.
"""

import argparse
import csv
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.core.termination import NoTermination
from pymoo.indicators.hv import HV

MODEL = Path(__file__).parents[2] / "models/studies/wishbone_trade_off.toml"
GOALS = ["track", "camber"]
BUMP_STEER = 0.05  # deg, the largest that the file admits
TIE_ROD = 325.0  # mm
INNER, OUTER = np.array([75.89, 230.0, 201.0]), np.array([75.89, 552.49, 240.94])


def front(command: str, points: int) -> dict:
    found = subprocess.run([command, "trade-off", MODEL, "--points", str(points), "--json"], capture_output=True)
    return json.loads(found.stdout)


class Wishbone(Problem):
    """Goals and limits of the model; designs are solved by the command, a generation at a time."""

    def __init__(self, command: str, variables: list[dict]):
        self.command, self.names, self.designs = command, [v["name"] for v in variables], 0
        low, high = np.array([v["bounds"] for v in variables]).T
        super().__init__(n_var=len(variables), n_obj=2, n_ieq_constr=2, xl=low, xu=high)

    def _evaluate(self, x, out, *args, **kwargs):
        self.designs += len(x)
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "generation.csv"
            with table.open("w", newline="") as file:
                writer = csv.writer(file)
                writer.writerow(self.names)
                writer.writerows(x.tolist())
            subprocess.run(
                [self.command, "sweep", MODEL, "--designs", table, "-o", Path(folder) / "out"],
                check=True,
                capture_output=True,
            )
            rows = list(csv.DictReader((Path(folder) / "out/designs.csv").open()))
        columns = {key.split(" [")[0]: key for key in rows[0]}
        # A design that does not move to the end has no values, and is as bad as any.
        value = lambda row, name: float(row[columns[name]] or "1e6")
        out["F"] = np.array([[value(row, goal) for goal in GOALS] for row in rows])
        place = {name: k for k, name in enumerate(self.names)}
        rod = INNER - OUTER + np.zeros((len(x), 3))
        rod[:, 1] += x[:, place["tie_rod_inner_y"]]
        rod[:, 2] += x[:, place["tie_rod_inner_z"]] - x[:, place["tie_rod_outer_z"]]
        steer = np.array([value(row, "bump_steer") for row in rows])
        out["G"] = np.column_stack([steer - BUMP_STEER, np.linalg.norm(rod, axis=1) - TIE_ROD])


def designs_needed(
    command: str, dense: dict, targets: list[float], volume, seed: int, most: int, population: int
) -> list:
    """Designs that NSGA-II evaluates until it has each hypervolume; None if it does not reach it."""
    problem = Wishbone(command, dense["variables"])
    algorithm = NSGA2(pop_size=population)
    algorithm.setup(problem, termination=NoTermination(), seed=seed)
    reached = [None] * len(targets)
    while problem.designs < most and None in reached:
        algorithm.next()
        population = algorithm.pop
        feasible = population.get("F")[population.get("CV")[:, 0] <= 0]
        now = volume(feasible) if len(feasible) else 0.0
        reached = [r or (problem.designs if now >= t else None) for r, t in zip(reached, targets)]
    print(f"seed {seed}: hypervolume {now:.6f} after {problem.designs} designs; reached {reached}", flush=True)
    return reached


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", help="path of hardpoint")
    parser.add_argument("--points", type=int, nargs="+", default=[15, 30, 60])
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--population", type=int, default=100, help="of NSGA-II; 0 for as many as the front has points")
    parser.add_argument("--most", type=int, default=100_000, help="designs of NSGA-II")
    options = parser.parse_args()
    dense = front(options.command, 200)
    goals = np.array([p["goals"] for p in dense["points"]])
    low, span = goals.min(axis=0), np.ptp(goals, axis=0)
    indicator = HV(ref_point=np.array([1.1, 1.1]))
    volume = lambda f: float(indicator((np.asarray(f) - low) / span))
    fronts = [front(options.command, n) for n in options.points]
    targets = [volume([p["goals"] for p in f["points"]]) for f in fronts]
    print(f"hypervolume of 200 points: {volume(goals):.6f}")
    for n, f, target in zip(options.points, fronts, targets):
        print(f"{n} points: {f['evaluations']['designs']} designs, hypervolume {target:.6f}, residual {f['kkt']:.1e}")
    needed = lambda targets, seed, population: designs_needed(
        options.command, dense, targets, volume, seed, options.most, population
    )
    seeds = range(options.seeds)
    if options.population:
        by_points = zip(*(needed(targets, seed, options.population) for seed in seeds))
    else:
        by_points = [[needed([t], seed, n)[0] for seed in seeds] for n, t in zip(options.points, targets)]
    for n, f, counts in zip(options.points, fronts, by_points):
        ours = f["evaluations"]["designs"]
        reached = [c if c is not None else float("inf") for c in counts]
        middle = statistics.median(reached)
        share = f"{100 * ours / middle:.2f} %" if np.isfinite(middle) else f"less than {100 * ours / options.most:.2f} %"
        print(f"{n} points: {ours} designs here, NSGA-II {counts}: {share}")


if __name__ == "__main__":
    main()
