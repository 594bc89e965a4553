"""Closed solutions of conduction: slabs, fronts, half-spaces; and steady plates by finite volumes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve
from scipy.special import erf, erfc

Values = Mapping[str, Any]
AMBIENT = 295.15


def slab_under_flux(inputs: Values) -> Values:
    """k theta/(q L) at the heated and the insulated face (Carslaw and Jaeger, 2nd ed., section 3.8 (3))."""
    n = np.arange(1, 400)

    def rise(fourier: float, depth: float) -> float:
        terms = (-1.0) ** n / n**2 * np.exp(-((n * np.pi) ** 2) * fourier) * np.cos(n * np.pi * depth)
        return float(fourier + (3.0 * depth**2 - 1.0) / 6.0 - 2.0 / np.pi**2 * np.sum(terms))

    return {name: [rise(fo, depth) for fo in inputs["fourier"]] for name, depth in (("front", 1.0), ("back", 0.0))}


def slab_in_a_stream(inputs: Values) -> Values:
    """Share of the difference left in a slab behind a film (Incropera, section 5.5): zeta tan zeta = Bi."""
    biot = inputs["biot"]
    roots = [
        brentq(lambda z: z * np.sin(z) - biot * np.cos(z), i * np.pi + 1e-9, i * np.pi + 0.5 * np.pi) for i in range(60)
    ]
    zeta = np.array(roots)
    weights = 4.0 * np.sin(zeta) / (2.0 * zeta + np.sin(2.0 * zeta))
    decays = [weights * np.exp(-(zeta**2) * fourier) for fourier in inputs["fourier"]]
    return {
        "insulated": [float(np.sum(terms)) for terms in decays],
        "wetted": [float(np.sum(terms * np.cos(zeta))) for terms in decays],
    }


def half_space_under_flux(inputs: Values) -> Values:
    """Rise of a half-space's surface [K] under 2000 W/m^2, 2 q sqrt(a t/pi)/k (Carslaw and Jaeger)."""
    diffusivity = 0.2 / (1145.0 * 1900.0)
    return {"surface": [2.0 * 2000.0 / 0.2 * np.sqrt(diffusivity * time / np.pi) for time in inputs["time"]]}


def touching_bodies(inputs: Values) -> Values:
    """Face of two half-spaces by their effusivities [degC] (Carslaw and Jaeger, section 2.14)."""
    plate = inputs["plate"]
    metal = np.sqrt(plate["conductivity"] * plate["density"] * plate["specific_heat"])
    layer = np.sqrt(inputs["layer_conductivity"] * 1145.0 * 1900.0)
    return {"face": [(100.0 * metal + 22.0 * layer) / (metal + layer)] * len(inputs["time"])}


def wall_in_series(inputs: Values) -> Values:
    """Drops under 2000 W/m^2 through joints, 1 mm of 0.2 W/m K, three cells of 1 mm of 0.8 W/m K, and a film."""
    flux, cell = 2000.0, 2000.0 * 1e-3 / 0.8
    joints = [flux / inputs[name] for name in ("hot_contact", "plate_contact", "film")]
    return {"drop": [joints[0], flux * 1e-3 / 0.2, joints[1], 0.5 * cell, cell, cell, 0.5 * cell + joints[2]]}


def front(inputs: Values) -> Values:
    """Neumann's root for a phase that grows from a face into another one, which melts or freezes at 330 K.

    Carslaw and Jaeger, section 11.2 (6); with the other phase at the melting point Stefan's one phase. 2000 J/kg K.
    """
    latent = float(inputs["latent_heat"].removesuffix(" kJ/kg")) * 1e3
    roots = []
    for solid, melt, far, face in inputs["cases"]:
        ratio = np.sqrt(melt / solid if face > 330.0 else solid / melt)
        above = 2000.0 * abs(face - 330.0) / latent
        below = 2000.0 * abs(330.0 - far) / latent if abs(far - 330.0) > 0.1 else 0.0

        def balance(x: float, ratio: float = ratio, above: float = above, below: float = below) -> float:
            into = above / (np.exp(x**2) * erf(x))
            away = below / (ratio * np.exp((ratio * x) ** 2) * erfc(ratio * x)) if below else 0.0
            return float(into - away - x * np.sqrt(np.pi))

        roots.append(brentq(balance, 1e-4, 3.0))
    return {"front": roots}


def plate_in_two_dimensions(inputs: Values, across: int = 20) -> Values:
    """Mean temperature of a plate's upper face that an even flux of 1 W/m^2 leaves, below its fed lower face [K].

    Half a module and half a gap, finite volumes; no heat passes the ends or the lower face beside the module.
    """
    fed, thickness, k = inputs["fed"], inputs["thickness"], inputs["conductivity"]
    step, results = thickness / across, []
    for beside in inputs["beside"]:
        columns, fed_columns = round((fed + beside) / step), round(fed / step)
        index = np.arange(columns * across).reshape(columns, across)
        first = np.concatenate([index[:-1].ravel(), index[:, :-1].ravel()])
        second = np.concatenate([index[1:].ravel(), index[:, 1:].ravel()])
        diagonal = np.zeros(index.size)
        np.add.at(diagonal, np.concatenate([first, second]), k)
        diagonal[index[:fed_columns, 0]] += 2.0 * k
        flux = np.zeros(index.size)
        flux[index[:, -1]] = step
        own = np.arange(index.size)
        places = (np.concatenate([first, second, own]), np.concatenate([second, first, own]))
        matrix = coo_matrix((np.concatenate([-k * np.ones(2 * len(first)), diagonal]), places)).tocsr()
        results.append(float(np.mean(spsolve(matrix, flux)[index[:, -1]]) + 0.5 * step / k))
    return {"resistance": results}


def plate_with_a_body_beside(inputs: Values, cells: int = 4000) -> Values:
    """Steady plate of many cells that each give heat to one body beside, solved as one system of equations [K]."""
    area, k, thickness = inputs["area"], inputs["conductivity"], inputs["thickness"]
    step = thickness / cells
    between = k * area / step
    sideways = inputs["sideways"] / cells
    body = inputs["side_area"] * inputs["side_film"]
    outer = 1.0 / (0.5 * step / (k * area) + 1.0 / (inputs["film"] * area))
    size = cells + 1
    upper, diagonal, right = np.full(cells - 1, -between), np.full(cells, 2.0 * between + sideways), np.zeros(size)
    diagonal[0] += between
    diagonal[-1] += outer - between
    right[0], right[cells - 1] = 2.0 * between * inputs["polymer"], outer * AMBIENT
    right[-1] = body * AMBIENT
    own = np.arange(cells)
    rows = np.concatenate([own, own[:-1], own[1:], own, np.full(cells, cells), [cells]])
    columns = np.concatenate([own, own[1:], own[:-1], np.full(cells, cells), own, [cells]])
    values = np.concatenate([diagonal, upper, upper, np.full(2 * cells, -sideways), [cells * sideways + body]])
    results = spsolve(coo_matrix((values, (rows, columns)), shape=(size, size)).tocsr(), right)
    middles = (own + 0.5) / cells
    places = (0.125, 0.375, 0.625, 0.875)
    return {"plate": [float(np.interp(place, middles, results[:-1])) for place in places], "beside": [results[-1]]}


def slab_that_heats_itself(inputs: Values) -> Values:
    """Rise [K] of the insulated face of a slab with heat I^2 R in it, its other face kept; that heat and 1 ohm's [W].

    q L^2/(2 k) (1 - 32/pi^3 sum (-1)^n/(2n+1)^3 exp(-((2n+1) pi/2)^2 Fo)), by separation of variables (Carslaw and
    Jaeger, ch. III); 1 mm of 0.2 W/m K on 1000 mm^2.
    """
    power = inputs["current"] ** 2 * inputs["resistance"]
    last = power / (1e-3 * 1e-3) * 1e-3**2 / (2.0 * 0.2)
    odd = 2.0 * np.arange(400) + 1.0
    signs = (-1.0) ** np.arange(400)
    left = [
        32.0 / np.pi**3 * np.sum(signs / odd**3 * np.exp(-((0.5 * odd * np.pi) ** 2) * fo)) for fo in inputs["fourier"]
    ]
    return {"insulated": [float(last * (1.0 - share)) for share in left], "power": power + inputs["current"] ** 2}


def comb_by_differences(inputs: Values) -> Values:
    """Resistance [ohm] of 1 mm on 1000 mm^2 over a comb by finite differences, extrapolated from two grids."""
    results = []
    for gap, width in inputs["combs"]:
        coarse, fine = (_comb_cell(gap, width, cells) for cells in (20, 40))
        # A finger's edge is a singularity: the error falls with the size of the cells.
        results.append(inputs["resistivity"] * (2.0 * fine - coarse) * (gap + width) * 1e-3 / 1e-3)
    return {"resistance": results}


def _comb_cell(gap: float, width: float, cells: int) -> float:
    """Resistance from finger to finger for a unit resistivity and length, of a layer one deep."""
    across, foot = round(0.5 * (gap + width) * cells), round(0.5 * width * cells)
    index = np.arange(across * cells).reshape(across, cells)
    pairs = [(index[:-1], index[1:]), (index[:, :-1], index[:, 1:])]
    diagonal = np.zeros(across * cells)
    rows, columns = [], []
    for each, other in pairs:
        rows += [each.ravel(), other.ravel()]
        columns += [other.ravel(), each.ravel()]
        for side in (each, other):
            np.add.at(diagonal, side.ravel(), 1.0)
    feet, middle = index[:foot, 0], index[-1]
    diagonal[feet] += 2.0
    diagonal[middle] += 2.0  # half way to the next finger the potential is zero
    places = np.concatenate([*rows, index.ravel()]), np.concatenate([*columns, index.ravel()])
    values = np.concatenate([-np.ones(sum(len(row) for row in rows)), diagonal])
    source = np.zeros(across * cells)
    source[feet] = 2.0
    potential = spsolve(coo_matrix((values, places)).tocsr(), source)
    return 2.0 / float(np.sum(2.0 * (1.0 - potential[feet])))
