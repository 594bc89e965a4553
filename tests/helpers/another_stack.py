"""The stack of the shear module written once more: sharp corners, temperatures in degC, ten times the cells.

Heat, plate and floor beside the arcs with the gap between them, melting, freezing with kinetics, convection and
radiation, from the numbers of a design alone.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

Array = NDArray[np.float64]
CELLS, PLATE_CELLS = 120, 40
STEFAN_BOLTZMANN = 5.670374419e-8
GAS = 8.314462618
LAYER, PLATE = slice(2, 2 + CELLS), slice(2 + CELLS, 2 + CELLS + PLATE_CELLS)
BESIDE, FLOOR = slice(PLATE.stop, PLATE.stop + 4), slice(PLATE.stop + 4, PLATE.stop + 13)
LEGS, SINK = FLOOR.stop, FLOOR.stop + 1
UPPER, LOWER, LEDGES, CORNER, HOUSING = np.arange(3), np.arange(3, 6), 6, 7, 8
"""Places in the floor: beside the pads in three widths, below those, below the pads, next to their hot sides."""
STRIPS, WAYS = np.array([0.087, 0.247, 0.666]), np.array([0.029, 0.153, 0.395])
"""Widths of the three bodies a strip is divided into and the way to each, as shares."""
PARABOLA = np.array([[7.0, -8.0, 1.0], [-8.0, 16.0, -8.0], [1.0, -8.0, 7.0]]) / 3.0
"""Heat that a bar's two ends and its middle between them give to it, over its conductance and their temperatures."""
UPPER_HALF, LOWER_HALF = np.array([-1.0, 8.0, 5.0]) / 12.0, np.array([5.0, 8.0, -1.0]) / 12.0
"""Means of that parabola over half of the bar, from its values at the cold end, in the middle and at the hot end."""
SIMPSON = np.array([1.0, 4.0, 1.0]) / 6.0


def value_of(model: DeviceFunctions) -> Callable[[str], float]:
    """Numbers of a model's inputs, and of its outputs that no simulation supplies."""
    computed = model.values(model.start, dict.fromkeys(model.switch_names, 0.0))
    return lambda name: float(model.start[model.index[name]]) if name in model.index else computed[name]


@dataclass
class AnotherStack:
    """State: cold and hot side, layer's enthalpies, plate, strip and core, floor and housing, legs, sink, psi.

    The sink is there where the module has one, psi where the layer freezes with kinetics.
    """

    value: Callable[[str], float]
    sink: bool = False
    kinetic: bool = False

    def __post_init__(self) -> None:
        v = self.value
        self.area = 0.5 * v("arc_count") * v("arc_span") * (v("pcl_outer_radius") ** 2 - v("pcl_inner_radius") ** 2)
        ledge, inner = v("window_ledge"), v("pcl_inner_radius")
        opening = v("arc_count") * (v("arc_span") - 2.0 * ledge / inner)
        self.window = 0.5 * opening * ((v("pcl_outer_radius") - ledge) ** 2 - (inner + ledge) ** 2)
        share = self.area / v("heater_area")
        self.seebeck, self.ohms, self.leak = (
            share * v(f"heater_{name}") for name in ("seebeck", "resistance", "conductance")
        )
        # A twelfth of the pads is either side, the legs between them ten.
        self.cold, self.middle, _ = (
            share
            * v("heater_unit_mass")
            * v("heater_specific_heat")
            * (np.array([1.0, 0.0, 1.0]) + 10.0 * SIMPSON)
            / 12.0
        )
        self.edge = v("arc_count") * (2.0 * (v("pcl_outer_radius") - inner) + v("arc_span") * self._radii())
        self._lumps()
        self.cell = v("pcl_thickness") / CELLS
        self.plate_cell = v("rotor_thickness") / PLATE_CELLS
        plate_heat = v("structure_density") * v("structure_specific_heat") * self.plate_cell * self.area
        self.mass = v("pcl_density") * self.area * self.cell
        sinks = [v("sink_capacity")] if self.sink else []
        layer, plate = np.full(CELLS, self.mass), np.full(PLATE_CELLS, plate_heat)
        self.capacities = np.concatenate([[self.cold] * 2, layer, plate, *self.lumps, [self.middle], sinks])
        self.start, self.end = v("pcl_melting_start") - 273.15, v("pcl_melting_end") - 273.15
        solid, melt = v("pcl_specific_heat_solid"), v("pcl_specific_heat_melt")
        first = solid * self.start
        last = first + v("pcl_latent_heat") + 0.5 * (solid + melt) * (self.end - self.start)
        self.curve = np.array([first - 400.0 * solid, first, last, last + 400.0 * melt])
        self.celsius = np.array([self.start - 400.0, self.start, self.end, self.end + 400.0])
        self.ambient = v("ambient_temperature") - 273.15

    def _radii(self) -> float:
        return self.value("pcl_inner_radius") + self.value("pcl_outer_radius")

    def _lumps(self) -> None:
        """Plate and floor beside the arcs, strips heated at their edge, with the core and the housing at their ends."""
        v = self.value
        k, rho_c = v("structure_conductivity"), v("structure_density") * v("structure_specific_heat")
        height = v("rotor_thickness")
        rotor = v("pcl_outer_radius") + v("rotor_rim")
        disc = np.pi * rotor**2
        self.beside = disc - self.area
        wide, arc = self.beside / self.edge, self.area / self.edge
        # A plate that the layer heats has the profile cosh x y: its mean, and how steep it is at the edge.
        x = arc * np.sqrt(
            0.5 * (v("pcl_conductivity_solid") + v("pcl_conductivity_melt")) / v("pcl_thickness") / k / height
        )
        way = arc * (np.cosh(x) - np.sinh(x) / x) / (x * np.sinh(x))
        far = (v("rotor_mass") + v("link_mass") + v("retainer_mass")) / v("structure_density") - disc * height
        near = STRIPS * self.beside
        inner = v("pcl_inner_radius") / v("core_radius")
        along = way / self.edge
        to_core = (1.0 - np.sum(WAYS)) * wide / self.edge + np.log(inner) / (2.0 * np.pi)
        ways = np.append(WAYS * wide / self.edge, to_core) / (k * height)
        self.to_beside = 1.0 / (ways + np.array([along / (k * height), 0.0, 0.0, 0.0]))
        self.uneven = k * height * self.edge / (way + height / np.pi)
        self.strips = np.append(near, 0.0)
        pad, web = v("heater_thickness"), v("floor_thickness") - v("heater_thickness")
        ledges = self.area - self.window
        volumes = np.concatenate([near * pad, near * web, [ledges * web, 0.5 * near[0] * pad]])
        volumes[UPPER[0]] *= 0.5
        housing = v("housing_mass") / v("structure_density") - np.sum(volumes)
        self.lumps = np.append(near * height, far) * rho_c, np.append(volumes, housing) * rho_c
        outer, tall = v("housing_outer_radius"), v("rim_level") + v("floor_thickness") + v("foot_height")
        outside = 2.0 * np.pi * outer * tall + np.pi * (outer**2 - rotor**2)
        self.below = np.concatenate([np.zeros(3), near, [ledges, 0.0, outside]])
        # A body that is warmed evenly is colder at its face by a third of its depth.
        self.to_face = height / 3.0 / k, np.array([0.0] * 3 + [web] * 4 + [0.0] * 2) / 3.0 / k
        self._floor(wide, arc / 3.0, rotor)
        # Between the middle of the floor's upper half and a third of the plate's depth lies the gap.
        walls = (height / 3.0 + 0.5 * pad) / k
        shine = v("surface_emissivity") / (2.0 - v("surface_emissivity")) * STEFAN_BOLTZMANN
        air = v("air_conductivity") / v("pcl_thickness")
        share = 1.0 / (1.0 + walls * (air + 4.0 * shine * v("ambient_temperature") ** 3))
        self.gap_air, self.gap_shine = share * air * near, share * shine * near

    def _floor(self, wide: float, way: float, rotor: float) -> None:
        """Conductances among the floor's bodies, and from the pads into them [W/K]."""
        v, edge = self.value, self.edge
        k, pad, web = v("structure_conductivity"), v("heater_thickness"), v("floor_thickness") - v("heater_thickness")
        among = self.among = np.zeros((9, 9))

        def join(a: int, b: int, conductance: float) -> None:
            among[a, b] = among[b, a] = conductance

        apart, beyond, widths = WAYS[1:] * wide, (1.0 - np.sum(WAYS)) * wide, STRIPS * wide
        for row, deep in ((UPPER, pad), (LOWER, web)):
            for i in range(2):
                join(row[i], row[i + 1], k * deep * edge / apart[i])
            wall = np.log(v("housing_inner_radius") / rotor) / (2.0 * np.pi * k * deep)
            join(row[2], HOUSING, 1.0 / (beyond / (k * deep * edge) + wall))
        # The lower strip's last part is colder than its body by a share of the way to its end, which loses heat too.
        share, along = 1.0 - 0.5 * STRIPS[2] * wide / beyond, k * web * edge / beyond
        air = (
            v("housing_coefficient") + 4.0 * v("surface_emissivity") * STEFAN_BOLTZMANN * v("ambient_temperature") ** 3
        )
        ends = share * STRIPS[2] * self.beside
        total = along + 1.0 / wall + ends / (1.0 / air + web / (3.0 * k))
        join(LOWER[2], HOUSING, along / (wall * total))
        self.below[LOWER[2]] -= ends * (1.0 - along / total)
        self.below[HOUSING] += ends / (wall * total)
        # The first of the upper ones is two, one above the other.
        join(UPPER[0], UPPER[1], 0.5 * among[UPPER[0], UPPER[1]])
        join(CORNER, UPPER[1], among[UPPER[0], UPPER[1]])
        join(CORNER, UPPER[0], k * widths[0] * edge / (0.5 * pad))
        # What is above a slab that cools below warms its lower face less than its mean: a sixth of its depth.
        areas = np.append(widths * edge, self.area - self.window)
        onto = np.append((np.array([0.25, 0.5, 0.5]) * pad + web / 3.0) / (k * areas[:3]), 0.0)
        across = web / 6.0 / (k * areas)
        ledge = (self.area - self.window) / edge
        join(LEDGES, LOWER[0], k * web * edge / (ledge / 3.0 + WAYS[0] * wide))
        side = 0.5 * pad * edge
        wall = way / (v("pad_conductivity") * side) + 1.0 / (v("pad_edge_contact") * side) + WAYS[0] * wide / (k * side)
        self.from_cold, self.from_hot = np.zeros(9), np.zeros(9)
        self.from_legs = np.zeros(9)
        # Of either half of the pads a sixth is a side, the rest half of the legs' parabola.
        self.from_cold[UPPER[0]] = self.from_hot[CORNER] = 1.0 / 6.0 / wall
        self.from_legs[[UPPER[0], CORNER]] = 5.0 / 6.0 / wall
        self._ledges(ledge, web, onto, across)
        self._layer_s_end()

    def _ledges(self, ledge: float, web: float, onto: Array, across: Array) -> None:
        """Return what leads onto ledges, and how much colder their lower face is than their mean."""
        k, edge = self.value("structure_conductivity"), self.edge
        # A slab of the web's depth heated evenly over a part of its face that ends free: cosines over its depth.
        waves = np.pi * np.arange(1, 2001) / web
        falling = 2.0 * ledge / waves - (1.0 - np.exp(-2.0 * waves * ledge)) / waves**2
        terms, sign = falling / (waves * web * ledge**2) / (k * edge), (-1.0) ** np.arange(1, 2001)
        onto[3], across[3] = np.sum(terms) + self._along_cold(ledge), -np.sum(sign * terms)
        self.onto, self.across = onto, across
        self.into_sink = self.window / (
            1.0 / self.value("sink_contact") + self.window * self._along_cold(self.area / edge - ledge)
        )

    def _along_cold(self, touched: float) -> float:
        """From the mean of the pads' cold sides to where they are touched for so much of half their width [K/W].

        What is drawn there evenly and comes evenly is cosines over the half width, which legs and side pass along.
        """
        v = self.value
        wide, pad, k = self.area / self.edge, v("heater_thickness"), v("pad_conductivity")
        up, film = self.leak / self.area * pad, pad / 12.0
        waves = np.pi * np.arange(1, 9) / wide
        drawn = 2.0 * np.sin(waves * touched) / (waves * wide * touched)
        legs = np.sqrt(k * up) * waves * np.tanh(waves * 10.0 * film * np.sqrt(k / up))
        felt = np.sin(waves * touched) / (waves * touched)
        return float(np.sum(drawn * felt / (legs + film * k * waves**2))) / self.edge

    def _layer_s_end(self) -> None:
        """From the layer's free side through the gap to floor and plate."""
        v, edge = self.value, self.edge
        k = v("structure_conductivity")
        # The end of the gap, as warm as the pads below: heat to its lower and to its upper wall.
        gap, slot = v("pcl_thickness"), v("air_conductivity") / v("pad_edge_contact")
        warm, cool = v("pcl_melting_end"), v("ambient_temperature")
        shine = v("surface_emissivity") / (2.0 - v("surface_emissivity")) * STEFAN_BOLTZMANN * gap
        radiated = shine * (warm**2 + cool**2) * (warm + cool) / v("air_conductivity")
        mean = v("air_conductivity") * np.sqrt(1.0 + radiated)
        through = edge / (1.0 / mean + 1.0 / v("pcl_conductivity_melt"))
        mouth = brentq(lambda u: np.sqrt(1.0 + u) - np.arctanh(1.0 / np.sqrt(1.0 + u)), 0.1, 1.0)
        stretched = slot * np.sqrt(1.0 + radiated) / gap
        down = np.log((1.0 + 0.25 / stretched**2) / mouth) / np.pi
        self.side = 1.0 / (1.0 / (down * through) + down / (3.0 * k * edge))
        self.up = 2.0 / np.pi * np.log(2.0) * through
        # Of the end's series 2 sin(n pi y) the odd ones bring 8/(n pi)^3/2 from within the layer; a slot keeps some.
        whole = np.sum(4.0 / (np.pi * np.arange(1, 2001, 2)) ** 3)
        turns = np.linspace(1e-9, np.arctanh(1.0 / np.sqrt(1.0 + mouth)), 2001)
        less = 2.0 / np.pi**2 * np.trapezoid(turns / np.tanh(turns), turns) * stretched
        height = (np.arange(CELLS) + 0.5) / CELLS
        self.within = 24.0 / CELLS * whole**2 / (whole + less) / (down + 2.0 / np.pi * np.log(2.0)) * (1.0 - height)

    # --- states ---

    def everywhere(self, celsius: float) -> Array:
        """State with all at one temperature below the melting window, without psi."""
        state = np.full(SINK + int(self.sink), celsius)
        state[LAYER] *= self.value("pcl_specific_heat_solid")
        return state

    def going_on(self, state: Array) -> Array:
        """Return a state on the equilibrium curve with the psi that belongs to it."""
        exponent = self.value("pcl_avrami_exponent")
        molten = np.clip((state[LAYER] - self.curve[1]) / (self.curve[2] - self.curve[1]), 1e-4, 1.0)
        return np.append(state, (-np.log(molten)) ** (1.0 / exponent))

    def layer(self, y: Array) -> tuple[Array, Array]:
        """Temperature [degC] and solid fraction of each cell of the layer."""
        heat = y[LAYER]
        if not self.kinetic:
            molten = np.clip((heat - self.curve[1]) / (self.curve[2] - self.curve[1]), 0.0, 1.0)
            return np.interp(heat, self.curve, self.celsius), 1.0 - molten
        v = self.value
        frozen = 1.0 - np.exp(-(np.maximum(y[-CELLS:], 0.0) ** v("pcl_avrami_exponent")))
        solid, melt = v("pcl_specific_heat_solid"), v("pcl_specific_heat_melt")
        offset = self.curve[2] - melt * self.end  # enthalpy of supercooled melt at 0 degC
        return (heat - (1.0 - frozen) * offset) / (frozen * solid + (1.0 - frozen) * melt), frozen

    def faces(self, y: Array) -> tuple[float, float, float]:
        """Near face, mean and far face of the layer [degC]."""
        temperatures, flows = self._flows(y)
        layer = temperatures[LAYER]
        half = 0.5 * self.cell / (self._conductivity(y) * self.area)
        return layer[0] + flows[1] * half[0], float(np.mean(layer)), layer[-1] - flows[1 + CELLS] * half[-1]

    def rotor_face(self, y: Array) -> float:
        """Rotor plate's face to the layer [degC]."""
        temperatures, flows = self._flows(y)
        half = 0.5 * self.plate_cell / (self.value("structure_conductivity") * self.area)
        return float(temperatures[2 + CELLS] + flows[1 + CELLS] * half)

    def power(self, y: Array, amps: float) -> float:
        """Voltage times current [W]."""
        return amps * (self.seebeck * (y[1] - y[0]) + amps * self.ohms)

    # --- rates ---

    def rates(self, y: Array, amps: float) -> Array:
        """Time derivative of the state at a current, positive where it heats."""
        _, flows = self._flows(y)
        watts = -np.diff(np.append(flows, self._outflow(y)))  # hot side, layer, plate
        watts[0] += self.seebeck * amps * (y[1] + 273.15)
        mean = np.mean(y[PLATE])
        aside = (self.to_beside[0] * (mean - y[BESIDE.start]) + self.uneven * (y[PLATE] - mean)) / PLATE_CELLS
        cold, hot = self.from_cold * (y[0] - y[FLOOR]), self.from_hot * (y[1] - y[FLOOR])
        up, side = self.up * (y[1] - y[BESIDE.start]), self.side * (y[1] - y[FLOOR][CORNER])
        pads = y[[0, LEGS, 1]]
        legs = self.from_legs * (np.where(np.arange(9) == CORNER, UPPER_HALF @ pads, LOWER_HALF @ pads) - y[FLOOR])
        given = legs[CORNER] * UPPER_HALF + legs[UPPER[0]] * LOWER_HALF
        below, middle, above = SIMPSON * amps**2 * self.ohms - given - self.leak * PARABOLA @ pads
        watts[1 + CELLS :] -= aside
        watts[0] += above - np.sum(hot) - (1.0 - np.sum(self.within)) * (up + side)
        watts[1 : 1 + CELLS] -= self.within * (up + side)
        beside = self._chain(y[BESIDE], self.to_beside, np.sum(aside) + up) - self.strips * self._flux(
            y[BESIDE], self.value("rotor_coefficient"), self.to_face[0]
        )
        floor = cold + hot + legs + self.among @ y[FLOOR] - np.sum(self.among, axis=1) * y[FLOOR]
        floor[CORNER] += side
        down, lost = self._through(y)
        floor[UPPER] -= down[:3]
        floor[[*LOWER, LEDGES]] += down
        floor -= lost
        gap = self._gap(y)
        beside[:3] -= gap
        floor[[CORNER, *UPPER[1:]]] += gap
        everything = np.concatenate(
            [[self._cold(y, amps) + below - np.sum(cold) - down[3]], watts, beside, floor, [middle]]
        )
        if self.sink:
            given = self.into_sink * (y[0] - y[SINK])
            lost = self.value("sink_area") * self._flux(y[SINK], self.value("sink_coefficient"))
            everything = np.append(everything, given - lost)
        rates = everything / self.capacities
        return np.append(rates, self._freezing(y)) if self.kinetic else rates

    def _through(self, y: Array) -> tuple[Array, Array]:
        """Heat into the lower strip and the ledges from above, and what each body of the floor loses [W]."""
        floor, places = y[FLOOR], [*LOWER, LEDGES]
        above = np.append(floor[UPPER], y[0])
        faces, down = floor.copy(), np.zeros(4)
        for _ in range(6):
            lost = self.below * self._flux(faces, self.value("housing_coefficient"), self.to_face[1])
            down = (above - floor[places] - self.across * lost[places]) / self.onto
            faces[places] = floor[places] - self.across * down
        return down, lost

    @staticmethod
    def _chain(temperatures: Array, conductances: Array, inflow: float) -> Array:
        onward = conductances[1:] * -np.diff(temperatures)
        return np.append(inflow, onward) - np.append(onward, 0.0)

    def _gap(self, y: Array) -> Array:
        """Heat through the air between plate and floor, and radiated between two grey plates [W]."""
        warm, cool = y[BESIDE][:3] + 273.15, y[FLOOR][[CORNER, *UPPER[1:]]] + 273.15
        return np.asarray(self.gap_air * (warm - cool) + self.gap_shine * (warm**4 - cool**4))

    def _freezing(self, y: Array) -> Array:
        """Nakamura's rate with Hoffman and Lauritzen's growth below T_m0; melting of what is above equilibrium."""
        v = self.value
        n, psi = v("pcl_avrami_exponent"), y[-CELLS:]
        highest, reference = v("pcl_equilibrium_melting_temperature"), v("pcl_crystallization_reference")

        def exponent(kelvin: Array | float) -> Array:
            mobile = np.maximum(kelvin - (v("pcl_glass_transition") - 30.0), 1.0)
            below = np.maximum(highest - np.asarray(kelvin), 0.05)
            correction = 2.0 * kelvin / (kelvin + highest)
            nucleation = v("pcl_nucleation_constant") / (kelvin * below * correction)
            return np.asarray(-v("pcl_transport_energy") / (GAS * mobile) - nucleation)

        celsius, _ = self.layer(y)
        at_reference = np.log(2.0) ** (1.0 / n) / v("pcl_crystallization_half_time")
        growth = at_reference * np.exp(np.maximum(exponent(celsius + 273.15) - exponent(reference), -200.0))
        molten = np.clip((celsius - self.start) / (self.end - self.start), 1e-4, 1.0)
        largest = (-np.log(molten)) ** (1.0 / n)
        return np.asarray(growth - np.maximum(psi - largest, 0.0) / v("melting_time"))

    def _conductivity(self, y: Array) -> Array:
        _, frozen = self.layer(y)
        solid, melt = self.value("pcl_conductivity_solid"), self.value("pcl_conductivity_melt")
        return melt + frozen * (solid - melt)

    def _flows(self, y: Array) -> tuple[Array, Array]:
        """Temperatures, and heat from each node to the next; the pump between the pads' sides is apart."""
        v = self.value
        t = np.concatenate([y[:2], self.layer(y)[0], y[PLATE]])
        half = 0.5 * self.cell / self._conductivity(y)
        plate = np.full(PLATE_CELLS, 0.5 * self.plate_cell / v("structure_conductivity"))
        own = np.concatenate([[0.0, 0.0], half, plate])
        resistance = own[:-1] + own[1:]
        resistance[1] += 1.0 / v("hot_contact")
        resistance[1 + CELLS] += 1.0 / v("rotor_contact")
        flows = -np.diff(t)[1:] / resistance[1:] * self.area
        return t, np.concatenate([[0.0], flows])

    def _flux(self, celsius: Array | float, coefficient: float, behind: Array | float = 0.0) -> Any:
        """Convection and the Stefan-Boltzmann law [W/m^2] at a face, which lies a resistance before `celsius`."""
        face = celsius
        for _ in range(4):  # each step leaves a twentieth of the error
            radiated = STEFAN_BOLTZMANN * ((np.asarray(face) + 273.15) ** 4 - (self.ambient + 273.15) ** 4)
            lost = coefficient * (face - self.ambient) + self.value("surface_emissivity") * radiated
            face = celsius - behind * lost
        return lost

    def _cold(self, y: Array, amps: float) -> float:
        drawn = self.seebeck * amps * (y[0] + 273.15)
        if self.sink:
            return -self.into_sink * (y[0] - y[SINK]) - drawn
        return -self.window * self._flux(y[0], self.value("cold_side_coefficient")) - drawn

    def _outflow(self, y: Array) -> float:
        """Return what the plate's outer face loses [W], at the temperature of the face itself."""
        last = surface = float(y[PLATE.stop - 1])
        half = 0.5 * self.plate_cell / self.value("structure_conductivity")
        for _ in range(3):  # half a cell is a tenth of a kelvin: it converges at once
            surface = last - half * self._flux(surface, self.value("rotor_coefficient"))
        return self.area * self._flux(surface, self.value("rotor_coefficient"))

    def neighbours(self) -> Array:
        """Which states a rate depends on, for the Jacobian, but for the heat from every plate cell to its edge.

        That is a row and a column across the whole plate, and little heat: Newton's steps reach the same state without
        it, and the differences take few evaluations instead of hundreds.
        """
        size = self.capacities.size
        near = np.eye(size) + np.eye(size, k=1) + np.eye(size, k=-1)
        bodies = np.r_[0:2, BESIDE, FLOOR, LEGS]
        near[np.ix_(bodies, bodies)] = 1.0
        if self.sink:
            near[0, -1] = near[-1, 0] = 1.0
        if not self.kinetic:
            return near
        cells = np.eye(size)[:, LAYER]
        around = near[:, LAYER]
        return np.block([[near, around], [cells.T, np.eye(CELLS)]])
