"""Hold the network's heat flows against the table's rates at a random state, for every shipped study."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from engine_cells import ROWS
from engine_heat import flows, slopes
from engine_network import HEAT_UNIT, Array, Assembler, Network
from engine_steps import temperatures

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.symbols import symbols
from tvimdesign.study import given, read_study

TO_LIP = 6
"""Newton's steps to the temperatures of the lip."""


def difference(file: Path) -> float:
    """Return the largest difference of the rates over the largest rate. Raises where the network lacks an element."""
    study = read_study(file)
    model = DeviceFunctions(study.table, given(study), tuple(study.operating_points), study.solver.cells)
    found, current = model.phases["softening"], model.index["current"]
    assembler = Assembler(found._stack, model.cells, symbols(found._inputs)[current])
    net = assembler.network()
    written = ca.Function("numbers", [found._inputs], [assembler.numbers(), assembler.material()])
    q, m = (np.asarray(one).ravel() for one in written.call([model.start]))
    state = _state(model, found)
    rates = np.asarray(found.rates(state, model.start[current], model.start)).ravel()
    y = _nodes(state, net)
    if net.lip >= 0:
        for _ in range(TO_LIP):
            y[-2:] -= np.linalg.solve(_slopes(y, q, m, net)[-2:, -2:], _flows(y, q, m, net)[0][-2:])
    heat = _flows(y, q, m, net)[0]
    massive = net.nodes - (2 if net.lip >= 0 else 0)
    mine = heat[:massive] / q[:massive]
    theirs = _nodes(rates, net, offset=0.0)[:massive]
    return float(np.max(np.abs(mine - theirs) / np.max(np.abs(theirs))))


def _state(model: DeviceFunctions, phase: PhaseFunctions) -> Array:
    """Return a random state: some cells frozen, some molten, everything else up to 60 K above the start."""
    random, state = np.random.default_rng(0), np.asarray(phase.initial(model.start)).ravel()
    state = state + random.uniform(0.0, 0.6, state.size)
    state[2 : 2 + model.cells] += random.uniform(0.0, 2.0, model.cells)
    return state


def _nodes(state: Array, net: Network, offset: float = 273.15) -> Array:
    """Return the nodes of a state of the product's, whose order is cold, hot, cells, plate, bodies, legs."""
    n, plate = net.cells, net.plate
    warm = [state[2 + n : 2 + n + plate], state[:1], state[-1:], state[1:2], state[2 + n + plate : -1]]
    lip = [np.full(2, 0.5)] if net.lip >= 0 else []
    return np.concatenate([state[2 : 2 + n] * 1e5 / HEAT_UNIT, offset + 100.0 * np.concatenate([*warm, *lip])])


def _flows(y: Array, q: Array, m: Array, net: Network) -> tuple[Array, Array, Array]:
    p, t, f = np.zeros((ROWS, net.cells)), np.empty(net.nodes), np.empty(net.nodes)
    temperatures(y, y, 0.0, net, m, False, p, t)
    flows(t, p, q, m, net, False, f)
    return f, p, t


def _slopes(y: Array, q: Array, m: Array, net: Network) -> Array:
    (_, p, t), a = _flows(y, q, m, net), np.empty((net.nodes, net.nodes))
    slopes(t, p, q, m, net, False, a, 1.0, 1.0)
    return a


def main() -> None:
    """Print a line for every study."""
    for file in sorted(Path("studies").glob("*.yaml")):
        try:
            reason = f"rates off {difference(file):.0e}"
        except (NotImplementedError, ValueError) as error:
            reason = f"not covered: {error}"
        print(f"{file.stem:28}{reason}", flush=True)


if __name__ == "__main__":
    main()
