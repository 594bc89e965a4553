"""Many designs through the one set of equations: designs a second by each way there is to do it, and how exact.

The algebraic rows a study limits, as functions of a dozen inputs: the table's floats in a Python loop, the table on
numpy arrays, CasADi's `Function.map`, and the tape. The softening switch with its full heat model: the
product's simulator one by one, and many at once, with the largest difference between the two. CPU seconds, so that
what else the machine does counts less; with several threads wall seconds beside them.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.solve.batch.batch_model import kernel_of
from tvimdesign.solve.batch.cycle_kernel import CycleKernel, Pace
from tvimdesign.study import given, read_study

STUDY = Path(__file__).resolve().parents[1] / "studies/wrist_joint.yaml"
MOVING = ["wire_diameter", "coil_diameter", "coil_count", "preload_angle", "pcl_inner_radius", "pcl_outer_radius",
          "arc_span", "pcl_thickness", "core_radius", "spring_youngs_modulus", "link_thickness",
          "rotor_rim"]  # fmt: skip
OUTPUTS = ["spring_stiffness", "spring_index", "spring_static_safety", "spring_fatigue_safety", "preload_margin",
           "envelope_volume", "module_mass", "parts_inertia"]  # fmt: skip
OF_SWITCH = ["current", "ambient_temperature", "heater_seebeck", "heater_resistance", "pcl_thickness"]


def main() -> None:
    """Print the table of one study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--study", type=Path, default=STUDY)
    parser.add_argument("--designs", type=int, default=1 << 20)
    options = parser.parse_args()
    study = read_study(options.study)
    table = table_for(study.mode)
    known = given(study)
    model = DeviceFunctions(table, known, tuple(study.operating_points), study.solver.cells)
    arithmetic(model, options.designs)
    for event in ("far_face_time", "softening_time"):
        cycle(model, event, min(options.designs, 1 << 14))


def _columns(model: DeviceFunctions, names: list[str], count: int, width: float) -> np.ndarray:
    drawn = np.random.default_rng(1).uniform(1.0 - width, 1.0 + width, (len(names), count))
    return np.array([[model.start[model.index[name]]] for name in names]) * drawn


def _report_rate(name: str, count: int, do: Callable[[], object]) -> None:
    cpu, wall = time.process_time(), time.perf_counter()
    do()
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    print(f"{name:56s} {count / cpu:14,.0f} /CPU s {count / wall:14,.0f} /s")


def arithmetic(model: DeviceFunctions, count: int) -> None:
    """Time the rows that are arithmetic."""
    moving, inputs = ca.SX.sym("moving", len(MOVING)), ca.SX(ca.DM(model.start))
    for i, name in enumerate(MOVING):
        inputs[model.index[name]] = moving[i]
    values = model.outputs(OUTPUTS).call([inputs, ca.SX.ones(len(model.switch_names))], True, False)
    function = ca.Function("moving", [moving], values)
    began = time.perf_counter()
    kernel = kernel_of(model, OUTPUTS, MOVING, [])
    print(f"{len(OUTPUTS)} outputs of {len(MOVING)} inputs, {function.n_instructions()} operations; "
          f"compiled in {time.perf_counter() - began:.2f} s")  # fmt: skip
    columns = _columns(model, MOVING, count, 0.01)
    known = {**model.words, **dict(zip(model.names, model.start, strict=True))}
    few, some = columns[:, :500], np.ascontiguousarray(columns[:, : 1 << 14])

    def loop() -> None:
        for column in few.T:
            model.table.evaluate({**known, **dict(zip(MOVING, column, strict=True))}, OUTPUTS)

    def arrays() -> None:
        model.table.evaluate({**known, **dict(zip(MOVING, some, strict=True))}, OUTPUTS)

    _report_rate("the table's floats, a Python loop", few.shape[1], loop)
    _report_rate("the table on numpy arrays", some.shape[1], arrays)
    mapped = function.map(some.shape[1])
    _report_rate("Function.map", some.shape[1], lambda: np.asarray(mapped(some)))
    out = kernel(columns)
    _report_rate("tape, one thread", count, lambda: kernel(columns))
    _report_rate("tape, two threads", count, lambda: kernel(columns, workers=2))
    expected = np.asarray(function(ca.DM(few)))
    print(f"{'largest difference from CasADi':56s} {np.max(np.abs(out[:, :500] / expected - 1.0)):14.1e}")


def cycle(model: DeviceFunctions, event: str, count: int) -> None:
    """Time the softening switch, its full heat model included."""
    simulator = Simulator(model)
    began = time.perf_counter()
    kernel = CycleKernel(model, OF_SWITCH, [event])
    print(f"\n{event}, {model.cells} cells in the layer; recorded in {time.perf_counter() - began:.2f} s")
    nominal = simulator.run(model.start)
    ends = {name: nominal.values[phase.phase.ends] for name, phase in model.phases.items()}
    pace = Pace({**ends, "softening": nominal.values[event]}, nominal.balances)
    pace = kernel.fitted(pace, model.start[[model.index[name] for name in OF_SWITCH]])
    columns = _columns(model, OF_SWITCH, count, 0.02)
    kernel_times = kernel(columns, pace)[0]
    few = 20
    times = np.empty(few)

    def one_by_one() -> None:
        for i in range(few):
            inputs = model.start.copy()
            inputs[[model.index[name] for name in OF_SWITCH]] = columns[:, i]
            times[i] = simulator.run(inputs, phases=["softening"]).values[event]

    _report_rate("the simulator, one by one", few, one_by_one)
    _report_rate("steps, one thread", count, lambda: kernel(columns, pace))
    _report_rate("steps, two threads", count, lambda: kernel(columns, pace, workers=2))
    largest = 100.0 * np.max(np.abs(kernel_times[:few] / times - 1.0))
    print(f"{'largest difference from the simulator':56s} {largest:13.3f} %")


if __name__ == "__main__":
    main()
