"""Small files of our own in the layouts of instruments, of one melt's spectrum (Ferry, ch. 3).

The layouts are those of RheoCompass, TRIOS, ARES-G2, RheoWin and of tables that people write, as in
github.com/bsaintmichel/read-rheol, rlt672/rheology_plotting and the examples in readers of RheoWin's text.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from layouts import noise_of, rows_of, table_of
from measured_files import arrhenius, moduli, workbook

from tvimdesign.physics.polymers.viscoelasticity import retardation

MODES = [(0.5, 800.0), (0.05, 1e4), (0.004, 6e4)]
VISCOSITY = sum(tau * modulus for tau, modulus in MODES)
PLATEAU = sum(modulus for _, modulus in MODES)
ENERGY, REFERENCE = 35e3, 373.15


class Layout(NamedTuple):
    """A file, and what a fit of it comes to: the kind, and values of its record or the words of the refusal."""

    data: Callable[[], bytes]
    kind: str
    truth: Mapping[str, float]
    ending: str = ".txt"
    refusal: str = ""


def sweep(seed: int, degrees: float = 100.0) -> tuple[Any, Any, Any]:
    """Angular frequencies and moduli."""
    omega = np.geomspace(100.0, 0.1, 16)
    storage, loss = moduli(omega * arrhenius(degrees, ENERGY, REFERENCE - 273.15), MODES)
    return omega, storage * noise_of(16, 0.02, seed), loss * noise_of(16, 0.02, seed + 1)


def relaxed() -> tuple[Any, Any]:
    """Times and moduli after a step of the strain."""
    time = np.geomspace(1e-3, 1.5, 60)
    return time, sum(modulus * np.exp(-time / tau) for tau, modulus in MODES) * noise_of(60, 0.02, 5)


def crept() -> tuple[Any, Any]:
    """Times and compliances under a constant stress."""
    time, response = np.geomspace(2e-3, 20.0, 60), retardation(MODES)
    recoverable = sum(compliance * (1.0 - np.exp(-time / tau)) for tau, compliance in response.modes)
    return time, (response.instant_compliance + recoverable + time / VISCOSITY) * noise_of(60, 0.01, 6)


def rheocompass_sweeps() -> bytes:
    text = "Project:\tPCL\n\n"
    for seed, degrees in enumerate((80.0, 100.0, 120.0)):
        omega, storage, loss = sweep(10 * seed, degrees)
        text += table_of(
            "Interval data:\tPoint No.\tTemperature\tFrequency\tStorage Modulus\tLoss Modulus\tStatus\n\t\t\t\t\t\t\n"
            "\t\t[°C]\t[Hz]\t[kPa]\t[kPa]\t[]\n\t0  (invalid)\t\t\t\t\t",
            rows_of("", np.arange(16.0), degrees, omega / (2.0 * np.pi), storage / 1e3, loss / 1e3, "Dy_auto"), "\t",
            ",") + "\n"  # fmt: skip
    return text.encode("utf-16")


def rheocompass_without_units() -> bytes:
    head = "Sample ID\tTPU\nInterval data:\tPoint No.\tTemperature\tAngular Frequency\tStorage Modulus\tLoss Modulus"
    return table_of(head, rows_of("", np.arange(16.0), 100.0, *sweep(20)), "\t").encode()


def rheocompass_relaxation() -> bytes:
    time, modulus = relaxed()
    head = (
        "Interval data:\tPoint No.\tTime\tRelaxation Modulus\tShear Strain\tTemperature\tStatus\n\n"
        "\t\t[ms]\t[MPa]\t[%]\t[°C]\t[]"
    )
    rows = rows_of("", np.arange(60.0), 1e3 * time, modulus / 1e6, 1.0, 100.0, "")
    return table_of(head.replace("\n\n", "\n\t\t\t\t\t\t\n"), rows, "\t").encode("utf-16")


def rheocompass_creep() -> bytes:
    time, compliance = crept()
    head = (
        "Interval data:\tPoint No.\tTime\tShear Strain\tShear Stress\tTemperature\tStatus\n\t\t[s]\t[%]\t[Pa]\t[°C]\t[]"
    )
    return table_of(head, rows_of("", np.arange(60.0), time, 5000.0 * compliance, 50.0, 100.0, ""), "\t", ",").encode(
        "utf-16"
    )


def trios_sweep() -> bytes:
    omega, storage, loss = sweep(30)
    head = (
        "Filename\tx\n[File Parameters]\nGap\t1000 µm\n[step]\nFrequency sweep - 1\n"
        "Angular frequency\tStorage modulus\tLoss modulus\tTan(delta)\tStep time\tTemperature\tOscillation torque\n"
        "rad/s\tMPa\tMPa\t\ts\t°C\tµN.m"
    )
    rows = rows_of(omega, storage / 1e6, loss / 1e6, loss / storage, 10.0 * np.arange(16.0), 100.0, 3.1)
    return table_of(head, rows, "\t").encode()


def trios_creep() -> bytes:
    time, compliance = crept()
    head = "[step]\nCreep - 2\nStep time\tTime\tCreep compliance\tStress\tTemperature\ns\ts\t1/Pa\tPa\t°C"
    return table_of(head, rows_of(time, 300.0 + time, compliance, 50.0, 100.0), "\t").encode()


def trios_ramp() -> bytes:
    degrees = np.linspace(75.0, 180.0, 40)
    text = ""
    for seed, omega in enumerate((1.0, 10.0, 100.0)):
        storage, loss = moduli(omega * arrhenius(degrees, ENERGY, REFERENCE - 273.15), MODES)
        storage, loss = storage * noise_of(40, 0.02, 40 + seed), loss * noise_of(40, 0.02, 50 + seed)
        head = (
            f"[step]\nTemperature ramp - {seed}\nTime\tTemperature\tStorage modulus\tLoss modulus\tAngular frequency\n"
            "s\t°C\tPa\tPa\trad/s"
        )
        text += table_of(head, rows_of(60.0 * np.arange(40.0), degrees, storage, loss, omega), "\t") + "\n"
    return text.encode()


def ares_workbook() -> bytes:
    omega, storage, loss = sweep(60)
    names = [["Frequency sweep - 1"], ["Angular frequency", "Storage modulus", "Loss modulus", "Temperature"],
             ["rad/s", "Pa", "Pa", "°C"]]  # fmt: skip
    return workbook([*names, *([float(cell) for cell in row] for row in rows_of(omega, storage, loss, 100.0))])


def ares_json() -> bytes:
    time, modulus = relaxed()
    columns = [{"name": name, "unit": unit} for name, unit in
               (("Step time", "s"), ("Modulus", "Pa"), ("Temperature", "°C"))]  # fmt: skip
    data = {"columns": columns, "values": [list(map(float, row)) for row in rows_of(time, modulus, 100.0)]}
    return json.dumps(
        {"Results": [{"Properties": {"Name": "Step (Transient) Stress Relaxation"}, "Data": data}]}
    ).encode()


def rheowin_sweep() -> bytes:
    omega, storage, loss = sweep(70)
    head = (
        "C:\\data\\pcl.rwd\nCompany / Operator: - / -\nDate / Time / Version: 11.04.2018 / 09:33:02 / HAAKE RheoWin 4\n"
        "Substance / Sample no: PCL / \n\n;t / s;t_seg / s;f / Hz;omega / rad/s;G' / Pa;G'' / Pa;T / °C;"
    )
    numbered = np.array([f"1|{i}" for i in range(1, 17)])
    time = 60.0 + 5.0 * np.arange(16.0)
    rows = rows_of(numbered, time, time - 60.0, omega / (2.0 * np.pi), omega, storage, loss, 100.0, "")
    return table_of(head, [[*map(_text, row)] for row in rows], ";", ",").encode("latin-1")


def rheowin_flow() -> bytes:
    rate = np.geomspace(0.01, 100.0, 15)
    eta = VISCOSITY * (1.0 + (0.4 * rate) ** 2) ** -0.3 * noise_of(15, 0.01, 8)
    head = "Date / Time / Version: - / - / HAAKE RheoWin\n\n;GP in 1/s;Tau in Pa;Eta in Pas;T in ºC;t in s;t_seg in s;"
    idle = [["1|1", "", "0,06978", "", "", "17,86", "7,239", ""]] * 2
    numbered = np.array([f"3|{i}" for i in range(1, 16)])
    rows = rows_of(numbered, rate, rate * eta, eta, 100.0, 245.4 + np.arange(15.0), 33.0 + np.arange(15.0), "")
    return table_of(head, [*idle, *([*map(_text, row)] for row in rows)], ";", ",").encode("latin-1")


def plain_sweeps() -> bytes:
    rows = [row for seed, at in enumerate((80.0, 100.0, 120.0)) for row in rows_of(at, *sweep(80 + 2 * seed, at))]
    return table_of("T (°C),omega (rad/s),G' (Pa),G'' (Pa)", rows, ",").encode()


def cut_off() -> bytes:
    omega = np.geomspace(100.0, 0.1, 16)
    loss = 0.8 * omega * noise_of(16, 0.01, 9)
    return table_of("omega [rad/s];G' [Pa];G'' [Pa];T [°C]", rows_of(omega, loss / 1e4, loss, 25.0), ";").encode()


def _text(cell: Any) -> Any:
    return str(cell) if isinstance(cell, str) else cell


SPECTRUM = {"zero_shear_viscosity": VISCOSITY, "plateau_modulus": PLATEAU}
SHIFTED = {**SPECTRUM, "flow_activation_energy": ENERGY}
LAYOUTS: Sequence[Layout] = (
    Layout(rheocompass_sweeps, "frequency_sweep", SHIFTED),
    Layout(rheocompass_relaxation, "relaxation", SPECTRUM),
    Layout(rheocompass_creep, "creep", {"zero_shear_viscosity": VISCOSITY}),
    Layout(trios_sweep, "frequency_sweep", SPECTRUM),
    Layout(trios_creep, "creep", {"zero_shear_viscosity": VISCOSITY}),
    Layout(trios_ramp, "temperature_ramp", {"plateau_modulus": PLATEAU, "flow_activation_energy": ENERGY}),
    Layout(ares_workbook, "frequency_sweep", SPECTRUM, ".xlsx"),
    Layout(ares_json, "relaxation", SPECTRUM, ".json"),
    Layout(rheowin_sweep, "frequency_sweep", SPECTRUM),
    Layout(rheowin_flow, "flow_curve", {"zero_shear_viscosity": VISCOSITY}),
    Layout(plain_sweeps, "frequency_sweep", SHIFTED),
    Layout(rheocompass_without_units, "", {}, refusal=r"txt:3: column 4, 'Angular Frequency', has no unit; write it"),
    Layout(cut_off, "", {}, refusal=r"txt:2: G''/G' stays at 1e\+04 .* G''/omega is 0\.80\d Pa\.s there"),
)
