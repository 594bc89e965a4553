"""Input of a virtual test: a study, resolved, and the table its quantities are evaluated with."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from tvimdesign.device import Table
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import Study, brought_along, given
from tvimdesign.study.design import Design


@dataclass(frozen=True)
class ResolvedModule:
    """A module on the bench. `values` holds every input in SI by full name, and every choice as record or word."""

    study: Study
    values: Mapping[str, Any]
    current_profiles: Mapping[str, CurrentProfile] = field(default_factory=dict)
    """Currents that follow a profile, by phase."""

    @property
    def table(self) -> Table:
        """The quantities of its mode."""
        return self.study.table

    @property
    def points(self) -> tuple[str, ...]:
        """Names of the operating points."""
        return tuple(self.study.operating_points)

    @property
    def replaced(self) -> set[str]:
        """Inputs in whose place a current follows a profile: nothing depends on them."""
        return {self.table.phase(phase).current_input for phase in self.current_profiles}

    @cached_property
    def functions(self) -> DeviceFunctions:
        """Its table and working cycle as functions of the numbers among its inputs."""
        return DeviceFunctions(self.table, self.values, self.points, self.study.solver.cells)

    def quantity(self, name: str) -> Any:
        """Return the value of one quantity by full name; hidden quantities too."""
        return self.table.evaluate(self.values, [name])[name]


def given_profiles(study: Study) -> dict[str, CurrentProfile]:
    """Return the currents that a study gives over time, by phase."""
    return {phase: CurrentProfile(given.moments, given.currents) for phase, given in study.currents.items()}


def resolve_study(study: Study) -> ResolvedModule:
    """Resolve a study for testing; what it varies stands at its start. Raises InputError for what has no value."""
    return ResolvedModule(study, given(study), given_profiles(study))


def resolve_design(design: Design) -> ResolvedModule:
    """Return the module of a design, with the currents found for it. Raises InputError for what has no value."""
    study = Study.model_validate({**design.study, "vary": {}, "profile": {}})
    brought = brought_along(design.choices, study.table)
    chosen = {name: word for name, word in design.choices.items() if name not in brought}
    study = study.model_copy(update={"module": {**study.module, **chosen}})
    values = given(study)
    numbers = {name: design.values[name] for name, value in values.items() if isinstance(value, float | int)}
    current_profiles = {phase: CurrentProfile.from_plain(plain) for phase, plain in design.current_profiles.items()}
    return ResolvedModule(study, {**values, **numbers}, current_profiles)
