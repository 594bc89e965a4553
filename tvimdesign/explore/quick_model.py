"""One module evaluated while a hand moves it: the working cycle by the steps of many designs, the rest by the table.

What they step takes a second to record, in a thread beside; until then the simulator goes through the cycle, loosely.
"""

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.working_cycle.cycle import Simulator, Trajectory
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_functions import TEMPERATURES
from tvimdesign.solve.batch.batch_model import pace_of
from tvimdesign.solve.batch.cycle_kernel import CycleKernel
from tvimdesign.solve.batch.phase_kernel import Steps
from tvimdesign.study import Study, given

Array = NDArray[np.float64]
Curves = dict[str, dict[str, list[float]]]

_STEPS = Steps(of_pace=28, first=1.0 / 32.0, growth=1.2)
"""About half of the steps that tolerances take where something freezes: times within 0.2 % still (a test)."""
_LOOSE, _SAMPLES = 1e-3, 10
_PHASES: tuple[str, ...] = ("softening", "stiffening")
_SHOWN = 24  # Moments of a phase that are drawn
_WATCHED = (TEMPERATURES, "impedance_now", "electrical_power")
_CURVES = ("hot_side", "near_face", "far_face", "joint_impedance", "electrical_power")


@dataclass(frozen=True)
class Evaluated:
    """A module's values, SI by full name, and its curves by phase."""

    values: dict[str, float]
    curves: Curves
    words: dict[str, str]  # Chosen records and options by name


class QuickModel:
    """The modules that have the same records and options, as a function of every number."""

    def __init__(self, study: Study, *, compiled: bool = True) -> None:
        """Simulate the study's start, which sets the pace, and begin to record."""
        known = given(study)
        self.words = words_of(known)
        self._chosen = {row.name: str(getattr(known[row.name], "name", known[row.name])) for row in study.table.choices}
        self.points, self.cells = tuple(study.operating_points), study.solver.cells
        self.model = DeviceFunctions(study.table, known, self.points, self.cells)
        self._simulator = Simulator(self.model, _LOOSE, _SAMPLES)
        self._kernel: CycleKernel | None = None
        self._maps = {name: _Drawn(self.model, name) for name in _PHASES if name in self.model.phases}
        self._pace = pace_of(self._simulator, self.model.start)
        self._thread = threading.Thread(target=self._record, daemon=True)
        if compiled:
            self._thread.start()

    def fits(self, study: Study, known: Mapping[str, Any]) -> bool:
        """Return whether a study's module differs in numbers alone; `known` holds the study's values."""
        same = tuple(study.operating_points) == self.points and study.solver.cells == self.cells
        return same and words_of(known) == self.words

    def wait(self) -> bool:
        """Wait until the steps are recorded; whether they could be."""
        self._thread.join()
        return self._kernel is not None

    def inputs(self, known: Mapping[str, Any]) -> Array:
        """Return the vector of a module's numbers."""
        return np.array([float(known[name]) for name in self.model.names])

    def evaluate(self, inputs: Array) -> Evaluated:
        """Compute every output of a module and its curves. Raises SimulationError."""
        kernel = self._kernel
        if kernel is None:
            cycle = self._simulator.run(inputs)
            switch, lines = cycle.values, {name: (line.times, line.states) for name, line in cycle.trajectories.items()}
        else:
            some, courses = kernel.course(np.delete(inputs, self.model.index["rotor_cells"]), self._pace)
            switch = {name: some.get(name, np.inf) for name in self.model.switch_names}
            lines = {name: _line(course) for name, course in courses.items() if course}
        ends = {name: phase.phase.ends for name, phase in self.model.phases.items()}
        curves: Curves = {
            name: drawn.curves(inputs, *lines[name], switch[ends[name]])
            for name, drawn in self._maps.items() if name in lines
        }  # fmt: skip
        return Evaluated({**dict(zip(self.model.names, inputs.tolist(), strict=True)),
                          **self.model.values(inputs, switch)}, curves, self._chosen)  # fmt: skip

    def _record(self) -> None:
        moving = [name for name in self.model.names if name != "rotor_cells"]
        try:
            kernel = CycleKernel(self.model, moving, self.model.switch_names, _STEPS)
        except ValueError:
            return  # an unknown operation: the simulator goes on
        self._kernel = kernel


class _Drawn:
    """The curves of one phase at moments evenly spaced."""

    def __init__(self, model: DeviceFunctions, name: str) -> None:
        phase = model.phases[name].phase
        self._sign, self._current, self._engine = phase.sign, model.index[phase.current_input], model.engines[name]
        self._rows = [1, 2, 3 + model.cells, -2, -1]

    def curves(self, inputs: Array, times: Array, states: Array, end: float) -> dict[str, list[float]]:
        """Time [s], temperatures [degC] of pads and layer's faces, impedance [N*m/rad] and power [W]."""
        last = end if np.isfinite(end) else float(times[-1])
        moments = np.linspace(0.0, last, _SHOWN)
        line = Trajectory(times, states, np.empty(0))
        if times[-1] <= 0.0:
            return {}
        at = line.at(moments / times[-1])
        currents = np.full((1, _SHOWN), self._sign * inputs[self._current])
        rows = self._engine.at_instants(_WATCHED, inputs, at, currents)[self._rows]
        rows[:3] -= ZERO_CELSIUS
        return {"time": moments.tolist(), **dict(zip(_CURVES, rows.tolist(), strict=True))}


def _line(course: list[tuple[float, Array]]) -> tuple[Array, Array]:
    return np.array([time for time, _ in course]), np.column_stack([states[:, 0] for _, states in course])


def words_of(known: Mapping[str, Any]) -> dict[str, Any]:
    """Return the records and options of a module, and its number of cells, which is a shape."""
    return {name: value for name, value in known.items() if not isinstance(value, int | float) or name == "rotor_cells"}
