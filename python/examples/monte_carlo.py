"""A Monte Carlo of 20,000 designs: the spread of toe and camber from tolerances of the hardpoints."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import numpy.typing as npt

import hardpoint

MODELS = Path(__file__).resolve().parents[2] / "models"
DESIGNS = 20_000
SIGMA = 0.3
"""Standard deviation of each coordinate, mm."""


def main(count: int = DESIGNS) -> npt.NDArray[np.float64]:
    model = hardpoint.read(MODELS / "macpherson.toml")
    names = ["tie_rod_outer_z", "ball_joint_y", "ball_joint_z"]
    designs = np.random.default_rng(1).normal(scale=SIGMA, size=(count, len(names)))

    begin = time.perf_counter()
    found = model.designs(designs, ["toe", "camber"], variables=names, at=slice(0, None, 50), sensitivities=False, partial=True)
    print(f"{len(found)} motions in {time.perf_counter() - begin:.1f} s, {len(found.stops)} stopped")

    toe, camber = found.values[:, 0], found.values[:, 1]
    spread = toe.std(axis=0)
    # The same to first order, from one run with exact sensitivities.
    run = model.run()
    slopes = run.sensitivities("toe", names)[:, ::50]
    linear = SIGMA * np.sqrt((slopes**2).sum(axis=0))
    # In the design configuration the wheel is mounted as the model says, whatever the hardpoints are.
    moved = linear > 1e-3 * linear.max()
    for t, one, other in zip(found.times[moved], spread[moved], linear[moved]):
        print(f"t = {t:4.1f} s: sigma of toe {one:.4f} deg, to first order {other:.4f} deg")
    print(f"camber between {np.nanmin(camber):.2f} and {np.nanmax(camber):.2f} deg")
    ratio: npt.NDArray[np.float64] = spread[moved] / linear[moved]
    return ratio


if __name__ == "__main__":
    main()
