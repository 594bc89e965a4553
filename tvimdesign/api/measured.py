"""Measured data from Python: files fitted, parameters as a table, a record written."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tvimdesign.api.notebook import drawn
from tvimdesign.api.tables import quantity
from tvimdesign.base.units import from_si, pretty

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure
    from pint import Quantity

    from tvimdesign.simulation.measurement.measure_files import Measured

File = str | os.PathLike[str]


def fit(
    files: File | Sequence[File], kind: str = "", *, columns: File | Mapping[str, Any] | None = None, **settings: str
) -> Fitted:
    """Fit files of measured data, all together, as `tvimdesign fit` does, without writing a file.

    `kind` is found by the columns unless given; `columns` is a column map or its file; settings are text with a unit,
    such as `arm="100 mm"`. Raises InputError for what cannot be read or lacks.
    """
    from tvimdesign.simulation.measurement.measure_files import measure_files
    from tvimdesign.simulation.measurement.reading.headings import column_map, read_column_map

    paths = [Path(files)] if isinstance(files, str | os.PathLike) else [Path(file) for file in files]
    if columns is None:
        mapped = None
    elif isinstance(columns, Mapping):
        mapped = column_map(columns, "fit(columns=...)")
    else:
        mapped = read_column_map(Path(columns))
    return Fitted(measure_files(paths, kind, settings, mapped))


class Fitted:
    """Result of fitting measured data: parameters with intervals of 95 %, notes, residuals, and a record."""

    def __init__(self, measured: Measured) -> None:
        self._measured = measured

    @property
    def kind(self) -> str:
        """The kind of measurement."""
        return self._measured.kind.name

    @property
    def read(self) -> list[str]:
        """Return what was understood of the files, in lines."""
        return self._measured.read()

    @property
    def notes(self) -> list[str]:
        """Return sentences on what was assumed, what the data cannot tell apart, and what else a reader has to know."""
        measurement = self._measured.measurement
        return [*measurement.notes, *measurement.fit.words]

    @property
    def data(self) -> dict[str, Any]:
        """All of it as plain data, as in `fit.json`."""
        from tvimdesign.report.fit_files import fit_data

        return fit_data(self._measured)

    def __getitem__(self, name: str) -> Quantity[float]:
        """Return a parameter, or what follows. Raises KeyError."""
        estimate = next((candidate for candidate in self._estimates() if candidate.name == name), None)
        if estimate is None:
            raise KeyError(f"{name!r}; there are {', '.join(candidate.name for candidate in self._estimates())}")
        return quantity(estimate.value, estimate.unit)

    def table(self) -> pd.DataFrame:
        """Return value, low and high of 95 %, unit and meaning of all parameters. An open end is not a number."""
        import pandas as pd

        rows = [
            {"value": from_si(estimate.value, estimate.unit), "low": _end(estimate.low, estimate.unit),
             "high": _end(estimate.high, estimate.unit), "unit": pretty(estimate.unit), "meaning": estimate.meaning}
            for estimate in self._estimates()
        ]  # fmt: skip
        return pd.DataFrame(rows, index=pd.Index([estimate.name for estimate in self._estimates()], name="parameter"))

    def plot(self) -> Figure:
        """Plot values, fitted curves and residuals."""
        from tvimdesign.report.fit_files import figure_data
        from tvimdesign.report.output.plot_process import Drawing

        names = ", ".join(file.path.name for file in self._measured.files)
        return drawn(Drawing("fit", "analysis_figures.fit", figure_data(self._measured)), names)

    def record(self, name: str, *, based_on: str = "", catalog: File = "my_records", overwrite: bool = False) -> Path:
        """Write what was measured as a record of this name; returns its file. Raises InputError and CatalogError."""
        from tvimdesign.simulation.measurement.record_file import write_record

        return write_record(self._measured, Path(catalog), name, based_on, overwrite=overwrite)

    def __repr__(self) -> str:
        names = ", ".join(estimate.name for estimate in self._estimates())
        return f"<Fitted {self.kind}, {len(self._measured.blocks)} tables: {names}>"

    def _estimates(self) -> list[Any]:
        fit_result = self._measured.measurement.fit
        return [*fit_result.parameters, *fit_result.derived]


def _end(value: float | None, unit: str) -> float:
    return float("nan") if value is None else from_si(value, unit)
