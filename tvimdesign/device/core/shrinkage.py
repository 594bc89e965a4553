"""What the PCL loses in volume on freezing, and how far the rotor can move along its axis."""

from __future__ import annotations

from tvimdesign.base.record import Record
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import shrinkage

quantities = QuantityGroup("Axial play")


@quantities.output("%")
def freezing_shrinkage(pcl_melt_density: Scalar, pcl_density: Scalar) -> Scalar:
    """Share of its volume that the PCL loses on freezing."""
    return shrinkage.volume_share(pcl_melt_density, pcl_density)


@quantities.helper()
def melting_growth(pcl_melt_density: Scalar, pcl_density: Scalar) -> Scalar:
    """Volume the PCL gains on melting over that of the solid."""
    return shrinkage.growth(pcl_melt_density, pcl_density)


@quantities.output("mm^3")
def freezing_volume(pcl_volume: Scalar, melting_growth: Scalar) -> Scalar:
    """Volume all PCL together loses on freezing and gains on melting."""
    return pcl_volume * melting_growth


@quantities.output("mm")
def axial_play(bearing: Record | str, axial_preload: Record | str, running_clearance: Scalar) -> Scalar:
    """How far the rotor can rise from where it stands, beyond what the melting PCL needs.

    In a plain bore nothing but the layer keeps the retainer from its running clearance below the hub; bearings are
    clamped, and a wave spring holds the rotor on its stop.
    """
    held = not isinstance(bearing, str) or not isinstance(axial_preload, str)
    return 0.0 * running_clearance if held else running_clearance


@quantities.output("g")
def turning_mass(
    rotor_mass: Scalar,
    link_mass: Scalar,
    retainer_mass: Scalar,
    link_screw_volume: Scalar,
    link_screw_density: Scalar,
    retainer_screw_volume: Scalar,
    retainer_screw_density: Scalar,
) -> Scalar:
    """Mass of rotor, link, retainer and their screws: what hangs on the layer where no wave spring carries it."""
    screws = link_screw_volume * link_screw_density + retainer_screw_volume * retainer_screw_density
    return rotor_mass + link_mass + retainer_mass + screws
