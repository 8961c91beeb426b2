"""Curves of runs with matplotlib (`pip install 'hardpoint[plot]'`)."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

import numpy as np

from . import files
from .arguments import ArgumentError, listed, named
from .errors import FileError, UsageError

if TYPE_CHECKING:
    from .run import Run

HEIGHT, WIDTH = 2.6, 6.4
"""Size of one diagram, in."""


def _matplotlib():
    try:
        import matplotlib.pyplot
    except ImportError:
        raise UsageError.saying("matplotlib is not installed; `pip install 'hardpoint[plot]'`") from None
    return matplotlib.pyplot


def titled(name: str, unit: str) -> str:
    """Title of an axis, with the unit."""
    return name if unit == "1" else f"{name} [{unit}]"


@named
def plot(
    runs: Run | Mapping[str, Run] | Iterable[Run],
    names: str | Sequence[str] | None = None,
    *,
    over: str | None = None,
    order: int | str = 0,
    by: str | None = None,
    ax: Any = None,
    **style: Any,
) -> Any:
    """Plots curves of one or several runs: a diagram for each quantity, a curve for each run.

    `runs` is a run, a list of runs, or a mapping of labels to runs such as `model.runs()`. `names` are measures or coordinates of points,
    by default all measures. `over` is the measure on the horizontal axis, by default the time. `order` 1 is the rate, 2 the
    acceleration; `by` names a design variable whose sensitivity is plotted. Further arguments go to matplotlib. Returns the axes of a
    single quantity, or an array of them.

        >>> hardpoint.plot(strut.runs(), ["toe", "camber"], over="wheel_travel")
    """
    labelled = _labelled(runs)
    model = next(iter(labelled.values())).model
    quantities = list(model.measures) if names is None else listed("names", names)
    if not quantities:
        what = "the model has no measures" if names is None else "`names` is empty"
        raise UsageError.saying(f"{what}; name measures or coordinates of points")
    # Before there is a figure: an error leaves none behind.
    abscissas = {label: run.times if over is None else run.values(over) for label, run in labelled.items()}
    ordinates = [
        {label: run.values(name, order) if by is None else run.sensitivity(name, by, order) for label, run in labelled.items()}
        for name in quantities
    ]
    _check_style(style)
    if ax is None:
        pyplot = _matplotlib()
        size = (WIDTH, HEIGHT * len(quantities) + 1)
        _, axes = pyplot.subplots(len(quantities), 1, sharex=True, squeeze=False, figsize=size, layout="constrained")
        axes = axes[:, 0]
    else:
        axes = np.atleast_1d(np.asarray(ax, dtype=object)).ravel()
        if len(axes) != len(quantities):
            raise UsageError.saying(f"there are {len(quantities)} quantities, and {len(axes)} axes in `ax`")
    for axis, name, curves in zip(axes, quantities, ordinates):
        for label, y in curves.items():
            axis.plot(abscissas[label], y, **{"label": label, **style})
        axis.set_ylabel(_ordinate(model, name, order, by))
        axis.grid(True, alpha=0.3)
        if len(labelled) > 1:
            axis.legend()
    axes[-1].set_xlabel("time [s]" if over is None else titled(over, model._declared(over).units[0]))
    if len(labelled) == 1:
        (run,) = labelled.values()
        axes[0].set_title(model.name + (f", {run.case}" if run.case else ""))
    return axes[0] if len(quantities) == 1 else axes


def _check_style(style: dict[str, Any]) -> None:
    """Checks that matplotlib can draw lines with these arguments."""
    _matplotlib()
    from matplotlib.lines import Line2D

    for name, value in style.items():
        try:
            Line2D([], [], **{name: value})
        except (AttributeError, TypeError, ValueError) as error:
            own = get_close_matches(name, ["over", "order", "by", "ax"], 1)
            help = f"; did you mean `{own[0]}`?" if own else ""
            raise ArgumentError.saying(f"`plot` with `{name}`, for matplotlib: {error}{help}") from None


def _ordinate(model, name: str, order: int | str, by: str | None) -> str:
    output, k = model._declared(name), model._order(order, [name])
    if by is None:
        return titled(output.columns[k], output.units[k])
    unit = model.variables[by].unit
    return f"d {output.columns[k]} / d {by} [{output.units[k]} / {unit}]"


def _labelled(runs: Any) -> dict[str, Run]:
    from .run import Run

    if isinstance(runs, Run):
        return {runs.case or runs.model.name: runs}
    given = list(runs.values()) if isinstance(runs, Mapping) else list(runs) if hasattr(runs, "__iter__") else [runs]
    strange = [one for one in given if not isinstance(one, Run)]
    if strange:
        raise UsageError.saying(f"`runs` is a run, a list of runs, or runs by their labels; {strange[0]!r} is not a run")
    found = dict(runs) if isinstance(runs, Mapping) else {f"{k + 1}: {run.case or run.model.name}": run for k, run in enumerate(given)}
    if not found:
        raise UsageError.saying("there are no runs to plot")
    return found


def animation(run: Run, seconds: float, frames: int, size: float) -> Any:
    """Animation of a run with matplotlib; a notebook plays it."""
    import json

    pyplot = _matplotlib()
    from matplotlib.animation import FuncAnimation

    model = run.model
    picked = np.unique(np.linspace(0, len(run) - 1, frames).round().astype(int))

    class Player(FuncAnimation):
        def __repr__(self) -> str:
            return f"<hardpoint animation of {model.name!r}: {len(picked)} frames, {seconds:g} s; save it with .save(path)>"

        def _repr_html_(self) -> str:
            return self.to_jshtml()

        def save(self, filename: str | os.PathLike, *args: Any, **more: Any) -> None:
            path = files.target(filename)
            try:
                super().save(path, *args, **more)
            except OSError as error:
                raise FileError.of_system("written", path, error) from error
            except ValueError as error:
                raise UsageError.saying(f"`{path}` cannot be written by matplotlib: {error}") from error

    parts = json.loads(model._native.skeleton(run._index, list(run._native.design)))
    bodies = [None, *(run.body(name) for name in model.bodies)]

    def moved(place: list[float]) -> np.ndarray:
        body, local = bodies[int(place[0])], np.array(place[1:])
        if body is None:
            return np.broadcast_to(local, (len(picked), 3))
        return body.position[picked] + _turned(body.quaternion[picked], local)

    groups: dict[int, list[np.ndarray]] = {}
    lines: list[tuple[int, np.ndarray]] = []
    for joint in parts["joints"]:
        ends = [moved(place) for place in joint["ends"]]
        if joint["is_rod"]:
            lines.append((-1, np.stack(ends, axis=1)))
        for place, end in zip(joint["ends"], ends):
            groups.setdefault(int(place[0]), []).append(end)
    for point in parts["points"]:
        groups.setdefault(int(point["at"][0]), []).append(moved(point["at"]))
    for body, points in groups.items():
        if body:
            lines += [(body, np.stack([points[a], points[b]], axis=1)) for a, b in _tree(np.array([p[0] for p in points]))]
    figure = pyplot.figure(figsize=(size, size), layout="constrained")
    axes = figure.add_subplot(projection="3d")
    every = np.concatenate([line.reshape(-1, 3) for _, line in lines] + [p for points in groups.values() for p in points])
    low, high = every.min(axis=0), every.max(axis=0)
    middle, half = (low + high) / 2, max(float((high - low).max()) / 2, 1e-12)
    for k, letter in enumerate("xyz"):
        getattr(axes, f"set_{letter}lim")(middle[k] - half, middle[k] + half)
        getattr(axes, f"set_{letter}label")(f"{letter} [{model.units['length']}]")
    axes.set_box_aspect((1, 1, 1))
    fixed = np.array([p[0] for p in groups.get(0, [])] or np.zeros((0, 3))).reshape(-1, 3)
    axes.scatter(*fixed.T, color="0.3", marker="s", s=16)
    drawn = [axes.plot(*line[0].T, color="0.4" if body < 0 else f"C{(body - 1) % 10}", lw=2)[0] for body, line in lines]
    names = axes.set_title("")

    def show(frame: int):
        for artist, (_, line) in zip(drawn, lines):
            artist.set_data_3d(*line[frame].T)
        names.set_text(f"{model.name}, t = {run.times[picked[frame]]:.3g} s")
        return [*drawn, names]

    made = Player(figure, show, frames=len(picked), interval=1000 * seconds / max(len(picked), 1), blit=False)
    pyplot.close(figure)
    return made


def _turned(quaternion: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Vectors of a body in world axes: v + 2 q x (q x v + w v)."""
    w, q = quaternion[:, :1], quaternion[:, 1:]
    return vector + 2 * np.cross(q, np.cross(q, np.broadcast_to(vector, q.shape)) + w * vector)


def _tree(points: np.ndarray) -> list[tuple[int, int]]:
    """Lines that connect points: all pairs of up to three, the shortest tree of more."""
    if len(points) <= 3:
        return [(a, b) for a in range(len(points)) for b in range(a)]
    reached, left, found = [0], list(range(1, len(points))), []
    while left:
        near = np.linalg.norm(points[reached][:, None] - points[left][None], axis=2)
        a, b = np.unravel_index(near.argmin(), near.shape)
        found.append((reached[a], left[b]))
        reached.append(left.pop(b))
    return found
