"""Many designs, solved in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .arrays import free, frozen
from .errors import Diagnostic, UsageError, diagnostics, index_of

if TYPE_CHECKING:
    import pandas
    import xarray

    from .model import Model


class Designs:
    """Stored results of many designs. Values of stopped designs (`stops`) and derivatives by inadmissible variables are NaN. Arrays are
    read-only: copy them to change values."""

    def __init__(self, model: Model, case: int, rows: np.ndarray, outputs: list[str], order: int, at: np.ndarray, found: dict, with_d: bool):
        self.model = model
        self._with_d = with_d
        self.variables: tuple[str, ...] = tuple(model.variables)
        drawn = np.array([v.drawn for v in model.variables.values()])
        self.designs: np.ndarray = frozen(np.where(np.isnan(rows), drawn, rows))
        """`[design, variable]`: the values of all design variables."""
        self.outputs: tuple[str, ...] = tuple(outputs)
        self.order = order
        self.times: np.ndarray = frozen(np.array(model._info["motions"][case]["times"], dtype=float)[at])
        """Stored output times, s."""
        self.values: np.ndarray = found["values"]
        """`[design, output, time]`."""
        self._sensitivities: np.ndarray = found["sensitivities"]
        self.metrics: np.ndarray = found["metrics"]
        """`[design, metric]`; no columns with `metrics=False`."""
        names = tuple(m["name"] for m in model._info["motions"][case]["metrics"])
        self._with_metrics = self.metrics.shape[1] == len(names)
        self.metric_names: tuple[str, ...] = names if self._with_metrics else ()
        self._metric_sensitivities: np.ndarray = found["metric_sensitivities"]
        self.stops: dict[int, Diagnostic] = {number: diagnostics(why)[0] for number, why in found["stops"]}
        """Designs whose motion ends early, with the reason."""

    @property
    def sensitivities(self) -> np.ndarray:
        """`[design, output, variable, time]`."""
        return self._asked(self._sensitivities)

    @property
    def metric_sensitivities(self) -> np.ndarray:
        """`[design, metric, variable]`."""
        return self._asked(self._metric_sensitivities)

    def _asked(self, array: np.ndarray) -> np.ndarray:
        if not self._with_d:
            raise UsageError.saying("the designs were solved without sensitivities; leave `sensitivities=False` out")
        return array

    def __len__(self) -> int:
        return len(self.designs)

    def __repr__(self) -> str:
        stopped = f", {len(self.stops)} of them stopped" if self.stops else ""
        return f"<hardpoint.Designs of {self.model.name!r}: {len(self)}{stopped}>"

    def metric(self, name: str) -> np.ndarray:
        """Values of a metric for all designs."""
        if not self._with_metrics:
            raise UsageError.saying("the designs were solved without metrics; leave `metrics=False` out")
        return self.metrics[:, index_of("metric", name, self.metric_names)]

    def to_xarray(self) -> xarray.Dataset:
        """Data set of all results, with labels."""
        import xarray

        data = {"values": (("design", "output", "time"), self.values), "metrics": (("design", "metric"), self.metrics)}
        if self._with_d:
            data["sensitivities"] = (("design", "output", "variable", "time"), self._sensitivities)
            data["metric_sensitivities"] = (("design", "metric", "variable"), self._metric_sensitivities)
        names = {"output": list(self.outputs), "metric": list(self.metric_names), "variable": list(self.variables)}
        data["designs"] = (("design", "variable"), self.designs)
        return xarray.Dataset(data, {**names, "time": self.times})

    def to_pandas(self) -> pandas.DataFrame:
        """Table of variables and metrics, with a row for each design. A metric with the name of a variable ends in `_`."""
        import pandas

        columns = dict(zip(self.variables, self.designs.T))
        for name, values in zip(self.metric_names, self.metrics.T):
            columns[free(name, columns)] = values
        return pandas.DataFrame(columns)
