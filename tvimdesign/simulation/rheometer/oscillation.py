"""The virtual rheometer oscillating: sweeps of frequency, of amplitude and of temperature."""

from collections.abc import Callable, Sequence

import numpy as np

from tvimdesign.physics.polymers import viscoelasticity
from tvimdesign.physics.polymers.polymer import LINEAR_DROP, ZERO_CELSIUS, maxwell_moduli
from tvimdesign.physics.polymers.viscoelasticity import Body
from tvimdesign.simulation.rheometer.specimen import (
    Comparison,
    Specimen,
    State,
    at_fraction,
    compare,
    history_note,
    parameters,
    specimen,
    specimens,
)
from tvimdesign.simulation.trial import Array, Column, CurveTable, Finding, Panel, PlottedLine, Trial
from tvimdesign.simulation.working_cycle.curves import frozen_on_cooling
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule

SMALL_STRAIN = 1e-4  # Strain of the frequency and temperature sweeps: the paper's 0.01 %
FREQUENCIES = np.geomspace(0.1, 628.0, 77)  # rad/s, the paper's
STRAINS = np.geomspace(1e-4, 10.0, 101)
AMPLITUDE_FREQUENCY = 10.0  # rad/s; the paper gives none: assumed, a usual choice
TEMPERATURES = np.arange(-5.0, 200.5, 1.0) + ZERO_CELSIUS  # K, the paper's
COOLING_RATE = 5.0 / 60.0  # K/s; the paper gives none: assumed, a usual choice
ONE_HERTZ = 2.0 * np.pi  # rad/s

Cooling = Callable[[float], float]  # Solid fraction [1] at a temperature [K] while the polymer is cooled from the melt


def _star(state: State, angular_frequency: float | Array, strain: float | Array) -> tuple[Array, Array]:
    """Return storage and loss modulus [Pa] at a strain; softening takes the same share of both."""
    storage, loss = maxwell_moduli(angular_frequency, state.modes)
    return storage * state.left(strain), loss * state.left(strain)


def frequency(resolved: ResolvedModule, temperatures: Sequence[float] | None = None) -> Trial:
    """Sweep the frequency at a small strain; the simple bodies are fitted to G' and G''."""
    tested = specimens(resolved, temperatures)
    sheets, compared = [], []
    for at in tested:
        fitted = compare(at, lambda state: np.concatenate(_star(state, FREQUENCIES, SMALL_STRAIN)), _both,
                         (1.0 / FREQUENCIES[-1], 1.0 / FREQUENCIES[0]))  # fmt: skip
        compared.append(fitted)
        sheets.append(_frequency_sheet(at, fitted))
    findings: list[Finding] = []
    for at, fitted in zip(tested, compared, strict=True):
        findings += [*_moduli_at_1_hertz(at), *fitted.findings()]
    labels = ("Angular frequency (rad/s)", "Complex modulus |G*| (Pa)")
    bodies = (
        at.bodies_panel("Simple bodies", labels, f"frequency_{at.point}", "angular_frequency", "complex_modulus")
        for at in tested
    )
    return Trial(
        test="frequency",
        title="Frequency sweep at 0.01 % strain",
        sheets=(*sheets, parameters(compared)),
        panels=(*_frequency_panels(tested), *bodies),
        findings=tuple(findings),
        notes=(history_note(resolved), "The simple bodies are drawn for the equilibrium curve on heating."),
    )


def _both(body: Body) -> Array:
    star = body.modulus(FREQUENCIES)
    return np.concatenate([star.real, star.imag])


def _frequency_sheet(at: Specimen, fitted: Comparison) -> CurveTable:
    columns: list[Column] = [Column("angular_frequency", "rad/s", FREQUENCIES)]
    columns += at.columns("storage_modulus", "Pa", lambda state: _star(state, FREQUENCIES, SMALL_STRAIN)[0])
    columns += at.columns("loss_modulus", "Pa", lambda state: _star(state, FREQUENCIES, SMALL_STRAIN)[1])
    columns += at.columns("complex_modulus", "Pa", lambda state: np.hypot(*_star(state, FREQUENCIES, SMALL_STRAIN)))
    columns += at.columns(
        "complex_viscosity", "Pa*s",
        lambda state: viscoelasticity.complex_viscosity(FREQUENCIES, state.modes) * state.left(SMALL_STRAIN),
    )  # fmt: skip
    columns += at.columns("loss_factor", "1", lambda state: viscoelasticity.loss_factor(FREQUENCIES, state.modes))
    columns += fitted.curves("complex_modulus", "Pa", lambda body: np.abs(body.modulus(FREQUENCIES)))
    return CurveTable(f"frequency_{at.point}", tuple(columns))


def _frequency_panels(tested: Sequence[Specimen]) -> tuple[Panel, ...]:
    def lines(name: str, *, dashed: bool = False, ending: str = "") -> list[PlottedLine]:
        return [
            at.line(f"frequency_{at.point}", "angular_frequency", name, f"{at.label}{ending}", dashed=dashed)
            for at in tested
        ]

    x = "Angular frequency (rad/s)"
    moduli = (*lines("storage_modulus", ending=", G'"), *lines("loss_modulus", dashed=True, ending=", G''"))
    return (
        Panel("Moduli", x, "Moduli G', G'' (Pa)", moduli, log_x=True, log_y=True),
        Panel(
            "Complex viscosity",
            x,
            "Complex viscosity |η*| (Pa·s)",
            tuple(lines("complex_viscosity")),
            log_x=True,
            log_y=True,
        ),
        Panel("Loss factor", x, "Loss factor tan δ (–)", tuple(lines("loss_factor")), log_x=True, log_y=True),
    )


def _moduli_at_1_hertz(at: Specimen) -> tuple[Finding, ...]:
    def factor(state: State) -> float:
        return float(viscoelasticity.loss_factor(ONE_HERTZ, state.modes))

    return (
        at.finding("storage_modulus", "Pa", "storage modulus at 1 Hz",
                   lambda state: float(_star(state, ONE_HERTZ, SMALL_STRAIN)[0])),
        at.finding("loss_modulus", "Pa", "loss modulus at 1 Hz",
                   lambda state: float(_star(state, ONE_HERTZ, SMALL_STRAIN)[1])),
        at.finding("loss_factor", "1", "loss factor, tan(delta), at 1 Hz", factor),
        at.finding("zero_shear_viscosity", "Pa*s", "viscosity of slow steady flow",
                   lambda state: float(viscoelasticity.zero_shear_viscosity(state.modes))),
    )  # fmt: skip


def amplitude(resolved: ResolvedModule, temperatures: Sequence[float] | None = None) -> Trial:
    """Sweep the strain at one frequency, and find the end of the linear range."""
    tested = specimens(resolved, temperatures)

    def moduli(state: State) -> tuple[Array, Array]:
        return _star(state, AMPLITUDE_FREQUENCY, STRAINS)

    sheets, lines, findings = [], [], []
    for at in tested:
        sheet = f"amplitude_{at.point}"
        columns = (
            Column("strain", "%", STRAINS),
            *at.columns("storage_modulus", "Pa", lambda state: moduli(state)[0]),
            *at.columns("loss_modulus", "Pa", lambda state: moduli(state)[1]),
        )
        sheets.append(CurveTable(sheet, columns))
        lines += [
            at.line(sheet, "strain", "storage_modulus", f"{at.label}, G'"),
            at.line(sheet, "strain", "loss_modulus", f"{at.label}, G''", dashed=True),
        ]
        meaning = f"strain at which the storage modulus has fallen {100.0 * LINEAR_DROP:g} %"
        findings.append(at.finding("linear_limit", "%", meaning, lambda state: _linear_limit(moduli(state)[0])))
    panel = Panel("Amplitude sweep", "Strain (%)", "Moduli G', G'' (Pa)", tuple(lines), log_x=True, log_y=True)
    return Trial(
        test="amplitude",
        title=f"Amplitude sweep at {AMPLITUDE_FREQUENCY:g} rad/s",
        sheets=tuple(sheets),
        panels=(panel,),
        findings=tuple(findings),
        notes=(
            history_note(resolved),
            "Strain takes the same share of G' and G''; the strain at which that begins is assumed, in the record.",
            f"The paper gives no frequency for this test; {AMPLITUDE_FREQUENCY:g} rad/s is assumed.",
        ),
    )


def _linear_limit(storage: Array) -> float:
    """Return the strain at which the storage modulus has fallen from that at the least strain, between two samples."""
    drop = 1.0 - storage / storage[0]
    return float(np.exp(np.interp(LINEAR_DROP, drop, np.log(STRAINS))))


def temperature(
    resolved: ResolvedModule, cooling: Cooling | None = None, temperatures: Sequence[float] | None = None
) -> Trial:
    """Sweep the temperature at 1 Hz: heated along the equilibrium curve, and cooled, freezing late, from the melt."""
    swept = specimens(resolved, TEMPERATURES.tolist() if temperatures is None else temperatures)
    cooling = cooling or frozen_on_cooling(resolved, COOLING_RATE)
    sheets = [_heating_sheet(swept), _cooling_sheet(resolved, swept, cooling)]
    cooled = sheets[1].column("solid_fraction").values
    first, last = _flow_range(sheets[0])
    crossing = Finding(
        "crossover_temperature", _crossing(sheets[0]), "degC",
        "temperature at which the loss modulus passes the storage modulus on heating at 1 Hz", first, last,
    )  # fmt: skip
    half_frozen = np.interp(0.5, cooled[::-1], sheets[1].column("temperature").values[::-1])
    half = Finding(
        "freezing_temperature", float(half_frozen), "degC",
        f"temperature at which half is frozen, cooled at {60.0 * COOLING_RATE:g} K/min",
    )  # fmt: skip
    ends = (specimen(resolved, 303.15), specimen(resolved, 373.15))
    return Trial(
        test="temperature",
        title="Temperature sweep at 1 Hz and 0.01 % strain",
        sheets=tuple(sheets),
        panels=_temperature_panels(sheets),
        findings=(crossing, half, *(finding for at in ends for finding in _moduli_at_1_hertz(at))),
        notes=(
            history_note(resolved),
            f"Cooled at {60.0 * COOLING_RATE:g} K/min, a usual rate; the paper states none. "
            "The slower, the less supercooled.",
            "Polycaprolactone decomposes near 200 °C, and the time spent there counts; that is not modelled.",
        ),
    )


def _at_1_hertz(states: Sequence[State]) -> tuple[Array, Array]:
    pairs = np.array([_star(state, ONE_HERTZ, SMALL_STRAIN) for state in states])
    return pairs[:, 0], pairs[:, 1]


def _columns(name: str, unit: str, nominal: Array, every: Sequence[Array]) -> tuple[Column, ...]:
    """Return a quantity along the sweep with its least and largest value at each temperature."""
    return (
        Column(name, unit, nominal),
        Column(f"{name}_low", unit, np.array([values.min() for values in every])),
        Column(f"{name}_high", unit, np.array([values.max() for values in every])),
    )


def _heating_sheet(swept: Sequence[Specimen]) -> CurveTable:
    storage, loss = _at_1_hertz([at.nominal for at in swept])
    every = [_at_1_hertz(at.states) for at in swept]
    fractions = np.array([at.nominal.fraction for at in swept])
    return CurveTable(
        "heating",
        (
            Column("temperature", "degC", np.array([at.temperature for at in swept])),
            *_columns("solid_fraction", "1", fractions, [np.array([s.fraction for s in at.states]) for at in swept]),
            *_columns("storage_modulus", "Pa", storage, [pair[0] for pair in every]),
            *_columns("loss_modulus", "Pa", loss, [pair[1] for pair in every]),
            *_columns("loss_factor", "1", loss / storage, [pair[1] / pair[0] for pair in every]),
        ),
    )


def _cooling_sheet(resolved: ResolvedModule, swept: Sequence[Specimen], cooling: Cooling) -> CurveTable:
    temperatures = np.array([at.temperature for at in swept])
    fractions = [cooling(at) for at in temperatures]
    states = [at_fraction(resolved, at, fraction) for at, fraction in zip(temperatures, fractions, strict=True)]
    storage, loss = _at_1_hertz(states)
    return CurveTable(
        "cooling",
        (
            Column("temperature", "degC", temperatures),
            Column("solid_fraction", "1", np.array(fractions)),
            Column("storage_modulus", "Pa", storage),
            Column("loss_modulus", "Pa", loss),
            Column("loss_factor", "1", loss / storage),
        ),
    )


def _temperature_panels(sheets: Sequence[CurveTable]) -> tuple[Panel, ...]:
    def lines(name: str, label: str, *, dashed: bool = False) -> list[PlottedLine]:
        return [
            PlottedLine(sheet.name, "temperature", name, f"{sheet.name}{label}",
                 (f"{name}_low", f"{name}_high") if sheet.name == "heating" else None, dashed)
            for sheet in sheets
        ]  # fmt: skip

    moduli = (*lines("storage_modulus", ", G'"), *lines("loss_modulus", ", G''", dashed=True))
    x = "Temperature (°C)"
    return (
        Panel("Moduli", x, "Moduli G', G'' (Pa)", moduli, log_y=True),
        Panel("Loss factor", x, "Loss factor tan δ (–)", tuple(lines("loss_factor", "")), log_y=True),
    )


def _crossing(heating: CurveTable) -> float:
    """Return the temperature [K] at which the nominal loss factor passes one, between two samples."""
    factor, at = heating.column("loss_factor").values, heating.column("temperature").values
    first = int(np.argmax(factor >= 1.0))
    if factor[0] >= 1.0 or factor[first] < 1.0:
        return float(at[0] if factor[0] >= 1.0 else at[-1])
    return float(np.interp(0.0, np.log(factor[first - 1 : first + 1]), at[first - 1 : first + 1]))


def _flow_range(heating: CurveTable) -> tuple[float, float]:
    """Return the lowest temperature [K] at which some history flows, highest at which some history is still solid."""
    at = heating.column("temperature").values
    flows = at[heating.column("loss_factor_high").values >= 1.0]
    holds = at[heating.column("loss_factor_low").values < 1.0]
    return float(flows.min(initial=at[-1])), float(holds.max(initial=at[0]))
