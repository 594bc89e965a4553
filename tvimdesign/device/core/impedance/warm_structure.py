"""The structure as warm as its parts are: stiffness and loss in series with the PCL, and the cold structure's strength.

At an operating point the PCL has been at its temperature for so long that nothing changes any more; in a phase the
parts have the temperatures of the instant. The floor, away from the pads' hot sides, has that of the air, or of the
pads' outer side; a wall between two pads is halfway between their sides. Each mode says in its own room what its parts
are: `structure_compliances`, and `lossless_compliance` of what is in series with the PCL's shear modes besides.

The plate beside the PCL gives next to the core: its compliance goes as 1/r^3 and its temperature as ln r between core
and PCL, so that their mean is 0.31 to 0.36 of the way out where the PCL begins at 2.5 to 4 radii of the core.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tvimdesign.device.core.impedance.joint_impedance import quantities as shared
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import heat, lumps
from tvimdesign.physics.heat_flow.held_plate import BehindPolymer, held_plate
from tvimdesign.physics.heat_flow.liner import Liner
from tvimdesign.physics.solids import warm
from tvimdesign.physics.solids.warm import Softening

quantities = QuantityGroup(shared.group)

WAY_OUT = 1.0 / 3.0
"""Share of the way from the core's temperature to the plate's at which the plate beside the PCL gives."""


class Compliances(NamedTuple):
    """Compliance about the axis of the parts in series at 23 degC [rad/(N*m)], by what warms them."""

    core: Scalar
    beside: Scalar
    """The rotor plate where it does not lie on the PCL."""
    plate: Scalar
    """What lies on the PCL: the plate, or the rotor's vanes."""
    walls: Scalar
    """What stands between the pads."""
    floor: Scalar
    pads: Scalar


class PartTemperatures(NamedTuple):
    """Temperatures [K] of those parts."""

    core: Scalar
    beside: Scalar
    plate: Sequence[Scalar]
    """In slices of its depth."""
    walls: Scalar
    floor: Scalar


@quantities.helper()
def structure_softening(
    structure_modulus_slope: Scalar,
    structure_softening_temperature: Scalar,
    structure_softening_width: Scalar,
    structure_softened_share: Scalar,
    structure_loss_factor: Scalar,
    structure_softening_loss_factor: Scalar,
) -> Softening:
    """How modulus and loss of the structure change with temperature."""
    return Softening(structure_modulus_slope, structure_softening_temperature, structure_softening_width,
                     structure_softened_share, structure_loss_factor, structure_softening_loss_factor)  # fmt: skip


def in_series(
    parts: Compliances, temperatures: PartTemperatures, law: Softening, clamped: Scalar, lossless: Scalar = 0.0
) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness [N*m/rad] of parts at temperatures of their own; joints add a loss to each."""

    def of(*slices: Scalar) -> tuple[Scalar, Scalar]:
        moduli = [warm.complex_modulus(temperature, law) for temperature in slices]
        storage, loss = (sum(parts) / len(moduli) for parts in zip(*moduli, strict=True))
        return storage, loss + clamped * storage

    core, beside, plate, walls, floor = temperatures
    moduli = [of(core), of(beside), of(*plate), of(walls), of(floor)]
    pads = (1.0, law.loss_factor + clamped)
    pairs = zip(parts, [*moduli, pads], strict=True)
    return warm.series([*((compliance, *modulus) for compliance, modulus in pairs), (lossless, 1.0, 0.0)])


# --- at the operating points ------------------------------------------------------------------------------------------


@quantities.helper()
def behind_pcl(
    pcl_area: Scalar,
    backing_depth: Scalar,
    liner_sheet: Liner | None,
    plate_outside: lumps.Surface,
    structure_conductivity: Scalar,
    ambient_temperature: Scalar,
    rotor_beside: tuple[lumps.Lump, ...],
    uneven_sideways: Scalar | None,
    core_and_link: lumps.Lump,
    plate_losses: tuple[lumps.Loss, ...],
    link_length: Scalar,
    link_half_width: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> BehindPolymer:
    """What the PCL heats, as in the stack; and both faces of the link lose heat, which a phase is too short to tell.

    What is beside the plate loses heat through `plate_losses` as well, such as the gap to the floor and the air there.
    """
    faces = lumps.Surface(4.0 * link_length * link_half_width, rotor_coefficient, surface_emissivity)
    cooled = list(rotor_beside)
    for loss in plate_losses:
        group, above = loss.link.first
        if group != "beside":
            continue
        cooled[above] = lumps.cooled_through(loss, cooled[above], ambient_temperature)
    return BehindPolymer(pcl_area, backing_depth, structure_conductivity, plate_outside, ambient_temperature,
                         (*cooled, core_and_link._replace(surface=faces)), uneven_sideways, liner_sheet)  # fmt: skip


@quantities.helper(per_point=True)
def part_temperatures(temperature: Scalar, behind_pcl: BehindPolymer) -> PartTemperatures:
    """Temperatures of the structure's parts with the PCL at the point's temperature for good."""
    held = held_plate(behind_pcl, temperature)
    walls = 0.5 * (temperature + behind_pcl.ambient)
    return _parts(held.plate, held.beside, walls, behind_pcl.ambient)


def _parts(plate: Sequence[Scalar], beside: Sequence[Scalar], walls: Scalar, floor: Scalar) -> PartTemperatures:
    core = beside[-1]
    return PartTemperatures(core, core + WAY_OUT * (beside[0] - core), plate, walls, floor)


@quantities.output("degC", per_point=True)
def plate_temperature(part_temperatures: PartTemperatures) -> Scalar:
    """Mean temperature of the plate, or of the rotor's vanes, on the PCL, which has been warm for long."""
    return sum(part_temperatures.plate) / len(part_temperatures.plate)


@quantities.output("degC", per_point=True)
def core_temperature(part_temperatures: PartTemperatures) -> Scalar:
    """Temperature of core and link with the PCL warm for long."""
    return part_temperatures.core


@quantities.helper(per_point=True)
def warm_structure(
    structure_compliances: Compliances,
    part_temperatures: PartTemperatures,
    structure_softening: Softening,
    clamped_loss_factor: Scalar,
) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of the structure at the point [N*m/rad]."""
    return in_series(structure_compliances, part_temperatures, structure_softening, clamped_loss_factor)


@quantities.output("N*m/rad", per_point=True)
def warm_structure_stiffness(warm_structure: tuple[Scalar, Scalar]) -> Scalar:
    """Stiffness in series with the PCL, parts as warm as they get at the point; `structure_stiffness` at 23 degC."""
    return warm_structure[0]


@quantities.output("N*m/rad", per_point=True)
def warm_structure_loss(warm_structure: tuple[Scalar, Scalar]) -> Scalar:
    """Loss stiffness of the structure at the point: of its material as warm as it gets, and of clamped joints."""
    return warm_structure[1]


_SOFT = "the hot part of the structure is soft: the hot joint is that soft only with its structure above its rating"


@quantities.output("1", advice=(Rule(sense=">=", value=0.5, reason=_SOFT),))
def hot_structure_share(warm_structure_stiffness_at_hot: Scalar, structure_stiffness: Scalar) -> Scalar:
    """Stiffness of the structure at the hot point over that at 23 degC."""
    return warm_structure_stiffness_at_hot / structure_stiffness


@quantities.helper(per_point=True)
def support(
    structure_compliances: Compliances,
    part_temperatures: PartTemperatures,
    structure_softening: Softening,
    clamped_loss_factor: Scalar,
    lossless_compliance: Scalar,
) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness in series with the PCL's shear modes [N*m/rad]."""
    return in_series(structure_compliances, part_temperatures, structure_softening, clamped_loss_factor,
                     lossless_compliance)  # fmt: skip


@quantities.helper(per_point=True)
def elastic_support(support: tuple[Scalar, Scalar]) -> Scalar:
    """Real stiffness in series with the PCL's shear modes [N*m/rad]."""
    return support[0]


@quantities.helper()
def cold_strength_share(temperature_at_cold: Scalar, structure_softening: Softening) -> Scalar:
    """Yield strength at the cold point over that at 23 degC [1], as that of the modulus: all parts as warm as the PCL.

    Yield stress and modulus of glassy polymers fall together (N. Brown, Mater. Sci. Eng. 8 (1971) 69).
    """
    return warm.modulus_share(temperature_at_cold, structure_softening)


@quantities.helper()
def cold_strength(structure_strength: Scalar, cold_strength_share: Scalar) -> Scalar:
    """Yield strength of the structure at the cold point [Pa]."""
    return structure_strength * cold_strength_share


@quantities.helper()
def cold_layer_strength(structure_layer_strength: Scalar, cold_strength_share: Scalar) -> Scalar:
    """Yield strength across the layers of a print at the cold point [Pa]."""
    return structure_layer_strength * cold_strength_share


# --- at each instant --------------------------------------------------------------------------------------------------


@quantities.helper(instant=True)
def parts_now(stack_profile: heat.Profile) -> PartTemperatures:
    """Temperatures of the structure's parts at an instant."""
    now = stack_profile
    slices = [now.plate[i] for i in range(len(now.plate))]
    return _parts(slices, now.beside, 0.5 * (now.hot + now.cold), now.cold)


@quantities.helper(instant=True)
def support_now(
    structure_compliances: Compliances,
    parts_now: PartTemperatures,
    structure_softening: Softening,
    clamped_loss_factor: Scalar,
    lossless_compliance: Scalar,
) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness in series with the PCL's slices at an instant [N*m/rad]."""
    return in_series(structure_compliances, parts_now, structure_softening, clamped_loss_factor, lossless_compliance)
