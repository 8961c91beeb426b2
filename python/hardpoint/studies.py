"""Results of studies."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from . import display
from .errors import UsageError

if TYPE_CHECKING:
    from .model import Model


class Study:
    """A finished study: `facts` are those that the command line writes as JSON (docs/results.md), `tables` those that it prints."""

    def __init__(self, model: Model, facts: dict[str, Any], tables: list[dict], rounded: list[float] | None, exact: list[float] | None):
        self.model = model
        self.facts = facts
        self.tables = tables
        names = list(model.variables)
        self.design: dict[str, float] | None = dict(zip(names, exact)) if exact else None
        """Resulting design: the values of all design variables."""
        self.rounded: dict[str, float] | None = dict(zip(names, rounded)) if rounded else None
        """Resulting design with rounded numbers, as saved."""

    @property
    def status(self) -> str | None:
        """Status at the end."""
        return self.facts.get("status")

    @property
    def message(self) -> str | None:
        """Status as a sentence, with a suggested action."""
        return self.facts.get("message")

    def text(self) -> str:
        """Text of the model file with the resulting design."""
        return self.model.edited(self._found())

    def save(self, path: str | os.PathLike) -> None:
        """Writes the model file with the resulting design, atomically."""
        self.model.save(path, self._found())

    def _found(self) -> dict[str, float]:
        if self.rounded is None:
            raise UsageError.saying("the study has no resulting design")
        return self.rounded

    def __repr__(self) -> str:
        return f"<hardpoint.Study of {self.model.name!r}: {self.message or self.facts.get('study', 'done')}>"

    def _repr_html_(self) -> str:
        return display.study(self)


def outcome(model: Model, text: str, rounded: list[float] | None = None, exact: list[float] | None = None) -> Study:
    found = json.loads(text)
    return Study(model, found["facts"], found["tables"], rounded, exact)


class SweepResult(Study):
    """A finished sweep."""

    def __init__(self, model: Model, columns: dict[str, Any], curves: dict[str, Any], found: dict):
        super().__init__(model, found["facts"], found["tables"], None, None)
        self.columns: dict[str, np.ndarray | list[str]] = columns
        """Table of designs: number, variables, metrics, and the reason of a failure (docs/sweep.md). Undefined values are NaN."""
        self.curves: dict[str, np.ndarray | list[str]] = curves
        """Table of curves; empty if none were requested."""

    def __len__(self) -> int:
        return len(self.columns["design"])

    def to_pandas(self):
        """Table of designs."""
        import pandas

        return pandas.DataFrame(self.columns)

    def to_arrow(self):
        """Table of designs."""
        import pyarrow

        return pyarrow.table(self.columns)
