"""Effect of a variable on an output: exact derivatives against power laws and against simulations made anew."""

import itertools
from collections.abc import Sequence

import numpy as np
import pytest
from support import fine, study_path

from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_study
from tvimdesign.solve.uncertainty.output_sensitivity import OutputSensitivities, output_sensitivities
from tvimdesign.study import read_study, read_study_text

pytestmark = pytest.mark.slow

CELLS = 12
OF_CYCLE = (
    "response_time", "softening_time", "stiffening_time", "frozen_time", "far_face_cooling_time", "cycle_time",
    "switch_energy", "peak_power", "peak_voltage", "stiffening_energy", "hold_power",
)  # fmt: skip
OF_GEOMETRY = ("spring_stiffness", "layer_strain", "pcl_area", "module_mass", "envelope_volume", "joint_stiffness@cold")
STEP = 4e-3


def _rig(text: str = "mode: shear\n") -> ResolvedModule:
    study = read_study_text(f"{text}solver: {{cells: {CELLS}}}\n", "a test")
    return resolve_study(study)


@pytest.fixture(scope="module")
def resolved() -> ResolvedModule:
    # The textbook's spring: its coils alone bend.
    return _rig("mode: shear\nmodule: {transmission: unity, leg_model: ignored, current: 2 A}\n")


@pytest.fixture(scope="module")
def sensitivities(resolved: ResolvedModule) -> OutputSensitivities:
    return output_sensitivities(resolved, [*OF_CYCLE, *OF_GEOMETRY])


def _logarithmic(sensitivities: OutputSensitivities) -> dict[tuple[str, str], float]:
    shares = sensitivities.derivatives * sensitivities.at / sensitivities.values[:, None]
    places = itertools.product(enumerate(sensitivities.outputs), enumerate(sensitivities.variables))
    return {(output, variable): float(shares[i, j]) for (i, output), (j, variable) in places}


def _simulated(resolved: ResolvedModule, name: str, wanted: Sequence[str], share: float = STEP) -> dict[str, float]:
    """Exponents of outputs by an input, from two simulations of changed designs."""
    model = resolved.functions
    simulator, ends = fine(model), []
    for factor in (1.0 - share, 1.0 + share):
        inputs = model.start.copy()
        inputs[model.index[name]] *= factor
        ends.append(model.values(inputs, simulator.run(inputs).values))
    below, above = ends
    return {name: float(np.log(above[name] / below[name]) / np.log((1.0 + share) / (1.0 - share))) for name in wanted}


def test_powers_of_textbook_formulae_come_back(sensitivities, resolved):
    by = _logarithmic(sensitivities)
    assert by["spring_stiffness", "wire_diameter"] == pytest.approx(4.0, abs=0.01)  # E d^4 / (64 D n)
    assert by["layer_strain", "pcl_thickness"] == pytest.approx(-1.0, rel=1e-12)  # r theta / t
    assert by["layer_strain", "pcl_outer_radius"] == pytest.approx(1.0, rel=1e-12)
    assert by["pcl_area", "arc_span"] == pytest.approx(1.0, rel=1e-12)
    outer, inner = resolved.values["pcl_outer_radius"], resolved.values["pcl_inner_radius"]
    assert by["pcl_area", "pcl_outer_radius"] == pytest.approx(2.0 * outer**2 / (outer**2 - inner**2), rel=1e-12)
    assert by["module_mass", "current"] == 0.0
    assert by["response_time", "cooling_current"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("name", ["pcl_thickness", "pcl_outer_radius", "current", "cooling_current", "core_radius"])
def test_outputs_of_the_cycle_change_as_simulations_of_changed_designs_do(name, sensitivities, resolved):
    by = _logarithmic(sensitivities)
    shown = _simulated(resolved, name, OF_CYCLE)
    for output in OF_CYCLE:
        assert by[output, name] == pytest.approx(shown[output], rel=3e-3, abs=3e-3), output


def test_what_never_happens_is_left_out_by_name():
    weak = _rig("mode: shear\nmodule: {current: 0.2 A}\n")
    changes = output_sensitivities(weak, ["response_time", "cycle_time", "module_mass"])
    assert changes.outputs == ("module_mass",)
    assert changes.left_out == ("response_time", "cycle_time")
    assert np.all(np.isfinite(changes.derivatives))


def test_what_hangs_on_a_profile_is_left_out_by_name(resolved):
    # A profile divides the time its stage takes, so the current is no one number there.
    driven = ResolvedModule(resolved.study, resolved.values, {"stiffening": CurrentProfile.constant(-0.5)})
    changes = output_sensitivities(driven, ["response_time", "stiffening_time", "module_mass"])
    assert changes.left_out == ("stiffening_time",)
    assert "cooling_current" not in changes.variables
    assert "current" in changes.variables


@pytest.mark.parametrize("name", ["block_height", "pcl_outer_radius"])
def test_a_layer_that_freezes_at_a_sharp_edge_is_differentiated_too(name):
    study = read_study(study_path("wrist_compression"))
    resolved = resolve_study(study)
    by = _logarithmic(output_sensitivities(resolved, ["frozen_time"], [name]))
    # By the radius 0.4 % is too far: differences go 1.367, 1.305, 1.284, 1.279 as it is halved.
    shown = _simulated(resolved, name, ["frozen_time"], STEP / 8.0)
    assert by["frozen_time", name] == pytest.approx(shown["frozen_time"], rel=3e-2)
