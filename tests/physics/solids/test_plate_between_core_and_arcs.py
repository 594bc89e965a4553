"""The rotor's plate: how a torque enters it and leaves it, by differences and by integrals."""

from typing import Any

import numpy as np
import pytest
from scipy import sparse
from scipy.integrate import quad
from scipy.sparse.linalg import spsolve

from tvimdesign.physics.solids import structure


def stepped_bar(plate: float, reach: float, fine: int) -> float:
    """How much 1/a^2 rises, times a^2, as a torque enters a plate: a core of radius one on it, by differences.

    The angle f follows from div(r^3 grad f) = 0 (Timoshenko and Goodier, torsion of round bars of varying section);
    twice the energy beyond the core's radius is T^2 ((1 + e) - 1/b^2)/(4 pi G h).
    """
    step, tall = 1.0 / fine, plate + 1.0
    radii, levels = np.arange(round(reach * fine) + 1) * step, np.arange(round(tall * fine) + 1) * step
    solid = (radii[:-1, None] < 1.0 - 1e-9) | (levels[None, :-1] < plate - 1e-9)  # cells
    at = np.arange(radii.size * levels.size).reshape(radii.size, levels.size)
    weight = np.where(solid, (0.5 * (radii[:-1] + radii[1:])[:, None]) ** 3, 0.0)
    ends, flows, beyond = [], [], []
    for near, far in (((0, 0), (1, 0)), ((0, 1), (1, 1)), ((0, 0), (0, 1)), ((1, 0), (1, 1))):
        first, second = (at[i : i + radii.size - 1, j : j + levels.size - 1] for i, j in (near, far))
        ends.append(np.stack([first.ravel(), second.ravel()]))
        flows.append(0.5 * weight.ravel())
        beyond.append(np.broadcast_to(radii[:-1, None] > 1.0 - 1e-9, solid.shape).ravel())
    pairs, flow = np.concatenate(ends, 1), np.concatenate(flows)
    whole: Any = sparse.coo_matrix(
        (np.tile(-flow, 2), (pairs.ravel(), pairs[::-1].ravel())), shape=(at.size, at.size)
    ).tocsr()
    whole += sparse.diags(-np.asarray(whole.sum(axis=1)).ravel())
    angle, free = np.zeros(at.size), np.asarray(whole.diagonal() > 0.0)
    angle[at[radii <= 1.0 + 1e-9, -1]] = 1.0
    free[at[:, -1]] = False
    free[at[-1]] = False
    angle[free] = spsolve(whole[free][:, free].tocsc(), -whole[free] @ angle)
    torque = 2.0 * np.pi * float(angle @ (whole @ angle))
    energy = 2.0 * np.pi * float(np.sum((flow * (angle[pairs[0]] - angle[pairs[1]]) ** 2)[np.concatenate(beyond)]))
    return energy / torque**2 * 4.0 * np.pi * plate - 1.0 + reach**-2


@pytest.mark.parametrize("plate", [0.3, 0.4, 0.5, 0.8])
def test_a_torque_enters_a_plate_as_it_does_in_a_stepped_bar(plate: float) -> None:
    coarse, fine = (stepped_bar(plate, 2.0, count) for count in (30, 60))
    entry = 2.0 * fine - coarse
    stiffness = structure.plate_stiffness(1.0, plate, 1.0, 2.0)
    # Where it enters a plate that is half as thick as the core's radius, a tenth of 1/a^2 more; 0.6 (h/a)^2 were 0.15.
    assert stiffness == pytest.approx(4.0 * np.pi * plate / (1.0 + entry - 0.25), rel=0.015)


def test_a_ring_that_a_layer_relieves_evenly_gives_as_its_energy_says() -> None:
    inner, outer = 15.0, 27.5

    def left(radius: float) -> float:
        borne, _ = quad(lambda r: r**3, inner, radius)
        whole, _ = quad(lambda r: r**3, inner, outer)
        return 1.0 - borne / whole

    worked, _ = quad(lambda r: left(r) ** 2 / r**3, inner, outer)
    plain, _ = quad(lambda r: r**-3, inner, outer)
    assert structure.evenly_relieved(inner, outer) == pytest.approx(worked / plain, rel=1e-9)


def test_a_plate_driven_on_one_face_gives_by_a_third_of_its_thickness() -> None:
    # A block of 10 by 10 mm, 3 mm thick, its shear falling from 1 N/mm^2 to nothing; its strain energy by integral.
    energy, _ = quad(lambda z: 0.5 * (1.0 - z / 3.0) ** 2 * 100.0 / 7.0, 0.0, 3.0)
    assert structure.face_compliance(7.0, 3.0, 100.0) == pytest.approx(2.0 * energy / 100.0**2, rel=1e-9)
