"""Shrinkage of the PCL on freezing, flow of molten PCL under its own weight, and axial play of the rotor.

The ends of an arc and the sides of a block are free; what stands between two faces flows out there, the axis level.
"""

from __future__ import annotations

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import melt, polymer, transitions, viscoelasticity

quantities = QuantityGroup("Axial play")


@quantities.output("%")
def freezing_shrinkage(m: Module) -> Scalar:
    """Share of its volume that the PCL loses on freezing."""
    return transitions.volume_share(m.pcl_melt_density, m.pcl_density)


@quantities.helper()
def melting_growth(m: Module) -> Scalar:
    """Volume the PCL gains on melting over that of the solid."""
    return transitions.growth(m.pcl_melt_density, m.pcl_density)


@quantities.output("mm^3")
def freezing_volume(m: Module) -> Scalar:
    """Volume all PCL together loses on freezing and gains on melting."""
    return m.pcl_volume * m.melting_growth


@quantities.output("mm")
def axial_play(m: Module) -> Scalar:
    """Distance that the rotor can rise from where it stands, beyond what the melting PCL needs.

    In a plain bore nothing but the layer keeps the retainer from its running clearance below the hub; bearings are
    clamped, and a wave spring holds the rotor on its stop.
    """
    held = not isinstance(m.bearing, str) or not isinstance(m.axial_preload, str)
    return 0.0 * m.running_clearance if held else m.running_clearance


@quantities.output("g")
def turning_mass(m: Module) -> Scalar:
    """Mass of rotor, link, retainer and their screws: what hangs on the layer where no wave spring carries it."""
    screws = m.link_screw_volume * m.link_screw_density + m.retainer_screw_volume * m.retainer_screw_density
    return m.rotor_mass + m.link_mass + m.retainer_mass + screws


rheology = QuantityGroup("Impedance")
GRAVITY = 9.80665
"""Standard acceleration of gravity [m/s^2], CODATA."""
HOUR = 3600.0
"""Seconds."""


@rheology.output("Pa*s", per_point=True)
def pcl_viscosity(m: Module) -> Scalar:
    """Viscosity of the PCL in slow steady flow."""
    return viscoelasticity.zero_shear_viscosity(polymer.spectrum(m.temperature, m.solid_fraction, m.pcl_rheology))


@quantities.output("mm")
def melt_creep(m: Module) -> Scalar:
    """Way the free ends of the PCL creep in an hour at the hot point, the axis level; lips along an arc hold no end."""
    weight = m.pcl_melt_density * GRAVITY
    return HOUR * melt.gap_speed(weight, m.pcl_depth + m.freezing_travel, m.pcl_viscosity_at_hot)
