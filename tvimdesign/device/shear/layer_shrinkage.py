"""Load of the shrinking layer on its bond, and play of the joint where nothing holds the rotor on it.

A rotor that is held, by the hub it stands on or by bearings, leaves a freezing layer two ways: plate and floor bend
after it, and it pulls on its bond, most where it begins beside the hub. One that a wave spring carries comes down
with it. All of the shrinkage is taken as that of the frozen solid at room temperature, so the traction is an upper
bound: what shrinks while it is warm and soft, and what relaxes, is not taken off; the plates' arcs between the
layer's are left to help.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import transitions
from tvimdesign.physics.solids import structure

places, quantities = QuantityGroup("Layout"), QuantityGroup("Axial play")


@places.output("mm")
def freezing_travel(m: Module) -> Scalar:
    """Thickness that the layer loses on freezing, its area held by its faces."""
    return m.pcl_thickness * m.melting_growth


def _layer_foundation(m: Module) -> Scalar:
    """Return the tension of the frozen layer over how far the middles of plate and floor part [Pa/m]."""
    layer = transitions.confined_modulus(m.pcl_flexural_modulus, m.pcl_poissons_ratio) / m.pcl_thickness
    halves = 2.0 * m.structure_youngs_modulus / (m.rotor_thickness + m.floor_thickness)
    return structure.series(layer, m.pad_foundation, halves)


def _plates_rigidity(m: Module) -> tuple[Scalar, Scalar]:
    """Return the rigidity of plate and floor in series, of all the circumference over that of the arcs: bending [N*m],
    shear [N/m]."""
    both, share = (m.rotor_thickness, m.floor_thickness), m.arc_count * m.arc_span / (2.0 * np.pi)
    bending = (
        transitions.flexural_rigidity(m.structure_youngs_modulus, m.structure_poissons_ratio, thickness)
        for thickness in both
    )
    shear = (transitions.shear_rigidity(m.structure_shear_modulus, thickness) for thickness in both)
    return structure.series(*bending) / share, structure.series(*shear) / share


@quantities.output("MPa")
def freezing_traction(m: Module) -> Scalar:
    """Highest tension on the frozen layer's bond: at its inner edge, of its shrinkage or of the wave spring.

    An upper bound for a rotor that is held; the PCL yields at its tensile yield.
    """
    span = m.pcl_inner_radius - m.hub_radius
    if isinstance(m.axial_preload, str):
        lost = m.freezing_shrinkage * m.pcl_thickness
        bending, shear = _plates_rigidity(m)
        held = transitions.edge_traction(lost, _layer_foundation(m), bending, shear, span)
        return np.fmin(held, m.pcl_tensile_yield)
    edge = m.arc_count * m.arc_span * m.pcl_inner_radius
    return transitions.edge_traction_of_force(
        m.frozen_preload / edge, _layer_foundation(m), _plates_rigidity(m)[0], span
    )


_PARTS = "the freezing layer shrinks, the rotor cannot follow, and the bond may part at its inner edge"


@quantities.output("1", advice=(Rule(sense=">=", value=1.0, reason=_PARTS),))
def freezing_safety(m: Module) -> Scalar:
    """Strength of the bond over the tension that the freezing layer puts on it."""
    return m.pcl_bond_strength / m.freezing_traction


@quantities.output("%")
def layer_wedge(m: Module) -> Scalar:
    """Play of core or bearings at the layer's outer edge over its thickness: a melt may freeze as that wedge."""
    return m.core_lean * m.pcl_outer_radius / m.pcl_thickness


_FLOATS = "the rotor can rise by that share of the layer's thickness, and nothing holds it down (assumed, 5 to 20 %)"


@quantities.output("%", advice=(Rule(sense="<=", value=0.1, reason=_FLOATS),))
def layer_play(m: Module) -> Scalar:
    """Distance that the rotor can rise off the layer over the layer's thickness: by so much the melt may be thicker."""
    return m.axial_play / m.pcl_thickness
