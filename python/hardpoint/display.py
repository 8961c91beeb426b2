"""Display in notebooks."""

from __future__ import annotations

import os
import sys
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from . import files

if TYPE_CHECKING:
    from .model import Model
    from .run import Run
    from .studies import Study

CURVES = 6
"""Maximum number of curves of a run."""
WIDTH, HEIGHT = 260, 90


class Page(str):
    """A page as HTML, displayed in a frame."""

    def _repr_html_(self) -> str:
        # The engine's text has many characters that other places would escape.
        source = self.replace("&", "&amp;").replace('"', "&quot;")
        return f'<iframe srcdoc="{source}" style="width:100%;height:640px;border:1px solid #ccc"></iframe>'

    def __repr__(self) -> str:
        return f"<hardpoint.Page, {len(self) / 1e6:.1f} MB of HTML; save it with .save(path)>"

    def save(self, path: str | os.PathLike) -> None:
        """Writes the page, atomically."""
        files.write(path, self)


def number(value) -> str:
    """Formats a number for a table."""
    return "–" if value is None or value != value else f"{value:.6g}"


def table(head: list[str], rows: list[list[str]]) -> str:
    """Formats a table."""
    cells = lambda tag, row: "".join(f"<{tag}>{escape(str(cell))}</{tag}>" for cell in row)  # noqa: E731
    body = "".join(f"<tr>{cells('td', row)}</tr>" for row in rows)
    return f"<table><thead><tr>{cells('th', head)}</tr></thead><tbody>{body}</tbody></table>"


def model(shown: Model) -> str:
    """Formats the outline of a model."""
    facts = [
        ["bodies", ", ".join(shown.bodies)],
        ["joints", ", ".join(f"{j['name']} ({j['type']})" for j in shown.joints)],
        ["drivers", ", ".join(f"{d['name']} ({d['joint']})" for d in shown.drivers)],
        ["cases", ", ".join(shown.cases) or "–"],
        ["measures", ", ".join(shown.measures) or "–"],
    ]
    variables = [[v.name, v.unit, number(v.drawn), str(v.bounds or "–")] for v in shown.variables.values()]
    outline = table(["", ""], facts)
    return f"<b>{escape(shown.name)}</b>{outline}" + (table(["design variable", "unit", "drawn", "bounds"], variables) if variables else "")


def curve(x: np.ndarray, y: np.ndarray, title: str) -> str:
    """Draws a small curve."""
    known = np.isfinite(y)
    if not known.any():
        return ""
    low, high = float(y[known].min()), float(y[known].max())
    span = (high - low) or 1.0
    length = float(x[-1] - x[0]) or 1.0
    points = " ".join(
        f"{(a - x[0]) / length * WIDTH:.1f},{HEIGHT - (b - low) / span * HEIGHT:.1f}" for a, b in zip(x[known], y[known])
    )
    return (
        f'<figure style="display:inline-block;margin:6px"><figcaption>{escape(title)}: {number(low)} to {number(high)}</figcaption>'
        f'<svg width="{WIDTH}" height="{HEIGHT + 4}" viewBox="0 -2 {WIDTH} {HEIGHT + 4}"><polyline points="{points}" fill="none" '
        f'stroke="#1f6fb4" stroke-width="1.5"/></svg></figure>'
    )


def run(shown: Run) -> str:
    """Formats curves and metrics of a motion."""
    outputs = [o for o in shown.model.outputs.values() if o.kind == "measure"] or list(shown.model.outputs.values())
    every = max(1, len(shown) // 200)
    x = shown.times[::every]
    curves = [curve(x, shown.values(o.name)[::every], f"{o.name} [{o.units[0]}]") for o in outputs[:CURVES]] if len(shown) else []
    metrics = [[m.name, number(m.value), m.unit] for m in shown.metrics.values()]
    stop = f"<pre>{escape(shown.stop.rendered)}</pre>" if shown.stop else ""
    title = escape(shown.model.name + (f", {shown.case}" if shown.case else ""))
    return f"<b>{title}</b>{stop}<div>{''.join(curves)}</div>" + (table(["metric", "value", "unit"], metrics) if metrics else "")


def study(shown: Study) -> str:
    """Formats the tables of a study."""
    parts = [f"<b>{escape(shown.message or shown._title)}</b>"]
    for one in shown.tables:
        rows = [[cell.get("text", cell) if isinstance(cell, dict) else cell for cell in row] for row in one.get("rows", [])]
        head = [cell.get("text", cell) if isinstance(cell, dict) else cell for cell in one.get("head", one.get("header", []))]
        parts.append(f"<p>{escape(one.get('title', ''))}</p>{table(head, rows)}")
    return "".join(parts)


def counter():
    """Returns a callback that shows progress on the standard error."""

    def report(done: int, total: int) -> None:
        sys.stderr.write(f"\r{done} of {total}" + ("\n" if done >= total else ""))
        sys.stderr.flush()

    return report
