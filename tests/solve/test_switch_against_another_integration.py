"""One switch against the same physics written once more: sharp melting, ten times the cells, scipy's BDF."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import simpson, solve_ivp

from tvimdesign.solve.model import Model
from tvimdesign.solve.simulate import Simulator, Switch

Array = NDArray[np.float64]
DESIGNS = ("as it is", "thin", "thick", "aluminium")
CELLS, PLATE_CELLS = 120, 40


@dataclass
class Reference:
    """The stack of the module in temperatures and enthalpies, from the study's inputs alone."""

    value: Callable[[str], float]

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
        self.plate_heat = v("structure_density") * v("structure_specific_heat") * self.plate_cell * self.area
        start, end = v("pcl_melting_start") - 273.15, v("pcl_melting_end") - 273.15
        solid, melt = v("pcl_specific_heat_solid"), v("pcl_specific_heat_melt")
        first = solid * start
        last = first + v("pcl_latent_heat") + 0.5 * (solid + melt) * (end - start)
        self.curve = np.array([first - 400.0 * solid, first, last, last + 400.0 * melt])
        self.celsius = np.array([start - 400.0, start, end, end + 400.0])

    def _lumps(self, opening: float) -> None:
        """The plate between the arcs, a strip heated along its edge, and the core with what is fixed to it."""
        v = self.value
        k, rho_c, height = (
            v("structure_conductivity"),
            v("structure_density") * v("structure_specific_heat"),
            v("rotor_thickness"),
        )
        disc = np.pi * (v("pcl_outer_radius") + v("rotor_rim")) ** 2
        rest = disc - self.area
        arcs = v("pcl_outer_radius") + v("pcl_inner_radius")
        edge = v("arc_count") * (2.0 * opening + v("arc_span") * arcs)
        strip = rest / edge
        ring = np.log(v("pcl_inner_radius") / v("core_radius")) / (2.0 * np.pi * k * height)
        far = (v("rotor_mass") + v("link_mass") + v("retainer_mass")) / v("structure_density") - disc * height
        self.to_lumps = k * height * edge / (strip / 3.0), 1.0 / ring
        self.lumps = np.array([rest * height * rho_c, far * rho_c])
        self.lump_loss = v("rotor_coefficient") * rest

    def faces(self, y: Array) -> tuple[float, float, float]:
        """Near face, mean and far face of the layer [degC]."""
        temperatures, flows = self._flows(y)
        layer = temperatures[2 : 2 + CELLS]
        half = 0.5 * self.cell / (self._conductivity(y) * self.area)
        return layer[0] + flows[1] * half[0], float(np.mean(layer)), layer[-1] - flows[1 + CELLS] * half[-1]

    def rotor_face(self, y: Array) -> float:
        """Rotor plate's face to the layer [degC]."""
        temperatures, flows = self._flows(y)
        half = 0.5 * self.plate_cell / (self.value("structure_conductivity") * self.area)
        return float(temperatures[2 + CELLS] + flows[1 + CELLS] * half)

    def rates(self, y: Array) -> Array:
        v = self.value
        _, flows = self._flows(y)
        balance = -np.diff(np.append(flows, self._outflow(y)))
        strip, core = y[-2:]
        beside = self.to_lumps[0] / PLATE_CELLS * (y[2 + CELLS : -2] - strip)
        onward = self.to_lumps[1] * (strip - core)
        ambient = v("ambient_temperature") - 273.15
        ends = np.array([np.sum(beside) - onward - self.lump_loss * (strip - ambient), onward])
        mass = v("pcl_density") * self.area * self.cell
        capacity = np.concatenate([[self.side + v("sink_capacity")], [self.side], np.full(CELLS, mass),
                                   np.full(PLATE_CELLS, self.plate_heat)])  # fmt: skip
        balance = np.concatenate([[self._cold(y)], balance])
        balance[1] += self._pumped(y)
        balance[2 + CELLS :] -= beside
        return np.concatenate([balance / capacity, ends / self.lumps])

    def power(self, y: Array) -> float:
        return self.value("current") * (self.seebeck * (y[1] - y[0]) + self.value("current") * self.ohms)

    def _temperatures(self, y: Array) -> Array:
        layer = np.interp(y[2 : 2 + CELLS], self.curve, self.celsius)
        return np.concatenate([y[:2], layer, y[2 + CELLS : -2]])

    def _conductivity(self, y: Array) -> Array:
        molten = np.clip((y[2 : 2 + CELLS] - self.curve[1]) / (self.curve[2] - self.curve[1]), 0.0, 1.0)
        solid, melt = self.value("pcl_conductivity_solid"), self.value("pcl_conductivity_melt")
        return solid + molten * (melt - solid)

    def _flows(self, y: Array) -> tuple[Array, Array]:
        """Temperatures, and heat from each node to the next; the pump between the pads' sides is apart."""
        v, t = self.value, self._temperatures(y)
        half = 0.5 * self.cell / self._conductivity(y)
        plate = np.full(PLATE_CELLS, 0.5 * self.plate_cell / v("structure_conductivity"))
        own = np.concatenate([[0.0, 0.0], half, plate])
        resistance = own[:-1] + own[1:]
        resistance[1] += 1.0 / v("hot_contact")
        resistance[1 + CELLS] += 1.0 / v("rotor_contact")
        flows = -np.diff(t)[1:] / resistance[1:] * self.area
        return t, np.concatenate([[0.0], flows])

    def _pumped(self, y: Array) -> float:
        amps = self.value("current")
        return self.seebeck * amps * (y[1] + 273.15) + 0.5 * amps**2 * self.ohms - self.leak * (y[1] - y[0])

    def _cold(self, y: Array) -> float:
        amps = self.value("current")
        drawn = self.seebeck * amps * (y[0] + 273.15) - 0.5 * amps**2 * self.ohms - self.leak * (y[1] - y[0])
        ambient = self.value("ambient_temperature") - 273.15
        return self.value("cold_side_coefficient") * self.window * (ambient - y[0]) - drawn

    def _outflow(self, y: Array) -> float:
        v = self.value
        resistance = 0.5 * self.plate_cell / v("structure_conductivity") + 1.0 / v("rotor_coefficient")
        return self.area * (y[-3] - (v("ambient_temperature") - 273.15)) / resistance


def _neighbours(size: int) -> Array:
    """Which states a rate depends on: its neighbours, and the lumps beside the plate on all of it."""
    near = np.eye(size) + np.eye(size, k=1) + np.eye(size, k=-1)
    near[-2:, 2 + CELLS :] = near[2 + CELLS :, -2:] = 1.0
    return near


@pytest.fixture(scope="module", params=DESIGNS)
def pair(
    request: pytest.FixtureRequest, build: Callable[..., Model], switch_of: Callable[[str], Switch]
) -> tuple[Switch, dict[str, float]]:
    """The product's switch and what the independent integration finds for the same design."""
    model = build(request.param)
    masses = model.values(model.start, dict.fromkeys(model.switch_names, 0.0))
    reference = Reference(lambda name: float(model.start[model.index[name]]) if name in model.index else masses[name])
    ambient = model.start[model.index["ambient_temperature"]] - 273.15
    target = model.start[model.index["target_temperature"]] - 273.15
    begin = np.full(2 + CELLS + PLATE_CELLS + 2, ambient)
    begin[2 : 2 + CELLS] *= model.start[model.index["pcl_specific_heat_solid"]]

    def waits(which: int) -> Callable[[float, Array], float]:
        def gap(_: float, y: Array) -> float:
            return reference.faces(y)[which] - target

        gap.terminal = which == 2
        return gap

    found = solve_ivp(
        lambda _, y: reference.rates(y), (0.0, 2000.0), begin, method="BDF", rtol=1e-6, atol=1e-4,
        jac_sparsity=_neighbours(begin.size),
        events=[waits(0), waits(1), waits(2)], dense_output=True,
    )  # fmt: skip
    times = [float(hits[0]) for hits in found.t_events]
    sampled = np.linspace(0.0, times[2], 2001)
    states = found.sol(sampled)
    power = np.array([reference.power(column) for column in states.T])
    values = {
        "near_face_time": times[0],
        "mean_time": times[1],
        "far_face_time": times[2],
        "switch_energy": float(simpson(power, x=sampled)),
        "peak_power": float(np.max(power)),
        "rotor_face": max(reference.rotor_face(column) for column in states.T[::20]) + 273.15,
        "peak_pcl_temperature": max(reference.faces(column)[0] for column in states.T[::20]) + 273.15,
    }
    return switch_of(request.param), values


def test_switch_agrees_with_the_independent_integration(pair: tuple[Switch, dict[str, float]]) -> None:
    # 1 % is what the product promises; twelve cells in the layer and eight in the rotor reach half of it.
    switch, reference = pair
    for name in ("near_face_time", "mean_time", "far_face_time", "switch_energy", "peak_power", "peak_pcl_temperature"):
        assert switch.values[name] == pytest.approx(reference[name], rel=5e-3), name


def test_peak_of_the_rotor_is_that_of_its_face_to_the_layer(pair: tuple[Switch, dict[str, float]]) -> None:
    switch, reference = pair
    assert switch.values["peak_rotor_temperature"] == pytest.approx(reference["rotor_face"], abs=1.0)


@pytest.mark.parametrize("design", DESIGNS)
def test_near_face_comes_before_the_mean_and_the_mean_before_the_far_face(
    design: str, switch_of: Callable[[str], Switch]
) -> None:
    values = switch_of(design).values
    assert 0.0 < values["near_face_time"] < values["mean_time"] < values["far_face_time"]
    # The layer is soft before its far face is at 100 degC.
    assert 0.0 < values["softening_time"] < values["far_face_time"]


@pytest.mark.parametrize("design", DESIGNS)
def test_energy_is_the_integral_of_the_power_over_the_trajectory(
    design: str, build: Callable[..., Model], switch_of: Callable[[str], Switch]
) -> None:
    model, switch = build(design), switch_of(design)
    trajectory = switch.trajectory
    place = len(model.events) + [row.name for row in model.paths].index("switch_energy")
    power = [float(np.asarray(model.instant(state, model.start)).ravel()[place]) for state in trajectory.states.T]
    energy = simpson(power, x=trajectory.times)
    assert switch.values["switch_energy"] == pytest.approx(energy, rel=1e-4)
    assert trajectory.times[-1] == pytest.approx(switch.values["response_time"], rel=1e-12)
    assert switch.values["peak_power"] == pytest.approx(max(power), rel=1e-9)


def test_state_at_the_response_time_fulfils_the_event(
    build: Callable[..., Model], switch_of: Callable[[str], Switch]
) -> None:
    model, switch = build(), switch_of("as it is")
    gap = model.watch(["response_time"])(switch.trajectory.states[:, -1], model.start)
    assert float(gap) == pytest.approx(0.0, abs=2e-5)  # in hundreds of kelvin


def test_a_switch_that_stalls_has_no_response_time(build: Callable[..., Model]) -> None:
    # At 0.4 A the pads cannot hold 100 degC against the losses.
    model = build()
    inputs = model.start.copy()
    inputs[model.index["current"]] = 0.4
    switch = Simulator(model).run(inputs)
    assert switch.values["far_face_time"] == np.inf
    assert switch.values["response_time"] == np.inf


def test_times_converge_with_the_square_of_the_cell(build: Callable[..., Model]) -> None:
    found = []
    for cells in (6, 12, 24, 48):
        model = build("as it is", cells, 8)
        found.append(Simulator(model).run(model.start).values["far_face_time"])
    changes = np.abs(np.diff(found))
    # Melting passes cell after cell, so the order is uneven; it must not be less than one on the whole.
    assert changes[-1] < 0.5 * changes[0]
    assert changes[-1] / found[-1] < 1e-3
