"""Small files of our own in the layouts of instruments, of melts and polymers with known values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

VISCOSITY, LIMIT = 1500.0, 0.3
HEAT, MELTS_FROM, MELTS_TO, MASS = 60.0, 50.0, 62.0, 5.2
"""kJ/kg, degC, degC, mg."""


def noise_of(count: int, share: float, seed: int) -> Any:
    return np.exp(np.random.default_rng(seed).normal(0.0, share, count))


def flow() -> tuple[Any, Any]:
    """Rates and viscosities by Carreau (Bird, Armstrong and Hassager, eq. 4.1-9)."""
    rate = np.geomspace(0.01, 100.0, 15)
    return rate, VISCOSITY * (1.0 + (0.4 * rate) ** 2) ** -0.3 * noise_of(15, 0.01, 1)


def amplitudes() -> tuple[Any, Any, Any]:
    """Strains [1] and moduli that lose 5 % at `LIMIT`."""
    strain = np.geomspace(1e-3, 3.0, 30)
    left = 1.0 / (1.0 + 0.05 / 0.95 * (strain / LIMIT) ** 1.6)
    return strain, 5e3 * left * noise_of(30, 0.01, 2), 1.2e4 * left**0.9 * noise_of(30, 0.01, 3)


def calorimetry() -> tuple[Any, Any, Any]:
    """Times [s], temperatures [degC] and heat given off [W/g] of a heating at 10 K/min over a melting window.

    The specific heat rises by 0.25 J/(g K) while it melts.
    """
    time = np.linspace(0.0, 480.0, 480)
    temperature = 10.0 + time / 6.0
    melts = 0.5 * (np.tanh((temperature - MELTS_FROM) / 2.4) - np.tanh((temperature - MELTS_TO) / 1.4))
    melts /= MELTS_TO - MELTS_FROM
    molten = np.cumsum(melts) * (temperature[1] - temperature[0])
    heat = -0.1 - (HEAT * melts + 0.25 * molten) / 6.0
    return time, temperature, heat + np.random.default_rng(4).normal(0.0, 5e-3, 480)


def table_of(head: str, rows: Sequence[Sequence[Any]], separator: str, decimal: str = ".") -> str:
    lines = [separator.join(cell if isinstance(cell, str) else f"{cell:.6g}".replace(".", decimal) for cell in row)
             for row in rows]  # fmt: skip
    return "\n".join([head, *lines]) + "\n"


def rows_of(*columns: Any) -> list[list[Any]]:
    count = max(len(column) for column in columns if isinstance(column, np.ndarray))
    return [[column[i] if isinstance(column, np.ndarray) else column for column in columns] for i in range(count)]


def rheocompass_flow() -> bytes:
    rate, eta = flow()
    head = (
        "Project:\tPCL\n\nInterval data:\tPoint No.\tShear Rate\tShear Stress\tViscosity\tTemperature\tStatus\n"
        "\t\t\t\t\t\t\n\t\t[1/s]\t[Pa]\t[mPa·s]\t[°C]\t[]"
    )
    return table_of(head, rows_of("", np.arange(15.0), rate, rate * eta, 1e3 * eta, 100.0, ""), "\t").encode("utf-16")


def trios_flow() -> bytes:
    rate, eta = flow()
    head = (
        "Filename\tx\n[step]\nFlow sweep - 1\nStress\tShear rate\tViscosity\tStep time\tTemperature\n"
        "Pa\t1/s\tPa.s\ts\t°C"
    )
    return table_of(head, rows_of(rate * eta, rate, eta, 30.0 * np.arange(15.0), 100.0), "\t").encode()


def haake_flow() -> bytes:
    rate, eta = flow()
    head = "t in s;GP in 1/s;Tau in Pa;Eta in mPas;T in °C"
    return table_of(head, rows_of(30.0 * np.arange(15.0), rate, rate * eta, 1e3 * eta, 100.0), ";", ",").encode(
        "latin-1"
    )


def plain_flow() -> bytes:
    return table_of("shear_rate_1/s,viscosity_Pas,T_sample", rows_of(*flow(), 100.0), ",").encode()


def rheocompass_amplitude() -> bytes:
    strain, storage, loss = amplitudes()
    wrong = np.arange(30) < 3
    storage, loss = (np.where(wrong, 1e6, moduli) for moduli in (storage, loss))
    head = (
        "Interval data:\tPoint No.\tStrain\tStorage Modulus\tLoss Modulus\tTemperature\tStatus\n"
        "\t\t[%]\t[Pa]\t[Pa]\t[°C]\t[]"
    )
    rows = rows_of("", np.arange(30.0), 100.0 * strain, storage, loss, 100.0, np.where(wrong, "ME-", ""))
    return table_of(
        head, [[str(cell) if isinstance(cell, str) else cell for cell in row] for row in rows], "\t"
    ).encode("utf-16")


def trios_amplitude() -> bytes:
    strain, storage, loss = amplitudes()
    head = (
        "[step]\nAmplitude sweep - 1\n"
        "Oscillation strain\tStorage modulus\tLoss modulus\tAngular frequency\tTemperature\n"
        "%\tPa\tPa\trad/s\t°C"
    )
    return table_of(head, rows_of(100.0 * strain, storage, loss, 10.0, 100.0), "\t").encode()


def haake_amplitude() -> bytes:
    return table_of("gamma in -;G' in Pa;G'' in Pa;f in Hz;T in °C", rows_of(*amplitudes(), 1.0, 100.0), ";").encode(
        "latin-1"
    )


def ta_universal() -> bytes:
    time, at, heat = calorimetry()
    head = (
        f"Version\tV4\nInstrument\tDSC Q200\nSize\t{MASS} mg\nNsig\t3\nSig1\tTime (min)\nSig2\tTemperature (°C)\n"
        "Sig3\tHeat Flow (mW)\nStartOfData"
    )
    return table_of(head, rows_of(time / 60.0, at, MASS * heat), "\t").encode("latin-1")


def trios_dsc() -> bytes:
    time, at, heat = calorimetry()
    head = "[step]\nRamp 10 °C/min\nTime\tTemperature\tHeat Flow (Normalized)\nmin\t°C\tW/g"
    return table_of(head, rows_of(time / 60.0, at, heat), "\t").encode()


def setaram() -> bytes:
    time, at, heat = calorimetry()
    head = "Index;Time (s);Furnace Temperature (°C);Sample Temperature (°C);HeatFlow (mW)"
    return table_of(head, rows_of(np.arange(480.0), time, at + 1.0, at, MASS * heat), ";").encode("latin-1")


def mettler() -> bytes:
    time, at, heat = calorimetry()
    head = "Curve Name:\n  PCL\nCurve Values:\n  Index  t  Heatflow  Tr\n  [s]  [mW]  [°C]"
    return table_of(head, rows_of(np.arange(480.0), time, MASS * heat, at), "  ").encode("latin-1")


def netzsch() -> bytes:
    time, at, heat = calorimetry()
    head = "#EXPORTTYPE:DATA ALL\n#SAMPLE MASS /mg:5,20\n#EXO:1\n##Temp./°C;Time/min;DSC/(mW/mg);Sensit./(uV/mW)"
    return table_of(head, rows_of(at, time / 60.0, heat, 3.4), ";", ",").encode("latin-1")


def plain_dsc() -> bytes:
    time, at, heat = calorimetry()
    return table_of("T_sample;t;HeatFlow\n/degC;/s;/mW", rows_of(at, time, MASS * heat), ";").encode()


def pyris() -> bytes:
    time, at, heat = calorimetry()
    head = (
        "Time\tUnsubtracted Heat Flow\tBaseline Heat Flow\tProgram Temperature\tSample Temperature\nmin\tmW\tmW\t°C\t°C"
    )
    return table_of(head, rows_of(time / 60.0, MASS * heat, 0.0, at + 0.5, at), "\t").encode("latin-1")


FLOW: Sequence[Callable[[], bytes]] = (rheocompass_flow, trios_flow, haake_flow, plain_flow)
AMPLITUDE: Sequence[Callable[[], bytes]] = (rheocompass_amplitude, trios_amplitude, haake_amplitude)
WITH_MASS: Sequence[Callable[[], bytes]] = (ta_universal, trios_dsc, netzsch)
WITHOUT_MASS: Sequence[Callable[[], bytes]] = (setaram, mettler, plain_dsc, pyris)
