"""Path of the frozen torque from the layer to the floor, beside rigid heaters and through flexible pads.

Makers rate rigid modules for pressure, not for shear or tension. A spreader therefore has a seat of adhesive, which
fills the gap along its inner and outer rim, and hands all of the torque to the floor in its own plane. The modules
below it lie in thermal grease on their ledges, free to slide, and bear neither shear nor tension. A pad that is cut to
the arc is sheared: it bears what its record allows, and nothing where that is silent. Adhesive holds it on its ledges.
"""

import numpy as np

from tvimdesign.device.components.liner_and_adhesive import WITH_PADS
from tvimdesign.device.core.heater_form import CUT, WITH_TILES
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.heat_flow.shape_factors import constriction
from tvimdesign.physics.layers import layer
from tvimdesign.physics.solids import plates, structure

kinds, places = QuantityGroup("Materials"), QuantityGroup("Layout")
strengths, rules = QuantityGroup("Impedance"), QuantityGroup("Gaps", WITH_TILES)

kinds.choices("spreader_seat")


@places.output("mm")
def heater_gap(m: Module) -> Scalar:
    """Gap along the rims of a pad in its pocket, or of a spreader, where adhesive fills it."""
    return m.slip_clearance if m.heater_form == CUT else m.spreader_gap


@places.helper()
def seat_length(m: Module) -> Scalar:
    """Length of the inner and outer rims of all arcs together [m]."""
    return m.arc_count * m.arc_span * (m.pcl_inner_radius + m.pcl_outer_radius)


@strengths.helper()
def heater_adhesive_shear_modulus(m: Module) -> Scalar:
    """Shear modulus of the heaters' adhesive [Pa]."""
    return structure.shear_modulus(m.heater_adhesive_youngs_modulus, m.heater_adhesive_poissons_ratio)


@strengths.helper(requires=WITH_TILES)
def floor_between_seats(m: Module) -> Scalar:
    """Compliance of the floor between the inner and outer rims of the spreaders [rad/(N*m)]: ribs, and web below."""
    web = (m.driven_share - m.windowed_share) * m.floor_web
    thickness = (1.0 - m.driven_share) * m.floor_thickness + web
    return 1.0 / structure.ring_stiffness(m.structure_shear_modulus, thickness, m.pcl_inner_radius, m.pcl_outer_radius)


@strengths.helper(requires=WITH_TILES, default=None)
def seat_path(m: Module) -> plates.Path:
    """Way of the torque from the spreaders through their seats into the floor."""
    spread = constriction(m.spreader_depth / m.floor_thickness)
    seat = plates.Seat(
        m.spreader_gap, m.spreader_depth, spread, m.heater_adhesive_shear_modulus, m.structure_shear_modulus
    )
    radii = m.pcl_inner_radius, m.pcl_outer_radius
    return plates.path(seat, m.arc_count * m.arc_span, radii, m.floor_between_seats)


@strengths.output("N*m", requires=WITH_TILES)
def inner_seat_holding_torque(m: Module) -> Scalar:
    """Torque the seats of the spreaders bear along their inner rims, by `holding_safety` below their strength."""
    return m.seat_strength / m.seat_path.inner_traction


@strengths.output("N*m", requires=WITH_TILES)
def outer_seat_holding_torque(m: Module) -> Scalar:
    """Torque the seats of the spreaders bear along their outer rims, by `holding_safety` below their strength."""
    return m.seat_strength / m.seat_path.outer_traction


@strengths.output("N*m", requires=WITH_TILES)
def spreader_holding_torque(m: Module) -> Scalar:
    """Torque the spreaders bear in shear beside their seats, by `holding_safety` below yield."""
    highest = np.fmax(m.seat_path.inner_traction, m.seat_path.outer_traction)
    return structure.shear_yield(m.spreader_strength) / (m.holding_safety * highest)


@strengths.output("N*m", requires=WITH_PADS)
def heater_holding_torque(m: Module) -> Scalar:
    """Torque at which pads cut to the arcs are sheared as hard at their outer rim as their record allows."""
    return layer.torque_at_traction(m.heater_shear_limit, m.layer_polar_moment, m.pcl_outer_radius)


@strengths.output("N*m", requires=WITH_PADS)
def ledge_holding_torque(m: Module) -> Scalar:
    """Torque the adhesive between pads cut to the arcs and their ledges bears, by `holding_safety` below strength."""
    glued = m.pad_section.polar - m.window_section.polar
    return layer.torque_at_traction(m.seat_strength, glued, m.pcl_outer_radius)


TILE_PARTS = ("inner_seat_holding_torque", "outer_seat_holding_torque", "spreader_holding_torque")
PAD_PARTS = ("heater_holding_torque", "ledge_holding_torque")


@strengths.output("N*m", least_of=(*TILE_PARTS, *PAD_PARTS))
def seat_holding_torque(m: Module) -> Scalar:
    """Torque that passes from the layer to the floor: through seats of spreaders, or through pads and their ledges."""
    if m.heater_form == CUT:
        return np.fmin(m.heater_holding_torque, m.ledge_holding_torque)
    rims = np.fmin(m.inner_seat_holding_torque, m.outer_seat_holding_torque)
    return np.fmin(rims, m.spreader_holding_torque)


_PULLED = "the freezing layer would pull the spreaders out of their seats: a thicker spreader"


@strengths.output("1", at_least(1.0, _PULLED), requires=WITH_TILES, default=1e3)
def seat_pull_safety(m: Module) -> Scalar:
    """Strength of the seats over what the freezing layer pulls at them with, by which no module is pulled."""
    pull = np.fmin(m.freezing_traction, m.pcl_bond_strength) * m.pcl_area
    return m.seat_strength * m.seat_length * m.spreader_depth / pull


rules.margins("spreader_seat")


ratings = QuantityGroup("Switch")


ratings.margins("spreader_seat.ratings")
