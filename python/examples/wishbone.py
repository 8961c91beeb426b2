"""A double wishbone built in code: geometry, a motion, positions, and what moves the toe."""

from __future__ import annotations

import numpy as np

import hardpoint

INBOARD, OUTBOARD = 320.0, 660.0
"""Distances from the vehicle's middle, mm."""


def wishbone() -> hardpoint.Model:
    """A left front corner: x forward, y left, z up, mm and deg."""
    return hardpoint.Model.new(
        "wishbone in code",
        units={"length": "mm", "angle": "deg"},
        hardpoints={
            "lca_front": [150, INBOARD, 140],
            "lca_rear": [-150, INBOARD, 145],
            "lower_ball": [5, OUTBOARD, 130],
            "uca_front": [120, INBOARD + 60, 310],
            "uca_rear": [-120, INBOARD + 60, 320],
            "upper_ball": [-12, OUTBOARD - 40, 330],
            "tie_rod_inner": [-110, INBOARD - 10, 175],
            "tie_rod_outer": [-110, OUTBOARD - 20, 170],
            "wheel_centre": [0, OUTBOARD + 60, 230],
        },
        bodies={"lca": {}, "uca": {}, "knuckle": {}},
        joints={
            "lca_pivot": {"type": "revolute", "bodies": ["ground", "lca"], "axis": {"through": ["lca_rear", "lca_front"]}},
            "uca_pivot": {"type": "revolute", "bodies": ["ground", "uca"], "axis": {"through": ["uca_rear", "uca_front"]}},
            "lower_ball": {"type": "spherical", "bodies": ["lca", "knuckle"], "at": "lower_ball"},
            "upper_ball": {"type": "spherical", "bodies": ["uca", "knuckle"], "at": "upper_ball"},
            "tie_rod": {"type": "distance", "bodies": ["ground", "knuckle"], "at": ["tie_rod_inner", "tie_rod_outer"]},
        },
        points={"wheel_centre": {"body": "knuckle", "at": "wheel_centre"}},
        drivers={"travel": {"point": {"body": "knuckle", "at": "wheel_centre"}, "along": "z", "law": "-50 + 100 * t"}},
        measures={
            "toe": {"type": "toe", "body": "knuckle", "spin_axis": [0, 1, 0]},
            "camber": {"type": "camber", "body": "knuckle", "spin_axis": [0, 1, 0]},
        },
        design={
            f"{name}_{axis}": {"move": name, "along": axis} for name in ("tie_rod_inner", "tie_rod_outer", "upper_ball") for axis in "yz"
        },
        time={"end": 1, "steps": 50},
    )


def main() -> None:
    model = wishbone()
    print(model)

    position = model.at(travel=30)
    print(f"30 mm in bump: toe {position['toe']:.3f} deg, {position.derivative('toe', 'travel'):.4f} deg per mm of travel")

    curve = model.at(travel=np.linspace(-50, 50, 11))
    print(f"camber from {curve['camber'].min():.2f} to {curve['camber'].max():.2f} deg")

    run = model.run()
    largest = {name: float(abs(run.sensitivity("toe", name)).max()) for name in run.followed}
    name = max(largest, key=lambda one: largest[one])
    print(f"{name} moves the toe most: {largest[name]:.4f} deg per mm")

    # The bump steer of 30 mm travel goes to zero with the inner end of the tie rod.
    slope = position.sensitivity("toe", "tie_rod_inner_z")
    better = model.with_(hardpoints={"tie_rod_inner": (model.hardpoints["tie_rod_inner"] - [0, 0, position["toe"] / slope]).tolist()})
    print(f"moved: toe {better.at(travel=30)['toe']:.3f} deg")
    print(better.to_toml().splitlines()[0])


if __name__ == "__main__":
    main()
