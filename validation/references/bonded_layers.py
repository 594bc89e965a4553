"""Bonded layers: rings by integrals, laps by Volkersen's equation solved, gaps of melt by Stokes and Reynolds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.integrate import quad, solve_bvp, solve_ivp

Values = Mapping[str, Any]


def sheared_ring(inputs: Values) -> Values:
    """Integral of r times traction over the ring; lengths in mm, modulus and traction in MPa."""
    outer, inner, thickness = (
        1e-3 * float(inputs[name].removesuffix(" mm")) for name in ("outer_radius", "inner_radius", "thickness")
    )
    shear, traction = (1e6 * float(inputs[name].removesuffix(" MPa")) for name in ("shear_modulus", "traction"))
    moment, _ = quad(lambda r: 2.0 * np.pi * r**3, inner, outer)
    return {
        "stiffness": shear * moment / thickness,
        "torque": traction * moment / outer,
        "strain": outer * inputs["angle"] / thickness,
    }


def in_series(inputs: Values) -> Values:
    """Compliances add, in complex numbers."""
    slices = np.mean([1.0 / complex(*pair) for pair in inputs["slices"]])
    joint = 1.0 / (1.0 / complex(*inputs["layer"]) + 1.0 / complex(*inputs["support"]))
    return {"slices": [(1.0 / slices).real, (1.0 / slices).imag], "joint": [joint.real, joint.imag]}


def rubber_blocks(inputs: Values) -> Values:
    """1/E_app = 1/(E (1 + 2 S^2)) + 1/K (Gent and Lindley, Proc. Inst. Mech. Eng. 173 (1959) 111); in MPa."""
    youngs, bulk = (1e6 * float(inputs[name].removesuffix(" MPa")) for name in ("youngs_modulus", "bulk_modulus"))
    return {"modulus": [1.0 / (1.0 / (youngs * (1.0 + 2.0 * s**2)) + 1.0 / bulk) for s in inputs["shape_factor"]]}


def lap_edges(inputs: Values) -> Values:
    """Volkersen's differential equation of a lap, and of a sheet over a window, by collocation."""
    stiffness, width = inputs["layer"], inputs["width"]
    first, second = inputs["sheets"]
    edges, windows = [], []
    grid = np.linspace(0.0, width, 600)
    for reach in inputs["reach"]:
        k = stiffness * reach**2 / (stiffness * (first + second) * width**2)

        def lap(_: Any, y: Any, k: float = k) -> Any:
            return np.vstack([k * y[1], second * y[0] - first * (1.0 - y[0])])

        solved = solve_bvp(lap, lambda a, b: np.array([a[0], b[0] - 1.0]), grid, np.zeros((2, grid.size)), tol=1e-8)
        edges.append(float(k * solved.sol(width)[1] * width))
        sheet = reach**2 / (stiffness * width**2)

        def window(_: Any, y: Any, sheet: float = sheet) -> Any:
            return np.vstack([sheet * y[1], -stiffness * (1.0 - y[0])])

        solved = solve_bvp(window, lambda a, b: np.array([a[0], b[1]]), grid, np.zeros((2, grid.size)), tol=1e-8)
        windows.append(float(solved.sol(0.0)[1] / (stiffness * width)))
    return {"edge": edges, "window": windows}


def melt_in_gaps(inputs: Values) -> Values:
    """Stokes' equation across a gap on a grid, Reynolds' integrated in time; the rise of water is the handbook's."""
    gap, length, width, thin, thick = (
        1e-3 * float(inputs[name].removesuffix(" mm")) for name in ("gap", "length", "width", "thin", "thick")
    )
    viscosity, cells = inputs["viscosity"], 500

    def tridiagonal(count: int) -> Any:
        return np.diag(np.full(count, -2.0)) + np.diag(np.ones(count - 1), 1) + np.diag(np.ones(count - 1), -1)

    across = tridiagonal(cells)
    across[0, 0] = across[-1, -1] = -3.0  # the wall is half a cell away
    profile = np.linalg.solve(across, np.full(cells, -inputs["gradient"] * (gap / cells) ** 2 / viscosity))
    step = width / cells
    bowl = np.linalg.solve(tridiagonal(cells - 1), np.full(cells - 1, -12.0 * viscosity * step**2))
    per_speed = float(np.sum(bowl)) * step * length  # force times h^3 for a closing speed of 1 m/s
    results = solve_ivp(
        lambda _, h: [-inputs["force"] * h[0] ** 3 / per_speed], (0.0, 1e5), [thick],
        events=_reached(thin), rtol=1e-9, atol=1e-14,
    )  # fmt: skip
    return {"speed": float(np.mean(profile)), "squeeze_time": float(results.t_events[0][0]), "rise": 14.9e-3}


def _reached(height: float) -> Any:
    def gap(_: float, h: Any) -> float:
        return float(h[0]) - height

    gap.terminal = True
    return gap


def held_link(inputs: Values) -> Values:
    """Step a link without inertia on springs beside a Maxwell layer behind a structure (Radau)."""
    tau, k = (np.array(column, float) for column in zip(*inputs["modes"], strict=True))
    torque, springs, behind = (float(inputs[name]) for name in ("torque", "springs", "structure"))
    whole = float(np.sum(k))

    def angles(state: Any) -> tuple[float, float]:
        pull = float(np.sum(k * state))
        joined = behind * whole / (behind + whole)
        angle = (torque + behind / (behind + whole) * pull) / (springs + joined)
        return angle, (behind * angle + pull) / (behind + whole)

    results = solve_ivp(
        lambda _, q: (angles(q)[1] - q) / tau, (0.0, inputs["time"][-1]), np.zeros(len(k)), method="Radau",
        t_eval=inputs["time"], rtol=1e-9, atol=1e-12,
    )  # fmt: skip
    return {
        "angle": [angles(state)[0] for state in results.y.T],
        "set_angle": [float(np.sum(k * state)) / whole for state in results.y.T],
    }


def plates_on_a_layer(inputs: Values) -> Values:
    """Plates as one beam: clamped, of bending and shear over a span, then without end on springs that shorten.

    In the span M = m - q x, turn = (m x - q x^2/2)/D, w = (m x^2/2 - q x^3/6)/D + q x/S; beyond it
    delta - w = exp(-b x)(A cos b x + B sin b x). Way, turn, moment and force agree at the edge: four equations.
    """
    k, rigidity, delta = (float(inputs[name]) for name in ("foundation", "rigidity", "shortened"))
    b, tractions = (k / (4.0 * rigidity)) ** 0.25, []
    for span in inputs["span"]:
        # Columns m, q, A, B; the derivatives of exp(-b x) cos b x and exp(-b x) sin b x at 0.
        agree = np.array([
            [span**2 / (2.0 * rigidity), -(span**3) / (6.0 * rigidity) + span / inputs["shear"], 1.0, 0.0],
            [span / rigidity, -(span**2) / (2.0 * rigidity), -b, b],
            [1.0 / rigidity, -span / rigidity, 0.0, -2.0 * b**2],
            [0.0, -1.0 / rigidity, 2.0 * b**3, 2.0 * b**3],
        ])  # fmt: skip
        tractions.append(k * float(np.linalg.solve(agree, [delta, 0.0, 0.0, 0.0])[2]))
    return {"traction": tractions}
