"""A study as plain data in SI units, which survives a trip through JSON."""

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeAlias

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

from tvimdesign.catalog import Catalog
from tvimdesign.device import Table, table_for

FORMAT = 1  # The file format this version reads, the study's key `tvimdesign`

FEWEST_POINTS, MOST_POINTS = 3, 200  # Designs on a front that a study may ask for

STANDARD_POINTS: dict[str, dict[str, float]] = {
    "cold": {"temperature": 303.15, "frequency": 1.0},
    "hot": {"temperature": 373.15, "frequency": 1.0},
}
"""The operating points every study has, in kelvin and hertz: the solid and the molten layer of the paper's tests."""


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Range(_Part):
    """A number that may lie anywhere between two limits; the search begins at `start` where one is given."""

    lower: float
    upper: float
    start: float | None = None


class Options(_Part):
    """Listed numbers or names of records; `source` is the catalogue record that lists them."""

    values: Annotated[tuple[float | str, ...], Field(min_length=1)]
    source: str | None = None


def _kind(vary: Any) -> str:
    """Return which of the two a variable's data mean, so that only its mistakes are reported."""
    ranged = isinstance(vary, Range) or (isinstance(vary, Mapping) and not {"lower", "upper"}.isdisjoint(vary))
    return "Range" if ranged else "Options"


Vary: TypeAlias = Annotated[Annotated[Range, Tag("Range")] | Annotated[Options, Tag("Options")], Discriminator(_kind)]


class Requirement(_Part):
    """One limit on one output; `text` is how the study wrote it."""

    output: str
    sense: Literal["<=", ">="]
    limit: float
    text: str


class Tolerance(_Part):
    """A deviation of an input to either side of its nominal value: `plus_minus`, a `share` of it, or a `row`."""

    plus_minus: float | None = None
    share: float | None = None
    row: str | None = None  # The output that gives it, so that it follows the design
    distribution: Literal["normal", "uniform"] = "normal"
    sigma: float = 3.0  # At how many standard deviations the tolerance lies, where it is normal
    adjustable: bool = False
    adjusted_to: float | None = None
    """What is left of it, to either side, where the module can be adjusted; nothing unless stated."""
    source: str = ""
    status: str = ""


class Robust(_Part):
    """By how many standard deviations each limit must be met, or which share of the modules must meet all of them."""

    sigma: float | None = None
    share: float | None = None
    plausible: float | None = None
    """Beside a share: in which share of the plausible cases of the assumed values each limit must be met."""


class SolverOptions(_Part):
    """Effort of the search and fineness of the heat model."""

    starts: int = Field(3, ge=1, le=1000, description="number of starting points; the first is the study's own")
    seed: int = Field(1, ge=0, le=2**32 - 1, description="seed of the random starting points")
    cells: int = Field(28, ge=2, le=200, description="cells through the polymer layer")
    fineness: float = Field(
        1.0,
        ge=0.5,
        le=50.0,
        description="fineness of the time steps; 2 doubles their number and divides their error by 8",
    )
    max_iterations: int = Field(300, ge=1, le=100_000, description="iterations before the solver gives up")
    tolerance: float = Field(1e-8, ge=1e-14, le=1e-2, description="relative tolerance of convergence")
    time_limit: float = Field(
        1800.0, gt=0.0, le=1e7, json_schema_extra={"unit": "s"},
        description="time after which the search ends with the best design found, such as 10 min",
    )  # fmt: skip
    alternatives: int = Field(
        3, ge=1, le=100, description="combinations of listed choices that are reported, best first"
    )
    prove: bool = Field(
        False, description="solve every combination of listed choices, not only those that branch and bound leaves"
    )


class ProfileOptions(_Part):
    """In how many straight pieces the current of a phase may change with time; 0 keeps it constant."""

    softening: int = Field(0, ge=0, le=64, description="straight pieces of the heating current over the switch")
    stiffening: int = Field(0, ge=0, le=64, description="straight pieces of the cooling current while it stiffens")

    def pieces(self) -> dict[str, int]:
        """Count of pieces by phase, of the phases whose current is free."""
        return {phase: count for phase, count in self.model_dump().items() if count}


class GivenCurrent(_Part):
    """A phase's current [A] at some moments [s] from its start, straight between them; the last one lasts."""

    moments: tuple[float, ...] = Field(description="moments, rising from zero", json_schema_extra={"unit": "s"})
    currents: tuple[float, ...] = Field(description="the current at each moment", json_schema_extra={"unit": "A"})


class GivenTrajectory(_Part):
    """Angles [rad] of the housing at some moments [s]; a cubic spline joins them."""

    moments: tuple[float, ...] = Field(description="moments, rising", json_schema_extra={"unit": "s"})
    angles: tuple[float, ...] = Field(description="the housing's angle at each", json_schema_extra={"unit": "rad"})
    at_rest: bool = Field(True, description="the housing starts and ends at rest; else at constant speed")


class DutyOptions(_Part):
    """Repeated switching, at the module's `ambient_temperature`."""

    switches_per_hour: float = Field(
        0.0, ge=0.0, le=3600.0, description="switches an hour, each to soft and back; 0 asks for no duty"
    )
    soft: float = Field(
        0.0, ge=0.0, le=1e6, description="time for which each switch keeps the joint soft, by its hold current",
        json_schema_extra={"unit": "s"},
    )  # fmt: skip


class ControlOptions(_Part):
    """The heater's controller, from a thermistor at the layer's hot face."""

    draws: int = Field(
        0, ge=0, le=4096, description="modules drawn within tolerances and assumed values under it; 0 asks for none"
    )
    period: float = Field(
        0.1, ge=1e-3, le=10.0, description="time between two steps of the controller", json_schema_extra={"unit": "s"}
    )
    thermistor_lag: float = Field(
        2.0, ge=0.01, le=100.0, description="time constant of the thermistor in its seat, assumed",
        json_schema_extra={"unit": "s"},
    )  # fmt: skip
    driver_lag: float = Field(
        0.05, ge=1e-3, le=10.0, description="time constant of the driver's current, assumed",
        json_schema_extra={"unit": "s"},
    )  # fmt: skip


class FrontOptions(_Part):
    """Two or three outputs to be traded against one another."""

    of: tuple[str, ...] = Field(min_length=2, max_length=3, description="outputs that are traded")
    points: int = Field(12, ge=FEWEST_POINTS, le=MOST_POINTS, description="designs on the front, its ends included")


class WriteOptions(_Part):
    """Files in the results folder besides the numbers."""

    plots: bool = Field(True, description="plots of the result")
    vector: bool = Field(False, description="plots as PDF and SVG too, as a run that makes parts always writes")
    cad: bool = Field(True, description="STEP, STL and GLB of the parts")


class Study(_Part):
    """A whole study. Numbers are SI; `module` holds only what the study set, `operating_points` every point in full."""

    name: str
    description: str = ""
    mode: str
    module: dict[str, float | str] = {}
    as_drawn: dict[str, float] = {}
    """Inputs that the parts were drawn with, where `module` has what was measured of them since."""
    vary: dict[str, Vary] = {}
    require: tuple[Requirement, ...] = ()
    simulated: tuple[Requirement, ...] = ()
    """Limits on `output@duty` and `output@control`, which are simulated once a design is found."""
    accept: tuple[str, ...] = ()  # Ratings beyond which the design may be, by the quantity's name
    minimize: dict[str, float] = {}
    front: FrontOptions | None = None
    operating_points: dict[str, dict[str, float]]
    profile: ProfileOptions = ProfileOptions()
    currents: dict[str, GivenCurrent] = {}
    """Currents over time by phase, of a study that evaluates its module; constant ones are inputs of it."""
    trajectory: GivenTrajectory | None = None  # Motion of the housing in the task
    duty: DutyOptions = DutyOptions()
    control: ControlOptions = ControlOptions()
    tolerances: dict[str, Tolerance] = {}
    robust: Robust | None = None
    solver: SolverOptions = SolverOptions()
    write: WriteOptions = WriteOptions()
    catalog_folder: str | None = None

    @cached_property
    def catalog(self) -> Catalog:
        """The shipped records and those of the folder the study names; raises CatalogError where that is not there."""
        return Catalog(Path(self.catalog_folder) if self.catalog_folder else None)

    @cached_property
    def table(self) -> Table:
        """The quantities of the study's mode; raises InputError for a mode that does not exist."""
        return table_for(self.mode)

    def based_on(self, catalog: Catalog, table: Table) -> Self:
        """Return the study with a catalogue that is open already, and a table."""
        copied = self.model_copy()
        copied.__dict__.update(catalog=catalog, table=table)
        return copied

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy with some fields changed; it keeps the open catalogue and the table unless these change."""
        copied = super().model_copy(update=update, deep=deep)
        for cached, field in _CACHED.items():
            if getattr(copied, field) != getattr(self, field):
                copied.__dict__.pop(cached, None)
        return copied

    def __getstate__(self) -> dict[Any, Any]:
        """Return the fields for a pickle; its reader looks up the catalogue and the table again."""
        state = super().__getstate__()
        return {**state, "__dict__": {name: value for name, value in state["__dict__"].items() if name not in _CACHED}}

    def reaches(self, point: str) -> bool:
        """Return whether heating cannot end before the whole layer is as warm as at an operating point."""
        rows, varied = self.table.by_name, self.vary.get("target_temperature")
        if "response_criterion" not in rows or "response_criterion" in self.vary:
            return "response_criterion" not in rows
        criterion, target = (
            self.module.get(name, getattr(rows[name], "default", None))
            for name in ("response_criterion", "target_temperature")
        )
        if varied is not None:
            target = varied.lower if isinstance(varied, Range) else min(map(float, varied.values))
        temperature = self.operating_points[point]["temperature"]
        return criterion == "far_face" and float(target or 0.0) >= temperature - _SAME_TEMPERATURE

    def limited_with(self, name: str) -> tuple[str, ...]:
        """Return the outputs on which a limit on another is put as well.

        Heating may end colder than the hot point. Then a limit there is put on the state in which heating ends, too.
        """
        row = self.table.output(name)
        at_end = row.at_end if name.endswith("@hot") else ""
        return (at_end,) if at_end and not self.reaches("hot") else row.also_limited

    @property
    def task(self) -> Literal["evaluate", "optimize"]:
        """The study's task."""
        return "optimize" if self.vary else "evaluate"


CONTROLLED = ("response_time", "peak_heater_temperature")  # Outputs that are simulated under the controller
_SAME_TEMPERATURE = 1e-6  # Kelvin by which two temperatures may differ by rounding
_CACHED = {"catalog": "catalog_folder", "table": "mode"}
"""What a study keeps once it is asked for, by the field it follows from."""
