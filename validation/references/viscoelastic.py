"""Viscoelastic bodies by closed solutions, by quadrature and stepped in time."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import quad, solve_ivp

Values = Mapping[str, Any]
CASES = Path(__file__).resolve().parents[1] / "cases"


def terminal_viscosities(inputs: Values) -> Values:
    """G''/w at the lowest frequencies of a file, the mean of the first two rows; power 3.4 of the molar mass."""

    def slow(name: str) -> float:
        text = (CASES / name).read_text(encoding="utf-8")
        rows = np.array([[float(x) for x in line.split()] for line in text.splitlines()[1:]])
        return float(np.mean(rows[:2, 2] / rows[:2, 0]))

    return {"viscosity": [slow(name) for name in inputs["files"]], "power_of_molar_mass": 3.4}


def zener(inputs: Values) -> Values:
    """Standard linear solid of a permanent R and a passing G, eta = G tau (Findley, Lai and Onaran, ch. 5)."""
    (_, settled), (tau, passing) = inputs["modes"]
    time, omega = np.array(inputs["time"], float), np.array(inputs["frequency"], float)
    whole, slow = settled + passing, tau * (settled + passing) / settled
    complex_modulus = settled + passing * 1j * omega * tau / (1.0 + 1j * omega * tau)
    return {
        "relaxation": settled + passing * np.exp(-time / tau),
        "creep": 1.0 / settled - (1.0 / settled - 1.0 / whole) * np.exp(-time / slow),
        "start_up": settled * time + passing * tau * (1.0 - np.exp(-time / tau)),
        "storage": complex_modulus.real,
        "loss": complex_modulus.imag,
    }


def of_a_spectrum(inputs: Values) -> Values:
    """Creep by the elements' own equations stepped in time, start-up and moduli by quadrature."""
    modes = [(float(tau), float(modulus)) for tau, modulus in inputs["modes"]]

    def relaxation(time: Any) -> Any:
        return sum(modulus * np.exp(-time / tau) for tau, modulus in modes)

    longest = max(tau for tau, _ in modes)
    storage, loss = [], []
    for omega in inputs["frequency"]:
        parts = [
            quad(relaxation, 0.0, 60.0 * longest, weight=weight, wvar=omega, limit=2000)[0] * omega
            for weight in ("sin", "cos")
        ]
        storage.append(parts[0])
        loss.append(parts[1])
    return {
        "relaxation": [relaxation(time) for time in inputs["time"]],
        "creep": _strain(modes, inputs["time"]),
        "start_up": [
            quad(relaxation, 0.0, time, limit=500, points=[tau for tau, _ in modes if tau < time] or None)[0]
            for time in inputs["time"]
        ],
        "storage": storage,
        "loss": loss,
    }


def _strain(modes: list[tuple[float, float]], times: Any) -> Any:
    """Strain of Maxwell elements side by side under a stress of 1 Pa: e' = gamma' - e/tau each, sum G e = 1."""
    tau, moduli = (np.array(column) for column in zip(*modes, strict=True))
    whole = float(np.sum(moduli))

    def rates(_: float, state: Any) -> Any:
        speed = float(np.sum(moduli * state[:-1] / tau)) / whole
        return np.append(speed - state[:-1] / tau, speed)

    begin = np.full(len(modes) + 1, 1.0 / whole)
    scale = 1e-9 / whole
    solved = solve_ivp(rates, (0.0, max(times)), begin, method="Radau", t_eval=times, rtol=1e-8, atol=1e-3 * scale)
    return solved.y[-1]


def wagner(inputs: Values, past_nodes: int = 6000, phases: int = 256) -> Values:
    """First harmonics of Wagner's stress, integrated over the past at every phase of a period.

    sigma = int m(s) h(g) g ds, g = gamma(t) - gamma(t - s), h = 1/(1 + 5/95 (g/limit)^2).
    """
    modes, omega, limit = inputs["modes"], inputs["frequency"], inputs["linear_limit"]
    longest, shortest = max(m[0] for m in modes), min(m[0] for m in modes)
    past = np.concatenate([[0.0], np.geomspace(1e-5 * shortest, 40.0 * longest, past_nodes)])
    memory = sum(float(modulus) / float(tau) * np.exp(-past / float(tau)) for tau, modulus in modes)
    turn = np.arange(phases) * 2.0 * np.pi / phases
    storage, loss = [], []
    for strain in inputs["strain"]:
        relative = strain * (np.sin(turn)[:, None] - np.sin(turn[:, None] - omega * past[None, :]))
        damped = relative / (1.0 + 0.05 / 0.95 * (relative / limit) ** 2)
        stress = np.trapezoid(memory * damped, past, axis=1)
        storage.append(2.0 * float(np.mean(stress * np.sin(turn))) / strain)
        loss.append(2.0 * float(np.mean(stress * np.cos(turn))) / strain)
    return {"storage": storage, "loss": loss}


def transforms(inputs: Values) -> Values:
    """exp(-t), 1 - exp(-t/5) and t."""
    time = np.array(inputs["time"], float)
    return {"fading": np.exp(-time), "creeping": 1.0 - np.exp(-0.2 * time), "flowing": time}
