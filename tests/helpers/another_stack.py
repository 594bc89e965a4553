"""The stack of the module written once more: sharp corners, temperatures in degC, ten times the cells.

Heat, melting, freezing with kinetics, convection and radiation, from the numbers of a design alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

Array = NDArray[np.float64]
CELLS, PLATE_CELLS = 120, 40
STEFAN_BOLTZMANN = 5.670374419e-8
GAS = 8.314462618
LAYER, PLATE = slice(2, 2 + CELLS), slice(2 + CELLS, 2 + CELLS + PLATE_CELLS)


def value_of(model: DeviceFunctions) -> Callable[[str], float]:
    """Numbers of a model's inputs, and of its outputs that no simulation supplies."""
    computed = model.values(model.start, dict.fromkeys(model.switch_names, 0.0))
    return lambda name: float(model.start[model.index[name]]) if name in model.index else computed[name]


@dataclass
class AnotherStack:
    """State: cold and hot side, enthalpies of the layer, plate, strip and core beside it, sink, psi of the layer.

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
        share = self.area / v("peltier_area")
        self.seebeck, self.ohms, self.leak = (
            share * v(f"peltier_{name}") for name in ("seebeck", "resistance", "conductance")
        )
        self.side = 0.5 * share * v("peltier_unit_mass") * v("peltier_specific_heat")
        self._lumps(opening=v("pcl_outer_radius") - inner)
        self.cell = v("pcl_thickness") / CELLS
        self.plate_cell = v("rotor_thickness") / PLATE_CELLS
        plate_heat = v("structure_density") * v("structure_specific_heat") * self.plate_cell * self.area
        self.mass = v("pcl_density") * self.area * self.cell
        sinks = [v("sink_capacity")] if self.sink else []
        self.capacities = np.concatenate(
            [[self.side] * 2, np.full(CELLS, self.mass), np.full(PLATE_CELLS, plate_heat), self.lumps, sinks]
        )
        self.start, self.end = v("pcl_melting_start") - 273.15, v("pcl_melting_end") - 273.15
        solid, melt = v("pcl_specific_heat_solid"), v("pcl_specific_heat_melt")
        first = solid * self.start
        last = first + v("pcl_latent_heat") + 0.5 * (solid + melt) * (self.end - self.start)
        self.curve = np.array([first - 400.0 * solid, first, last, last + 400.0 * melt])
        self.celsius = np.array([self.start - 400.0, self.start, self.end, self.end + 400.0])
        self.ambient = v("ambient_temperature") - 273.15

    def _lumps(self, opening: float) -> None:
        """The plate between the arcs, a strip heated along its edge, and the core with what is fixed to it."""
        v = self.value
        k, rho_c, height = (
            v("structure_conductivity"),
            v("structure_density") * v("structure_specific_heat"),
            v("rotor_thickness"),
        )
        disc = np.pi * (v("pcl_outer_radius") + v("rotor_rim")) ** 2
        self.rest = disc - self.area
        arcs = v("pcl_outer_radius") + v("pcl_inner_radius")
        edge = v("arc_count") * (2.0 * opening + v("arc_span") * arcs)
        strip = self.rest / edge
        ring = np.log(v("pcl_inner_radius") / v("core_radius")) / (2.0 * np.pi * k * height)
        far = (v("rotor_mass") + v("link_mass") + v("retainer_mass")) / v("structure_density") - disc * height
        self.to_lumps = k * height * edge / (strip / 3.0), 1.0 / ring
        self.lumps = [self.rest * height * rho_c, far * rho_c]

    # --- states ---

    def everywhere(self, celsius: float) -> Array:
        """State with all at one temperature below the melting window, without psi."""
        state = np.full(2 + CELLS + PLATE_CELLS + 2 + int(self.sink), celsius)
        state[LAYER] *= self.value("pcl_specific_heat_solid")
        return state

    def going_on(self, state: Array) -> Array:
        """A state on the equilibrium curve with the psi that belongs to it."""
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
        watts[0] += self.seebeck * amps * (y[1] + 273.15) + 0.5 * amps**2 * self.ohms - self.leak * (y[1] - y[0])
        strip, core = y[PLATE.stop], y[PLATE.stop + 1]
        beside = self.to_lumps[0] / PLATE_CELLS * (y[PLATE] - strip)
        onward = self.to_lumps[1] * (strip - core)
        watts[1 + CELLS :] -= beside
        lost = self.rest * self._flux(strip, self.value("rotor_coefficient"))
        everything = np.concatenate([[self._cold(y, amps)], watts, [np.sum(beside) - onward - lost, onward]])
        if self.sink:
            temperature = y[PLATE.stop + 2]
            given = self.window * self.value("sink_contact") * (y[0] - temperature)
            lost = self.value("sink_area") * self._flux(temperature, self.value("sink_coefficient"))
            everything = np.append(everything, given - lost)
        rates = everything / self.capacities
        return np.append(rates, self._freezing(y)) if self.kinetic else rates

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

    def _flux(self, celsius: float, coefficient: float) -> float:
        """Convection and the Stefan-Boltzmann law [W/m^2]."""
        radiated = STEFAN_BOLTZMANN * ((celsius + 273.15) ** 4 - (self.ambient + 273.15) ** 4)
        return coefficient * (celsius - self.ambient) + self.value("surface_emissivity") * radiated

    def _cold(self, y: Array, amps: float) -> float:
        drawn = self.seebeck * amps * (y[0] + 273.15) - 0.5 * amps**2 * self.ohms - self.leak * (y[1] - y[0])
        if self.sink:
            return -self.window * self.value("sink_contact") * (y[0] - y[PLATE.stop + 2]) - drawn
        return -self.window * self._flux(y[0], self.value("cold_side_coefficient")) - drawn

    def _outflow(self, y: Array) -> float:
        """What the plate's outer face loses [W], at the temperature of the face itself."""
        last = surface = float(y[PLATE.stop - 1])
        half = 0.5 * self.plate_cell / self.value("structure_conductivity")
        for _ in range(3):  # half a cell is a tenth of a kelvin: it converges at once
            surface = last - half * self._flux(surface, self.value("rotor_coefficient"))
        return self.area * self._flux(surface, self.value("rotor_coefficient"))

    def neighbours(self) -> Array:
        """Which states a rate depends on, for the Jacobian."""
        size = self.capacities.size
        near = np.eye(size) + np.eye(size, k=1) + np.eye(size, k=-1)
        lumps = slice(PLATE.stop, PLATE.stop + 2)
        near[lumps, PLATE.start :] = near[PLATE.start :, lumps] = 1.0
        if self.sink:
            near[0, -1] = near[-1, 0] = 1.0
        if not self.kinetic:
            return near
        cells = np.eye(size)[:, LAYER]
        around = near[:, LAYER]
        return np.block([[near, around], [cells.T, np.eye(CELLS)]])
