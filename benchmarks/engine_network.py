"""The network of a stack as data: nodes, links, surfaces and cells as arrays, written by CasADi from the table.

A link ends at a place, which is a weighted sum of nodes. Heat that a place receives is spread over the nodes by the
same weights. So all that conducts linearly, the pads included, becomes one sparse matrix. Radiation, surfaces and the
layer that changes phase are short lists of their own. Nodes: cells of the layer, cells of the plate, cold side, middle
of the legs, hot side, bodies beside the plate, bodies around the pads. A lip at the layer's end is two nodes more,
without heat capacity: its temperature if the layer conducted alike everywhere, and its temperature.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.heat_flow import heat, lumps, peltier
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.working_cycle.casadi_setup import ca

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Weights = Mapping[int, Any]
AIR = -1
"""The ambient, as if it were a node."""
HEAT_UNIT = 1e3
"""Enthalpy of a cell that counts as one, as a kelvin of the other nodes does [J/kg]."""
STEPS, SOFTENING, FREEZING = 1.0, 2.5, 8.0
"""Steps in about the time that the pads at their power would need to heat the layer; how many times more to an event of
the impedance, and of a layer that freezes."""


NONE = np.zeros(0)


class Network(NamedTuple):
    """The constant shape of a network."""

    nodes: int
    cells: int
    """Of the layer; they are the first nodes."""
    plate: int
    """Cells of the plate; they come next, then cold side, middle of the legs and hot side."""
    rows: Integers
    """Of the entries of the linear conduction."""
    columns: Integers
    exposed: Integers
    """Node of each surface."""
    radiating: Integers
    """Pairs of nodes that radiate to one another, a row each."""
    linear: int
    """Where the linear entries begin in the numbers, after the heat capacities of the nodes."""
    constant: int
    """Where the constant heat of each node begins."""
    surface: int
    """Five numbers of each surface: area, convection, emissivity times sigma, resistance to the face and in series."""
    pairs: int
    """Conductance of each radiating pair."""
    layer: int
    """Area over depth of a cell, ways to pads and plate, half a cell of the plate; Seebeck coefficient, resistance and
    current of the pads; time of a step; conductance from each cell and from the pads to the lip."""
    lip: int
    """First node of the lip; below zero without one."""
    beside: int
    """Bodies beside the plate, the core last."""
    impedance: int
    """Where the numbers of the joint begin: `engine_joint`."""
    layer_columns: int
    """Columns of the layer; none where the impedance is not watched."""
    column_shares: Array
    fed_evenly: Array
    below: Integers
    """Rows that are not zero below each diagonal entry of the factored matrix, column after column."""
    below_at: Integers
    """Where each column begins there."""
    right: Integers
    """Columns that are not zero to the right of each diagonal entry, row after row."""
    right_at: Integers
    left: Integers
    """Columns that are not zero to the left of each diagonal entry, row after row."""
    left_at: Integers


class Assembler:
    """Collect what a stack conducts, by nodes."""

    def __init__(self, stack: heat.Stack, cells: int, current: Any, steps: float = STEPS) -> None:
        """Number the nodes and stamp every element of the stack."""
        if stack.sink is not None or stack.liner is not None or stack.legs_capacity is None:
            raise NotImplementedError("sinks, liners, and pads without heat capacity")
        self.stack, self.cells, self.current, self.steps = stack, cells, current, steps
        first = cells + stack.plate_cells
        self.cold, self.legs, self.hot, self.beside = first, first + 1, first + 2, first + 3
        self.around = self.beside + len(stack.beside)
        self.size = self.around + len(stack.around)
        self.lip = -1
        if stack.lip is not None:
            self.lip, self.size = self.size, self.size + 2
        self.matrix: dict[tuple[int, int], Any] = {}
        self.constant: list[Any] = [0.0] * self.size
        self.surfaces: list[tuple[int, tuple[Any, ...]]] = []
        self.radiating: list[tuple[int, int, Any]] = []
        self.plate_half = 0.5 * stack.plate_thickness / stack.plate_cells / (stack.plate_conductivity * stack.area)
        for stamp_part in (self._pads, self._plate, self._links, self._surfaces, self._lip):
            stamp_part()

    def stamp(self, conductance: Any, seen: Weights, given: Weights) -> None:
        """Add heat, `conductance` times the sum of temperatures `seen`, spread over the nodes by `given`."""
        for row, share in given.items():
            for column, weight in seen.items():
                value = conductance * share * weight
                if row != AIR and column == AIR:
                    self.constant[row] = self.constant[row] + value * self.stack.ambient
                elif row != AIR:
                    self.matrix[row, column] = self.matrix.get((row, column), 0.0) + value

    def conduct(self, conductance: Any, first: Weights, second: Weights) -> None:
        """Join two places by a conductance [W/K]."""
        self.stamp(conductance, _less(second, first), _less(first, second))

    def place(self, place: lumps.Place) -> Weights:
        """Return the weights of the nodes in a place."""
        group, i = place
        if group == "legs":
            tilt = (0.0, peltier.OF_HALF, -peltier.OF_HALF)[i]
            return {self.cold: 1.0 / 6.0 - tilt, self.legs: 4.0 / 6.0, self.hot: 1.0 / 6.0 + tilt}
        if group in ("layer", "plate"):
            first, count = (0, self.cells) if group == "layer" else (self.cells, self.stack.plate_cells)
            return {first + k: 1.0 / count for k in range(count)}
        single = {"ambient": AIR, "cold": self.cold, "hot": self.hot, "face": self.cells}
        return {single[group] if group in single else getattr(self, group) + i: 1.0}

    def _pads(self) -> None:
        pads, cold, legs, hot = self.stack.peltier, self.cold, self.legs, self.hot
        self.conduct(pads.conductance, {hot: 1.0}, {cold: 1.0})
        self.stamp(8.0 / 3.0 * pads.conductance, {legs: 1.0, hot: -0.5, cold: -0.5}, {hot: 1.0, cold: 1.0, legs: -2.0})
        self.stamp(pads.seebeck * self.current, {hot: 1.0}, {hot: 1.0})
        self.stamp(pads.seebeck * self.current, {cold: 1.0}, {cold: -1.0})
        for node, share in ((cold, peltier.OF_SIDE), (legs, peltier.OF_MIDDLE), (hot, peltier.OF_SIDE)):
            self.constant[node] = self.constant[node] + share * self.current**2 * pads.resistance
        made = self.stack.motion_heat + self.current**2 * self.stack.layer_resistance / self.cells
        self.constant[: self.cells] = [made] * self.cells

    def _plate(self) -> None:
        stack, count = self.stack, self.stack.plate_cells
        for k in range(self.cells, self.cold - 1):
            self.conduct(0.5 / self.plate_half, {k: 1.0}, {k + 1: 1.0})
        even, mean = stack.beside[0].conductance / count, self.place(("plate", 0))
        uneven = even if stack.uneven_conductance is None else stack.uneven_conductance / count
        for k in range(self.cells, self.cold):
            self.stamp(even, _less(mean, {self.beside: 1.0}), {k: -1.0, self.beside: 1.0})
            self.stamp(uneven, _less({k: 1.0}, mean), {k: -1.0, self.beside: 1.0})
        for i, lump in enumerate(stack.beside[1:], self.beside):
            self.conduct(lump.conductance, {i: 1.0}, {i + 1: 1.0})

    def _links(self) -> None:
        falling = 2.0 * (1.0 - (np.arange(self.cells) + 0.5) / self.cells) / self.cells
        for link in self.stack.links:
            if link.slope is not None or "spreader" in (link.first[0], link.second[0]):
                raise NotImplementedError("links along a slope or from a spreader")
            first, second = self.place(link.first), self.place(link.second)
            parts = [{node: 1.0} for node in first] if link.first[0] in ("layer", "plate") else [first]
            for part in parts:
                self.conduct(link.conductance / len(parts), part, second)
            if link.of_layer is not None:
                given = {**first, **dict(enumerate((-falling).tolist()))}
                self.stamp(link.of_layer * link.conductance, _less(first, second), given)
            if not _is_zero(link.radiating_area):
                (one,), (other,) = first, second
                self.radiating.append((one, other, link.radiating_area * lumps.STEFAN_BOLTZMANN))

    def _surfaces(self) -> None:
        stack = self.stack
        everywhere: list[tuple[int, lumps.Surface]] = [(self.cold, stack.cold_surface)]
        everywhere += [(self.beside + i, lump.surface) for i, lump in enumerate(stack.beside)]
        everywhere += [(self.around + i, body.surface) for i, body in enumerate(stack.around)]
        outer = stack.plate_surface._replace(area=stack.area)
        for node, one in (*everywhere, (self.cold - 1, outer)):
            if not _is_zero(one.area):
                behind = 0.0 if one.behind is None else one.behind
                series = self.plate_half * stack.area if one is outer else behind
                self.surfaces.append(
                    (node, (one.area, one.coefficient, one.emissivity * lumps.STEFAN_BOLTZMANN, behind, series))
                )

    def _lip(self) -> None:
        if self.stack.lip is None:
            return
        lip, alike, found = self.stack.lip, self.lip, self.lip + 1
        layer, pads = self.place(("layer", 0)), {self.hot: 1.0}
        self.stamp(lip.slices, _less(layer, {alike: 1.0}), {alike: 1.0})
        self.stamp(lip.pads, _less(pads, {alike: 1.0}), {alike: 1.0})
        for arm in lip.arms:
            mean: dict[int, Any] = {}
            for place, weight in arm.ends:
                for node, share in self.place(place).items():
                    mean[node] = mean.get(node, 0.0) + weight * share
            self.stamp(arm.conductance, _less(mean, {alike: arm.share}), {alike: arm.share})
            self.stamp(arm.conductance, _less(mean, {found: arm.share}), _less({found: arm.share}, mean))

    def capacities(self) -> list[Any]:
        """Return the heat capacity of every node [J/K]; of a cell of the layer for `HEAT_UNIT`."""
        stack = self.stack
        side, middle = (share * stack.legs_capacity for share in (peltier.OF_SIDE, peltier.OF_MIDDLE))
        mass = stack.density * stack.area * stack.thickness / self.cells
        plate = stack.plate_heat_capacity * stack.area * stack.plate_thickness / stack.plate_cells
        pads = [stack.cold_capacity + side, middle, stack.hot_capacity + side]
        bodies = [*(lump.capacity for lump in stack.beside), *(body.capacity for body in stack.around)]
        massless = [0.0] * (0 if self.lip < 0 else 2)
        return [mass * HEAT_UNIT] * self.cells + [plate] * stack.plate_cells + pads + bodies + massless

    def step_time(self) -> Any:
        """Return about the time of a step [s]: the layer's heat over the pads' power."""
        stack, melting = self.stack, self.stack.melting
        heat_of_layer = melting.latent_heat + melting.specific_heat_melt * (melting.end - stack.ambient)
        power = self.current * stack.peltier.seebeck * 330.0 + 0.5 * self.current**2 * stack.peltier.resistance
        size, steps = np.sqrt(power**2 + 0.01), self.steps * (1.0 if stack.freezing is None else FREEZING)
        return stack.density * stack.area * stack.thickness * heat_of_layer / size / steps

    def numbers(self) -> Any:
        """Return all numbers of the network below one another (SX), in the order of `Network`."""
        stack = self.stack
        of_layer = (
            stack.area * self.cells / stack.thickness,
            1.0 / (stack.hot_contact * stack.area),
            1.0 / (stack.plate_contact * stack.area) + self.plate_half,
            self.plate_half,
        )
        of_pads = (stack.peltier.seebeck, stack.peltier.resistance, self.current)
        blocks = (
            *self.capacities(), *self.matrix.values(), *self.constant,
            *(one for _, numbers in self.surfaces for one in numbers),
            *(conductance for *_, conductance in self.radiating), *of_layer, *of_pads, self.step_time(),
            *((0.0, 0.0) if stack.lip is None else (stack.lip.slices / self.cells, stack.lip.pads)),
        )  # fmt: skip
        return ca.vertcat(*blocks)

    def network(self, shares: Array = NONE, fed: Array = NONE) -> Network:
        """Return the constant shape; with shares of the layer's columns, and how far each is below its mean."""
        rows, columns = np.array(list(self.matrix), dtype=np.int64).T.copy()
        linear = self.size
        constant = linear + len(self.matrix)
        surface = constant + self.size
        pairs = surface + 5 * len(self.surfaces)
        layer = pairs + len(self.radiating)
        joined = np.array([pair[:2] for pair in self.radiating], dtype=np.int64).reshape(-1, 2)
        exposed = np.array([node for node, _ in self.surfaces], dtype=np.int64)
        return Network(self.size, self.cells, self.stack.plate_cells, rows, columns, exposed, joined, linear, constant,
                       surface, pairs, layer, self.lip, len(self.stack.beside), layer + 10, len(shares), shares, fed,
                       *self._pattern())  # fmt: skip

    def _pattern(self) -> list[Integers]:
        """Return where the factors of the network's matrix are not zero."""
        filled = np.eye(self.size, dtype=bool)
        pairs = [*self.matrix, *((a, b) for a, b, _ in self.radiating), (0, self.hot)]
        if self.lip >= 0:
            pairs += [(a, self.lip + i) for a in (*range(self.cells), self.hot, self.lip) for i in (0, 1)]
        for a, b in (*pairs, *((k, k + 1) for k in range(self.cells))):
            filled[a, b] = filled[b, a] = True
        for k in range(self.size):
            filled[k + 1 :, k + 1 :] |= np.outer(filled[k + 1 :, k], filled[k, k + 1 :])
        found: list[Integers] = []
        for half in (np.tril(filled, -1).T, np.triu(filled, 1), np.tril(filled, -1)):
            found += [np.nonzero(half)[1], np.concatenate([[0], np.cumsum(half.sum(axis=1))])]
        return found

    def material(self) -> Any:
        """Return what the layer's material is (SX), without derivatives: see `engine_heat.MATERIAL`."""
        stack, melting = self.stack, self.stack.melting
        equilibrium = (
            melting.specific_heat_solid, melting.specific_heat_melt, melting.enthalpy_start, melting.enthalpy_end,
            melting.start, melting.end, melting.smoothing, stack.conductivity_solid, stack.conductivity_melt,
            stack.ambient, polymer.enthalpy(stack.ambient, melting),
        )  # fmt: skip
        return ca.vertcat(*equilibrium, *(stack.freezing or ()))


def _less(first: Weights, second: Weights) -> dict[int, Any]:
    """Return the difference of two places, by nodes."""
    found = dict(first)
    for node, weight in second.items():
        found[node] = found.get(node, 0.0) - weight
    return found


def _is_zero(value: Any) -> bool:
    return isinstance(value, float) and value == 0.0
