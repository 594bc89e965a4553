"""The motion tests on the paper's module: what their findings say, against rows and hand calculation."""

import numpy as np
import pytest
from stiff_when_warm import LOSSLESS
from support import study_path

from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.joint_tests import release as release_test
from tvimdesign.simulation.joint_tests import sine as sine_test
from tvimdesign.simulation.joint_tests.case import with_paper_points
from tvimdesign.simulation.trial import Trial
from tvimdesign.simulation.working_cycle.melt_history import fractions_at
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.study import read_study, read_study_text

STUDY = study_path("paper_reconstructed")
POINTS = ("cold", "melting", "hot")


@pytest.fixture(scope="module")
def resolved() -> ResolvedModule:
    # Without friction, as the textbook has it (what it does is in test_link_with_dry_friction.py), and without the
    # structure's loss (what that does is in test_loss_in_motion.py).
    study = read_study(STUDY)
    textbook = {"pin_friction": 0.0, **LOSSLESS}
    return resolve_study(study.model_copy(update={"module": {**study.module, **textbook}}))


@pytest.fixture(scope="module")
def release(resolved: ResolvedModule) -> Trial:
    return release_test.release(resolved)


@pytest.fixture(scope="module")
def sine(resolved: ResolvedModule) -> Trial:
    return sine_test.sine(resolved)


def value(trial: Trial, name: str) -> float:
    return next(finding.value for finding in trial.findings if finding.name == name)


def slowness(resolved: ResolvedModule) -> float:
    """Time of the hot link's creep over the melt's viscosity [1/Pa]."""
    size = resolved.quantity("layer_polar_moment") / resolved.quantity("pcl_thickness")
    return float(size / resolved.quantity("spring_stiffness"))


def test_hot_link_creeps_back_and_cold_link_rings(resolved: ResolvedModule, release: Trial) -> None:
    assert value(release, "ringing_frequency@hot") == 0.0
    # Three time constants of the melt's viscosity over the springs, a little more for the melt's own memory.
    viscosity = resolved.values["pcl_grade"].value("zero_shear_viscosity")
    creep = viscosity * slowness(resolved)
    assert value(release, "settling_time@hot") == pytest.approx(np.log(20.0) * creep, rel=0.02)
    # Frozen, the layer is rigid beside the structure.
    stiff = resolved.quantity("spring_stiffness") + resolved.quantity("structure_stiffness")
    expected = np.sqrt(stiff / resolved.quantity("moving_inertia")) / (2.0 * np.pi)
    assert value(release, "ringing_frequency@cold") == pytest.approx(expected, rel=0.01)
    # A lightly damped swing fades as exp(-zeta omega t): ln 20/(zeta omega) to 5 %.
    decay = value(release, "ringing_damping_ratio@cold") * 2.0 * np.pi * value(release, "ringing_frequency@cold")
    assert value(release, "settling_time@cold") == pytest.approx(np.log(20.0) / decay, rel=0.01)


def test_release_gives_back_what_holding_put_in_and_makes_no_energy(release: Trial) -> None:
    for sheet in release.sheets:
        energy = sheet.column("stored_energy").values
        assert np.max(np.diff(energy)) <= 1e-9 * energy[0]
    # The hot layer has relaxed: 0.1 rad on springs of 5.609 N*m/rad is 28.05 mJ.
    assert value(release, "energy_dissipated@hot") == pytest.approx(28.05e-3, rel=1e-3)
    assert value(release, "held_torque@hot") == pytest.approx(0.5609, rel=1e-3)
    hot = next(sheet for sheet in release.sheets if sheet.name == "release_hot")
    # The link is at rest before and after, so the module does no net work on it: the whole loop has no area.
    loop = np.trapezoid(hot.column("torque").values, hot.column("angle").values)
    assert loop == pytest.approx(0.0, abs=1e-3 * 28.05e-3)


def test_kelvin_voigt_of_the_hot_link_is_too_stiff_and_comes_back_too_soon(
    resolved: ResolvedModule, release: Trial
) -> None:
    hot = next(sheet for sheet in release.sheets if sheet.name == "release_hot")
    times, simple = hot.column("time").values, hot.column("angle_kelvin_voigt").values
    stiffness, damping = resolved.quantity("joint_stiffness@hot"), resolved.quantity("joint_damping@hot")
    slow = max(np.roots([resolved.quantity("moving_inertia"), damping, stiffness]).real)
    middle = (times > 0.2) & (times < 2.0)
    assert np.gradient(np.log(simple), times)[middle] == pytest.approx(slow, rel=1e-2)
    assert value(release, "kelvin_voigt_settling_time@hot") == pytest.approx(-np.log(20.0) / slow, rel=1e-2)
    # Both creep as one exponential: the square of their difference has an integral known in closed form.
    rate, other = np.log(20.0) / value(release, "settling_time@hot"), -slow
    apart = np.sqrt((0.5 / rate + 0.5 / other - 2.0 / (rate + other)) * 2.0 * rate)
    assert value(release, "kelvin_voigt_difference@hot") == pytest.approx(apart, rel=0.02)
    bare = release_test.release(resolved, kelvin_voigt=False)
    assert not any("kelvin" in finding.name for finding in bare.findings)
    assert not any("kelvin" in column.name for sheet in bare.sheets for column in sheet.columns)


def test_frozen_joint_slips_at_the_torque_it_bears(resolved: ResolvedModule, release: Trial) -> None:
    bears = float(resolved.quantity("holding_torque"))
    assert value(release, "held_torque@cold") == pytest.approx(bears, rel=1e-9)
    assert any("slips or yields" in note and "cold" in note for note in release.notes)
    small = release_test.release(resolved, angle=1e-3)
    assert value(small, "held_torque@cold") < bears
    assert not any("slips or yields" in note for note in small.notes)
    assert not any("does not break" in note for note in release.notes)
    # Let go, it rings about where the elastic part alone, bears/K, takes it, and stays turned by the rest.
    angle = next(sheet for sheet in release.sheets if sheet.name == "release_cold").column("angle").values
    stiffness = value(small, "held_torque@cold") / 1e-3
    assert 0.5 * (np.max(angle) + np.min(angle)) == pytest.approx(0.1 - bears / stiffness, rel=0.02)


@pytest.mark.parametrize("point", POINTS)
def test_sine_in_time_agrees_with_the_rows_within_one_percent(
    resolved: ResolvedModule, sine: Trial, point: str
) -> None:
    worst = next(finding for finding in sine.findings if finding.name == f"frequency_domain_difference@{point}")
    assert max(worst.value, worst.high or 0.0) < 1e-2
    stiffness, damping = resolved.quantity(f"joint_stiffness@{point}"), resolved.quantity(f"joint_damping@{point}")
    assert value(sine, f"stiffness@{point}") == pytest.approx(stiffness, rel=1e-2)
    assert value(sine, f"damping@{point}") == pytest.approx(damping, rel=1e-2)
    # A cycle's heat is pi b omega theta^2.
    heat = np.pi * damping * 2.0 * np.pi * resolved.quantity(f"frequency@{point}") * resolved.quantity("stroke") ** 2
    assert value(sine, f"cycle_energy@{point}") == pytest.approx(heat, rel=1e-2)


def test_interval_holds_what_stands_between_the_histories(resolved: ResolvedModule, release: Trial) -> None:
    # Neither the liquid nor the most frozen layer creeps slowest: a layer a quarter of the way between does, by
    # its longest mode's viscosity over the springs, and takes longer than all three that are shown.
    found = next(one for one in release.findings if one.name == "settling_time@melting")
    temperature = resolved.quantity("temperature@melting")
    fraction = 0.25 * fractions_at(resolved, temperature)[2]
    lasting = resolved.quantity("pcl_rheology").equilibrated  # it was cooled
    time, modulus = polymer.spectrum(temperature, fraction, lasting)[0]
    assert found.high == pytest.approx(np.log(20.0) * time * modulus * slowness(resolved), rel=0.2)
    assert found.high > 10.0 * found.value


def test_study_without_points_is_tested_at_the_papers_three_temperatures() -> None:
    def bench(text: str) -> ResolvedModule:
        return with_paper_points(resolve_study(read_study_text(text, "a test")))

    resolved = bench("mode: shear\n")
    assert resolved.points == POINTS
    at = [resolved.quantity(f"temperature@{point}") for point in resolved.points]
    assert at == pytest.approx([303.15, 333.15, 373.15])
    assert resolved.quantity("joint_stiffness@melting") > resolved.quantity("joint_stiffness@hot")
    own = "mode: shear\noperating_points:\n  hot: {temperature: 90 degC, frequency: 2 Hz}\n"
    assert set(bench(own).points) == {"cold", "hot"}
