"""Volume, mass and inertia of the motor's parts, its hub and its housing, and of all that the motor turns.

All is zero without a motor. A motor below the feet turns the housing and what goes with it. Holes of tangs count at the
springs' axes, the rounding of pockets and windows at their mean radius: right to a thousandth or two (the checks on the
solids hold it to 0.5 %)."""

from tvimdesign.device.components.bearing import BEARINGS, density_as_a_ring, inner_ring
from tvimdesign.device.components.fastening import screw_moments
from tvimdesign.device.core.mass_properties import template_made_inertia, template_volume
from tvimdesign.device.core.motor_choice import WITH_ENCODER, WITH_MOTOR
from tvimdesign.device.motor.motor_layout import BASE_SCREWS
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.solids import shapes

quantities = QuantityGroup("Size and weight", WITH_MOTOR)


@quantities.helper(default=shapes.NOTHING)
def motor_hub_moments(m: Module) -> shapes.Section:
    """Volume and its polar moment about the axis, of the motor's hub; the spokes' corners count at the disc's rim."""
    spokes = shapes.spoke(m.mount_boss_radius, m.motor_disc_radius, m.placement_radius) - shapes.disc_at(
        0.5 * m.mount_screw_pilot, m.placement_radius
    )
    corners = 2.0 * shapes.inner_corner(m.motor_corner_radius, m.motor_disc_radius, m.mount_boss_radius)
    return shapes.stacked(
        (shapes.ring(0.0, m.motor_disc_radius), m.motor_plate_thickness),
        (spokes.times(m.foot_count), m.motor_plate_thickness),
        (shapes.Section(corners, corners * m.motor_disc_radius**2).times(m.foot_count), m.motor_plate_thickness),
        (shapes.ring(m.motor_barrel_radius, m.motor_disc_radius), m.motor_plate_level - m.motor_rotor_bottom_level),
        (shapes.ring(0.0, m.motor_collar_radius), m.motor_plate_level - m.stator_top_level),
        (shapes.ring(0.0, m.motor_journal_radius), m.stator_top_level - m.motor_journal_level),
        (shapes.ring(0.0, 0.5 * m.motor_screw_pilot), -m.motor_screw_depth),
        (shapes.point_at(0.5 * m.motor_screw_pilot, 0.0), -m.drill_point_ratio * m.motor_screw_pilot),
    )


quantities.from_template("motor_hub", "the motor's hub", template_volume, "mm^3")


@quantities.output("mm^3")
def motor_housing_volume(m: Module) -> Scalar:
    """Volume of the motor's housing: base, wall and tube, less bore, seats, holes, recesses and wires' ways."""
    lower = m.motor_retainer_level + m.drive_motor.bearing_width - m.motor_bottom_level
    lip = m.stator_top_level - m.drive_motor.bearing_width - m.motor_bottom_level - lower
    solid = (
        shapes.ring(0.0, m.motor_outer_radius).area * m.motor_base_thickness
        + shapes.ring(m.stator_seat_radius, m.motor_outer_radius).area * m.drive_motor.stator_length
        + shapes.ring(0.0, m.motor_tube_radius).area * m.drive_motor.stator_length
    )
    bore = (
        shapes.ring(0.0, m.motor_seat_radius).area * (lower + m.drive_motor.bearing_width)
        + shapes.ring(0.0, m.motor_lip_radius).area * lip
    )
    point = m.drill_point_ratio * m.mount_screw_pilot
    screws = BASE_SCREWS * shapes.ring(0.0, 0.5 * m.mount_screw_pilot).area * (m.motor_base_hole_depth + point / 3.0)
    wires = shapes.notch(0.5 * m.motor_wire_width, m.stator_seat_radius, m.motor_outer_radius).area * m.motor_wire_depth
    whole = solid - bore - screws - wires
    if m.angle_sensor is None:
        return whole
    radius = m.encoder_recess_radius
    groove = shapes.notch(0.5 * m.motor_wire_width, radius, m.motor_outer_radius).area
    return whole - (shapes.ring(m.motor_seat_radius, radius).area + groove) * m.angle_sensor.board_height


@quantities.helper(default=shapes.NOTHING)
def motor_retainer_moments(m: Module) -> shapes.Section:
    """Volume and its polar moment about the axis, of the motor's retainer."""
    return shapes.stacked(
        (shapes.ring(0.5 * m.motor_screw_clearance, m.motor_collar_radius), m.motor_retainer_floor),
        (shapes.ring(m.motor_sink_radius, m.motor_collar_radius), m.motor_retainer_thickness - m.motor_retainer_floor),
    )


quantities.from_template("motor_retainer", "the motor's retainer", template_volume, "mm^3")


@quantities.helper(default=shapes.NOTHING)
def motor_screw_moments(m: Module) -> shapes.Section:
    """Volume and its polar moment about the axis, of the motor retainer's screw."""
    return screw_moments(
        1.0, 0.0, m.motor_screw_pilot, m.motor_screw_length, m.motor_screw_head, m.motor_screw_head_height
    )


quantities.from_template("motor_screw", "the motor retainer's screw", template_volume, "mm^3")


@quantities.helper(default=shapes.NOTHING)
def mount_screw_moments(m: Module) -> shapes.Section:
    """Volume and its polar moment about the axis, of the screws between housing and motor hub."""
    return screw_moments(
        m.foot_count, m.placement_radius, m.mount_screw_pilot, m.mount_screw_length, m.mount_screw_head,
        m.mount_screw_head_height,
    )  # fmt: skip


_MOUNTING = "the screws between housing and motor hub together; without a motor they are not the module's"
quantities.from_template("mount_screw", _MOUNTING, template_volume, "mm^3")


@quantities.output("mm^3")
def motor_rotor_volume(m: Module) -> Scalar:
    """Volume of the motor's rotor as a ring."""
    return shapes.ring(m.drive_motor.rotor_bore, m.drive_motor.rotor_radius).area * m.drive_motor.rotor_length


@quantities.output("mm^3")
def motor_stator_volume(m: Module) -> Scalar:
    """Volume of the motor's stator with its windings as a ring."""
    return shapes.ring(m.drive_motor.stator_bore, m.drive_motor.stator_radius).area * m.drive_motor.stator_length


@quantities.output("mm^3")
def motor_bearing_volume(m: Module) -> Scalar:
    """Volume of the motor's two bearings as rings without gaps."""
    return (
        BEARINGS
        * shapes.ring(m.drive_motor.bearing_bore, m.drive_motor.bearing_radius).area
        * m.drive_motor.bearing_width
    )


@quantities.output("mm^3", requires=WITH_ENCODER)
def encoder_magnet_volume(m: Module) -> Scalar:
    """Volume of the encoder's magnet."""
    return shapes.ring(0.0, m.angle_sensor.magnet_radius).area * m.angle_sensor.magnet_height


@quantities.output("mm^3", requires=WITH_ENCODER)
def encoder_board_volume(m: Module) -> Scalar:
    """Volume of the encoder's board as a disc as high as board and chip."""
    return shapes.ring(0.0, m.angle_sensor.board_radius).area * m.angle_sensor.board_height


quantities.formulas("motor_mass_properties")


@quantities.output("kg/m^3")
def motor_bearing_density(m: Module) -> Scalar:
    """Mass of one of the motor's bearings over its volume; zero without a motor."""
    return density_as_a_ring(m.motor_bearing)


@quantities.output("g")
def drive_mass(m: Module) -> Scalar:
    """Mass of motor, its hub, housing, retainer, bearings and screws, and encoder; zero without a motor."""
    made = (m.motor_hub_volume + m.motor_housing_volume + m.motor_retainer_volume) * m.structure_density
    screws = m.motor_screw_volume * m.motor_screw_density + m.mount_screw_volume * m.mount_screw_density
    bought = m.drive_motor.stator_mass + m.drive_motor.rotor_mass + m.motor_bearing_volume * m.motor_bearing_density
    encoder = m.encoder_magnet_volume * m.encoder_magnet_density + m.encoder_board_volume * m.encoder_board_density
    return made + screws + bought + encoder


quantities.from_template(
    "motor_hub", "the motor's hub about the axis; zero without a motor", template_made_inertia, "kg*mm^2",
    name="motor_hub_inertia",
)  # fmt: skip


@quantities.output("kg*mm^2")
def drive_inertia(m: Module) -> Scalar:
    """Moment of inertia of what the motor turns below the housing: rotor, hub, retainer, screws, inner rings, magnet.

    It is on the motor's side of springs and PCL, and no part of `parts_inertia`. The rotor's is its record's.
    """
    retainer = m.motor_retainer_moments.polar * m.structure_density
    screws = m.motor_screw_moments.polar * m.motor_screw_density + m.mount_screw_moments.polar * m.mount_screw_density
    inner = inner_ring(m.drive_motor.bearing_bore, m.drive_motor.bearing_radius)
    rings = BEARINGS * m.drive_motor.bearing_width * inner.polar * m.motor_bearing_density
    magnet = shapes.ring(0.0, m.encoder_magnet_radius).polar * m.encoder_magnet_height * m.encoder_magnet_density
    return m.drive_motor.rotor_inertia + m.motor_hub_inertia + retainer + screws + rings + magnet


inertias = QuantityGroup("Size and weight")


inertias.from_template(
    "housing", "the housing about the axis", template_made_inertia, "kg*mm^2", name="housing_inertia"
)


@inertias.output("kg*mm^2", requires=WITH_MOTOR)
def driven_inertia(m: Module) -> Scalar:
    """Moment of inertia of all the motor turns while the link stands; zero without a motor.

    Springs and adjusters as rings about the springs' axes, PCL and pads spread over their ring; a cover's screws not
    counted, nor the outer rings of the module's bearings, near the axis.
    """
    at_pcl = 0.5 * (m.pcl_inner_radius**2 + m.pcl_outer_radius**2)
    on_arcs = m.pcl_mass + m.heater_mass + m.spreader_mass + m.lead_mass + m.thermistor_mass + m.cutout_mass
    carried = m.springs_inertia + on_arcs * at_pcl
    cover = m.cover_section.polar * m.cover_height * m.structure_density
    base = m.base_moments.polar * m.structure_density
    return m.drive_inertia + m.housing_inertia + cover + carried + base
