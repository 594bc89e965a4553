"""The device, compiled: the one table turned into CasADi functions of one vector of inputs.

`inputs` is the vector of every number the table is evaluated with, in the order of `Model.names`; `switch` holds the
values of the quantities that a simulation or the optimiser supplies, in the order of `Model.switch_names`.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.record import Record
from tvimdesign.device import Phase, Table
from tvimdesign.device.table.table import AS_DRAWN
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.phase_engine import PhaseEngine
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.recordings import Recordings
from tvimdesign.simulation.working_cycle.symbols import ca, symbols
from tvimdesign.study import Design, Study, brought_along, given

MOST_STRUCTURES = 8  # Structures whose functions a thread keeps


class _Structures(threading.local):
    """Functions of the structures that a thread used last: a tape has one room to work in, so threads share none."""

    def __init__(self) -> None:
        self._last: deque[tuple[tuple[Any, ...], dict[str, Any]]] = deque(maxlen=MOST_STRUCTURES)

    def functions_of(self, structure: tuple[Any, ...]) -> dict[str, Any]:
        """Return the functions of a structure by name, none where it is new; the caller adds to them."""
        for known, functions in self._last:
            if known == structure:
                return functions
        self._last.append((structure, {}))
        return self._last[-1][1]

    def forget(self) -> None:
        """Let the next device write its equations anew."""
        self._last.clear()


STRUCTURES = _Structures()


def built_once(build: Callable[[Any], Any]) -> Any:
    """Make a property of a method: built when first asked for, for all devices of one structure."""

    def value(device: DeviceFunctions) -> Any:
        return device.built(build.__qualname__, lambda: build(device))

    return property(value, doc=build.__doc__)


class DeviceFunctions:
    """One device with its records chosen.

    Devices that differ in numbers alone share their functions, those of records too that no quantity reads itself.
    """

    def __init__(self, table: Table, given: Mapping[str, Any], points: Sequence[str], cells: int) -> None:
        """Index the numbers of `given`; records and options stay constants. `cells` divides the polymer layer."""
        self.table = table
        self.points = tuple(points)
        self.cells = cells
        self.names = [name for name, value in given.items() if isinstance(value, int | float)]
        self.start = np.array([float(given[name]) for name in self.names])
        self.index = {name: i for i, name in enumerate(self.names)}
        self.words = {name: value for name, value in given.items() if name not in self.index}
        self.switch_names = tuple(row.name for row in table.supplied)
        self._rotor_cells = int(self.start[self.index["rotor_cells"]])  # A shape, not a number of the model
        read = {need for row in table.outputs for need in row.needs}
        structural = {name: word for name, word in self.words.items() if name in read or not isinstance(word, Record)}
        self._built = STRUCTURES.functions_of(
            (table, self.names, structural, self.points, cells, self._rotor_cells, *self._apart)
        )
        """What is built, by the name of its property or by the outputs of a function."""

    @property
    def _apart(self) -> tuple[Any, ...]:
        """Return what else tells structures apart."""
        return ()

    @built_once
    def _symbols(self) -> tuple[Any, Any, dict[str, Any]]:
        inputs = ca.SX.sym("inputs", len(self.names))
        cycle = ca.SX.sym("cycle", len(self.switch_names))
        known = dict(self.words)
        entries = symbols(inputs)
        known.update({name: entries[i] for i, name in enumerate(self.names)})
        known["rotor_cells"] = self._rotor_cells
        return inputs, cycle, self.table.with_drawn(known)

    @built_once
    def _settled(self) -> dict[str, Any]:
        """Return all that follows from the inputs alone, written once for the outputs and every phase."""
        return self.table.settled(self._symbols[2])

    @built_once
    def _known(self) -> dict[str, Any]:
        """Return what is written so far, with the cycle's values as symbols; what is asked for is added."""
        return {**self._settled, **self._cycle}

    @property
    def _cycle(self) -> dict[str, Any]:
        return dict(zip(self.switch_names, symbols(self._symbols[1]), strict=True))

    @built_once
    def phases(self) -> dict[str, PhaseFunctions]:
        """Return every phase of the working cycle by name, in the order they are gone through."""
        return {phase.name: self._phase(phase) for phase in self.table.phases}

    def _phase(self, phase: Phase) -> PhaseFunctions:
        return PhaseFunctions(self.table, phase, self._symbols[0], lambda: self._settled, self.cells, self.names)

    def _engine(self, phase: PhaseFunctions) -> PhaseEngine:
        return PhaseEngine(phase, self.recordings(["stack_now", "ambient_temperature", *phase.quantities], phase.phase))

    def recordings(self, wanted: Iterable[str], *more: Any) -> Recordings:
        """Return what is recorded of some quantities; `more` tells them apart from others of the same names."""
        if not self.table.mode:
            return Recordings("")
        read = frozenset[str]().union(*(self.table.ancestors(name) for name in wanted))
        words = {name: word for name, word in self.words.items() if name in read or name == AS_DRAWN}
        return Recordings(repr(
            (self.table.mode, self.names, words, self.points, self.cells, self._rotor_cells, self._apart, *more)
        ))  # fmt: skip

    @built_once
    def engines(self) -> dict[str, PhaseEngine]:
        """Return the engine of every phase by name; what one records serves all who step this device."""
        return {name: self._engine(phase) for name, phase in self.phases.items()}

    @built_once
    def either_way(self) -> PhaseFunctions:
        """Return the first phase with a layer that has its history from the start: it melts and freezes at any current.

        It melts `melting_time` behind the equilibrium curve, which the first phase follows.
        """
        return self._phase(replace(self.table.phases[0], history=True))

    @built_once
    def either_way_engine(self) -> PhaseEngine:
        """Return the engine of that phase."""
        return self._engine(self.either_way)

    @built_once
    def output_names(self) -> list[str]:
        """Return every output's full name in the table's order."""
        return self.table.names(self.points)

    def inputs(self, values: Mapping[str, float]) -> NDArray[np.float64]:
        """Return the numbers of the device with some of them, by name, replaced."""
        inputs = self.start.copy()
        for name, value in values.items():
            inputs[self.index[name]] = value
        return inputs

    def outputs(self, wanted: Sequence[str], instead: Mapping[str, float] | None = None) -> Any:
        """Return the function (inputs, switch) -> the wanted outputs, one vector.

        `instead` fixes quantities, by full name, that would otherwise be computed.
        """
        if instead:
            return self._function_of(wanted, {**self._symbols[2], **self._cycle, **instead})
        return self.built(" ".join(["outputs", *wanted]), lambda: self._function_of(wanted, self._known))

    def _function_of(self, wanted: Sequence[str], known: dict[str, Any]) -> Any:
        values = self.table.resolve(known, wanted)
        # Rows of the table write out what they need: a third to two thirds of the operations are repeats. CasADi's own
        # option would look for them in every derivative again.
        written = ca.densify(ca.cse(ca.vertcat(*(values[name] for name in wanted))))
        return ca.Function("outputs", [*self._symbols[:2]], [written])

    def dependence(self, wanted: Sequence[str]) -> list[tuple[str, str]]:
        """Return the pairs of a wanted output and an input that it depends on, with these records and options."""
        key = " ".join(["dependence of", *wanted])

        def record() -> list[NDArray[Any]]:
            return [np.array(self.outputs(wanted).jac_sparsity(0, 0).get_triplet(), dtype=np.int64)]

        (places,) = self.recordings(wanted).arrays(key, record)
        return [(wanted[row], self.names[column]) for row, column in places.T.tolist()]

    def values(self, inputs: NDArray[np.float64], cycle: Mapping[str, float]) -> dict[str, float]:
        """Return every output in SI by full name."""
        return self.some_values(self.output_names, inputs, cycle)

    def some_values(
        self, wanted: Sequence[str], inputs: NDArray[np.float64], cycle: Mapping[str, float]
    ) -> dict[str, float]:
        """Return the wanted outputs in SI: quicker than all of them on a first call."""
        if not wanted:
            return {}
        (numbers,) = self.tape(wanted).values(inputs, np.array([cycle[name] for name in self.switch_names]))
        return dict(zip(wanted, numbers.tolist(), strict=True))

    def tape(self, wanted: Sequence[str]) -> Tape:
        """Return the wanted outputs, recorded: of the inputs and of what the cycle supplies."""
        key = " ".join(["tape of", *wanted])
        tape: Tape = self.built(
            key, lambda: self.recordings(wanted).tapes(key, 1, lambda: [Tape.of_function(self.outputs(wanted))])[0]
        )
        return tape

    def built(self, key: str, build: Callable[[], Any]) -> Any:
        """Return what a key stands for, built when first asked for, for all devices of one structure."""
        if key not in self._built:
            self._built[key] = build()
        return self._built[key]


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
