"""What the process can make: its limits, taken from its record, and the room the design leaves to each of them."""

from __future__ import annotations

from tvimdesign.device.book import Book
from tvimdesign.device.gaps import book as shared
from tvimdesign.device.rows import Scalar, at_least

limits = Book("Process")
"""What the process says."""
book = Book(shared.group)
"""What the design leaves of it."""

for name, unit, field, description in (
    ("minimum_wall", "mm", "minimum_wall", "Thinnest wall the process makes"),
    ("minimum_feature", "mm", "minimum_feature", "Thinnest pin or post the process makes"),
    ("minimum_running_clearance", "mm", "minimum_running_clearance", "Least gap between turning and fixed faces"),
    ("slip_clearance", "mm", "slip_clearance", "Least gap to each side of what slips into a hole"),
    (
        "hole_compensation",
        "mm",
        "hole_compensation",
        "What upright holes are wider by in print files; STEP stays nominal",
    ),
    ("corner_radius", "mm", "corner_radius", "Radius of the upright inner corners of pockets"),
    ("corner_depth_ratio", "1", "corner_depth_ratio", "Largest depth of a corner over its radius"),
    ("pocket_depth_ratio", "1", "pocket_depth_ratio", "Largest depth of a pocket over its width"),
    ("thread_engagement", "1", "thread_engagement", "Least length of thread over a screw's diameter"),
    ("thinnest_wall", "mm", "thinnest_wall", "Wall below which the process makes none, however weak"),
    ("overhang_angle", "deg", "overhang_angle", "Lean from upright up to which a face needs no support"),
    ("bridge_span", "mm", "bridge_span", "Longest bridge between two supports"),
    ("hole_depth_ratio", "1", "hole_depth_ratio", "Largest depth of a hole over its diameter"),
    ("bed_length", "mm", "bed_length", "Length of the printer's bed, or travel of the mill"),
    ("bed_width", "mm", "bed_width", "Width of the printer's bed, or travel of the mill"),
    ("bed_height", "mm", "bed_height", "Height the machine can make"),
):
    limits.property(name, unit, ("process", field), description)
limits.option(
    "making_method", ("printed", "milled"), "How the process shapes a part: in layers, or with a mill of three axes",
    record=("process", "method"),
)  # fmt: skip

limits.option(
    "thread_insert", ("none", "heat_set"), "Whether screws cut their thread in the part, or in brass inserts melted in",
    record=("process", "insert"),
)  # fmt: skip


_WALL = "is thinner than the process can make it"


@book.output("mm", at_least(0.0, f"the housing's wall {_WALL}"))
def housing_wall_reserve(wall_thickness: Scalar, minimum_wall: Scalar) -> Scalar:
    """Housing wall beyond the process's least."""
    return wall_thickness - minimum_wall


@book.output("mm", at_least(0.0, f"the hub {_WALL}"))
def hub_wall_reserve(hub_wall: Scalar, minimum_wall: Scalar) -> Scalar:
    """Wall of the hub beyond the process's least."""
    return hub_wall - minimum_wall


@book.output("mm", at_least(0.0, f"the rotor plate {_WALL}"))
def rotor_plate_reserve(rotor_thickness: Scalar, minimum_wall: Scalar) -> Scalar:
    """Rotor plate beyond the process's least wall."""
    return rotor_thickness - minimum_wall


@book.output("mm", at_least(0.0, f"the output link {_WALL}"))
def link_reserve(link_thickness: Scalar, minimum_wall: Scalar) -> Scalar:
    """Output link beyond the process's least wall."""
    return link_thickness - minimum_wall


@book.output("mm", at_least(0.0, f"the core's wall outside the link screws {_WALL}: it would split"))
def link_screw_wall_reserve(link_screw_wall: Scalar, link_hole_wall: Scalar) -> Scalar:
    """Wall of the core outside the link screws' holes beyond the least around them."""
    return link_screw_wall - link_hole_wall


@book.output("mm", at_least(0.0, "the rotor's pins are thinner than the process can make them"))
def pin_reserve(pin_diameter: Scalar, minimum_feature: Scalar) -> Scalar:
    """Diameter of the rotor's pins beyond the process's least."""
    return pin_diameter - minimum_feature


@book.output("mm", at_least(0.0, "the spring posts are thinner than the process can make them"))
def post_reserve(post_radius: Scalar, minimum_feature: Scalar) -> Scalar:
    """Diameter of the spring posts beyond the process's least."""
    return 2.0 * post_radius - minimum_feature


@book.output("mm", at_least(0.0, "turning faces would rub: the process cannot keep a gap so small"))
def running_fit_reserve(running_clearance: Scalar, minimum_running_clearance: Scalar) -> Scalar:
    """Gap between turning and fixed faces beyond the process's least."""
    return running_clearance - minimum_running_clearance


@book.output("mm", at_least(0.0, "the tangs would not go into their holes: the process cannot keep a gap so small"))
def tang_fit_reserve(tang_clearance: Scalar, slip_clearance: Scalar) -> Scalar:
    """Gap between a tang and its hole beyond the process's least."""
    return tang_clearance - slip_clearance
