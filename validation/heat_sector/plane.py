"""Heat in a plane of rectangles by finite volumes: what the drawings of both modules are heated with.

A drawing says what material is in each rectangle of a grid; neighbours conduct through their halves and through the
contact between them. The pads' two sides pump heat and leak it, through legs that the current heats where the drawing
has them; polymer melts between two temperatures with sharp
corners; borders lose heat by convection and radiation or give it to bodies of one temperature. Implicit steps of second
order (BDF2), Newton's method. Nothing of the product's heat equations is used. Temperatures in degC, for one metre.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import splu

PAD_FILM = 1.0 / 12.0
"""Thickness of each side of a pad, over the pad's; assumed. Between them are the legs, which fall evenly in temperature
and are heated evenly by the current."""
Array = NDArray[np.float64]
Whole = NDArray[np.int64]
STEFAN_BOLTZMANN = 5.670374419e-8
KELVIN = 273.15


@dataclass(frozen=True)
class Polymer:
    """A material that melts."""

    density: float
    conductivity_solid: float
    conductivity_melt: float
    specific_heat_solid: float
    specific_heat_melt: float
    latent_heat: float
    start: float
    end: float

    def molten(self, celsius: Array) -> Array:
        """Share that is molten."""
        return np.clip((celsius - self.start) / (self.end - self.start), 0.0, 1.0)

    def conductivity(self, celsius: Array) -> Array:
        """[W/m K]"""
        return self.conductivity_solid + self.molten(celsius) * (self.conductivity_melt - self.conductivity_solid)

    def heat(self, celsius: Array) -> tuple[Array, Array]:
        """Heat content of a volume [J/m3] and its derivative."""
        mean = 0.5 * (self.specific_heat_solid + self.specific_heat_melt)
        melting = self.latent_heat / (self.end - self.start) + mean
        below, above = np.minimum(celsius, self.start), np.maximum(celsius, self.end) - self.end
        within = np.clip(celsius, self.start, self.end) - self.start
        content = self.specific_heat_solid * below + melting * within + self.specific_heat_melt * above
        slope = np.where(celsius < self.start, self.specific_heat_solid, melting)
        slope = np.where(celsius > self.end, self.specific_heat_melt, slope)
        return self.density * content, self.density * slope


@dataclass(frozen=True)
class Material:
    """A solid, or still air; along the plane and up."""

    along: float
    up: float
    heat_capacity: float
    """Per volume [J/m3 K]."""
    radiates_over: float = 0.0
    """Width of a gap whose faces radiate to one another up through it [m], times their exchange factor."""


@dataclass(frozen=True)
class Pump:
    """Peltier pads of an area of one."""

    seebeck: float
    resistance: float
    conductance: float
    current: float


@dataclass(frozen=True)
class Body:
    """A body of one temperature, and what it gives to the air."""

    capacity: float
    surface: float = 0.0
    coefficient: float = 0.0
    emissivity: float = 0.0


@dataclass(frozen=True)
class Border:
    """Cells' faces that meet the air, or a body."""

    cells: Whole
    areas: Array
    coefficient: float
    """[W/m2 K]"""
    emissivity: float = 0.0
    body: int | None = None
    """Which body takes the heat; the air where none."""
    behind: Array | float = 0.0
    """Resistance of half of each cell, which heat passes to its face [m2 K/W]."""


@dataclass
class Plane:
    """A drawing, ready to be heated."""

    x: Array
    y: Array
    names: list[list[str | None]]
    """Material of each rectangle, by column."""
    materials: dict[str, Material]
    polymer: Polymer
    pump: Pump
    pump_along: bool
    """Whether the pads lie along the plane, their sides above one another; or stand, side by side."""
    contacts: dict[frozenset[str], float]
    """Conductance of contacts between materials [W/m2 K]; others touch perfectly."""
    ambient: float
    bodies: list[Body] = field(default_factory=list)
    borders: list[Border] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Number the cells; link neighbours."""
        self.number = -np.ones((len(self.x) - 1, len(self.y) - 1), dtype=int)
        places = [(i, j) for i, column in enumerate(self.names) for j, name in enumerate(column) if name]
        for cell, (i, j) in enumerate(places):
            self.number[i, j] = cell
        self.count, self.i, self.j = len(places), *np.array(places).T
        self.material = np.array([self.names[i][j] for i, j in places])
        self.dx, self.dy = np.diff(self.x)[self.i], np.diff(self.y)[self.j]
        self.volume = self.dx * self.dy
        self.middle = 0.5 * (self.x[1:] + self.x[:-1])[self.i], 0.5 * (self.y[1:] + self.y[:-1])[self.j]
        self.pcl = self.material == "layer"
        right = [(self.number[i, j], self.number[i + 1, j]) for i, j in places if i + 2 < len(self.x)]
        above = [(self.number[i, j], self.number[i, j + 1]) for i, j in places if j + 2 < len(self.y)]
        self.right, self.above = (
            np.array([p for p in pairs if p[1] >= 0], dtype=int).reshape(-1, 2) for pairs in (right, above)
        )
        self.size = self.count + len(self.bodies)
        self._own = {name: self.cells(name) for name in self.materials}
        self._touching = [self._contact(*pairs.T) for pairs in (self.right, self.above)]
        self._capacity = np.zeros(self.count)
        for name, own in self._own.items():
            self._capacity[own] = self.materials[name].heat_capacity * self.volume[own]

    def cells(self, name: str) -> Whole:
        """Cells of a material."""
        return np.flatnonzero(self.material == name)

    def facing(self, name: str, side: str) -> tuple[Whole, Array]:
        """Cells of a material whose face at a side (`left`, `right`, `below`, `above`) meets nothing, and its area."""
        di, dj = {"left": (-1, 0), "right": (1, 0), "below": (0, -1), "above": (0, 1)}[side]
        padded = np.pad(self.number, 1, constant_values=-1)
        own = self.cells(name)
        free = own[padded[self.i[own] + 1 + di, self.j[own] + 1 + dj] < 0]
        return free, (self.dy if di else self.dx)[free]

    def meets(self, name: str, side: str, coefficient: float, emissivity: float = 0.0, body: int | None = None) -> None:
        """Add a border of all free faces of a solid at a side; heat comes to them through half of their cells."""
        cells, areas = self.facing(name, side)
        deep, own = (self.dx, "along") if side in ("left", "right") else (self.dy, "up")
        behind = 0.5 * deep[cells] / getattr(self.materials[name], own)
        self.borders.append(Border(cells, areas, coefficient, emissivity, body, behind))

    def _conductivity(self, t: Array) -> tuple[Array, Array]:
        along, up = np.empty(self.count), np.empty(self.count)
        for name, material in self.materials.items():
            own = self._own[name]
            shine = 4.0 * STEFAN_BOLTZMANN * (t[own] + KELVIN) ** 3 * material.radiates_over
            along[own], up[own] = material.along, material.up + shine
        along[self.pcl] = up[self.pcl] = self.polymer.conductivity(t[: self.count][self.pcl])
        return along, up

    def _links(self, t: Array) -> tuple[Whole, Whole, Array]:
        """Pairs of neighbours and the conductances between them [W/K]."""
        along, up = self._conductivity(t)
        links = []
        ways = ((self.right, along, self.dx, self.dy), (self.above, up, self.dy, self.dx))
        for (pairs, k, depth, face), contact in zip(ways, self._touching, strict=True):
            a, b = pairs.T
            links.append((a, b, face[a] / (0.5 * depth[a] / k[a] + contact + 0.5 * depth[b] / k[b])))
        for border in self.borders:
            if border.body is not None:
                at = np.full(len(border.cells), self.count + border.body)
                through = border.coefficient / (1.0 + border.coefficient * border.behind)
                links.append((border.cells, at, through * border.areas))
        a, b, g = (np.concatenate(part) for part in zip(*links, strict=True))
        return a, b, g

    def _contact(self, a: Whole, b: Whole) -> Array:
        """Resistance of the contact between neighbours [m2 K/W]."""
        out = np.zeros(len(a))
        for pair, conductance in self.contacts.items():
            first, second = tuple(pair)
            met = (self.material[a] == first) & (self.material[b] == second)
            met |= (self.material[a] == second) & (self.material[b] == first)
            out[met] = 1.0 / conductance
        return out

    def _sources(self, t: Array) -> tuple[Array, Array]:
        """Heat that comes into each cell from pads and air [W], and its derivative."""
        heat, slope = np.zeros(self.size), np.zeros(self.size)
        p = self.pump
        joule = p.current**2 * p.resistance
        warms = {"legs": joule} if "legs" in self._own else {"hot": 0.5 * joule, "cold": 0.5 * joule}
        for name, watts in warms.items():
            heat[self._own[name]] += watts * self._faces(name)
        for name, sign in (("hot", 1.0), ("cold", -1.0)):
            own, share = self._own[name], self._faces(name)
            heat[own] += share * sign * p.seebeck * p.current * (t[own] + KELVIN)
            slope[own] += share * sign * p.seebeck * p.current
        for border in self.borders:
            if border.body is None:
                lossy = (border.coefficient, border.emissivity, border.behind)
                self._lose(heat, slope, t, border.cells, border.areas, *lossy)
        for k, body in enumerate(self.bodies):
            at = np.array([self.count + k])
            self._lose(heat, slope, t, at, np.array([body.surface]), body.coefficient, body.emissivity)
        return heat, slope

    def _faces(self, name: str) -> Array:
        """Return each cell's share of the pads' area [m2]: its volume over the part's thickness."""
        own = self._own[name]
        lines, at = (self.y, self.j[own]) if self.pump_along else (self.x, self.i[own])
        return self.volume[own] / float(np.max(lines[at + 1]) - np.min(lines[at]))

    def _lose(
        self, heat: Array, slope: Array, t: Array, at: Whole, areas: Array, coefficient: float, emissivity: float,
        behind: Array | float = 0.0,
    ) -> None:  # fmt: skip
        warm, air = t[at] + KELVIN, self.ambient + KELVIN
        shine = emissivity * STEFAN_BOLTZMANN
        outside = coefficient + shine * (warm**2 + air**2) * (warm + air)
        open_areas = areas / (1.0 + outside * behind)
        np.add.at(heat, at, -open_areas * outside * (warm - air))
        np.add.at(slope, at, -open_areas * (coefficient + 4.0 * shine * warm**3))

    def _content(self, t: Array) -> tuple[Array, Array]:
        """Heat of each cell and body [J], and its derivative."""
        slope = np.append(self._capacity, [body.capacity for body in self.bodies])
        content = slope * t
        pcl = np.flatnonzero(self.pcl)
        heat, rise = self.polymer.heat(t[pcl])
        content[pcl], slope[pcl] = heat * self.volume[pcl], rise * self.volume[pcl]
        return content, slope

    def heat(self, seconds: float, steps: int) -> tuple[Array, Array]:
        """Heat from ambient; times and temperatures of cells and bodies at each step."""
        t = np.full(self.size, self.ambient)
        dt = seconds / steps
        before = last = self._content(t)[0]
        states = [t]
        for step in range(steps):
            weights, known = (1.0, last) if step == 0 else (1.5, 2.0 * last - 0.5 * before)
            t = self._step(t, dt, weights, known)
            before, last = last, self._content(t)[0]
            states.append(t)
        return np.linspace(0.0, seconds, steps + 1), np.array(states)

    def _step(self, t: Array, dt: float, weight: float, known: Array) -> Array:
        for _ in range(30):
            a, b, g = self._links(t)
            source, slope = self._sources(t)
            content, rise = self._content(t)
            flow = g * (t[a] - t[b])
            gain = source - np.bincount(a, flow, self.size) + np.bincount(b, flow, self.size)
            residual = (weight * content - known) / dt - gain
            total = np.bincount(a, g, self.size) + np.bincount(b, g, self.size)
            off = coo_matrix((g, (a, b)), shape=(self.size, self.size))
            matrix = diags(weight * rise / dt + total - slope) - off - off.T
            change = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A").solve(-residual)
            t = t + change
            if np.max(np.abs(change)) < 1e-4:
                return t
        raise RuntimeError(f"a step of {dt} s did not settle: last change {np.max(np.abs(change)):.3g} K")


def lines(*parts: tuple[float, float, int, float], fine: float = 1.0) -> Array:
    """Ends of cells: of each part from, to, how many cells, how much wider each is than the one before.

    With `fine` each cell is divided into so many, which widen as the cells did: wide ones are divided as narrow ones.
    """
    ends: list[float] = [parts[0][0]]
    for start, end, count, ratio in parts:
        widths = ratio ** (np.arange(max(1, round(fine * count))) / fine)
        ends.extend(start + (end - start) * np.cumsum(widths) / widths.sum())
    return np.array(ends)


def drawn(x: Array, y: Array, what: Callable[[float, float], str | None]) -> list[list[str | None]]:
    """Material of each rectangle by that of its middle."""
    middles = 0.5 * (x[1:] + x[:-1]), 0.5 * (y[1:] + y[:-1])
    return [[what(float(a), float(b)) for b in middles[1]] for a in middles[0]]


def passed(times: Array, values: Sequence[float] | Array, limit: float) -> float:
    """First time at which rising values reach a limit; infinite where they never do."""
    above = np.asarray(values) >= limit
    if not np.any(above):
        return np.inf
    k = int(np.argmax(above))
    if k == 0:
        return float(times[0])
    part = (limit - values[k - 1]) / (values[k] - values[k - 1])
    return float(times[k - 1] + part * (times[k] - times[k - 1]))
