"""The structure as warm as its parts are: stiffness and loss in series with the PCL, and the cold structure's strength.

At an operating point the PCL has been at its temperature for so long that nothing changes any more; in a phase the
parts have the temperatures of the instant. The floor, away from the pads' hot sides, has that of the air, or of the
pads' outer side; a wall between two pads is halfway between their sides. Each mode defines what its parts
are: `structure_compliances`, and `lossless_compliance` of what is in series with the PCL's shear modes besides.

The plate beside the PCL gives next to the core: its compliance goes as 1/r^3 and its temperature as ln r between core
and PCL, so that their mean is 0.31 to 0.36 of the way out where the PCL begins at 2.5 to 4 radii of the core.
"""

from collections.abc import Sequence
from typing import NamedTuple

from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.heat_flow import lumps
from tvimdesign.physics.heat_flow.held_plate import BehindPolymer, held_plate
from tvimdesign.physics.polymers import plastics
from tvimdesign.physics.polymers.plastics import Softening

quantities = QuantityGroup("Impedance")

WAY_OUT = 1.0 / 3.0
"""Share of the way from the core's temperature to the plate's at which the plate beside the PCL gives."""


class Compliances(NamedTuple):
    """Compliance about the axis of the parts in series at 23 degC [rad/(N*m)], by what warms them."""

    core: Scalar
    beside: Scalar  # The rotor plate where it does not lie on the PCL
    plate: Scalar  # Part on the PCL: the plate, or the rotor's vanes
    walls: Scalar  # Part between the pads
    floor: Scalar
    pads: Scalar


class PartTemperatures(NamedTuple):
    """Temperatures [K] of those parts."""

    core: Scalar
    beside: Scalar
    plate: Sequence[Scalar]  # In slices of its depth
    walls: Scalar
    floor: Scalar


@quantities.helper()
def structure_softening(m: Module) -> Softening:
    """Change of the structure's modulus and loss with temperature."""
    return Softening(
        m.structure_modulus_slope, m.structure_softening_temperature, m.structure_softening_width,
        m.structure_softened_share, m.structure_loss_factor, m.structure_softening_loss_factor,
    )  # fmt: skip


def in_series(
    parts: Compliances, temperatures: PartTemperatures, law: Softening, clamped: Scalar, lossless: Scalar = 0.0
) -> tuple[Scalar, Scalar]:
    """Return the real and imaginary stiffness [N*m/rad] of parts at temperatures of their own; joints add a loss to
    each."""

    def of(*slices: Scalar) -> tuple[Scalar, Scalar]:
        moduli = [plastics.complex_modulus(temperature, law) for temperature in slices]
        storage, loss = (sum(parts) / len(moduli) for parts in zip(*moduli, strict=True))
        return storage, loss + clamped * storage

    core, beside, plate, walls, floor = temperatures
    moduli = [of(core), of(beside), of(*plate), of(walls), of(floor)]
    pads = (1.0, law.loss_factor + clamped)
    pairs = zip(parts, [*moduli, pads], strict=True)
    return plastics.series([*((compliance, *modulus) for compliance, modulus in pairs), (lossless, 1.0, 0.0)])


# --- at the operating points ------------------------------------------------------------------------------------------


def _behind_pcl(m: Module) -> BehindPolymer:
    """Return the bodies that the PCL heats, as in the stack; both faces of the link lose heat.

    What is beside the plate loses heat through `plate_losses` as well, such as the gap to the floor and the air there.
    """
    faces = lumps.Surface(4.0 * m.link_length * m.link_half_width, m.rotor_coefficient, m.surface_emissivity)
    cooled = list(m.rotor_beside)
    for loss in m.plate_losses:
        group, above = loss.link.first
        if group != "beside":
            continue
        cooled[above] = lumps.cooled_through(loss, cooled[above], m.ambient_temperature)
    return BehindPolymer(
        m.pcl_area, m.backing_depth, m.structure_conductivity, m.plate_outside, m.ambient_temperature,
        (*cooled, m.core_and_link._replace(surface=faces)), m.uneven_sideways, m.liner_sheet,
    )  # fmt: skip


@quantities.helper(per_point=True)
def part_temperatures(m: Module) -> PartTemperatures:
    """Temperatures of the structure's parts with the PCL at the point's temperature for good."""
    held = held_plate(_behind_pcl(m), m.temperature)
    walls = 0.5 * (m.temperature + _behind_pcl(m).ambient)
    return _parts(held.plate, held.beside, walls, _behind_pcl(m).ambient)


def _parts(plate: Sequence[Scalar], beside: Sequence[Scalar], walls: Scalar, floor: Scalar) -> PartTemperatures:
    core = beside[-1]
    return PartTemperatures(core, core + WAY_OUT * (beside[0] - core), plate, walls, floor)


@quantities.output("degC", per_point=True)
def plate_temperature(m: Module) -> Scalar:
    """Mean temperature of the plate, or of the rotor's vanes, on the PCL, which has been warm for long."""
    return sum(m.part_temperatures.plate) / len(m.part_temperatures.plate)


@quantities.output("degC", per_point=True)
def core_temperature(m: Module) -> Scalar:
    """Temperature of core and link with the PCL warm for long."""
    return m.part_temperatures.core


@quantities.helper(per_point=True)
def warm_structure(m: Module) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of the structure at the point [N*m/rad]."""
    return in_series(m.structure_compliances, m.part_temperatures, m.structure_softening, m.clamped_loss_factor)


@quantities.output("N*m/rad", per_point=True)
def warm_structure_stiffness(m: Module) -> Scalar:
    """Stiffness in series with the PCL, parts as warm as they get at the point; `structure_stiffness` at 23 degC."""
    return m.warm_structure[0]


@quantities.output("N*m/rad", per_point=True)
def warm_structure_loss(m: Module) -> Scalar:
    """Loss stiffness of the structure at the point: of its material as warm as it gets, and of clamped joints."""
    return m.warm_structure[1]


_SOFT = "the hot part of the structure is soft: the hot joint is that soft only with its structure above its rating"


@quantities.output("1", advice=(at_least(0.5, _SOFT),))
def hot_structure_share(m: Module) -> Scalar:
    """Stiffness of the structure at the hot point over that at 23 degC."""
    return m.warm_structure_stiffness_at_hot / m.structure_stiffness


@quantities.helper(per_point=True)
def support(m: Module) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness in series with the PCL's shear modes [N*m/rad]."""
    return in_series(
        m.structure_compliances,
        m.part_temperatures,
        m.structure_softening,
        m.clamped_loss_factor,
        m.lossless_compliance,
    )


@quantities.helper(per_point=True)
def elastic_support(m: Module) -> Scalar:
    """Real stiffness in series with the PCL's shear modes [N*m/rad]."""
    return m.support[0]


@quantities.helper()
def cold_strength_share(m: Module) -> Scalar:
    """Yield strength at the cold point over that at 23 degC [1], as that of the modulus: all parts as warm as the PCL.

    Yield stress and modulus of glassy polymers fall together (N. Brown, Mater. Sci. Eng. 8 (1971) 69).
    """
    return plastics.modulus_share(m.temperature_at_cold, m.structure_softening)


@quantities.helper()
def cold_strength(m: Module) -> Scalar:
    """Yield strength of the structure at the cold point [Pa]."""
    return m.structure_strength * m.cold_strength_share


@quantities.helper()
def cold_layer_strength(m: Module) -> Scalar:
    """Yield strength across the layers of a print at the cold point [Pa]."""
    return m.structure_layer_strength * m.cold_strength_share


# --- at each instant --------------------------------------------------------------------------------------------------


@quantities.helper(instant=True)
def parts_now(m: Module) -> PartTemperatures:
    """Temperatures of the structure's parts at an instant."""
    now = m.stack_profile
    slices = [now.plate[i] for i in range(len(now.plate))]
    return _parts(slices, now.beside, 0.5 * (now.hot + now.cold), now.cold)


@quantities.helper(instant=True)
def support_now(m: Module) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness in series with the PCL's slices at an instant [N*m/rad]."""
    return in_series(
        m.structure_compliances, m.parts_now, m.structure_softening, m.clamped_loss_factor, m.lossless_compliance
    )
