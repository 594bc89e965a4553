"""What the shrinking layer does to its bond, and to the joint where nothing holds the rotor on it.

A rotor that is held, by the hub it stands on or by bearings, leaves a freezing layer two ways: plate and floor bend
after it, and it pulls on its bond, most where it begins beside the hub. One that a wave spring carries comes down
with it. All of the shrinkage is taken as that of the frozen solid at room temperature, so the traction is an upper
bound: what shrinks while it is warm and soft, and what relaxes, is not taken off; the plates' arcs between the
layer's are left to help.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.base.record import Record
from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.core.shrinkage import quantities as shared
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import shrinkage
from tvimdesign.physics.solids import structure

places, quantities = QuantityGroup(layout.group), QuantityGroup(shared.group)
groups = (places, quantities)


@places.output("mm")
def freezing_travel(pcl_thickness: Scalar, melting_growth: Scalar) -> Scalar:
    """What the layer loses of its thickness on freezing, its area held by its faces."""
    return pcl_thickness * melting_growth


@quantities.helper()
def layer_foundation(
    pcl_flexural_modulus: Scalar,
    pcl_poissons_ratio: Scalar,
    pcl_thickness: Scalar,
    pad_foundation: Scalar,
    structure_youngs_modulus: Scalar,
    rotor_thickness: Scalar,
    floor_thickness: Scalar,
) -> Scalar:
    """Tension of the frozen layer over how far the middles of plate and floor part [Pa/m]."""
    layer = shrinkage.confined_modulus(pcl_flexural_modulus, pcl_poissons_ratio) / pcl_thickness
    halves = 2.0 * structure_youngs_modulus / (rotor_thickness + floor_thickness)
    return structure.series(layer, pad_foundation, halves)


@quantities.helper()
def plates_rigidity(
    structure_youngs_modulus: Scalar,
    structure_poissons_ratio: Scalar,
    structure_shear_modulus: Scalar,
    rotor_thickness: Scalar,
    floor_thickness: Scalar,
    arc_count: Scalar,
    arc_span: Scalar,
) -> tuple[Scalar, Scalar]:
    """Rigidity of plate and floor in series, of all the circumference over that of the arcs: bending [N*m], shear
    [N/m]."""
    both, share = (rotor_thickness, floor_thickness), arc_count * arc_span / (2.0 * np.pi)
    bending = (
        shrinkage.flexural_rigidity(structure_youngs_modulus, structure_poissons_ratio, thickness) for thickness in both
    )
    shear = (shrinkage.shear_rigidity(structure_shear_modulus, thickness) for thickness in both)
    return structure.series(*bending) / share, structure.series(*shear) / share


@quantities.output("MPa")
def freezing_traction(
    axial_preload: Record | str,
    freezing_shrinkage: Scalar,
    pcl_thickness: Scalar,
    layer_foundation: Scalar,
    plates_rigidity: tuple[Scalar, Scalar],
    pcl_inner_radius: Scalar,
    hub_radius: Scalar,
    frozen_preload: Scalar,
    arc_count: Scalar,
    arc_span: Scalar,
    pcl_tensile_yield: Scalar,
) -> Scalar:
    """Highest tension on the frozen layer's bond: at its inner edge, of its shrinkage or of the wave spring.

    An upper bound for a rotor that is held; the PCL yields at its tensile yield.
    """
    span = pcl_inner_radius - hub_radius
    if isinstance(axial_preload, str):
        lost = freezing_shrinkage * pcl_thickness
        held = shrinkage.edge_traction(lost, layer_foundation, *plates_rigidity, span)
        return np.fmin(held, pcl_tensile_yield)
    edge = arc_count * arc_span * pcl_inner_radius
    return shrinkage.edge_traction_of_force(frozen_preload / edge, layer_foundation, plates_rigidity[0], span)


_PARTS = "the freezing layer shrinks, the rotor cannot follow, and the bond may part at its inner edge"


@quantities.output("1", advice=(Rule(sense=">=", value=1.0, reason=_PARTS),))
def freezing_safety(pcl_bond_strength: Scalar, freezing_traction: Scalar) -> Scalar:
    """What the bond bears over the tension the freezing layer puts on it."""
    return pcl_bond_strength / freezing_traction


@quantities.output("%")
def layer_wedge(core_lean: Scalar, pcl_outer_radius: Scalar, pcl_thickness: Scalar) -> Scalar:
    """Play of core or bearings at the layer's outer edge over its thickness: a melt may freeze as that wedge."""
    return core_lean * pcl_outer_radius / pcl_thickness


_FLOATS = "the rotor can rise by that share of the layer's thickness, and nothing holds it down (assumed, 5 to 20 %)"


@quantities.output("%", advice=(Rule(sense="<=", value=0.1, reason=_FLOATS),))
def layer_play(axial_play: Scalar, pcl_thickness: Scalar) -> Scalar:
    """How far the rotor can rise off the layer over the layer's thickness: by so much the melt may be thicker."""
    return axial_play / pcl_thickness
