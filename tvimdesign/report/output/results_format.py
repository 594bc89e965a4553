"""The format of results.json: the types of what stands in it, from which its JSON schema is made.

One unit system: every bare number is in SI. A number that people read in another unit stands under `value`, `low` and
`high` with its `unit`, and under `si` once more in SI. What never happens is null.
"""

from typing import Any, Literal, NotRequired

from pydantic import TypeAdapter

from tvimdesign.report.output.numbers import Entry, Head, NumberEntry
from tvimdesign.solve.nlp import solution

Shares = dict[str, float | None]


class IntervalEntry(NumberEntry):
    """The range of an output over unmeasured inputs: between `low` and `high` with 95 %, all moved together."""

    one_at_a_time: NumberEntry  # Least and largest with one input at an end of its range
    shares: dict[str, float]
    """Share of the variance that knowing one input would take away; the first is what to measure first."""
    to_halve: list[str]  # The fewest inputs to measure for half the width; none where no few do it
    before: NumberEntry | None
    """The same by the ranges that inputs had before a user's records measured them; none where none did."""


class UnmeasuredEntry(NumberEntry):
    """An unmeasured input, and the range it was moved in."""

    name: str
    status: str


class ShareEntry(Entry):
    """A share of what was drawn, and between what it lies with 95 %."""

    share: float
    low: float
    high: float


class UncertaintyEntry(Entry):
    """The uncertainty of a design: what varies from part to part and, apart from it, unmeasured inputs."""

    parts_yield: ShareEntry | None
    """Modules that satisfy the limits, parts within their tolerances and all else as assumed."""
    modules: int
    limits: int
    left_out: list[str]
    tolerances: Literal["study", "standard"]
    ranges_hold: ShareEntry | None
    """Share of the ranges of unmeasured inputs in which every limit is satisfied, parts as drawn."""
    draws: int
    held: dict[str, float]  # That share for each limit that is not always kept, the least first
    intervals: dict[str, IntervalEntry]
    unmeasured: list[UnmeasuredEntry]


Stands = Literal["active", "touches", "slack"]  # How a limit stands at the optimum


class ValueEntry(NumberEntry):
    """An input or an output: where it comes from, how well it is known, and what it means.

    `idealized` is empty, or the words of the study without which it would be another value.
    """

    kind: Literal["input", "output"]
    status: str
    source: str
    group: str
    description: str
    note: str
    idealized: str


class CheckEntry(NumberEntry):
    """A limit and the design's value; the margin is a share, or in `margin_unit` where the limit has no size."""

    limit: str
    output: str
    margin: float | None
    margin_unit: str
    met: bool
    origin: str


class IdealizationEntry(Entry):
    """A word of the study that leaves out something of the drawn module, and the values that come out without it."""

    choice: str
    word: str
    instead: str
    leaves_out: str
    as_drawn: dict[str, NumberEntry]


class CoolingEntry(Entry):
    """Cooling by current: if the heater can and does, and the times of the way back with its pads unpowered."""

    able: bool
    used: bool
    unpowered: dict[str, NumberEntry]


class DutyEntry(Entry):
    """Repeated switching: its periodic cycle, and the most switches an hour that keep the ratings."""

    values: dict[str, NumberEntry]
    exceeded: list[str]
    settling_time: NumberEntry
    energy_a_day: NumberEntry
    most_switches_per_hour: float
    limited_by: str


class ControlEntry(Entry):
    """The heater's controller on drawn modules: values that a share of them does not exceed."""

    controller: dict[str, Any]
    share: float
    overshoot: NumberEntry
    hottest_pads: NumberEntry
    settling: float
    settling_of_nominal: float
    controlled: ShareEntry
    stays_soft: ShareEntry


class BestConstant(Entry):
    """The best design with constant currents, where the study lets them follow a profile."""

    objective: float
    values: dict[str, ValueEntry]


class Yield(Entry):
    """Yield of a design with margins, and of the one without margins, by random modules."""

    target: float
    modules: int
    shares: dict[str, float]
    together: float
    lost_to: list[solution.LostTo]
    nominal_together: float
    nominal: dict[str, NumberEntry]
    tightened: solution.TightenedTolerance | None
    eased: solution.EasedRequirement | None


class Listed(Entry):
    """One combination of what is listed: its choices, words or numbers, and what it comes to."""

    choices: dict[str, str | NumberEntry]
    objective: float
    outputs: dict[str, str | NumberEntry]


class ChoosingEntry(Entry):
    """The search over listed choices."""

    combinations: int
    solved: int
    pruned_by_bound: int
    without_design: int
    not_searched: int
    proven: bool
    better_by_proof: float
    better_than_bound: float
    objective_of_mixture: float | None
    ruled_out_by_arithmetic: int
    runs: int
    iterations: int
    best: list[Listed]
    between_sizes: Listed | None
    cost_of_standard_sizes: dict[str, float]


class Search(Entry):
    """The search for the optimum: its runs, and the limits and ends of ranges at the optimum with their prices."""

    objective: float | None
    reference: Shares
    distinct_optima: list[int]
    starts: list[dict[str, Any]]
    active_constraints: list[dict[str, Any]]


class LimitEntry(Entry):
    """A limit at the optimum in the words of why.csv: how it stands, its margin, and what a step of it costs."""

    limit: str
    stands: Stands
    origin: str
    margin: float | None
    margin_unit: str
    step: str
    shadow_price: float
    sensitivity: dict[str, float]


class Why(Entry):
    """Reasons for this design."""

    limits: list[LimitEntry]
    sentences: list[str]


class Optimum(Entry):
    """One optimum: its objective, the first start that found it, how many did, and its free numbers (SI)."""

    objective: float
    start: int
    reached_by: int
    at: dict[str, float]


class Starts(Entry):
    """The starts of the search, and how they ended."""

    count: int
    converged: int
    optima: list[Optimum]
    passed_over: dict[str, int]
    not_converged: list[dict[str, Any]]


class SideEntry(Entry):
    """One limit of a conflict."""

    limit: str
    origin: str
    broken_by: float | None
    move_to: str | None
    not_enough_for: list[str]


class Conflict(Entry):
    """Limits that cannot hold together, and what the design that comes closest violates."""

    cannot_hold_together: list[SideEntry]
    least_violation: list[SideEntry]
    ends_of_ranges: list[str]


class FrontPoint(Entry):
    """A point of a front: its outputs and variables in their units and in SI, and the file of its design."""

    number: int
    status: str
    design: str
    values: Shares
    si: Shares
    yield_share: NotRequired[float]
    above_rating: NotRequired[list[str]]


class FrontEntry(Entry):
    """A front; `units_of_values` are those of the points' `values`, `knee` is the number of a point."""

    of: list[str]
    units_of_values: dict[str, str]
    points: list[FrontPoint]
    knee: int | None
    in_words: list[str]
    spread: float
    sought: int
    dominated: int
    failures: list[dict[str, str]]
    notes: list[str]


class Parts(Entry):
    """The parts: checks on the solids, files, and what is to be said of them."""

    checks: list[dict[str, Any]]
    files: list[str]
    notes: list[str]


class Answered(Head):
    """A study answered: every number, every limit, how it was found."""

    name: str
    mode: str
    status: str
    feasible: bool
    choices: dict[str, str]
    values: dict[str, ValueEntry]
    checks: list[CheckEntry]
    warnings: list[CheckEntry]
    above_rating: list[CheckEntry]
    accepting: list[CheckEntry]
    accepted_in_vain: list[str]
    idealizations: list[IdealizationEntry]
    current_profiles: dict[str, dict[str, list[float]]]  # Moments and currents, straight between them
    at_default_currents: dict[str, ValueEntry]
    cooling: CoolingEntry
    best_constant_currents: BestConstant | None
    yield_reached: Yield | None
    choosing: ChoosingEntry | None
    solution: Search | None


class RunResults(Answered):
    """The result of a run: results.json, and with `folder` and `not_done` the output of `run --json`."""

    verdict: NotRequired[str]
    why: NotRequired[Why]
    starts: NotRequired[Starts]
    conflict_set: NotRequired[Conflict | None]
    doubts: NotRequired[list[str]]
    duty: NotRequired[DutyEntry]
    control: NotRequired[ControlEntry]
    front: NotRequired[FrontEntry]
    uncertainty: NotRequired[UncertaintyEntry]
    left_out: NotRequired[list[str]]
    cad: NotRequired[Parts]
    folder: NotRequired[str]
    not_done: NotRequired[list[str]]


class RefusedRun(Head):
    """A run whose study was refused before there was any design, with the reason."""

    name: str
    mode: str
    status: Literal["infeasible"]
    feasible: Literal[False]
    reason: str
    folder: NotRequired[str]


def results_schema() -> dict[str, Any]:
    """Return the JSON schema of results.json and of `run --json`, made from the types above."""
    made: TypeAdapter[Any] = TypeAdapter(RunResults | RefusedRun)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "tvimdesign results",
            **made.json_schema()}  # fmt: skip
