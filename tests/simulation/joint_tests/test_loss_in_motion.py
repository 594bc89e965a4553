"""Motion tests of the paper's module against textbooks; printed structures' loss in motion against Radau."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from stiff_when_warm import LOSSLESS
from support import study_path

from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.joint_tests import release as release_test
from tvimdesign.simulation.joint_tests import sine as sine_test
from tvimdesign.simulation.joint_tests.case import cases, with_paper_points
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.sampled_motion import spectrum
from tvimdesign.simulation.trial import Trial
from tvimdesign.simulation.working_cycle.curves import fractions_at
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_study
from tvimdesign.study import read_study, read_study_text


def module(name: str) -> ResolvedModule:
    study = read_study(study_path(name))
    return resolve_study(study.model_copy(update={"module": {**study.module, "pin_friction": 0.0}}))


@pytest.fixture(scope="module")
def shear() -> ResolvedModule:
    return module("paper_reconstructed")


def value(trial: Trial, name: str) -> float:
    return next(finding.value for finding in trial.findings if finding.name == name)


def hold_to_rows(resolved: ResolvedModule, points: tuple[str, ...]) -> None:
    ran = sine_test.sine(resolved)
    for point in points:
        for name in ("stiffness", "damping"):
            row = resolved.quantity(f"joint_{name}@{point}")
            assert value(ran, f"{name}@{point}") == pytest.approx(row, rel=0.01), (name, point)
        assert value(ran, f"frequency_domain_difference@{point}") < 0.01


def test_sine_gives_stiffness_and_damping_of_the_operating_points(shear):
    # The frozen joint's damping is its structure's alone: without loss in time it came to a hundredth.
    assert shear.quantity("joint_damping@cold") > 1.0
    hold_to_rows(shear, ("cold", "hot"))


@pytest.mark.slow
def test_sine_of_frozen_blocks_is_that_of_an_independent_integration():
    # A lossy block lags behind the link and is left before the link is back: no row of small motions knows of that.
    resolved = module("paper_compression")
    ran = sine_test.sine(resolved)
    case = next(known for known in cases(resolved) if known.point == "cold")
    support = resolved.quantity("support@cold")
    frequency, stroke = float(resolved.quantity("frequency@cold")), float(resolved.quantity("stroke"))
    spring, elements = spectrum(float(support[0]), float(support[1]), frequency)
    layer = [(float(tau), float(k)) for tau, k in resolved.quantity("pcl_modes@cold")]
    (slow, soft), (slower, softer) = (np.array(modes).T for modes in (elements, layer))
    block, most = len(slow) + len(slower), spring + np.sum(soft)

    def pushed(angle: float, state: np.ndarray) -> tuple[float, np.ndarray]:
        """Torque of one block, with its rates; it is squeezed to the angle, or further where nothing pushes it."""
        give, inner = state[: len(slow)], state[len(slow) :]
        across = np.sum(softer * inner) / np.sum(softer)
        end = max(angle, across + np.sum(soft * give) / most)
        if end == angle:
            across = (np.sum(softer * inner) + most * angle - np.sum(soft * give)) / (most + np.sum(softer))
        rates = np.concatenate([(end - across - give) / slow, (across - inner) / slower])
        return float(np.sum(softer * (across - inner))), rates

    def both(time: float, state: np.ndarray) -> tuple[float, np.ndarray]:
        angle = stroke * np.sin(2.0 * np.pi * frequency * time)
        ahead, behind = pushed(angle, state[:block]), pushed(-angle, state[block:])
        return ahead[0] - behind[0], np.concatenate([ahead[1], behind[1]])

    times = np.linspace(9.0, 10.0, 4001) / frequency
    moved = solve_ivp(
        lambda t, y: both(t, y)[1], (0.0, times[-1]), np.zeros(2 * block), method="LSODA", t_eval=times,
        rtol=1e-7, atol=1e-10, max_step=0.005 / frequency,
    )  # fmt: skip
    torque = np.array([both(t, y)[0] for t, y in zip(times, moved.y.T, strict=True)])
    wave = np.exp(-2j * np.pi * frequency * times)
    turned = stroke * np.sin(2.0 * np.pi * frequency * times)
    whole = case.joint.spring_stiffness + np.trapezoid(torque * wave, times) / np.trapezoid(turned * wave, times)
    assert value(ran, "stiffness@cold") == pytest.approx(whole.real, rel=1e-3)
    assert value(ran, "damping@cold") == pytest.approx(whole.imag / (2.0 * np.pi * frequency), rel=5e-3)


def test_release_of_a_frozen_link_is_that_of_an_independent_integration(shear):
    case = next(known for known in cases(shear) if known.point == "cold")
    support = shear.quantity("support@cold")
    spring, elements = spectrum(float(support[0]), float(support[1]), float(shear.quantity("frequency@cold")))
    layer = [(float(tau), float(k)) for tau, k in shear.quantity("pcl_modes@cold")]
    springs, inertia = case.joint.spring_stiffness, case.joint.inertia
    (slow, soft), (slower, softer) = (np.array(modes).T for modes in (elements, layer))

    # Structure and layer each with their own dashpots: what the structure bears is what the layer bears.
    def rates(_: float, state: np.ndarray, moving: bool = True) -> np.ndarray:
        angle, speed = state[:2]
        give, inner = state[2 : 2 + len(slow)], state[2 + len(slow) :]
        across = (np.sum(softer * inner) + (spring + np.sum(soft)) * angle - np.sum(soft * give)) / (
            spring + np.sum(soft) + np.sum(softer)
        )
        carried = np.sum(softer * (across - inner))
        push = -(springs * angle + carried) / inertia
        flows = [*((angle - across - give) / slow), *((across - inner) / slower)]
        return np.array([speed, push, *flows] if moving else [0.0, 0.0, *flows])

    start = np.array([0.01, *np.zeros(1 + len(slow) + len(slower))])
    settings = {"method": "Radau", "rtol": 1e-8, "atol": 1e-12}
    held = solve_ivp(lambda t, y: rates(t, y, moving=False), (0.0, 0.2), start, **settings).y[:, -1]
    moved = link.released(case.plant, 0.01, link.held(case.plant, 0.01, 0.2), case.friction).motion
    times = moved.times[moved.times < 0.02]
    again = solve_ivp(rates, (0.0, times[-1]), held, t_eval=times, **settings)
    assert moved.angle[: len(times)] == pytest.approx(again.y[0], abs=2e-6 * 0.01)


def test_frozen_link_rings_down_by_half_its_loss_factor(shear):
    case = next(known for known in cases(shear) if known.point == "cold")
    moved = link.released(case.plant, 0.01, link.held(case.plant, 0.01, 1e-6), case.friction).motion
    crests = np.flatnonzero((moved.angle[1:-1] > moved.angle[:-2]) & (moved.angle[1:-1] > moved.angle[2:]))[:5] + 1
    decrement = np.log(moved.angle[crests[0]] / moved.angle[crests[3]]) / 3.0
    loss, stiffness = (shear.quantity(f"joint_{name}@cold") for name in ("damping", "stiffness"))
    factor = 2.0 * np.pi * shear.quantity("frequency@cold") * loss / stiffness
    # 2 pi zeta with zeta = eta/2, at the link's own pace of some hundred hertz.
    assert decrement == pytest.approx(np.pi * factor, rel=0.25)


STUDY = study_path("paper_reconstructed")
POINTS = ("cold", "melting", "hot")


@pytest.fixture(scope="module")
def resolved() -> ResolvedModule:
    # Without friction, as the textbook has it (what it does is in test_link_with_dry_friction.py), and without the
    # structure's loss (what that does is in below).
    study = read_study(STUDY)
    textbook = {"pin_friction": 0.0, **LOSSLESS}
    return resolve_study(study.model_copy(update={"module": {**study.module, **textbook}}))


@pytest.fixture(scope="module")
def release(resolved: ResolvedModule) -> Trial:
    return release_test.release(resolved)


@pytest.fixture(scope="module")
def sine(resolved: ResolvedModule) -> Trial:
    return sine_test.sine(resolved)


def slowness(resolved: ResolvedModule) -> float:
    """Time of the hot link's creep over the melt's viscosity [1/Pa]."""
    size = resolved.quantity("layer_polar_moment") / resolved.quantity("pcl_thickness")
    return float(size / resolved.quantity("spring_stiffness"))


def test_hot_link_creeps_back_and_cold_link_rings(resolved, release):
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


def test_release_gives_back_what_holding_put_in_and_makes_no_energy(release):
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


def test_kelvin_voigt_of_the_hot_link_is_too_stiff_and_comes_back_too_soon(resolved, release):
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


def test_frozen_joint_slips_at_the_torque_it_bears(resolved, release):
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
def test_sine_in_time_agrees_with_the_rows_within_one_percent(resolved, sine, point):
    worst = next(finding for finding in sine.findings if finding.name == f"frequency_domain_difference@{point}")
    assert max(worst.value, worst.high or 0.0) < 1e-2
    stiffness, damping = resolved.quantity(f"joint_stiffness@{point}"), resolved.quantity(f"joint_damping@{point}")
    assert value(sine, f"stiffness@{point}") == pytest.approx(stiffness, rel=1e-2)
    assert value(sine, f"damping@{point}") == pytest.approx(damping, rel=1e-2)
    # A cycle's heat is pi b omega theta^2.
    heat = np.pi * damping * 2.0 * np.pi * resolved.quantity(f"frequency@{point}") * resolved.quantity("stroke") ** 2
    assert value(sine, f"cycle_energy@{point}") == pytest.approx(heat, rel=1e-2)


def test_interval_holds_what_stands_between_the_histories(resolved, release):
    # Neither the liquid nor the most frozen layer creeps slowest: a layer a quarter of the way between does, by
    # its longest mode's viscosity over the springs, and takes longer than all three that are shown.
    settling = next(finding for finding in release.findings if finding.name == "settling_time@melting")
    temperature = resolved.quantity("temperature@melting")
    fraction = 0.25 * fractions_at(resolved, temperature)[2]
    lasting = resolved.quantity("pcl_rheology").equilibrated  # it was cooled
    time, modulus = polymer.spectrum(temperature, fraction, lasting)[0]
    assert settling.high == pytest.approx(np.log(20.0) * time * modulus * slowness(resolved), rel=0.2)
    assert settling.high > 10.0 * settling.value


def test_study_without_points_is_tested_at_the_papers_three_temperatures():
    def bench(text: str) -> ResolvedModule:
        return with_paper_points(resolve_study(read_study_text(text, "a test")))

    resolved = bench("mode: shear\n")
    assert resolved.points == POINTS
    at = [resolved.quantity(f"temperature@{point}") for point in resolved.points]
    assert at == pytest.approx([303.15, 333.15, 373.15])
    assert resolved.quantity("joint_stiffness@melting") > resolved.quantity("joint_stiffness@hot")
    own = "mode: shear\noperating_points:\n  hot: {temperature: 90 degC, frequency: 2 Hz}\n"
    assert set(bench(own).points) == {"cold", "hot"}
