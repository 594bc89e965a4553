"""Bars, rings, beams and flat shapes by integrals, Castigliano's theorem and counting of small squares."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.integrate import quad

Values = Mapping[str, Any]


def torsion(inputs: Values) -> Values:
    """Torsion by integrals: sum of r^2 over a bar's section; rings sheared one against the next."""
    shear = inputs["youngs_modulus"] / (2.0 * (1.0 + inputs["poissons_ratio"]))
    radius, ring = inputs["radius"], inputs["ring"]
    polar, _ = quad(lambda r: 2.0 * np.pi * r**3, 0.0, radius)
    angle, _ = quad(lambda r: 1.0 / (2.0 * np.pi * r**3 * ring["thickness"] * shear), ring["inner"], ring["outer"])
    return {
        "shear_modulus": shear,
        "shaft": shear * polar / inputs["length"],
        "yield_torque": inputs["tensile_yield"] / np.sqrt(3.0) * polar / radius,
        "ring": 1.0 / angle,
    }


def foot(inputs: Values) -> Values:
    """Solve a beam between built-in ends that shift, by energy: moment F (x - h/2), shear over 0.9 of the area."""
    youngs = inputs["youngs_modulus"]
    shear = youngs / (2.0 * (1.0 + inputs["poissons_ratio"]))
    radius, bore = inputs["radius"], inputs["bore"]
    inertia, area = 0.25 * np.pi * (radius**4 - bore**4), np.pi * (radius**2 - bore**2)
    results = []
    for height in inputs["height"]:
        bending, _ = quad(lambda x, h=height: (x - 0.5 * h) ** 2 / (youngs * inertia), 0.0, height)
        results.append(1.0 / (bending + height / (0.9 * shear * area)))
    return {"stiffness": results}


def pressed_cantilever(inputs: Values) -> Values:
    """Timoshenko's cantilever, pressed evenly beyond a free length: mean way of the pressed part, by quadrature."""
    youngs, width, thickness = (inputs[name] for name in ("youngs_modulus", "width", "thickness"))
    shear = youngs / (2.0 * (1.0 + inputs["poissons_ratio"]))
    bending, shearing = youngs * width * thickness**3 / 12.0, 5.0 / 6.0 * shear * width * thickness
    height, results = inputs["height"], []
    for free in inputs["free"]:
        tip = free + height

        def moment(x: float, free: float = free, tip: float = tip) -> float:
            start = max(x, free)
            return (tip - start) / height * (0.5 * (tip + start) - x)

        def force(x: float, free: float = free, tip: float = tip) -> float:
            return (tip - max(x, free)) / height

        # The mean way of the pressed part is the work of a unit pressure spread over it: m^2/EI + v^2/kGA.
        bent = sum(quad(lambda x: moment(x) ** 2, a, b)[0] for a, b in ((0.0, free), (free, tip)))
        sheared = sum(quad(lambda x: force(x) ** 2, a, b)[0] for a, b in ((0.0, free), (free, tip)))
        results.append(1.0 / (bent / bending + sheared / shearing))
    return {"stiffness": results}


def flat_shapes(inputs: Values, step: float = 2.5e-5) -> Values:
    """Areas and polar moments by counting squares of 0.025 mm whose middles are inside, row by row."""
    axis = np.arange(-0.05 + 0.5 * step, 0.05, step)
    names = ("sector", "disc", "rectangle", "slot", "notch")
    area, polar = dict.fromkeys((*names, "lens", "strip"), 0.0), dict.fromkeys(names, 0.0)
    for y in axis:
        squares = axis**2 + y**2
        for name, inside in _inside(inputs, axis, y, np.sqrt(squares)).items():
            area[name] += float(np.sum(inside)) * step**2
            if name in polar:
                polar[name] += float(np.sum(squares[inside])) * step**2
    return {
        "area": [area[name] for name in names],
        "polar": [polar[name] for name in names],
        "lens": area["lens"],
        "strip": area["strip"],
    }


def _inside(inputs: Values, x: Any, y: float, radius: Any) -> Mapping[str, Any]:
    """Which places of a row are inside each shape."""
    span, inner, outer = inputs["sector"]
    small, distance = inputs["disc"]
    radial, along, at = inputs["rectangle"]
    half, reach = inputs["slot"]
    notch_half, notch_inner, notch_outer = inputs["notch"]
    lens_radius, circle = inputs["lens"]
    thickness, near, far = inputs["strip"]
    ahead = x > 0.0
    return {
        "sector": (np.abs(np.arctan2(y, x)) < 0.5 * span) & (radius > inner) & (radius < outer),
        "disc": np.hypot(x - distance, y) < small,
        "rectangle": (np.abs(x - at) < 0.5 * radial) & (abs(y) < 0.5 * along),
        "slot": ((abs(y) < half) & ahead & (x < reach)) | (radius < half) | (np.hypot(x - reach, y) < half),
        "notch": ahead & (abs(y) < notch_half) & (radius > notch_inner) & (radius < notch_outer),
        "lens": (np.hypot(x - circle, y) < lens_radius) & (radius < circle),
        "strip": ahead & (0.0 < y < thickness) & (radius > near) & (radius < far),
    }
