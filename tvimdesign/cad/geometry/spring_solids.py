"""The torsion springs: their shape free and on the rotor's pin, and one swept solid of it.

Everything describes the right-hand spring in its own frame: its axis is z, the floor's upper face z = 0, the x axis
points away from the rotor's axis. The left-hand spring is its mirror image in the plane of both axes.
"""

from dataclasses import dataclass
from math import atan, cos, hypot, isfinite, pi, sin, sqrt

import cadquery as cq

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.device.core.spring_as_drawn import leg_azimuth

VOLUME_TOLERANCE = 1e-3


@dataclass(frozen=True)
class Coil:
    """A right-hand torsion spring: straight leg, coils, quarter bend, straight tang. Lengths in mm."""

    wire_diameter: float
    diameter: float  # Mean coil diameter
    turns: float
    pitch: float
    leg_length: float  # In plan view; the leg keeps rising as the coils do
    tang_length: float
    bend_radius: float  # Of the wire's centre, between coils and tang
    leg_azimuth: float  # Direction of the leg in plan view [rad]

    @property
    def rise(self) -> float:
        """Angle of the helix [rad]."""
        return atan(self.pitch / (pi * self.diameter))

    @property
    def start_azimuth(self) -> float:
        """Place where on the coil circle the coils start [rad]: at the tang."""
        return self.leg_azimuth - 0.5 * pi - 2.0 * pi * self.turns

    @property
    def start_level(self) -> float:
        """Level at which the coils start, so that the bend below ends on the floor."""
        return self.bend_radius * cos(self.rise)

    @property
    def end_level(self) -> float:
        """Level at which the coils end and the leg begins."""
        return self.start_level + self.pitch * self.turns

    @property
    def tang_position(self) -> tuple[float, float]:
        """Centre of the tang in the floor, from the spring's axis."""
        way = self.bend_radius * (1.0 - sin(self.rise))
        radial, tangent = _directions(self.start_azimuth)
        centre = radial * (0.5 * self.diameter) - tangent * way
        return centre.x, centre.y

    @property
    def wire_length(self) -> float:
        """Length of the wire along its centre."""
        leg = self.leg_length / cos(self.rise)
        helix = self.turns * hypot(pi * self.diameter, self.pitch)
        return leg + helix + self.bend_radius * (0.5 * pi - self.rise) + self.tang_length

    def check(self) -> None:
        """Raise GeometryError where no wire can be bent to this shape."""
        d, gap = self.wire_diameter, self.pitch * cos(self.rise) - self.wire_diameter
        for name, value in (
            ("wire_diameter", d),
            ("coil diameter less wire diameter", self.diameter - d),
            ("number of coils", self.turns),
            ("gap between coils", gap),
            ("leg_length", self.leg_length),
            ("tang_length", self.tang_length),
            ("inside radius of the tang's bend", self.bend_radius - 0.5 * d),
        ):
            if not (isfinite(value) and value > 0.0):
                raise GeometryError(f"spring: {name} is {value:.4g}; it must be above zero")


def free_coil(dims: Dimensions) -> Coil:
    """Return the spring as its maker delivers it, the coils starting on the x axis."""
    return Coil(
        wire_diameter=dims.wire_diameter, diameter=dims.coil_diameter, turns=dims.coil_count, pitch=dims.coil_pitch,
        leg_length=dims.leg_length, tang_length=dims.tang_length,
        bend_radius=dims.tang_bend_radius, leg_azimuth=0.5 * pi + 2.0 * pi * dims.coil_count,
    )  # fmt: skip


def installed_coil(dims: Dimensions, rotor_angle: float = 0.0) -> Coil:
    """Return the right-hand spring in the module, wound up by the preload and by the rotor at `rotor_angle` [rad].

    The tang stays in its hole and the coil on its post; the leg lies on the pin, which winds the spring where
    `rotor_angle` falls. A coil of n turns keeps its wire length and pitch: n sqrt((pi D)^2 + p^2) is constant.
    Raises GeometryError where the leg cannot reach the pin.
    """
    rest_turns = dims.coil_count + dims.preload_angle / (2.0 * pi)
    rest_azimuth = _leg_azimuth(dims, 0.0, _wound_diameter(dims, rest_turns))
    turns = rest_turns
    for _ in range(20):
        azimuth = _leg_azimuth(dims, rotor_angle, _wound_diameter(dims, turns))
        turns = rest_turns + (azimuth - rest_azimuth) / (2.0 * pi)
    return Coil(
        wire_diameter=dims.wire_diameter, diameter=_wound_diameter(dims, turns), turns=turns, pitch=dims.coil_pitch,
        leg_length=dims.leg_length, tang_length=dims.tang_length,
        bend_radius=dims.tang_bend_radius, leg_azimuth=azimuth,
    )  # fmt: skip


def _wound_diameter(dims: Dimensions, turns: float) -> float:
    """Return mean diameter of the coil wound to `turns`: the helix keeps its wire and its pitch."""
    wire = dims.coil_count * hypot(pi * dims.coil_diameter, dims.coil_pitch)
    if not turns > 0.0 or wire / turns <= dims.coil_pitch:
        raise GeometryError(f"spring: {turns:.4g} turns cannot be wound of {wire:.4g} mm of wire")
    return sqrt((wire / turns) ** 2 - dims.coil_pitch**2) / pi


def _leg_azimuth(dims: Dimensions, rotor_angle: float, diameter: float) -> float:
    """Return the direction of the leg that lies on the pin from the side on which the pin winds the spring up."""
    # The device's model takes the free coil's diameter here (row leg_offset), which makes its equations explicit; the
    # drawing takes the wound one, or leg and pin would not touch.
    offset = 0.5 * (diameter + dims.wire_diameter + dims.pin_diameter)
    reach = dims.placement_radius - dims.pin_radius
    if not 0.0 < offset < reach:
        raise GeometryError(f"spring: its leg, {offset:.4g} mm beside its axis, cannot reach a pin {reach:.4g} mm away")
    return leg_azimuth(dims.pin_radius, dims.placement_radius, rotor_angle, offset)


def _directions(azimuth: float) -> tuple[cq.Vector, cq.Vector]:
    """Return radial and tangential (counter-clockwise) unit vectors at an azimuth."""
    return cq.Vector(cos(azimuth), sin(azimuth), 0), cq.Vector(-sin(azimuth), cos(azimuth), 0)


def wire_edges(coil: Coil) -> list[cq.Edge]:
    """Return centre of the wire from the tang's end to the leg's: line, arc, helix, line, tangent to one another."""
    bend_radius, rise, down = coil.bend_radius, coil.rise, cq.Vector(0, 0, -1)
    radial, tangent = _directions(coil.start_azimuth)
    start = radial * (0.5 * coil.diameter) - down * coil.start_level
    centre = start + (tangent * sin(rise) + down * cos(rise)) * bend_radius
    half_way = 0.5 * (rise + 0.5 * pi)
    middle = centre - (tangent * sin(half_way) + down * cos(half_way)) * bend_radius
    floor = centre - tangent * bend_radius
    tang = cq.Edge.makeLine(floor + down * coil.tang_length, floor)
    bend = cq.Edge.makeThreePointArc(floor, middle, start)
    helix = cq.Wire.makeHelix(coil.pitch, coil.pitch * coil.turns, 0.5 * coil.diameter)
    placed = helix.rotate(cq.Vector(), cq.Vector(0, 0, 1), coil.start_azimuth * 180.0 / pi)
    placed = placed.translate(cq.Vector(0, 0, coil.start_level))
    out, along = _directions(coil.leg_azimuth - 0.5 * pi)
    end = out * (0.5 * coil.diameter) - down * coil.end_level
    leg = cq.Edge.makeLine(end, end + (along * cos(rise) - down * sin(rise)) * (coil.leg_length / cos(rise)))
    return [tang, bend, *placed.Edges(), leg]


def spring_solid(coil: Coil) -> cq.Solid:
    """Sweep the wire's section along its centre; raises GeometryError where the solid is not that wire."""
    # One sweep over the four pieces works because they are tangent to one another: the Frenet frame of the helix, and
    # 'transformed' so that no joint is rounded or mitred. isValid() passes wrong solids, so the volume is held too.
    coil.check()
    edges = wire_edges(coil)
    path = cq.Wire.assembleEdges(edges)
    section = cq.Wire.makeCircle(0.5 * coil.wire_diameter, edges[0].startPoint(), cq.Vector(0, 0, 1))
    solid = cq.Solid.sweep(section, [], path, True, True, transitionMode="transformed")
    if not isinstance(solid, cq.Solid) or not solid.isValid() or len(solid.Solids()) != 1:
        raise GeometryError("spring: sweeping the wire gave no valid single solid")
    expected = 0.25 * pi * coil.wire_diameter**2 * coil.wire_length
    if abs(solid.Volume() / expected - 1.0) > VOLUME_TOLERANCE:
        raise GeometryError(f"spring: the swept solid has {solid.Volume():.6g} mm3, the wire {expected:.6g} mm3")
    return solid
