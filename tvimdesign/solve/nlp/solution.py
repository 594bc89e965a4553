"""Records of a solution: starts, active limits, the solution."""

from collections.abc import Iterable
from dataclasses import astuple, dataclass, field
from typing import Self

import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.cycle import Cycle
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.spread import Yield, yield_of

SAME_OPTIMUM = 1e-4  # Two solutions are the same optimum if their objectives differ by no more than this share


@dataclass(frozen=True)
class Start:
    """One run of the solver: where it began, how it ended."""

    number: int
    status: str
    converged: bool
    iterations: int
    objective: float
    seconds: float
    begin: dict[str, float]
    end: dict[str, float]
    choices: dict[str, str | float] = field(default_factory=dict)  # The listed records and sizes this run was held to
    relaxed: bool = False  # True if listed sizes were free to lie between one another: where to begin, not an answer
    second_try: bool = False  # True if it converged only from a feasible design, which was sought first
    by_neighbor: bool = False
    """Whether it ended a period of a number, such as a turn of the coils, beside where the solver came to first."""
    crossed: bool = False  # True if it began with a part, such as the springs, of one optimum in another one


def same_optimum(start: Start, other: Start) -> bool:
    """Return whether two converged runs ended at the same optimum."""
    return abs(start.objective - other.objective) <= SAME_OPTIMUM * abs(other.objective)


@dataclass(frozen=True)
class ActiveConstraint:
    """One limit or bound at the solution: its residual (share of its scale, kept where <= 0) and what it costs.

    `price` is how much of the objective, in percent, relaxing it by `step` would save; `step` is in words.
    `savings` says the same of each minimised output, negative where it rises; empty where that is not determined.
    """

    name: str
    output: str
    text: str
    residual: float
    scale: float  # SI
    absolute: bool  # True if the room is to be read in the row's unit, not as a share
    shadow_price: float
    step: str
    origin: str
    sensitivity: dict[str, float] = field(default_factory=dict)

    @property
    def margin(self) -> float:
        """Return the margin as a share of the scale."""
        return -self.residual


@dataclass
class SolverEffort:
    """Number of solver runs of a search over listed choices."""

    warm: int = 0
    warm_iterations: int = 0
    cold: int = 0  # From a simulated point, where a warm run came to nothing
    cold_iterations: int = 0
    screened: int = 0  # Boxes of sizes in which the limits that depend on no switch cannot be kept

    @classmethod
    def total(cls, build_plan: "Iterable[SolverEffort]") -> Self:
        """Return the work of several searches together."""
        together = [astuple(work) for work in build_plan]
        return cls(*(sum(column) for column in zip(*together, strict=True)))

    def count(self, start: Start, *, warm: bool) -> None:
        """Add one run."""
        if warm:
            self.warm, self.warm_iterations = self.warm + 1, self.warm_iterations + start.iterations
        else:
            self.cold, self.cold_iterations = self.cold + 1, self.cold_iterations + start.iterations


@dataclass(frozen=True)
class Standard:
    """One design whose every choice is listed: its choices, its objective, and its minimised outputs (SI)."""

    choices: dict[str, str | float]
    objective: float
    values: dict[str, float]


@dataclass(frozen=True)
class Choosing:
    """The account of a search over listed choices."""

    combinations: int
    solved: int  # Combinations whose design was found
    pruned: int  # Combinations that no bound leaves room for
    without_design: int  # Combinations for which every search came to nothing
    not_searched: int = field(default=0, kw_only=True)  # Combinations, or records, that are left as the time was over
    best: tuple[Standard, ...]  # The best combinations, the first of them the answer
    between: Standard | None
    """The best design with every listed number free between its smallest and its largest size, with the best records
    where these are listed; None where none is."""
    bound: float | None = field(default=None, kw_only=True)
    """Objective of the best mixture of records with sizes in between, below which no combination comes as far as the
    starts go; None where no records are mixed."""
    proven: bool  # True if every combination was solved, and not only those that branch and bound leaves
    improved: float  # Share by which that found better than branch and bound did; zero where they agree
    work: SolverEffort  # Of branch and bound
    proof: SolverEffort  # Of the enumeration
    inside: float
    """Largest share by which a design within a box was better than the bound of the box: zero if bounds were bounds."""


@dataclass(frozen=True)
class Side:
    """One limit that is violated, or conflicts."""

    text: str
    origin: str
    by: float  # How far the design that breaks least breaks it, as a share of its scale
    move_to: float | None = None
    """Where it would have to stand (SI) for all others to hold; None where no place of it alone was found."""
    move_words: str = ""
    robust_to: float | None = None  # Where it would have to stand with margins (SI), by estimate
    beside: tuple[str, ...] = ()  # The other limits that cannot hold either, however far this one moves


@dataclass(frozen=True)
class ConflictSet:
    """Facts known of a study that has no design."""

    broken: tuple[Side, ...]  # Limits that the least infeasible design violates
    sides: tuple[Side, ...]  # Limits that cannot hold together, while without any one of them the others can
    ends: tuple[str, ...]  # Ends of ranges that keep them from it


@dataclass(frozen=True)
class Constant:
    """The best design with constant currents, where the study lets them follow a profile."""

    objective: float
    values: dict[str, float]  # Inputs and outputs in SI by full name


@dataclass(frozen=True)
class LostTo:
    """A limit that too many modules break, and what spreads it."""

    text: str
    share: float  # Share of the modules that keep it
    carriers: dict[str, float]  # Inputs by their share of the variance behind it, the largest first


@dataclass(frozen=True)
class TightenedTolerance:
    """The tolerance that needs least tightening for a requested yield, to first order at the same sizes."""

    name: str
    plus_minus: float  # As the study has it [SI]
    to: float  # Value that suffices [SI]; zero if no tolerance alone is enough
    share: float  # Yield with it


@dataclass(frozen=True)
class EasedRequirement:
    """A requirement that is in the way of a requested yield: with this one alone eased, a design reaches it."""

    text: str
    to: float  # Value that suffices [SI]


@dataclass(frozen=True)
class YieldReached:
    """Yield of random modules of a design, against the requested yield, and its cost."""

    target: float
    modules: int  # Drawn apart from those the design was found by
    shares: dict[str, float]  # Share of them that satisfies each limit, by its name
    together: float  # Share of them that keeps all
    lost_to: tuple[LostTo, ...]  # The limits that most modules break, the worst first
    nominal_together: float  # Share of modules that keeps all at the optimum without margins
    nominal: dict[str, float]  # Headline values and minimised outputs (SI) of the optimum without margins
    tightened: TightenedTolerance | None = None  # Change that would reach it; None where it is reached
    eased: EasedRequirement | None = None  # As `tightened`; None where none of those tried is enough

    @property
    def share(self) -> Yield:
        """The share that keeps all, with its interval."""
        return yield_of(self.together, self.modules)

    @property
    def reached(self) -> bool:
        """Return whether the requested share of modules satisfies the limits."""
        return self.together >= self.target


def _different_begins(starts: Iterable[Start]) -> int:
    return len({tuple(start.begin.items()) for start in starts})


@dataclass(frozen=True)
class Solution:
    """The best design found, with the account of how. `inputs` is in the order of `model.names`."""

    status: str
    feasible: bool
    model: DeviceFunctions
    inputs: NDArray[np.float64]
    current_profiles: dict[str, CurrentProfile]  # The currents that were free, by phase
    cycle: Cycle
    values: dict[str, float]
    objective: float
    starts: tuple[Start, ...]
    held: tuple[ActiveConstraint, ...]
    reference: dict[str, float]
    """Value of each minimised output at the study's start; the objective is the weighted sum of the ratios to it."""
    seconds: dict[str, float]
    constant: Constant | None = None
    choosing: Choosing | None = None  # How the listed choices were searched; None where none is listed
    passed_over: dict[str, int] = field(default_factory=dict)  # Points drawn at which no search began, by the reason
    yield_reached: YieldReached | None = None  # Yield reached; None where none is asked
    out_of_time: float | None = None
    """The time limit [s] that ended the search before its end; None where it came to that."""
    left_out: tuple[str, ...] = ()  # List the steps after the search that the time limit left out
    conflict_set: ConflictSet | None = None
    """Where there is no design: which limits cannot hold together, and what the design that breaks least breaks."""

    @property
    def free_starts(self) -> tuple[Start, ...]:
        """The runs from the recorded starts with the best records, none held to a listed size."""
        sizes_listed = any(start.relaxed for start in self.starts)
        best = min((s for s in self.starts if not s.relaxed), key=lambda s: (not s.converged, s.objective))
        records = {name: value for name, value in best.choices.items() if isinstance(value, str)}
        return tuple(
            start
            for start in self.starts
            if start.relaxed == sizes_listed
            and all(start.choices.get(name, value) == value for name, value in records.items())
        )

    def reached(self, optimum: Start) -> int:
        """Return the number of free starts from which a search ended at an optimum, searches beside it included."""
        return _different_begins(
            start for start in self.free_starts if start.converged and same_optimum(start, optimum)
        )

    def start_count(self) -> int:
        """Return the number of free starts; searches beside an optimum count with the start that led to it."""
        return _different_begins(self.free_starts)

    def distinct_optima(self) -> list[Start]:
        """Return one converged free start for each different optimum, the best first."""
        optima: list[Start] = []
        for start in sorted((s for s in self.free_starts if s.converged), key=lambda s: s.objective):
            if not any(same_optimum(start, o) for o in optima):
                optima.append(start)
        return optima
