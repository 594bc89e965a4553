"""Hold the engine against CVODES and finite differences: both phases of one study, the softening of another.

Event times of the product's simulation at a tolerance of 1e-9; slopes of times along each free number by central
differences of the engine itself.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np
from engine_module import Module
from engine_network import Array, Assembler
from engine_phase import TIME, phase, with_history
from engine_steps import FAR, FROZEN, THIRD, WATCHED

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.symbols import symbols
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study

MOVED = 1e-5
SOFTENED = ("response_time", "peak_power", "peak_voltage", "peak_peltier_temperature")


class Stiffening:
    """The way back of a module, from the end of its softening."""

    def __init__(self, module: Module, steps: float) -> None:
        """Write the numbers of its network and their slopes."""
        model, found = module.model, module.model.phases["stiffening"]
        current = found.phase.sign * symbols(found._inputs)[model.index[found.phase.current_input]]
        assembler = Assembler(found._stack, model.cells, current, steps)
        self.module, self.network = module, assembler.network()
        q, material = ca.Function("q", [found._inputs], [assembler.numbers(), assembler.material()])(module.inputs)
        self.material = np.asarray(ca.DM(material)).ravel()
        slopes = ca.densify(ca.horzcat(ca.jacobian(q, module.unknowns), ca.SX(q.numel(), 1)))
        self._numbers = ca.Function("numbers", [module.unknowns], [q, slopes])

    def run(self, unknowns: Array, which: int, target: float, sense: float) -> tuple[float, Array, int]:
        """Return the time from the softening's end to an event, its slopes by the unknowns, and the steps."""
        self.module.run(unknowns)
        y, s = with_history(*self.module.state, self.network, self.material)
        numbers, moved = (np.asarray(one) for one in self._numbers(unknowns))
        q, dq = numbers.ravel(), np.ascontiguousarray(moved)
        ends, slopes = np.zeros((2, WATCHED + 1)), np.zeros((2, WATCHED + 1, dq.shape[1]))
        steps = phase(
            y, s, q, dq, self.material, np.zeros(0), self.network, True, THIRD, which, target, sense, ends[0],
            slopes[0], ends[1], slopes[1],
        )  # fmt: skip
        return ends[0, TIME], slopes[0, TIME, :-1], steps


def checked(file: str, criterion: str, steps: float, *, both: bool) -> None:
    """Print how far the engine is off for one study."""
    study = read_study(file)
    study = study.model_copy(update={"robust": None, "module": {**study.module, "response_criterion": criterion}})
    optimizer = Optimizer(study)
    model = optimizer.model
    module = Module(model, optimizer.free, list(SOFTENED), steps)
    start = np.array([one.to_unknown(model.start[model.index[one.name]]) for one in optimizer.free])
    simulator = Simulator(model, 1e-9, 200)
    phases = ["stiffening"] if both else ["softening"]
    judge = simulator.run(model.start, phases=phases).values
    found, slopes = module.run(start)
    print(f"{file}, {criterion}: {module.network.nodes} nodes, {module.network.rows.size} linear entries")
    for name, value in zip(SOFTENED, found, strict=True):
        _line(name, value, judge[name])
    _differences("slopes of response_time", slopes[0], start, lambda x: module.run(x)[0][0])
    begin = time.process_time()
    Simulator(model).run(model.start, phases=["softening"], wanted=("response_time",))
    print(f"  product's simulation of the softening, built: {1e3 * (time.process_time() - begin):.1f} ms")
    if not both:
        return
    back, cold = Stiffening(module, steps), float(model.start[model.index["temperature@cold"]])
    for name, event in (("frozen_time", (FROZEN, 0.5, 1.0)), ("far_face_cooling_time", (FAR, cold, -1.0))):
        value, by, count = back.run(start, *event)
        _line(f"{name} ({count} steps)", value, judge[name])
        _differences(f"slopes of {name}", by, start, lambda x, event=event: back.run(x, *event)[0])


def _line(name: str, value: float, judge: float) -> None:
    print(f"  {name:40}{value:14.6f}{judge:14.6f}{value / judge - 1.0:10.1e}")


def _differences(name: str, slopes: Array, start: Array, of: Any) -> None:
    """Print the largest error of slopes over the largest slope."""
    moved = MOVED * np.eye(len(start))
    there = np.array([(of(start + one) - of(start - one)) / (2.0 * MOVED) for one in moved])
    worst = np.max(np.abs(there - slopes)) / np.max(np.abs(slopes))
    print(f"  {name}: largest difference over the largest slope {worst:.1e}")


def main() -> None:
    """Print all checks."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=float, default=2.0, help="steps in about the time that heats the layer")
    steps = parser.parse_args().steps
    checked("studies/paper_shear.yaml", "far_face", steps, both=True)
    checked("studies/paper_shear.yaml", "softening", steps, both=False)
    checked("studies/compare_shear.yaml", "softening", steps, both=False)


if __name__ == "__main__":
    main()
