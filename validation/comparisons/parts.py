"""Fits, screws, pins and friction."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from comparisons.numbers import si
from tvimdesign.cad.drawing.drawing_requirements import limit_deviations, standard_tolerance
from tvimdesign.catalog import Catalog
from tvimdesign.physics.motions import contacts
from tvimdesign.physics.solids import fasteners, structure

Values = Mapping[str, Any]


def limits_of_fits(inputs: Values) -> Values:
    """Lower and upper limit deviations [um] of tolerance classes, rows of class and size [mm]."""
    limits = [limit_deviations(fit, size) for fit, size in inputs["fits"]]
    return {"lower": [1e3 * each.lower for each in limits], "upper": [1e3 * each.upper for each in limits]}


def tolerance_grades(inputs: Values) -> Values:
    """Standard tolerances [um] of one grade over sizes [mm]."""
    return {"tolerance": [1e3 * standard_tolerance(inputs["grade"], size) for size in inputs["size"]]}


def screw_holes(inputs: Values) -> Values:
    """Clearance hole and tapping drill [m] of screws of the catalogue."""
    records = [Catalog().record("screws", name) for name in inputs["screws"]]
    return {name: [record.value(name) for record in records] for name in ("clearance_hole", "tap_drill")}


def tightening(inputs: Values) -> Values:
    """Torque for a force [m] of screws by a nut factor."""
    return {
        "torque_per_force": [
            contacts.tightening_torque(1.0, si(diameter), inputs["nut_factor"]) for diameter in inputs["diameter"]
        ]
    }


def pin_shear(inputs: Values) -> Values:
    """Force [N] that shears pins of the catalogue off in one section."""
    results = []
    for name in inputs["pins"]:
        record = Catalog().record("dowel_pins", name)
        results.append(fasteners.peg_shear_force(record.value("shear_strength"), record.value("diameter")))
    return {"shear_force": results}


def clamped_disc(inputs: Values) -> Values:
    """Friction torque [N*m] of clamped rings over the inner radius."""
    outer = si(inputs["outer_radius"])
    share, force = inputs["friction"], si(inputs["force"])
    return {"torque": [contacts.disc_torque(share, force, si(inner), outer) for inner in inputs["inner_radius"]]}


def bearing(inputs: Values) -> Values:
    """Friction torque [N*m] of a ball bearing, and load on the nearer of two of an overhung force."""
    return {
        "torque": contacts.journal_torque(inputs["friction"], si(inputs["force"]), si(inputs["bore"])),
        "nearer": structure.overhung_load(si(inputs["force"]), si(inputs["overhang"]), si(inputs["spread"])),
    }


def damping_of_friction(inputs: Values) -> Values:
    """Viscous damping [N*m*s/rad] that loses as much as friction, constant and in proportion to the load."""
    omega, amplitude = inputs["angular_frequency"], inputs["amplitude"]
    stiffness = inputs["stiffness"]
    return {
        "constant": contacts.equivalent_damping(inputs["torque"], omega, amplitude),
        "with_the_load": [
            contacts.loaded_damping(inputs["share"], stiffness, stiffness * tangent, omega)
            for tangent in inputs["loss_factor"]
        ],
    }
