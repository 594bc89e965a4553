"""Cores that lean and bend: plates on a foundation, rigid plates, beams, and FE of drawn modules."""

import csv
from collections import defaultdict

import numpy as np
import pytest
from random_designs import Draws
from scipy.integrate import solve_bvp
from support import ROOT, study_path

from tvimdesign.cad.fe.model_comparison import model_values
from tvimdesign.device import table_for
from tvimdesign.physics.solids import plates, structure
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.study import given, read_study

FE_ROWS = list(csv.DictReader((ROOT / "validation/fe_structure/tilt.csv").read_text().splitlines()))
RIGID = 1e12
MODULUS, POISSON = 2.1e9, 0.37
AT = plates.Leaning(
    core=7e-3, plate=3e-3, inner=7e-3, outer=20e-3, layer=400.0, bore=9e-3, floor=1.0, feet=37e-3, upright=RIGID,
    turning=RIGID,
)  # fmt: skip


def bvp_of_a_plate(at: plates.Leaning) -> float:
    """Return the lean under one newton metre of a plate on an even foundation, free at its rim, by collocation."""
    rigidity = MODULUS * at.plate**3 / (12.0 * (1.0 - POISSON**2))
    press = 4.0 * at.layer / (np.pi * (at.outer**4 - at.inner**4))

    def slopes(r, y):
        f, first, second, third = y
        bent = -2.0 * third / r + 3.0 * second / r**2 - 3.0 * first / r**3 + 3.0 * f / r**4
        return np.vstack([first, second, third, bent - press / rigidity * f])

    def ends(start, end):
        r, (f, first, second, third) = at.outer, end
        moment = second + POISSON * (first / r - f / r**2)
        laplacian = third + second / r - 2.0 * first / r**2 + 2.0 * f / r**3
        return np.array(
            [start[0] - at.core, start[1] - 1.0, moment, laplacian - (1.0 - POISSON) * (first / r**2 - f / r**3)]
        )

    r = np.linspace(at.core, at.outer, 200)
    solved = solve_bvp(slopes, ends, r, np.vstack([r, np.ones_like(r), 0.0 * r, 0.0 * r]), tol=1e-6, max_nodes=20000)
    assert solved.success
    fine = np.linspace(at.core, at.outer, 4000)
    return float(1.0 / (np.pi * press * np.trapezoid(solved.sol(fine)[0] * fine**2, fine)))


@pytest.mark.parametrize("layer", [4.0, 40.0, 400.0])
def test_a_plate_on_a_foundation_leans_as_its_equation_has_it(layer):
    at = AT._replace(layer=layer)
    assert plates.leaning_compliance(MODULUS, POISSON, at) == pytest.approx(bvp_of_a_plate(at), rel=0.04)


def test_rigid_plates_lean_by_layer_and_feet():
    at = AT._replace(plate=1.0, upright=3e6, turning=900.0)
    feet = 0.5 * at.upright * at.feet**2 + 0.5 * at.turning
    assert plates.leaning_compliance(MODULUS, POISSON, at) == pytest.approx(1.0 / at.layer + 1.0 / feet, rel=1e-4)


def test_a_core_bends_as_a_cantilever():
    radius, length, beyond = 7e-3, 30e-3, 2e-3
    shear = structure.shear_modulus(MODULUS, POISSON)
    torsion = structure.shaft_stiffness(shear, radius, length)
    inertia, area = 0.25 * np.pi * radius**4, np.pi * radius**2
    levers = np.linspace(beyond, length + beyond, 2001)
    bends = np.trapezoid(levers**2, levers) / (MODULUS * inertia) + length / (0.9 * shear * area)
    foot = 0.75 * radius * (length + beyond) ** 2 / (MODULUS * inertia)
    moved = structure.bent_shaft_compliance(torsion, MODULUS, POISSON, radius, length, beyond)
    assert moved == pytest.approx(bends + foot, rel=1e-6)


def drawn_modules(study: str, seed: int, draws: set[int]) -> dict[int, ResolvedModule]:
    """Return random modules of a study by their draw, as validation/fe_structure/tilt.py draws them."""
    past = ROOT / f"validation/fe_structure/studies/{study}.yaml"
    read, modules = read_study(past if past.exists() else study_path(study)), {}
    for number, design in Draws(read, seed).numbered(draws):
        varied = {name: design.values[name] for name in read.vary if name in design.values}
        modules[number] = ResolvedModule(read, {**given(read), **varied})
    return modules


@pytest.mark.gate
def test_modules_whose_cores_lean_are_as_stiff_at_the_link_as_in_fe():
    factor = next(row for row in table_for("shear").inputs if row.name == "tilt_factor")
    by_study, off = defaultdict(list), defaultdict(list)
    for row in FE_ROWS:
        by_study[row["study"], int(row["seed"])].append(row)
    for (study, seed), rows in by_study.items():
        modules = drawn_modules(study, seed, {int(row["draw"]) for row in rows})
        for row in rows:
            module = modules[int(row["draw"])]
            model, fe = model_values(module), {name: float(row[f"{name} by fe"]) for name in ("hub", "tilt")}
            link = 1.0 / model["link"]
            free = 1.0 / fe["hub"] + link + fe["tilt"]
            upright, in_play = free / (1.0 / model["hub"] + link), free * model["link_in_play"]
            tilt = (1.0 / model["link_in_play"] - 1.0 / model["hub"] - link) / fe["tilt"]
            known = [float(row[name]) for name in ("tilt", "upright", "in play")]
            assert (tilt, upright, in_play) == pytest.approx(known, abs=2e-3), row
            assert factor.low <= 1.0 / tilt <= factor.high, row
            assert upright > 1.04, row  # without leaning
            off[module.study.mode].append(abs(in_play - 1.0))
    for mode, deviations in off.items():
        assert np.mean(np.array(deviations) < 0.1) >= 0.9, mode
