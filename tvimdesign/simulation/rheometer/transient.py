"""The virtual rheometer holding still: creep with recovery, and stress relaxation."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from tvimdesign.physics.polymers import viscoelasticity
from tvimdesign.physics.polymers.viscoelasticity import Body
from tvimdesign.simulation.rheometer.specimen import (
    TITLES,
    Comparison,
    Specimen,
    State,
    compare,
    history_note,
    parameters,
    specimens,
)
from tvimdesign.simulation.trial import Array, Column, CurveTable, Finding, Panel, Trial
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule

STRESS = 50.0  # Pa, the paper's
LOADED = 300.0  # s, the paper's
RECOVERY = 600.0  # s, the paper's; it says 200 s once
UNDER_LOAD = np.geomspace(0.01, LOADED, 90)  # s
AFTER_LOAD = LOADED + np.geomspace(0.01, RECOVERY, 90)  # s
LAST_LOADED = LOADED * (1.0 - 1e-12)  # s, the instant before the load goes
STRAIN = 0.10  # the paper's
STEP = 1e-5  # s; as good as at once: the first instant is a hundred times later
RISE = 0.1  # s; the strain is reached at a constant rate, as a motor can
HELD = np.geomspace(1e-3, 1e3, 121)  # s
DAY = 86400.0  # s


def creep(resolved: ResolvedModule, temperatures: Sequence[float] | None = None) -> Trial:
    """Load with a constant stress, take it off, and watch the strain; the simple bodies are fitted under load."""
    tested = specimens(resolved, temperatures)
    compared = [compare(at, _compliance, lambda body: body.creep(UNDER_LOAD), (UNDER_LOAD[0], LOADED)) for at in tested]
    pairs = list(zip(tested, compared, strict=True))
    lines = tuple(at.line(f"creep_{at.point}", "time", "compliance") for at in tested)
    panels = [Panel("Creep compliance", "Time (s)", "Compliance J (1/Pa)", lines, log_x=True, log_y=True)]
    panels += [
        at.bodies_panel("Creep and recovery", ("Time (s)", "Strain (%)"), f"creep_{at.point}", "time", "strain",
                        log_x=False, log_y=bool(at.others))
        for at in tested
    ]  # fmt: skip
    return Trial(
        test="creep",
        title=f"Creep under {STRESS:g} Pa for {LOADED:g} s, and {RECOVERY:g} s of recovery",
        sheets=(*(_creep_sheet(at, fitted) for at, fitted in pairs), parameters(compared)),
        panels=tuple(panels),
        findings=tuple(
            finding
            for at, fitted in pairs
            for finding in (*_creep_findings(at), *fitted.findings(), *_static_load(at, fitted))
        ),
        notes=(
            history_note(resolved),
            "The paper gives the recovery as 600 s and, once, as 200 s; 600 s is taken.",
            "Linear: at 50 Pa the melt flows so slowly that its strain, however large, is forgotten as it grows.",
            "The simple bodies are drawn for the equilibrium curve on heating.",
        ),
    )


def _compliance(state: State) -> Array:
    compliance: Array = viscoelasticity.creep_compliance(UNDER_LOAD, viscoelasticity.retardation(state.modes))
    return compliance


def _strain(state: State, time: Array) -> Array:
    response = viscoelasticity.retardation(state.modes)
    strain: Array = viscoelasticity.creep_and_recovery(time, STRESS, LOADED, response)
    return strain


def _body_strain(body: Body, time: Array) -> Array:
    before, after = np.minimum(time, LOADED), np.maximum(time - LOADED, 0.0)
    strain: Array = STRESS * np.where(time < LOADED, body.creep(before), body.creep(time) - body.creep(after))
    return strain


def _creep_sheet(at: Specimen, fitted: Comparison) -> CurveTable:
    time = np.concatenate([UNDER_LOAD[:-1], [LAST_LOADED], AFTER_LOAD])
    columns = (
        Column("time", "s", time),
        Column("stress", "Pa", np.where(time < LOADED, STRESS, 0.0)),
        *at.columns("strain", "%", lambda state: _strain(state, time)),
        *at.columns("compliance", "1/Pa", lambda state: _strain(state, time) / STRESS),
        *fitted.curves("strain", "%", lambda body: _body_strain(body, time)),
    )
    return CurveTable(f"creep_{at.point}", columns)


def _creep_findings(at: Specimen) -> tuple[Finding, ...]:
    end, last = np.array([LAST_LOADED]), np.array([LOADED + RECOVERY])

    def recovered(state: State) -> float:
        return float(1.0 - _strain(state, last)[0] / _strain(state, end)[0])

    return (
        at.finding("creep_strain", "%", f"strain after {LOADED:g} s under {STRESS:g} Pa",
                   lambda state: float(_strain(state, end)[0])),
        at.finding("recovered_share", "%", f"share of that strain gone {RECOVERY:g} s after the load", recovered),
        at.finding("instant_compliance", "1/Pa", "compliance at once",
                   lambda state: viscoelasticity.retardation(state.modes).instant_compliance),
    )  # fmt: skip


def _static_load(at: Specimen, fitted: Comparison) -> tuple[Finding, ...]:
    """Return the compliance of the fitted bodies under a load that stays: one cannot hold it, another cannot flow."""
    findings = []
    for kind, fits in fitted.fits.items():
        bodies = dict(zip(at.states, (fit.body for fit in fits), strict=True))

        def share(state: State, bodies: dict[State, Body] = bodies) -> float:
            full = viscoelasticity.creep_compliance(DAY, viscoelasticity.retardation(state.modes))
            return float(bodies[state].creep(DAY) / full)

        meaning = f"compliance after a day under load, {TITLES[kind]} body over full spectrum"
        findings.append(at.finding(f"{kind}_after_a_day", "1", meaning, share))
    return tuple(findings)


def relaxation(resolved: ResolvedModule, temperatures: Sequence[float] | None = None) -> Trial:
    """Strain within a short rise, hold, and watch the stress; the simple bodies are fitted to G(t) of an ideal step."""
    tested = specimens(resolved, temperatures)
    compared = [compare(at, _relaxed, lambda body: body.relaxation(HELD), (HELD[0], HELD[-1])) for at in tested]
    pairs = list(zip(tested, compared, strict=True))
    lines = tuple(at.line(f"relaxation_{at.point}", "time", "stress") for at in tested)
    title = f"Stress, strained within {RISE:g} s"
    panels = [Panel(title, "Time (s)", "Stress (Pa)", lines, log_x=True, log_y=True)]
    labels = ("Time (s)", "Modulus G (Pa)")
    panels += [
        at.bodies_panel("Relaxation modulus", labels, f"relaxation_{at.point}", "time", "relaxation_modulus")
        for at in tested
    ]
    return Trial(
        test="relaxation",
        title=f"Stress relaxation at {100.0 * STRAIN:g} % strain",
        sheets=(*(_relaxation_sheet(at, fitted) for at, fitted in pairs), parameters(compared)),
        panels=tuple(panels),
        findings=tuple(finding for at, fitted in pairs for finding in (*_relaxation_findings(at), *fitted.findings())),
        notes=(
            history_note(resolved),
            f"The strain is reached at a constant rate within {RISE:g} s, as a motor can; the melt relaxes meanwhile.",
            "In the melt, strain beyond the linear range takes the same share of the modulus at all times.",
            "Frozen, stress shortens all relaxation times: the polymer yields at the strength of its record.",
            "Fits do not look below a millionth of the first stress. The simple bodies are drawn for the equilibrium "
            "curve on heating.",
        ),
    )


def _relaxed(state: State) -> Array:
    return _held(state, STEP) / STRAIN


def _stress(state: State) -> Array:
    return _held(state, RISE)


@cache
def _held(state: State, rise: float) -> Array:
    return state.step_stress(HELD, STRAIN, rise)


def _relaxation_sheet(at: Specimen, fitted: Comparison) -> CurveTable:
    columns = (
        Column("time", "s", HELD),
        Column("strain", "%", STRAIN * np.minimum(HELD / RISE, 1.0)),
        *at.columns("stress", "Pa", _stress),
        *at.columns("relaxation_modulus", "Pa", _relaxed),
        *fitted.curves("relaxation_modulus", "Pa", lambda body: body.relaxation(HELD)),
    )
    return CurveTable(f"relaxation_{at.point}", columns)


def _relaxation_findings(at: Specimen) -> tuple[Finding, ...]:
    def left_after(state: State, time: float) -> float:
        return float(np.interp(time, HELD, _stress(state)))

    def linear_share(state: State) -> float:
        linear = viscoelasticity.ramped_stress(np.ones(1), STRAIN, RISE, state.modes)
        return left_after(state, 1.0) / float(linear[0])

    return (
        at.finding("stress_after_1_s", "Pa", "stress 1 s after the strain began", lambda state: left_after(state, 1.0)),
        at.finding(
            "stress_after_100_s", "Pa", "stress 100 s after the strain began", lambda state: left_after(state, 100.0)
        ),
        at.finding("largest_stress", "Pa", "largest stress", lambda state: float(np.max(_stress(state)))),
        at.finding("linear_share", "1", "share of the linear spectrum's stress after 1 s", linear_share),
    )
