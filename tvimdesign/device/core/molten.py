"""How molten PCL flows of its own weight: its viscosity, and how far its free ends creep in a hot hour.

The ends of an arc and the sides of a block are free; what stands between two faces flows out there, the axis level.
"""

from __future__ import annotations

from tvimdesign.device.core.impedance.joint_impedance import quantities as impedance
from tvimdesign.device.core.shrinkage import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import melt, polymer, viscoelasticity

rheology, quantities = QuantityGroup(impedance.group), QuantityGroup(shared.group)
groups = (rheology, quantities)
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
