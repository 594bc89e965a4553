"""Stress of screws and pins at the torque the joint holds: by the model's forces, or by those that FE finds.

All screws are tightened to `link_clamp_stress`. What is across a foot's screw, or turns the link on the core, goes by
friction first, with the coefficient between link and core; what is left shears the foot's screw, or the link's pins
where there are any and its screws where there are none. Equivalent stress by VDI 2230-1:2015 (`physics/solids`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tvimdesign.base.record import Record
from tvimdesign.device.core.mass_properties import LINK_SCREWS
from tvimdesign.physics.motions.contacts import tightened_force
from tvimdesign.physics.solids import fasteners
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

_MPA = 1e-6


class Carried(NamedTuple):
    """Loads that screws and pins carry."""

    across: float | None
    """Force across the screw of the foot that takes most [N]; None for a module that stands on a flange."""
    along: float
    """Force along it [N]."""
    slip: float
    """Torque that friction under the link screws holds [N*m]."""


class _Tightened(NamedTuple):
    """A screw of a joint, tightened."""

    diameter: float
    pitch: float
    force: float
    twist: float

    def stress(self, along: float, across: float) -> float:
        """Return the equivalent stress [MPa] with forces along and across it [N]."""
        combined = fasteners.combined_stress(self.force + along, across, self.twist, self.diameter, self.pitch)
        return float(combined) * _MPA


def screw_rows(module: ResolvedModule, carried: Carried) -> dict[str, float]:
    """Return stresses [MPa] by row; none of missing pins or feet, or of pins that friction relieves."""
    names = ("holding_torque", "link_bolt_circle_radius", "link_dowel_circle_radius")
    values = {name: float(value) for name, value in module.table.evaluate(module.values, names).items()}
    friction = float(module.values["link_friction"])
    left = max(values["holding_torque"] - carried.slip, 0.0)
    pins = 0.0 if isinstance(module.values["link_fit"], str) and module.values["link_fit"] == "clearance" else left
    link = _tightened(module, "link_screw")
    sheared = (left - pins) / (LINK_SCREWS * values["link_bolt_circle_radius"])
    rows = {"link_screw_stress": link.stress(0.0, sheared)}
    if pins:
        diameter, count = (float(module.values[name]) for name in ("link_dowel_diameter", "link_dowel_count"))
        force = pins / (count * values["link_dowel_circle_radius"])
        rows["link_pin_shear"] = force / (0.25 * math.pi * diameter**2) * _MPA
    if carried.across is not None:
        foot = _tightened(module, "mount_screw")
        rows["foot_screw_stress"] = foot.stress(carried.along, max(carried.across - friction * foot.force, 0.0))
    return rows


def _tightened(module: ResolvedModule, choice: str) -> _Tightened:
    """Return the screw of a choice, tightened as all are."""
    screw = module.values[choice]
    assert isinstance(screw, Record)
    diameter, drill = (float(screw.value(name)) for name in ("nominal_diameter", "tap_drill"))
    head = 0.5 * float(screw.value("head_diameter") + screw.value("clearance_hole"))
    pitch = diameter - drill
    force = float(tightened_force(module.values["link_clamp_stress"], diameter))
    friction = fasteners.thread_friction(module.values["nut_factor"], diameter, pitch, head)
    torque = fasteners.thread_torque(force, diameter, pitch, friction)
    return _Tightened(diameter, pitch, force, float(fasteners.twist_stress(torque, diameter, pitch)))
