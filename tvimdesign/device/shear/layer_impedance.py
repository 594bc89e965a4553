"""The PCL layer of the shear module and what it works against: stiffness, damping, strain, and the torque it holds.

A rotor that is held, by the hub it stands on or by bearings, leaves a freezing layer two ways: plate and floor bend
after it, and it pulls on its bond, most where it begins beside the hub. One that a wave spring carries comes down
with it. All of the shrinkage is taken as that of the frozen solid at room temperature, so the traction is an upper
bound: what shrinks while it is warm and soft, and what relaxes, is not taken off; the plates' arcs between the
layer's are left to help.
"""

import numpy as np

from tvimdesign.device.components.bearing import with_bearings
from tvimdesign.device.components.dowels import LINK_PARTS
from tvimdesign.device.components.liner_and_adhesive import WITH_LINER, traction_with_liner
from tvimdesign.device.core.heater_form import CUT
from tvimdesign.device.core.impedance.structure_stiffness import CORE_PARTS
from tvimdesign.device.core.impedance.warm_structure import Compliances
from tvimdesign.device.shear.spreader_seat import PAD_PARTS, TILE_PARTS
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_most
from tvimdesign.physics.layers import lasting_load, layer, shear_lag
from tvimdesign.physics.polymers import melt, polymer, transitions
from tvimdesign.physics.solids import structure

quantities = QuantityGroup("Impedance")

quantities.choices("layer_impedance")


quantities.field("layer_polar_moment", "pcl_section", "polar", "Polar second moment of area of the PCL layer", "m^4")


@quantities.output("N*m/rad", per_point=True, headline=True)
def pcl_stiffness(m: Module) -> Scalar:
    """Stiffness of the PCL layer alone, K_PCL."""
    return m.storage_modulus * m.layer_polar_moment / m.pcl_thickness


@quantities.output("N*m*s/rad", per_point=True, headline=True)
def pcl_damping(m: Module) -> Scalar:
    """Damping of the PCL layer alone, b_PCL."""
    return m.loss_modulus * m.layer_polar_moment / m.pcl_thickness / (2.0 * np.pi * m.frequency)


@quantities.helper()
def window_span(m: Module) -> Scalar:
    """Angle that the window below an arc takes up [rad]."""
    return m.arc_span - 2.0 * m.window_ledge / m.pcl_inner_radius


@quantities.helper()
def held_pads(m: Module) -> Scalar:
    """Polar moment of the pads [m^4] less what gives above the windows, along both rims and both ends of each.

    A spreader bridges the windows.
    """
    if m.heater_form != CUT:
        return m.layer_polar_moment
    fringe = shear_lag.end_fringe(m.heater_shear_modulus, m.heater_bulk_modulus)
    across = shear_lag.held_over_window(m.heater_thickness, 0.5 * m.window_depth)
    along = shear_lag.held_over_window(m.heater_thickness, 0.5 * m.window_span * m.pcl_mean_radius, fringe)
    return m.layer_polar_moment - (1.0 - across) * (1.0 - along) * m.window_section.polar


@quantities.helper()
def held_polar_moment(m: Module) -> Scalar:
    """Polar moment of the frozen layer [m^4] less what it does not bear above the windows, which do not hold the pads.

    Under the layer a pad gives over a third of its own thickness, as a sheet that is sheared along its upper face. No
    less is held than of pads under a stiff layer, as one that gives evens out. A spreader bridges the windows, so it
    holds all of the layer.
    """
    if m.heater_form != CUT:
        return m.layer_polar_moment
    per_area = 1.0 / (m.pcl_thickness / m.frozen_shear_modulus + m.heater_thickness / (3.0 * m.heater_shear_modulus))
    sheet = 1.0 / (m.heater_shear_modulus * m.heater_thickness)
    borne = shear_lag.borne_over_window(per_area, sheet, 0.5 * m.window_depth)
    return np.fmax(m.layer_polar_moment - (1.0 - borne) * m.window_section.polar, m.held_pads)


@quantities.helper(requires=WITH_LINER)
def liner_shear_modulus(m: Module) -> Scalar:
    """Shear modulus of the liner [Pa]."""
    return structure.shear_modulus(m.liner_youngs_modulus, m.liner_poissons_ratio)


@quantities.helper(requires=WITH_LINER, default=np.inf)
def liner_traction(m: Module) -> Scalar:
    """Shear that a liner and its bond bear [Pa]: infinite without one."""
    return np.fmin(m.liner_bond_strength, structure.shear_yield(m.liner_strength))


@quantities.helper(requires=WITH_LINER)
def liner_compliance(m: Module) -> Scalar:
    """Compliance of the liners in shear about the axis [rad/(N*m)]; zero without."""
    return m.liner_thickness / (m.liner_shear_modulus * m.layer_polar_moment)


@quantities.helper()
def frozen_layer_stiffness(m: Module) -> Scalar:
    """Stiffness of frozen layer, pads and liners in series at 23 degC [N*m/rad]."""
    layers = m.pcl_thickness / (m.frozen_shear_modulus * m.layer_polar_moment)
    return 1.0 / (layers + m.pad_compliance + m.liner_compliance)


@quantities.helper()
def layer_against_leaning(m: Module) -> Scalar:
    """Stiffness of layer and pads between rigid faces that lean [N*m/rad].

    Half of that about the axis, as often as a pad is stiffer drawn than sheared: a strip on its ledge, 4 (1 + S^2) with
    half the ledge over the pad's thickness as S. Adhesive around spreaders is sheared either way.
    """
    strip = 4.0 * (1.0 + (0.5 * m.window_ledge / m.heater_thickness) ** 2) if m.heater_form == CUT else 1.0
    return 0.5 * strip * m.frozen_layer_stiffness


@quantities.helper()
def layer_sideways(m: Module) -> Scalar:
    """Sideways compliance of layer and pads [m/N]."""
    return 0.5 * (m.pcl_inner_radius**2 + m.pcl_outer_radius**2) / m.frozen_layer_stiffness


@quantities.helper()
def core_foot_rise(m: Module) -> Scalar:
    """Rise of the core's stress at its foot [1]: on a plate that the arcs drive, with the holes of the link."""
    length = m.link_bottom_level - m.rotor_top_level
    holes = m.core_screw_bores, m.core_dowel_bores
    return structure.foot_rise_on_plate(m.core_radius, length, m.rotor_thickness, *holes, fillet=m.foot_fillet)


@quantities.helper()
def structure_compliances(m: Module) -> Compliances:
    """Compliances in series with the layer: core, rotor plate inside and above the arcs, floor, pads and liners."""
    above, below = m.over_arcs_compliance, 1.0 / m.floor_stiffness
    sheets = m.pad_compliance + m.liner_compliance
    return Compliances(1.0 / m.core_stiffness, 1.0 / m.plate_stiffness - above, above, 0.0, below, sheets)


@quantities.helper()
def pcl_moment(m: Module) -> Scalar:
    """Factor of the PCL's shear modulus over its depth in its stiffness [m^4]: the layer's polar moment."""
    return m.layer_polar_moment


@quantities.helper()
def lossless_compliance(_: Module) -> Scalar:
    """Compliance without loss in series with the PCL's shear modes [rad/(N*m)]: zero."""
    return 0.0


@quantities.output("1", headline=True)
def layer_strain(m: Module) -> Scalar:
    """Shear strain of the molten layer at its outer radius at full stroke."""
    return layer.shear_strain(m.pcl_outer_radius, m.stroke, m.pcl_thickness)


quantities.margins("layer_impedance.quantities")


@quantities.helper()
def largest_melt_strain(m: Module) -> Scalar:
    """Largest shear strain of the molten layer at full stroke [1]: that at its outer radius."""
    return m.layer_strain


@quantities.helper()
def stroke_strains(m: Module) -> list[tuple[Scalar, Scalar]]:
    """Shear strains of the layer at full stroke, and the share of the small-motion torque borne at each [1]."""
    nodes = melt.ring(m.pcl_inner_radius / m.pcl_outer_radius)
    return [(m.layer_strain * reach, share) for reach, share in nodes]


@quantities.output("1")
def bond_derating(m: Module) -> Scalar:
    """Share of the bond's strength after `bond_cycles` meltings and at the cold point; counted if the study says so.

    A share is lost with each tenfold of cycles, and with the frozen PCL's modulus by temperature: both are assumed.
    """
    cold, sheet = (
        polymer.solid_shear_modulus(kelvin, m.pcl_solid_modulus)
        for kelvin in (m.temperature_at_cold, m.pcl_reference_temperature)
    )
    return (1.0 - m.bond_cycle_loss) ** np.log10(1.0 + m.bond_cycles) * cold / sheet


@quantities.output("MPa")
def bond_strength(m: Module) -> Scalar:
    """Traction that the bond of layer and faces bears, derated where the study's `bond_rating` says so."""
    return m.pcl_bond_strength * (m.bond_derating if m.bond_rating == "derated" else 1.0)


quantities.same(
    "bearing_polar_moment", "layer_polar_moment", "Polar moment of what bears of the frozen layer [m^4]: all of it"
)


@quantities.output("N*m")
def layer_holding_torque(m: Module) -> Scalar:
    """Torque at which the frozen layer's bond, its shear yield, or a liner on it fails at its outer rim."""
    traction = np.fmin(m.bond_strength, structure.shear_yield(m.pcl_tensile_yield))
    traction = traction_with_liner(m.liner_material, traction, m.liner_traction)
    return layer.torque_at_traction(traction, m.bearing_polar_moment, m.pcl_outer_radius)


_PARTS = ("layer_holding_torque", *TILE_PARTS, *PAD_PARTS, *CORE_PARTS, *LINK_PARTS, "bearing_holding_torque")


@quantities.output("N*m", headline=True, least_of=_PARTS)
def holding_torque(m: Module) -> Scalar:
    """Torque the frozen joint holds from link to floor: the least of what the parts on its way bear."""
    rotor = np.fmin(m.core_holding_torque, m.link_holding_torque)
    held = np.fmin(np.fmin(m.layer_holding_torque, m.seat_holding_torque), rotor)
    return with_bearings(m.bearing, held, m.bearing_holding_torque)


@quantities.output("MPa")
def layer_edge_traction(m: Module) -> Scalar:
    """Traction along the edge of an arc under the torque the joint bears, a mean over one thickness of the layer."""
    return m.layer_edge_rise * layer.traction(m.borne_torque, m.layer_polar_moment, m.pcl_outer_radius)


@quantities.output("1", headline=True)
def parting_share(_: Module) -> Scalar:
    """Share of the PCL that can part from what presses on it: none, the layer is bonded to both its faces.

    It pulls as well as it pushes, so no hold opens a gap and a swing loses no contact. The bond pays for it.
    """
    return 0.0


@quantities.output("N*m", per_point=True)
def layer_torque(m: Module) -> Scalar:
    """Torque of the layer in a hold when the load has just come on; the springs bear the rest."""
    return lasting_load.first_torque(m.hold_torque, m.spring_stiffness, m.elastic_support, m.pcl_modes)


places = QuantityGroup("Layout")
plays = QuantityGroup("Axial play")


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


@plays.output("MPa")
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


plays.margins("layer_impedance.plays")


_FLOATS = "the rotor can rise by that share of the layer's thickness, and nothing holds it down (assumed, 5 to 20 %)"


@plays.output("mm")
def expansion_travel(m: Module) -> Scalar:
    """Length by which the warm core outgrows its hub from plate to retainer: the gap of the layer widens by it.

    The core is as warm as with the PCL hot for long, the hub as cold as the air: an upper bound.
    """
    length = m.rotor_bottom_level - m.hub_bottom_level
    return m.structure_expansion * length * (m.core_temperature_at_hot - m.ambient_temperature)


@plays.output("%", advice=(at_most(0.1, _FLOATS),))
def layer_play(m: Module) -> Scalar:
    """Way of the rotor off the layer, by its play and by expansion, over the layer's thickness: so much more melt."""
    return (m.axial_play + m.expansion_travel) / m.pcl_thickness


@quantities.helper()
def layer_proportions(m: Module) -> dict[str, Scalar]:
    """Ratios of the arcs' sizes that the stiffness of plate and floor hangs on [1]."""
    return {"pcl_thickness/rotor_thickness": m.pcl_thickness / m.rotor_thickness}
