"""One switch against the same physics written once more: sharp melting, ten times the cells, scipy's BDF."""

from collections.abc import Callable

import numpy as np
import pytest
from another_stack import AnotherStack, value_of
from numpy.typing import NDArray
from scipy.integrate import simpson, solve_ivp
from support import tight

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle

Array = NDArray[np.float64]
DESIGNS = ("as it is", "thin", "thick", "aluminium", "sink")


LONG = {"as it is", "thick", "aluminium", "sink"}


@pytest.fixture(
    scope="module", params=[pytest.param(name, marks=pytest.mark.slow if name in LONG else []) for name in DESIGNS]
)
def pair(request: pytest.FixtureRequest, build: Callable[..., DeviceFunctions]) -> tuple[Cycle, dict[str, float]]:
    """The product's switch and what the independent integration finds for the same design."""
    model = build(request.param, rotor_cells=16)
    reference = AnotherStack(value_of(model), sink=model.words["cold_side"] == "sink")
    current = model.start[model.index["current"]]
    target = model.start[model.index["target_temperature"]] - 273.15
    begin = reference.everywhere(model.start[model.index["ambient_temperature"]] - 273.15)

    def waits(which: int) -> Callable[[float, Array], float]:
        def gap(_: float, y: Array) -> float:
            return reference.faces(y)[which] - target

        gap.terminal = which == 2
        return gap

    found = solve_ivp(
        lambda _, y: reference.rates(y, current), (0.0, 2000.0), begin, method="BDF", rtol=1e-5, atol=1e-3,
        jac_sparsity=reference.neighbours(),
        events=[waits(0), waits(1), waits(2)], dense_output=True,
    )  # fmt: skip
    times = [float(hits[0]) for hits in found.t_events]
    sampled = np.linspace(0.0, times[2], 2001)
    states = found.sol(sampled)
    power = np.array([reference.power(column, current) for column in states.T])
    values = {
        "near_face_time": times[0],
        "mean_time": times[1],
        "far_face_time": times[2],
        "switch_energy": float(simpson(power, x=sampled)),
        "peak_power": float(np.max(power)),
        "rotor_face": max(reference.rotor_face(column) for column in states.T[::20]) + 273.15,
        "peak_pcl_temperature": max(reference.faces(column)[0] for column in states.T[::20]) + 273.15,
    }
    return tight(model).run(model.start), values


@pytest.mark.gate
def test_switch_agrees_with_the_independent_integration(pair: tuple[Cycle, dict[str, float]]) -> None:
    # 1 % is what the product promises; twelve cells in the layer and sixteen in the rotor reach half of it; eight
    # in the rotor, as by default, are 0.54 % off in the thin one.
    cycle, reference = pair
    for name in ("near_face_time", "mean_time", "far_face_time", "switch_energy", "peak_power", "peak_pcl_temperature"):
        assert cycle.values[name] == pytest.approx(reference[name], rel=5e-3), name


@pytest.mark.gate
@pytest.mark.parametrize("pair", ["thin"], indirect=True)
def test_switch_at_the_usual_cells_is_within_the_promised_percent(
    pair: tuple[Cycle, dict[str, float]], switch_of: Callable[[str], Cycle]
) -> None:
    for name in ("near_face_time", "mean_time", "far_face_time", "switch_energy", "peak_power", "peak_pcl_temperature"):
        assert switch_of("thin").values[name] == pytest.approx(pair[1][name], rel=1e-2), name


@pytest.mark.gate
def test_peak_of_the_rotor_is_that_of_its_face_to_the_layer(pair: tuple[Cycle, dict[str, float]]) -> None:
    cycle, reference = pair
    assert cycle.values["peak_rotor_temperature"] == pytest.approx(reference["rotor_face"], abs=1.0)


@pytest.mark.parametrize("design", ["as it is", "sink"])
def test_energy_is_the_integral_of_the_power_over_the_trajectory(
    design: str, build: Callable[..., DeviceFunctions], switch_of: Callable[[str], Cycle]
) -> None:
    model, cycle = build(design), switch_of(design)
    trajectory = cycle.trajectory
    current = model.start[model.index["current"]]
    power_at = model.phases["softening"].watch(["switch_energy"])
    power = [float(power_at(state, current, model.start)) for state in trajectory.states.T]
    energy = simpson(power, x=trajectory.times)
    assert cycle.values["switch_energy"] == pytest.approx(energy, rel=1e-4)
    assert trajectory.times[-1] == pytest.approx(cycle.values["response_time"], rel=1e-12)
    assert cycle.values["peak_power"] == pytest.approx(max(power), rel=1e-9)


def test_state_at_the_response_time_fulfils_the_event(
    build: Callable[..., DeviceFunctions], switch_of: Callable[[str], Cycle]
) -> None:
    model, cycle = build(), switch_of("as it is")
    gap = model.phases["softening"].watch(["response_time"])(cycle.trajectory.states[:, -1], 1.5, model.start)
    assert float(gap) == pytest.approx(0.0, abs=2e-5)  # in hundreds of kelvin
