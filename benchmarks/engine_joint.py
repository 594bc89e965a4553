"""What the joint's impedance follows from at an instant, as numbers for `engine_layer`, written by CasADi."""

from __future__ import annotations

from typing import Any

import numpy as np
from engine_network import Assembler

from tvimdesign.device.shear import layer_columns
from tvimdesign.device.table.module import Module
from tvimdesign.physics.heat_flow import columns, heat
from tvimdesign.physics.heat_flow.lip import WarmLip
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.symbols import symbols

SETTLED = (
    "heater_form", "pad_wall", "heater_along", "plate_to_edge", "uneven_sideways", "cold_end", "edge_length",
    "air_beside", "plate_slenderness", "end_profile", "moment_now", "pcl_depth", "spring_stiffness", "soft_threshold",
    "structure_compliances", "lossless_compliance", "pcl_rheology", "structure_softening", "clamped_loss_factor",
    "frequency_now",
)  # fmt: skip


class JointNumbers:
    """The layer's columns and the joint's other parts, in the shear mode."""

    def __init__(self, phase: PhaseFunctions, assembler: Assembler) -> None:
        """Write them from the table's quantities."""
        of = phase.table.resolve_instant(phase._written, SETTLED)
        end = of["cold_end"]
        across = layer_columns.across(end)
        self.column_shares = np.array(across.shares)
        self.fed_evenly = np.array([float(columns.fed_evenly(place)) for place in across.places])
        node_temperatures = ca.SX.sym("nodes", assembler.size)
        now = _profile(symbols(node_temperatures), assembler)
        m = Module(stack_profile=now, stack=assembler.stack, **of)
        m.edge_drops = layer_columns.edge_drops(m)
        around = layer_columns.layer_surroundings(m)
        seen = ca.vertcat(*around.drops, around.through)
        by_nodes = ca.densify(ca.jacobian(seen, node_temperatures))
        if end is None:
            (below,) = of["end_profile"]
            warmer: list[Any] = [np.ones(assembler.cells)] * len(below)
        else:
            lost, cooled = of["end_profile"]
            warmer, below = columns.beside_wall(lost), columns.below_wall(cooled)
        moment = of["moment_now"] / of["pcl_depth"]
        self.numbers = ca.vertcat(
            ca.vec(by_nodes.T), ca.vec(ca.vertcat(around.in_plate)), ca.vec(ca.vertcat(around.share)),
            *(ca.vec(ca.vertcat(one)) for one in (*warmer, *below)), moment, of["spring_stiffness"],
            of["soft_threshold"], *of["structure_compliances"], of["lossless_compliance"],
        )  # fmt: skip
        self.constants = self._constants(of)

    @staticmethod
    def _constants(of: dict[str, Any]) -> Any:
        rheology, law = of["pcl_rheology"], of["structure_softening"]
        solid = rheology.solid
        pinned, _ = polymer.maxwell_moduli(polymer.PINNED_FREQUENCY, rheology.solid_modes)
        risen = solid.slope * solid.width * np.log1p(np.exp((solid.reference_temperature - solid.onset) / solid.width))
        level = np.log(solid.reference_modulus / (2.0 * (1.0 + solid.poissons_ratio)) / pinned) + risen
        times, shares = zip(*rheology.solid_modes, strict=True)
        melt_times, moduli = zip(*rheology.melt_modes, strict=True)
        return ca.vertcat(
            2.0 * np.pi * of["frequency_now"], level, 0.0, solid.slope, solid.onset, solid.width, 0.0,
            rheology.activation_energy / polymer.GAS_CONSTANT, rheology.melt_reference, *law, of["clamped_loss_factor"],
            *(np.log(one) for one in (*times, *shares, *melt_times, *moduli)),
        )  # fmt: skip


def _profile(t: Any, assembler: Assembler) -> heat.Profile:
    """Return a profile that stands at the temperatures of the nodes."""
    a, n = assembler, assembler.cells
    lip = None if a.lip < 0 else WarmLip(t[a.lip + 1], None, {})
    around = t[a.around : a.around + len(a.stack.around)]
    return heat.Profile(
        cold=t[a.cold], hot=t[a.hot], spreader=t[a.hot], near=None, cells=t[:n], far=None, plate_face=None,
        plate=t[n : a.cold], beside=t[a.beside : a.around], sink=None, around=around, legs=t[a.legs : a.hot],
        liner=None, fractions=None, through_layer=None, through_liner=None, through_plate=None, lip=lip,
    )  # fmt: skip
