"""Heat in a strip of the module, in two dimensions: along the stack, and from the middle of an arc to beside it.

Plain finite volumes with scipy; nothing of the product's heat equations is used. A strip of half the width `half_width`
stands for the arc (its area over its perimeter), `beside` is as wide as plate and floor around it are. Nothing passes
the middle of the arc nor the end of the strip. Sharp corners of the melting curve, conduction between cells by the
integral of the conductivity, temperatures in degC, lengths in m, everything for one metre of strip.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.sparse import coo_matrix, csr_matrix

Array = NDArray[np.float64]
STEFAN_BOLTZMANN = 5.670374419e-8


@dataclass(frozen=True)
class Case:
    """What a strip is made of and what it meets; SI and degC."""

    half_width: float
    beside: float
    layer_depth: float
    plate_depth: float
    pad_depth: float
    floor_depth: float
    gap: float
    conductivity_solid: float
    conductivity_melt: float
    density: float
    specific_heat_solid: float
    specific_heat_melt: float
    latent_heat: float
    melting_start: float
    melting_end: float
    structure_conductivity: float
    structure_heat_capacity: float
    """Per volume."""
    pad_conductivity: float
    """In the plane of the pad."""
    pad_heat_capacity: float
    """Per area, both sides together [J/m2 K]."""
    pad_edge_contact: float
    hot_contact: float
    rotor_contact: float
    seebeck: float
    """Of all pads in series over their whole area [V/K m2], as are the next two."""
    resistance: float
    conductance: float
    window_share: float
    current: float
    ambient: float
    cold_coefficient: float
    rotor_coefficient: float
    floor_coefficient: float
    emissivity: float
    air_conductivity: float
    side_coefficient: float
    """From the layer's free side to the floor beside."""
    core_conductance: float
    """From the end of the plate's strip to core and link [W/m K]."""
    core_capacity: float
    """[J/m K]"""
    housing_conductance: float
    housing_capacity: float
    housing_surface: float
    """Outside of the housing for a metre of strip [m]."""
    sink_conductance: float = 0.0
    """From the cold side, where that has a sink in place of the air [W/m K]; none where it is zero."""
    sink_capacity: float = 1.0
    sink_surface: float = 0.0
    sink_coefficient: float = 0.0


@dataclass(frozen=True)
class Grid:
    """Cells through layer and plate, across the arc and beside it."""

    layer: int = 28
    plate: int = 8
    across: int = 16
    beside: int = 12


class Strip:
    """The strip as a sparse system of ordinary differential equations."""

    def __init__(self, case: Case, grid: Grid) -> None:
        """Number the unknowns: of a column across the arc cold and hot side, layer, plate; beside it floor, plate."""
        self.case, self.grid = case, grid
        c, g = case, grid
        # Across the arc cells get finer towards its edge, beside it towards the arc.
        self.dx = _widths(c.half_width, g.across, 0.88)
        self.dw = _widths(c.beside, g.beside, 0.88)[::-1]
        size = 2 + g.layer + g.plate
        index = np.arange(g.across * size).reshape(g.across, size)
        self.cold, self.hot = index[:, 0], index[:, 1]
        self.layer, self.plate = index[:, 2 : 2 + g.layer], index[:, 2 + g.layer :]
        rest = g.across * size + np.arange(g.beside * (1 + g.plate)).reshape(g.beside, 1 + g.plate)
        self.floor, self.beside = rest[:, 0], rest[:, 1:]
        self.core, self.housing = index.size + rest.size, index.size + rest.size + 1
        self.sink = self.housing + 1
        self.size = self.sink + 1
        self.capacity = self._capacities()
        self.dz, self.dp = c.layer_depth / g.layer, c.plate_depth / g.plate
        self.links = self._links()

    def _capacities(self) -> Array:
        c, g = self.case, self.grid
        out = np.empty(self.size)
        out[self.cold] = out[self.hot] = 0.5 * c.pad_heat_capacity * self.dx
        out[self.layer] = (c.density * c.layer_depth / g.layer * self.dx)[:, None]  # per kelvin times c: enthalpy
        out[self.plate] = (c.structure_heat_capacity * c.plate_depth / g.plate * self.dx)[:, None]
        out[self.beside] = (c.structure_heat_capacity * c.plate_depth / g.plate * self.dw)[:, None]
        out[self.floor] = c.structure_heat_capacity * c.floor_depth * self.dw
        out[[self.core, self.housing, self.sink]] = c.core_capacity, c.housing_capacity, c.sink_capacity
        return out

    def _links(self) -> csr_matrix:
        """Constant conductances between bodies that are not of PCL [W/K per metre], as a Laplacian."""
        c = self.case
        links: list[tuple[int, int, float]] = []

        def row(nodes: Array, widths: Array, k_depth: float) -> None:
            links.extend(
                (int(nodes[i]), int(nodes[i + 1]), 2.0 * k_depth / (widths[i] + widths[i + 1]))
                for i in range(len(nodes) - 1)
            )

        for side in (self.cold, self.hot):
            row(side, self.dx, 0.5 * c.pad_conductivity * c.pad_depth)
            into = 0.5 * self.dx[-1] / (0.5 * c.pad_conductivity * c.pad_depth)
            through = 1.0 / (0.5 * c.pad_edge_contact * c.pad_depth)
            away = 0.5 * self.dw[0] / (c.structure_conductivity * c.floor_depth)
            links.append((int(side[-1]), int(self.floor[0]), 1.0 / (into + through + away)))
        row(self.floor, self.dw, c.structure_conductivity * c.floor_depth)
        for layer in range(self.grid.plate):
            nodes = np.concatenate([self.plate[:, layer], self.beside[:, layer]])
            row(nodes, np.concatenate([self.dx, self.dw]), c.structure_conductivity * self.dp)
        for columns, widths in ((self.plate, self.dx), (self.beside, self.dw)):
            for column, width in zip(columns, widths, strict=True):
                links.extend((int(a), int(b), c.structure_conductivity * width / self.dp) for a, b in pairwise(column))
        links.extend((int(cell), self.core, c.core_conductance / self.grid.plate) for cell in self.beside[-1])
        links.append((int(self.floor[-1]), self.housing, c.housing_conductance))
        shares = self.dx / c.half_width * c.sink_conductance
        links.extend((int(cell), self.sink, share) for cell, share in zip(self.cold, shares, strict=True))
        i, j, w = (np.array(part) for part in zip(*links, strict=True))
        i, j = i.astype(int), j.astype(int)
        off = coo_matrix((w, (i, j)), shape=(self.size, self.size))
        off = off + off.T
        return (off - coo_matrix((np.asarray(off.sum(axis=1)).ravel(), (np.arange(self.size),) * 2))).tocsr()

    # --- the polymer ---

    def celsius(self, enthalpy: Array) -> Array:
        """Temperature of specific enthalpy."""
        return np.interp(enthalpy, *self._curve())

    def enthalpy(self, celsius: Array) -> Array:
        """Specific enthalpy of a temperature."""
        heats, temperatures = self._curve()
        return np.interp(celsius, temperatures, heats)

    def _curve(self) -> tuple[Array, Array]:
        c = self.case
        first = c.specific_heat_solid * c.melting_start
        mean = 0.5 * (c.specific_heat_solid + c.specific_heat_melt)
        last = first + c.latent_heat + mean * (c.melting_end - c.melting_start)
        heats = np.array([first - 300.0 * c.specific_heat_solid, first, last, last + 300.0 * c.specific_heat_melt])
        return heats, np.array([c.melting_start - 300.0, c.melting_start, c.melting_end, c.melting_end + 300.0])

    def _potential(self, t: Array) -> Array:
        c = self.case
        window = c.melting_end - c.melting_start
        above, beyond = np.maximum(t - c.melting_start, 0.0), np.maximum(t - c.melting_end, 0.0)
        molten = (above**2 - beyond**2) / (2.0 * window)
        return c.conductivity_solid * (t - c.melting_start) + (c.conductivity_melt - c.conductivity_solid) * molten

    def solid(self, celsius: Array) -> Array:
        """Share that is frozen."""
        c = self.case
        return np.clip((c.melting_end - celsius) / (c.melting_end - c.melting_start), 0.0, 1.0)

    def _conductivity(self, t: Array) -> Array:
        c = self.case
        return c.conductivity_melt + self.solid(t) * (c.conductivity_solid - c.conductivity_melt)

    # --- rates ---

    def temperatures(self, y: Array) -> Array:
        """Temperature of every cell."""
        t = y.copy()
        t[self.layer] = self.celsius(y[self.layer])
        return t

    def _radiation(self, a: Array | float, b: Array | float) -> Array | float:
        return STEFAN_BOLTZMANN * ((a + 273.15) ** 4 - (b + 273.15) ** 4)

    def _faces(self, t: Array) -> tuple[Array, Array]:
        """Flux into the layer and out of it, for each column."""
        c = self.case
        half = 0.5 * self.dz / self._conductivity(t[self.layer])
        into = (t[self.hot] - t[self.layer[:, 0]]) / (1.0 / c.hot_contact + half[:, 0])
        plate = 0.5 * self.dp / c.structure_conductivity
        out = (t[self.layer[:, -1]] - t[self.plate[:, 0]]) / (half[:, -1] + 1.0 / c.rotor_contact + plate)
        return into, out

    def far(self, t: Array) -> Array:
        """Temperature of the layer's face at the plate, in each column."""
        _, out = self._faces(t)
        return t[self.layer[:, -1]] - out * 0.5 * self.dz / self._conductivity(t[self.layer[:, -1]])

    def rates(self, y: Array) -> Array:
        """Time derivative of temperatures, and of the layer's enthalpies."""
        t = self.temperatures(y)
        watts = self.links @ t
        into, out = self._faces(t)
        theta = self._potential(t[self.layer])
        through = np.column_stack([into, -np.diff(theta, axis=1) / self.dz, out]) * self.dx[:, None]
        watts[self.hot] -= through[:, 0]
        watts[self.layer] += -np.diff(through, axis=1)
        watts[self.plate[:, 0]] += through[:, -1]
        apart = 0.5 * (self.dx[1:] + self.dx[:-1])
        across = -np.diff(theta, axis=0) / apart[:, None] * self.dz
        watts[self.layer[:-1]] -= across
        watts[self.layer[1:]] += across
        self._pads(t, watts)
        self._outside(t, watts)
        return watts / self.capacity

    def _pads(self, t: Array, watts: Array) -> None:
        c = self.case
        # Couples in series carry one current; each strip has the share of its area.
        hot, cold = t[self.hot], t[self.cold]
        leak = c.conductance * (hot - cold)
        joule = 0.5 * c.current**2 * c.resistance
        watts[self.hot] += (c.seebeck * c.current * (hot + 273.15) + joule - leak) * self.dx
        watts[self.cold] -= (c.seebeck * c.current * (cold + 273.15) - joule - leak) * self.dx

    def _outside(self, t: Array, watts: Array) -> None:
        c = self.case

        def lost(nodes: Array, coefficient: float, widths: Array) -> None:
            radiated = c.emissivity * self._radiation(t[nodes], c.ambient)
            watts[nodes] -= (coefficient * (t[nodes] - c.ambient) + radiated) * widths

        if c.sink_conductance:
            radiated = c.emissivity * self._radiation(t[self.sink], c.ambient)
            watts[self.sink] -= c.sink_surface * (c.sink_coefficient * (t[self.sink] - c.ambient) + radiated)
        else:
            lost(self.cold, c.cold_coefficient, self.dx * c.window_share)
        lost(self.plate[:, -1], c.rotor_coefficient, self.dx)
        lost(self.beside[:, -1], c.rotor_coefficient, self.dw)
        lost(self.floor, c.floor_coefficient, self.dw)
        radiated = c.emissivity * self._radiation(t[self.housing], c.ambient)
        watts[self.housing] -= c.housing_surface * (c.floor_coefficient * (t[self.housing] - c.ambient) + radiated)
        above, below = t[self.beside[:, 0]], t[self.floor]
        between = c.emissivity / (2.0 - c.emissivity) if c.emissivity else 0.0
        flow = (c.air_conductivity / c.gap * (above - below) + between * self._radiation(above, below)) * self.dw
        watts[self.beside[:, 0]] -= flow
        watts[self.floor] += flow
        half = 0.5 * self.dx[-1] / self._conductivity(t[self.layer[-1]])
        if c.side_coefficient:
            side = (t[self.layer[-1]] - t[self.floor[0]]) / (half + 1.0 / c.side_coefficient) * self.dz
            watts[self.layer[-1]] -= side
            watts[self.floor[0]] += np.sum(side)

    def pattern(self) -> csr_matrix:
        """Which rates depend on which unknowns."""
        near = (self.links != 0).astype(float) + coo_matrix(np.diag(np.ones(self.size)))
        pairs = [(self.cold, self.hot), (self.hot, self.layer[:, 0]), (self.layer[:, -1], self.plate[:, 0]),
                 (self.beside[:, 0], self.floor)]  # fmt: skip
        pairs += [(self.layer[:, k], self.layer[:, k + 1]) for k in range(self.grid.layer - 1)]
        pairs += [(self.layer[k], self.layer[k + 1]) for k in range(self.grid.across - 1)]
        pairs += [(self.layer[-1], np.full(self.grid.layer, self.floor[0]))]
        i, j = (np.concatenate([np.ravel(pair[side]) for pair in pairs]) for side in (0, 1))
        more = coo_matrix((np.ones(len(i)), (i, j)), shape=(self.size, self.size))
        return (near + more + more.T).tocsr()


def _widths(whole: float, count: int, ratio: float) -> Array:
    """Widths that fall by a ratio from the first to the last."""
    steps = ratio ** np.arange(count)
    return whole * steps / np.sum(steps)


@dataclass(frozen=True)
class Heating:
    """A strip heated from ambient: times, and temperatures of every column's layer."""

    strip: Strip
    times: Array
    states: Array

    def far_mean(self) -> Array:
        """Mean over the arc of the layer's far face at each time."""
        shares = self.strip.dx / self.strip.case.half_width
        return np.array([shares @ self.strip.far(self.strip.temperatures(y)) for y in self.states.T])

    def passed(self, values: Array, limit: float) -> float:
        """First time at which rising values reach a limit; infinite where they never do."""
        above = values >= limit
        if not np.any(above):
            return np.inf
        k = int(np.argmax(above))
        if k == 0:
            return float(self.times[0])
        part = (limit - values[k - 1]) / (values[k] - values[k - 1])
        return float(self.times[k - 1] + part * (self.times[k] - self.times[k - 1]))


def heat(case: Case, seconds: float, grid: Grid | None = None, samples: int = 601) -> Heating:
    """Heat a strip from ambient for some seconds."""
    strip = Strip(case, grid or Grid())
    begin = np.full(strip.size, case.ambient)
    begin[strip.layer] = strip.enthalpy(np.full(strip.layer.shape, case.ambient))
    times = np.linspace(0.0, seconds, samples)
    found = solve_ivp(
        lambda _, y: strip.rates(y), (0.0, seconds), begin, method="BDF", t_eval=times, rtol=1e-5, atol=1e-3,
        jac_sparsity=strip.pattern(),
    )  # fmt: skip
    if not found.success:
        raise RuntimeError(found.message)
    return Heating(strip, found.t, found.y)


def case_from(numbers: dict[str, float]) -> Case:
    """A case from numbers by name; unknown names are refused by the constructor."""
    known = {field.name for field in fields(Case)}
    unknown = set(numbers) - known
    if unknown:
        raise ValueError(
            f"no such number of a strip: {', '.join(sorted(unknown))}; a strip has {', '.join(sorted(known))}"
        )
    return Case(**numbers)
