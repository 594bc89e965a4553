"""The reference problem's arithmetic written out by hand for numba, as someone would who has this one problem to solve.

One module, one layout, every choice made: the numbers of `reference.yaml`, the table's defaults and the catalogue stand
here as constants, SI throughout, with short names as in such a program. Nothing of tvimdesign is imported; a test
holds every number that comes out against the table's.
"""

from __future__ import annotations

import math

import numpy as np
from hand_polymer import COLD_LOSS, COLD_STORAGE, HOT_LOSS, HOT_STORAGE, OMEGA
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
PI = math.pi

# Springs: music wire
E_WIRE, NU_WIRE, RHO_WIRE, STRENGTH, STRENGTH_POWER = 196.5e9, 0.292, 7850.0, 2211e6, 0.145
YIELD_RATIO, FATIGUE_RATIO = 0.78, 0.5
PRELOAD, STROKE, STOP, COIL_GAP, LEG_OVERHANG = 0.15, 0.104, 0.104 + 0.02, 0.1e-3, 4e-3
TANG_CLEARANCE, TANG_END_GAP = 0.25e-3, 0.5e-3
BEND, BEND_ACROSS, BEND_IN_PLANE = 2.0, 1.1, (4.0 * 4.0**2 - 4.0 - 1.0) / (4.0 * 4.0 * (4.0 - 1.0))  # radius in wires
# Structure: printed PETG
E_PETG, NU_PETG, RHO_PETG, K_PETG, C_PETG, ACROSS_LAYERS = 2.1e9, 0.38, 1270.0, 0.24, 1200.0, 31e6
G_PETG = E_PETG / (2.0 * (1.0 + NU_PETG))
LOSS = 0.03 + 0.01  # of PETG and of what is clamped
SHAFT_ENTRY, BORE_ENTRY, PLATE_ENTRY, BORED_PLATE = 0.1, 0.15, 0.38, 0.2
FLOOR_BENDS, FLOOR_DENTS = 0.76, 0.89
FILLET_SHORTENS, THIN_SHORTENS, FILLET_GIVES, FILLET_BEARS = 0.495, 0.0046, 0.136, 0.023
CORE_FOOT, BORED_FOOT, NEAR_FOOT, HOLDING_SAFETY = 0.796, 1.41, 0.25, 1.25
FILLET, LEAST_FILLET, FELT_FILLET, EVENED, SLIP = 1.5e-3, 1e-4, 1.16e-3, 3e-4, 0.2e-3
STOPS, STOP_DEPTH, STOP_LENGTH, TOOTH, SLIVER = 2.0, 4e-3, 12e-3, 5e-3, 1e-4
YIELD_COLD, FOOT_CLAMP = 47.5e6, 55e6 * 25.0 / 104.0  # in a foot under its screw
LINK_HOLDS = 12.257291898068024  # N m, friction under the screws and pins: nothing here that is free
WALL_LEAST, FEATURE_LEAST, CORNER, POCKET_RATIO = 1.2e-3, 2e-3, 0.2e-3, 50.0
PIN_RATIO, PIN, CORE, WALL, FLOOR, ROTOR, LINK = 0.5, 4e-3, 10e-3, 3e-3, 4e-3, 4e-3, 4e-3
RADIAL, AXIAL, RUNNING, LEAST_GAP, RIM = 1e-3, 1e-3, 0.4e-3, 0.3e-3, 1.5e-3
HUB_WALL, FOOT, NOTCH = 3e-3, 6e-3, 12e-3
LINK_RIM, BOLT_CIRCLE, TOOL_HOLE, BOSS, MOUNT_HOLE = 2e-3, 6.5e-3, 4.5e-3, 3.5e-3, 3.4e-3
RETAINER, RETAINER_RADIUS = 2.5e-3, 13e-3
# Screws: four M3 of the link, one M4 of the retainer
LINK_PILOT, LINK_HOLE, LINK_HEAD, LINK_HEAD_HEIGHT, LINK_SCREW = 2.5e-3, 3.4e-3, 5.7e-3, 1.65e-3, 12e-3
LAST_PILOT, LAST_HOLE, LAST_HEAD, LAST_HEAD_HEIGHT, LAST_SCREW = 3.3e-3, 4.5e-3, 7.6e-3, 2.2e-3, 10e-3
TIP_ROOM, RHO_STEEL, RHO_SCREW = 0.5e-3, 7850.0, 7900.0
CUTOUT_RADIUS = 2.1e-3
CUTOUT = 3500.0 * PI * (CUTOUT_RADIUS**2 * 11.2e-3 + 0.5e-3**2 * 2.0 * 6e-3)  # kg, with the straight ends of its wires
DOWELS, DOWEL, DOWEL_LONG, DOWEL_CIRCLE = 4.0, 2.5e-3, 10e-3, 7e-3
BY_SCREWS, BY_DOWELS = 4.0 * LINK_PILOT**2 * BOLT_CIRCLE**2 / CORE**4, DOWELS * DOWEL**2 * DOWEL_CIRCLE**2 / CORE**4
# Layer and pads
ARCS, INNER, LEDGE, RHO_PCL, K_SOLID, K_MELT = 4.0, 26e-3, 2e-3, 1145.0, 0.225, 0.18
G_FROZEN = 411e6 / (2.0 * (1.0 + 0.45))  # at 23 degC
BOND, SHEAR_YIELD, MELT_STRAIN, MELT_FRACTURE = 2e6, 16e6 / math.sqrt(3.0), 6.0, 0.2e6
PAD, PAD_AREA, PAD_MASS, C_PAD, G_PAD, BULK_PAD = 1.5e-3, 1.6e-3, 6e-3, 500.0, 100e6, 1e9
LEAD, FILM, LEAD_BEND = 1.4e-3, 0.1e-3, 3.5e-3  # of a pad: thickness, least gap, radius along its middle
LEAD_ANGLE = math.acos(1.0 - 0.5 * (FLOOR - PAD + FILM) / LEAD_BEND)
LEAD_WAY, LEADS = 2.0 * LEAD_BEND * math.sin(LEAD_ANGLE), 2600.0 * ARCS * PI * LEAD**2 * LEAD_BEND * LEAD_ANGLE  # m, kg
PAD_SHEAR, GLUE = 2e6, 6e6 / HOLDING_SAFETY  # Pa, of the pads by their record, of what holds them on their ledges
EMISSIVITY, BLACK, AMBIENT = 0.9, 5.670374419e-8, 295.15

SPRINGS = 4.0
OUTPUTS, RESIDUALS, HEAT = 3, 53, 68
"""Rows: volume [m^3], mass [kg], nothing yet; then every limit's residual, kept where <= 0, in the order of the study
and the table, without the rules on impedance, keys and free angles that no design of this problem can break. HEAT
numbers for the switch.
"""


@njit(cache=True)
def corner(r: float, circle: float, side: float) -> float:
    """Return what a fillet takes from a sector's corner: inside the outer arc (1), outside the inner (-1)."""
    along = math.sqrt((circle - side * r) ** 2 - r**2)
    centre = math.asin(r / (circle - side * r))
    return side * 0.5 * (circle**2 * centre - along * r) - 0.5 * r**2 * (0.5 * PI + side * centre)


@njit(cache=True)
def rounded(span: float, inner: float, outer: float) -> tuple[float, float]:
    """Area and its polar moment of annular sectors with rounded corners, one at each arc."""
    cut, far = corner(CORNER, inner, -1.0), corner(CORNER, outer, 1.0)
    beside = (5.0 / 6.0 - 0.25 * PI) / (1.0 - 0.25 * PI) * CORNER
    moved = cut * ((inner + beside) ** 2 + beside**2) + far * ((outer - beside) ** 2 + beside**2)
    area = ARCS * (0.5 * span * (outer**2 - inner**2) - 2.0 * (cut + far))
    return area, ARCS * (0.25 * span * (outer**4 - inner**4) - 2.0 * moved)


@njit(cache=True)
def segment(half: float, radius: float) -> float:
    """Area beside the middle of a disc up to a parallel at `half`, one side."""
    return half * math.sqrt(radius**2 - half**2) + radius**2 * math.asin(half / radius)


@njit(cache=True)
def around_foot(radius: float, q: float) -> tuple[float, float]:
    """Volume and its polar moment of a fillet around the foot of a cylinder."""
    b, flat, first = radius + q, q**2 * (1.0 - 0.25 * PI), q**3 / 6.0
    polar = b**3 * flat - 3.0 * b**2 * first + 3.0 * b * q**4 * (1.0 / 3.0 - PI / 16.0) - 7.0 * q**5 / 60.0
    return 2.0 * PI * (b * flat - first), 2.0 * PI * polar


@njit(cache=True)
def joint(storage: float, loss: float, over: float, support: float) -> tuple[float, float]:
    """Real and imaginary stiffness of a layer behind a support with a loss of its own."""
    behind = complex(support, LOSS * support)
    layer = complex(storage * over, loss * over)
    both = layer * behind / (layer + behind)
    return both.real, both.imag


@njit(cache=True)
def gerber(per_angle: float, strength: float) -> float:
    """Fatigue safety of a stress per radian of winding, over the stroke to both sides."""
    half = 0.5 * FATIGUE_RATIO * strength
    amplitude = per_angle * STROKE / (half / (1.0 - (half / strength) ** 2))
    mean = per_angle * PRELOAD / strength
    return 2.0 / (amplitude + math.sqrt(amplitude**2 + 4.0 * mean**2))


@njit(cache=True)
def least(first: float, second: float) -> float:
    """Less of two lengths, rounded off where they are about as long."""
    return min(first, second) - EVENED / 6.0 * max(1.0 - abs(first - second) / EVENED, 0.0) ** 3


@njit(cache=True)
def stops(r: float, rotor: float, reach: float) -> tuple[float, float, float, float]:
    """Inner radius of the stops' posts, width and length of their faces, and what feet leave of the width, or lack."""
    inner = rotor + max(RUNNING, CORNER)
    left = least(STOP_DEPTH, r - BOSS - inner)
    width = max(left, SLIVER)
    outer, middle = inner + width, inner + 0.5 * width
    cosine = (r**2 + outer**2 - (reach + RADIAL) ** 2) / (2.0 * r * outer)
    room = PI / SPRINGS - math.acos(min(cosine, 1.0 - 1e-6)) - STOP - 0.5 * TOOTH / middle
    return inner, width, max(least(STOP_LENGTH, room * middle), SLIVER), left


@njit(cache=True)
def tooth(span: float, radius: float, outer: float) -> tuple[float, float]:
    """Area and its polar moment of a tooth outside a disc, both corners at its root rounded."""
    beyond = radius + CORNER
    along, at_axis = math.sqrt(beyond**2 - CORNER**2), math.asin(CORNER / beyond)
    turn = 0.5 * PI - at_axis
    fillets = 0.25 * (along**3 * CORNER - radius**4 * at_axis - CORNER**4 * turn) + along * CORNER**3 / 12.0
    fillets += CORNER**2 * beyond * (2.0 / 3.0 * CORNER * math.sin(turn) - 0.5 * turn * beyond)
    area = 0.5 * span * (outer**2 - radius**2) + 2.0 * corner(CORNER, radius, -1.0)
    return area, 0.25 * span * (outer**4 - radius**4) + 2.0 * fillets


@njit(cache=True)
def stub(lever: float, width: float, depth: float) -> float:
    """Stress at the root of a short beam for each newton: bending and mean shear."""
    return math.sqrt((6.0 * lever / (depth * width**2)) ** 2 + 3.0 / (depth * width) ** 2)


@njit(cache=True)
def measure(x: Array, rows: Array, heat: Array) -> None:
    """Fill in everything that is arithmetic, for one design."""
    d, coil, n, r, outer, span, t = x[0], x[1], x[2], x[3], x[4], x[5], x[6]
    # where things are
    pin_at = PIN_RATIO * r
    curve = BEND * d
    reach = math.sqrt(0.25 * coil**2 + curve**2) + 0.5 * d
    offset = 0.5 * (coil + d + PIN)
    arm = math.sqrt((r - pin_at) ** 2 - offset**2)
    leg = arm + LEG_OVERHANG
    rotor = outer + RIM
    inside = r + reach + RADIAL
    outside = inside + WALL
    pitch = d + COIL_GAP
    slope = pitch / (PI * coil)
    rise = math.sqrt(1.0 + slope**2)
    end = curve / rise + pitch * (n + PRELOAD / (2.0 * PI))
    pin_top = end + slope * leg + 0.5 * d + AXIAL
    link_bottom = pin_top + AXIAL
    plate_top = t + ROTOR
    wound = coil * n / (n + (PRELOAD + STOP) / (2.0 * PI))
    post = 0.45 * (wound - d)
    bore = CORE + RUNNING
    hub = bore + HUB_WALL
    web = FLOOR - PAD
    stop_inner, stop_width, stop_long, stop_left = stops(r, rotor, reach)
    stop_outer, stop_middle = stop_inner + stop_width, stop_inner + 0.5 * stop_width
    volume = PI * outside**2 * (FOOT + FLOOR + link_bottom + LINK + LINK_HEAD_HEIGHT)
    # springs: coil, leg and bend under the pin's force, wound up by the preload
    turned = 2.0 * PI * n + PRELOAD
    radius = 0.5 * coil * n / (n + PRELOAD / (2.0 * PI))
    climb = pitch / (2.0 * PI)
    low = climb * arm / radius
    high = low + climb * turned
    sine, cosine = math.sin(turned), math.cos(turned)
    twice, twice_cosine = 2.0 * sine * cosine, cosine**2 - sine**2
    about = arm**2 * turned + radius**2 * (0.5 * turned - 0.25 * twice) + 2.0 * arm * radius * (1.0 - cosine)
    tilted = (1.0 + 0.5 * NU_WIRE) * (high**3 - low**3) / (3.0 * climb)
    tilted += 0.5 * NU_WIRE * ((0.5 * high**2 - 0.25 * climb**2) * twice + 0.5 * climb * (high * twice_cosine - low))
    lever = arm + radius * sine
    aside, low_end = curve * cosine, high + curve
    bent = 0.5 * PI * lever**2 + 2.0 * lever * aside + 0.25 * PI * aside**2
    bent += 0.5 * PI * high**2 + (PI - 2.0) * high * curve + (0.75 * PI - 2.0) * curve**2
    twisted = 0.25 * PI * ((cosine * low_end) ** 2 + lever**2) + 0.5 * PI * aside**2
    twisted -= 2.0 * cosine**2 * curve * low_end + cosine * lever * (low_end - 2.0 * curve)
    wound_up = (radius * (about + tilted) + curve * (bent + NU_WIRE * twisted)) / arm**2 + arm / 3.0
    rate = PI * E_WIRE * d**4 / 64.0 / wound_up
    # the pin bends, shears and rocks, the tang twists the floor: both in series with the spring
    height, half_pin = max(end + slope * arm - plate_top, 0.5 * d), 0.5 * PIN
    give = height**3 / (0.75 * PI * E_PETG * half_pin**4) + height / (0.9 * G_PETG * PI * half_pin**2)
    give += 0.75 * height**2 * (1.0 - NU_PETG**2) / (E_PETG * half_pin**3)
    tang = PI * G_PETG * d**2 * (FLOOR - TANG_END_GAP)
    give = give / arm**2 + (1.0 + math.sqrt(0.25 * coil**2 + curve**2) / arm) ** 2 / tang
    rate /= 1.0 + rate * give
    index = coil / d
    inner_fibre = (4.0 * index**2 - index - 1.0) / (4.0 * index * (index - 1.0))
    straight = 32.0 * rate / (PI * d**3)
    in_coil = straight * inner_fibre * math.sqrt((1.0 + radius / arm) ** 2 + (high / arm) ** 2)
    at_coil = (BEND_IN_PLANE * high * sine) ** 2 + BEND_ACROSS**2 * (lever**2 + 0.75 * (high * cosine) ** 2)
    at_floor = (BEND_IN_PLANE * low_end * sine) ** 2
    at_floor += BEND_ACROSS**2 * ((low_end * cosine) ** 2 + 0.75 * (lever + aside) ** 2)
    in_bend = straight * (at_coil**6 + at_floor**6) ** (1.0 / 12.0) / arm
    strength = STRENGTH * (1e3 * d) ** -STRENGTH_POWER
    most = PRELOAD + STOP
    pin_stress = 32.0 * rate * most / arm * height / (PI * PIN**3)
    # layer and what carries it
    area = 0.5 * ARCS * span * (outer**2 - INNER**2)
    polar = 0.25 * ARCS * span * (outer**4 - INNER**4)
    middle = 0.5 * (INNER + outer)
    link_deep, last_deep = LINK_SCREW - LINK + TIP_ROOM, LAST_SCREW - RETAINER + TIP_ROOM
    dowel_deep = DOWEL_LONG - LINK + TIP_ROOM
    free = link_bottom - plate_top
    felt = BY_SCREWS / (1.0 + math.exp((free - link_deep) / (NEAR_FOOT * CORE)))
    felt += BY_DOWELS / (1.0 + math.exp((free - dowel_deep) / (NEAR_FOOT * CORE)))
    beside_holes = max(2.0 * BOLT_CIRCLE / (1.0 - BY_SCREWS), 2.0 * DOWEL_CIRCLE / (1.0 - BY_DOWELS)) / CORE
    sharp = CORE_FOOT * (CORE / 1e-3) ** 0.26 * (CORE / ROTOR) ** 0.137
    # fillets at the feet of core and pins: below the legs, short of the rim and of one another
    gap = least(rotor - pin_at - 0.5 * PIN, 0.5 * (pin_at - 0.5 * PIN - CORE)) - LEAST_FILLET
    fillet = max(least(FILLET, least(end - 0.5 * d - plate_top - RUNNING, gap)), LEAST_FILLET)
    sharp *= (1.0 + (fillet / FELT_FILLET) ** 6) ** (-0.26 / 6.0)
    core_foot = sharp * (1.0 + BORED_FOOT * felt)
    worst = max(core_foot, beside_holes)
    to_screws, to_dowels = min(link_deep, free + BORE_ENTRY * CORE), min(dowel_deep, free + BORE_ENTRY * CORE)
    both = min(to_screws, to_dowels)
    free += SHAFT_ENTRY * CORE + both * (BY_SCREWS + BY_DOWELS) / (1.0 - BY_SCREWS - BY_DOWELS)
    free += (FILLET_GIVES - FILLET_BEARS * fillet * CORE / ROTOR**2) * fillet  # the plate's share: a length of the core
    free -= (FILLET_SHORTENS + THIN_SHORTENS * (CORE / ROTOR) ** 2) * fillet
    free += (to_screws - both) * BY_SCREWS / (1.0 - BY_SCREWS) + (to_dowels - both) * BY_DOWELS / (1.0 - BY_DOWELS)
    inner, far = INNER + LEDGE, outer - LEDGE
    opened = span - 2.0 * LEDGE / INNER
    (windows, open_polar), (_, pads_polar) = rounded(opened, inner, far), rounded(span, INNER, outer)
    glued = GLUE * (pads_polar - open_polar) / outer
    fringe = 1.0 - 1.9 * G_PAD / (BULK_PAD + 7.0 / 3.0 * G_PAD)
    across, along = 0.25 * PI * (far - inner) / PAD, 0.5 * math.log(2.0) * opened * middle / PAD / fringe
    slack = math.log(math.cosh(across)) / across * math.log(math.cosh(along)) / along
    held = polar - slack * open_polar
    left = 0.5 * outer**8 * (INNER**-2 - outer**-2) - outer**4 * (outer**2 - INNER**2) + (outer**6 - INNER**6) / 6.0
    left *= 2.0 / (outer**4 - INNER**4) ** 2
    driven = math.sqrt(ARCS * span / (2.0 * PI))
    hole = 0.5 * MOUNT_HOLE
    section = 0.25 * PI * (BOSS**4 - hole**4)
    give = 1.0 / (FLOOR_BENDS * FLOOR**3) + 1.0 / (FLOOR_DENTS * BOSS**3)
    tilt = 1.0 + 3.0 / (1.0 + FOOT / (section * give))
    sideways = 1.0 / (tilt * FOOT**3 / (12.0 * E_PETG * section) + FOOT / (0.9 * PI * G_PETG * (BOSS**2 - hole**2)))
    # below the arcs: both ledges of the windows, the inner as a hoop, ribs beside the windows
    near, last_ledge = INNER + 0.5 * LEDGE, outer - 0.5 * LEDGE
    ribs = (1.0 - driven**2) * FLOOR + (driven**2 - 0.5 * ARCS * opened / PI) * web
    ways = (near**-2 - last_ledge**-2) / (4.0 * PI * G_PETG * ribs)
    ways += opened * near / (12.0 * E_PETG * web * LEDGE * ARCS * near**2)
    seat = (t / G_FROZEN + PAD / G_PAD) / (0.25 * ARCS * span)
    seats = seat / (middle**4 - INNER**4), seat / (outer**4 - middle**4)
    below = (seats[1] / (seats[0] + seats[1] + ways)) ** 2 * ways
    below += (far**-2 - outer**-2) / (4.0 * PI * G_PETG * driven**2 * web)
    support = 1.0 / (
        2.0 * free / (G_PETG * PI * CORE**4)
        + ((1.0 + PLATE_ENTRY * (ROTOR / CORE) ** 2 + BORED_PLATE * felt) / CORE**2 - INNER**-2)
        / (4.0 * PI * G_PETG * ROTOR)
        + left / driven / (4.0 * PI * G_PETG * ROTOR)
        + ROTOR / (3.0 * G_PETG * polar)
        + below
        + (outer**-2 - r**-2) / (4.0 * PI * G_PETG * FLOOR)
        + (3.0 - NU_PETG) * math.log(PI * r / SPRINGS / BOSS) / (4.0 * PI * G_PETG * FLOOR * SPRINGS * r**2)
        + 1.0 / (SPRINGS * sideways * r**2)
        + PAD / (G_PAD * held)
    )
    cold, _ = joint(COLD_STORAGE, COLD_LOSS, polar / t, support)
    hot, damped = joint(HOT_STORAGE, HOT_LOSS, polar / t, support)
    stiffness = SPRINGS * rate
    # masses
    pads = PAD_MASS / PAD_AREA * area
    into, onto, wider = INNER - SLIP, outer + SLIP, span + 2.0 * SLIP / INNER
    pockets = rounded(wider, into, onto)[0] * PAD
    ring = PI * (outside**2 - inside**2)
    notches = SPRINGS * (segment(0.5 * NOTCH, outside) - segment(0.5 * NOTCH, inside))
    feet = SPRINGS * PI * (BOSS**2 - 0.25 * MOUNT_HOLE**2)
    holes = SPRINGS * PI * ((0.5 * d + TANG_CLEARANCE) ** 2 + 0.25 * MOUNT_HOLE**2)
    housing = (ring - notches + feet) * FOOT + (PI * (outside**2 - hub**2) - holes) * FLOOR - pockets - windows * web
    housing += ring * pin_top + PI * (hub**2 - bore**2) * (t + FLOOR) + SPRINGS * PI * post**2 * (end + 0.5 * d)
    housing += 2.0 * STOPS * stop_long * stop_width * plate_top
    core_long = link_bottom + FLOOR + RUNNING - ROTOR
    dowel = DOWELS * 0.25 * PI * DOWEL**2
    dowel_polar = dowel * (0.125 * DOWEL**2 + DOWEL_CIRCLE**2)
    plate = PI * rotor**2 * ROTOR
    core = PI * CORE**2 * core_long
    pins = SPRINGS * 0.25 * PI * PIN**2 * (pin_top - plate_top)
    drilled = PI * LINK_PILOT**2 * link_deep
    last = 0.25 * PI * LAST_PILOT**2 * last_deep
    turning = plate + core + pins - drilled - last - dowel * dowel_deep
    inertia = 0.5 * (plate * rotor**2 + core * CORE**2 - last * 0.25 * LAST_PILOT**2)
    inertia += pins * (0.125 * PIN**2 + pin_at**2) - drilled * (0.125 * LINK_PILOT**2 + BOLT_CIRCLE**2)
    inertia -= dowel_polar * dowel_deep
    at_core, at_pin = around_foot(CORE, fillet), around_foot(0.5 * PIN, fillet)
    teeth = tooth(TOOTH / stop_middle, rotor, stop_outer)
    turning += at_core[0] + SPRINGS * at_pin[0] + STOPS * ROTOR * teeth[0]
    inertia += at_core[1] + SPRINGS * (at_pin[1] + at_pin[0] * pin_at**2) + STOPS * ROTOR * teeth[1]
    b, long = CORE + LINK_RIM, outside - CORE - LINK_RIM
    bolts, tool = PI * LINK_HOLE**2, 0.25 * PI * TOOL_HOLE**2
    link = (2.0 * b * long + PI * b**2 - bolts - tool - dowel) * LINK
    link_polar = 2.0 * b * long * (long**2 + b**2) / 3.0 + 0.5 * PI * b**4
    link_polar += 0.5 * PI * b**2 * long * (long + 8.0 * b / (3.0 * PI))
    link_polar -= (
        bolts * (0.125 * LINK_HOLE**2 + BOLT_CIRCLE**2) + tool * (0.125 * TOOL_HOLE**2 + long**2) + dowel_polar
    )
    retainer = PI * (RETAINER_RADIUS**2 - 0.25 * LAST_HOLE**2) * RETAINER
    retainer_polar = 0.5 * retainer * (RETAINER_RADIUS**2 + 0.25 * LAST_HOLE**2)
    inertia = RHO_PETG * (inertia + link_polar * LINK + retainer_polar)
    shanks, heads = PI * LINK_PILOT**2 * LINK_SCREW, PI * LINK_HEAD**2 * LINK_HEAD_HEIGHT
    shank, head = 0.25 * PI * LAST_PILOT**2 * LAST_SCREW, 0.25 * PI * LAST_HEAD**2 * LAST_HEAD_HEIGHT
    screws = shanks * (0.125 * LINK_PILOT**2 + BOLT_CIRCLE**2) + heads * (0.125 * LINK_HEAD**2 + BOLT_CIRCLE**2)
    screws += 0.125 * (shank * LAST_PILOT**2 + head * LAST_HEAD**2)
    inertia += RHO_SCREW * screws + RHO_STEEL * dowel_polar * DOWEL_LONG
    wire = leg * rise + n * math.sqrt((PI * coil) ** 2 + pitch**2) + curve * (0.5 * PI - math.atan(slope))
    wire += FLOOR - TANG_END_GAP
    mass = RHO_PETG * (housing + turning + link + retainer) + RHO_PCL * area * t + pads
    mass += (
        CUTOUT
        + LEADS
        + RHO_WIRE * SPRINGS * 0.25 * PI * d**2 * wire
        + RHO_SCREW * (shanks + heads + shank + head)
        + RHO_STEEL * dowel * DOWEL_LONG
    )
    # gaps
    far_pin = math.sqrt(pin_at**2 + r**2 - 2.0 * pin_at * r * math.cos(STOP))
    along = PI - math.atan2(pin_at * math.sin(STOP), r - pin_at * math.cos(STOP)) + math.asin(offset / far_pin)
    off_axis, ahead = r * math.sin(along) + 0.5 * coil, max(-r * math.cos(along) - leg, 0.0)
    rows[0], rows[1], rows[2] = volume, mass, 0.0
    g = rows[OUTPUTS:]
    g[0], g[1] = 1.0 - stiffness / 5.2, stiffness / 5.8 - 1.0
    g[2] = 1.0 - (stiffness + cold) / (stiffness + hot) / 50.0
    g[3] = 1.0 - damped / OMEGA
    g[4] = 1.0 - min(BOND, SHEAR_YIELD) * polar / outer / 8.0
    g[5] = 1.0 - PAD_SHEAR * polar / outer / 8.0
    g[6] = 1.0 - glued / 8.0
    g[7] = 1.0 - 0.5 * PI * ACROSS_LAYERS / math.sqrt(3.0) * CORE**3 / core_foot / HOLDING_SAFETY / 8.0
    g[8] = 1.0 - gerber(in_coil, strength) / 1.2
    g[9] = 1.0 - gerber(in_bend, strength) / 1.2
    g[10], g[11] = 1.0 - index / 5.0, index / 16.0 - 1.0
    g[12], g[13], g[14] = inertia / 300e-6 - 1.0, 2.0 * outside / 0.16 - 1.0, mass / 0.6 - 1.0
    g[15] = -(outer - INNER - 2.0 * LEDGE) / 0.01
    g[16] = 1.0 - (span * INNER - 2.0 * LEDGE) / 2e-3
    g[17] = 1.0 - ACROSS_LAYERS / pin_stress
    g[18] = 1.0 - YIELD_RATIO * strength / (in_coil * most)
    g[19] = 1.0 - YIELD_RATIO * strength / (in_bend * most)
    g[20] = 1.0 - MELT_FRACTURE * t / (outer * STROKE * math.sqrt(HOT_STORAGE**2 + HOT_LOSS**2))
    bears = 0.5 * PI * ACROSS_LAYERS / math.sqrt(3.0) * CORE**3 / worst / HOLDING_SAFETY
    bears = min(min(BOND, SHEAR_YIELD, PAD_SHEAR) * polar / outer, glued, bears, LINK_HOLDS)
    push, bears = bears / (STOPS * stop_middle) * HOLDING_SAFETY, bears / (SPRINGS * r)
    bent, sheared = bears * FOOT * (tilt + 2.0) / 6.0 * BOSS / section, bears / (PI * (BOSS**2 - hole**2))
    pulled = ACROSS_LAYERS / math.sqrt(bent**2 + 3.0 * sheared**2 + 1e6)
    pressed = YIELD_COLD / math.sqrt((bent + FOOT_CLAMP) ** 2 + 3.0 * sheared**2 + 1e6)
    g[21] = 1.0 - min(pulled, pressed) / HOLDING_SAFETY
    # where stops have no room, limits on their width go on with it as straight lines: SLSQP is lost without a slope
    g[22] = 1.0 - YIELD_COLD * stop_left * ROTOR / push
    g[23] = 1.0 - ACROSS_LAYERS / (push * stub(plate_top - 0.5 * ROTOR, stop_long, stop_width)) * stop_left / stop_width
    g[24] = 1.0 - YIELD_COLD / (push * stub(stop_middle - rotor, TOOTH, ROTOR))
    g[25] = 1.0 - MELT_STRAIN * t / (outer * STROKE)
    g[26] = -(r - reach - rotor - RADIAL) / 0.01
    g[27] = -(end - 0.5 * d - plate_top - AXIAL) / 0.01
    g[28] = -(rotor - pin_at - 0.5 * PIN - RADIAL) / 0.01
    g[29] = -(math.sqrt(off_axis**2 + ahead**2) - 0.5 * d - CORE - RADIAL) / 0.01
    g[30] = 1.0 - (leg - math.sqrt(far_pin**2 - offset**2)) / 0.5e-3
    g[31] = 1.0 - (r - pin_at - offset) / 1e-3
    g[32] = 1.0 - (2.0 * PI / ARCS - span) * INNER / 3e-3
    g[33] = 1.0 - (outer - INNER) / 2e-3
    g[34] = -post / 0.01
    g[35] = -(2.0 * r * math.sin(PI / SPRINGS) - 2.0 * reach - RADIAL) / 0.01
    g[36] = 1.0 - (link_bottom + FLOOR + RUNNING - link_deep - last_deep) / 1e-3
    g[37] = -(inside - r - BOSS - LEAST_GAP) / 0.01
    g[38] = -(r - BOSS - outer - RADIAL) / 0.01
    g[39] = -(span * INNER - 2.0 * LEDGE - 2.1 * CORNER) / 0.01
    g[40] = -(outer - INNER - 2.0 * LEDGE - 2.1 * CORNER) / 0.01
    g[41] = -(POCKET_RATIO * (outer - INNER - 2.0 * LEDGE) - web) / 0.01
    g[42] = -(POCKET_RATIO * (pin_at - 0.5 * PIN - CORE) - pin_top + plate_top) / 0.01
    g[43] = -(2.0 * post - FEATURE_LEAST) / 0.01
    g[44] = -(middle - CUTOUT_RADIUS - RETAINER_RADIUS) / 0.01
    g[45] = -(link_bottom - t - dowel_deep - WALL_LEAST) / 0.01
    g[46] = -((STOP - STROKE) * stop_middle - SLIP) / 0.01
    g[47] = -(stop_left - WALL_LEAST) / 0.01
    g[48] = -(min(stop_long, TOOTH) - WALL_LEAST) / 0.01
    g[49] = -(t + FLOOR - WALL_LEAST) / 0.01
    g[50] = -(POCKET_RATIO * (inside - r - post) - end - 0.5 * d) / 0.01
    g[51] = -((2.0 * PI / ARCS - wider) * into - WALL_LEAST) / 0.01
    beside = 0.5 * (outer - INNER - 2.0 * LEDGE - LEAD) - LEAD_WAY**2 / (8.0 * middle)
    apart = 0.5 * (opened * middle - LEAD_WAY) * (1.0 - 0.5 * LEAD / middle) - 0.5 * LEAD_WAY
    g[52] = -(min(beside, apart) - FILM) / 0.01
    # what the switch needs: current, area, layer, pads, windows; what the strips are taken from, sides in the air
    heat[0], heat[1], heat[2], heat[3] = x[7], area, t, area / PAD_AREA
    heat[4], heat[5] = pads * C_PAD, windows
    heat[9], heat[22] = RHO_PETG * (turning - plate + link + retainer) * C_PETG, 0.0
    heat[18] = RHO_PETG * housing * C_PETG
    heat[31] = 2.0 * PI * outside * (pin_top + FLOOR + FOOT) + PI * (outside**2 - rotor**2)
