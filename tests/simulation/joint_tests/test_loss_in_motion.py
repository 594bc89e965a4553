"""Printed structures lose energy in motions in time as their complex stiffness says; held against Radau."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support import study_path

from tvimdesign.simulation.joint_tests import sine as sine_test
from tvimdesign.simulation.joint_tests.case import cases
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.sampled_motion import spectrum
from tvimdesign.simulation.trial import Trial
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.study import read_study


def module(name: str) -> ResolvedModule:
    study = read_study(study_path(name))
    return resolve_study(study.model_copy(update={"module": {**study.module, "pin_friction": 0.0}}))


@pytest.fixture(scope="module")
def shear() -> ResolvedModule:
    return module("paper_reconstructed")


def value(trial: Trial, name: str) -> float:
    return next(finding.value for finding in trial.findings if finding.name == name)


def hold_to_rows(resolved: ResolvedModule, points: tuple[str, ...]) -> None:
    found = sine_test.sine(resolved)
    for point in points:
        for name in ("stiffness", "damping"):
            row = resolved.quantity(f"joint_{name}@{point}")
            assert value(found, f"{name}@{point}") == pytest.approx(row, rel=0.01), (name, point)
        assert value(found, f"frequency_domain_difference@{point}") < 0.01


def test_sine_gives_stiffness_and_damping_of_the_operating_points(shear: ResolvedModule) -> None:
    # The frozen joint's damping is its structure's alone: without loss in time it came to a hundredth.
    assert shear.quantity("joint_damping@cold") > 1.0
    hold_to_rows(shear, ("cold", "hot"))


@pytest.mark.slow
def test_sine_of_frozen_blocks_is_that_of_an_independent_integration() -> None:
    # A lossy block lags behind the link and is left before the link is back: no row of small motions knows of that.
    resolved = module("paper_compression")
    found = sine_test.sine(resolved)
    case = next(one for one in cases(resolved) if one.point == "cold")
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
    assert value(found, "stiffness@cold") == pytest.approx(whole.real, rel=1e-3)
    assert value(found, "damping@cold") == pytest.approx(whole.imag / (2.0 * np.pi * frequency), rel=5e-3)


def test_release_of_a_frozen_link_is_that_of_an_independent_integration(shear: ResolvedModule) -> None:
    case = next(one for one in cases(shear) if one.point == "cold")
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


def test_frozen_link_rings_down_by_half_its_loss_factor(shear: ResolvedModule) -> None:
    case = next(one for one in cases(shear) if one.point == "cold")
    moved = link.released(case.plant, 0.01, link.held(case.plant, 0.01, 1e-6), case.friction).motion
    crests = np.flatnonzero((moved.angle[1:-1] > moved.angle[:-2]) & (moved.angle[1:-1] > moved.angle[2:]))[:5] + 1
    decrement = np.log(moved.angle[crests[0]] / moved.angle[crests[3]]) / 3.0
    loss, stiffness = (shear.quantity(f"joint_{name}@cold") for name in ("damping", "stiffness"))
    factor = 2.0 * np.pi * shear.quantity("frequency@cold") * loss / stiffness
    # 2 pi zeta with zeta = eta/2, at the link's own pace of some hundred hertz.
    assert decrement == pytest.approx(np.pi * factor, rel=0.25)
