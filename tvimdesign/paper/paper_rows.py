"""The paper check's rows on springs and on rheometry.

The specimen is the paper's, between plates of 25 mm diameter 1 mm apart; what an instrument of its class can do is
assumed with a range in `paper_claims.yaml`, as no sheet of its maker was read.
"""

import math

import numpy as np

from tvimdesign.base.units import from_si, to_si
from tvimdesign.paper.paper_case import (
    Instrument,
    from_paper,
    instrument,
    published_module,
    published_rate,
    published_values,
    spring_rate,
)
from tvimdesign.physics import spring
from tvimdesign.physics.layers import layer
from tvimdesign.physics.motions import motion
from tvimdesign.physics.polymers import polymer, viscoelasticity
from tvimdesign.simulation.working_cycle.curves import fractions_at

OTHER_PIN = 38e-3  # A pin elsewhere than the ratio of one asks [m]


def _torsion_rate() -> str:
    rate, stated = published_rate(), from_paper("torsion_rate")
    inch_pounds = rate / (to_si(1.0, "lbf") * to_si(1.0, "in"))
    needed = from_paper("wire_diameter") * (stated / rate) ** 0.25
    return (
        f"E d^4/(64 D n) = {rate:.4f} N·m/rad = {inch_pounds:.2f} in·lbf/rad, which is {stated / rate:.2f} times less; "
        f"{from_si(stated, 'N*m/rad'):g} N·m/rad needs d = {from_si(needed, 'mm'):.2f} mm"
    )


def _output_stiffness() -> str:
    rate = published_rate()
    count, stroke = from_paper("springs"), from_paper("stroke")
    return (
        f"N·m/rad on the left, N·m·rad on the right; the paper's own energy line gives K_s = 4 k (alpha/theta)^2 = "
        f"{_by_unity(rate):.2f} N·m/rad, not {count * rate * stroke**2:.4f} at {stroke:g} rad"
    )


def _by_unity(rate: float) -> float:
    """Return the output stiffness of the paper's springs with its ratio of one [N*m/rad]."""
    return float(spring.output_stiffness(from_paper("springs"), rate, 0.0, 1.0, 0.0))


def _implied() -> str:
    stated, rate, inertia = from_paper("torsion_rate"), published_rate(), from_paper("inertia")
    implied, computed, angle = _by_unity(stated), _by_unity(rate), from_paper("largest_rotation")
    wire = published_module().values["spring_material"]
    diameter = from_paper("wire_diameter")
    factor = spring.inner_fibre_factor(spring.spring_index(diameter, from_paper("coil_diameter")))
    stress = spring.bending_stress(stated * angle, diameter, factor)
    strength = spring.tensile_strength(
        diameter, [(row["coefficient"], row["exponent"]) for row in wire.table("strength")]
    )
    return (
        f"K_s = 4 k = {implied:.1f} N·m/rad, {implied / computed:.2f} times the {computed:.2f} of the formula: the "
        f"link would ring at {motion.natural_frequency(implied, inertia):.1f} Hz, not "
        f"{motion.natural_frequency(computed, inertia):.1f}; {stated * angle:.1f} N·m at {angle:g} rad would stress "
        f"this wire to {stress / 1e6:.0f} MPa, its tensile strength is {strength / 1e6:.0f} MPa"
    )


def _modulus() -> str:
    stated, diameter = from_paper("youngs_modulus"), from_paper("wire_diameter")
    steps = published_module().study.catalog.record("spring_materials", "music_wire").table("youngs_modulus_steps")
    moduli = [row["youngs_modulus"] for row in steps]
    handbook = next(
        row["youngs_modulus"] for row in steps if row["wire_diameter_from"] <= diameter < row["wire_diameter_to"]
    )
    rate = spring_rate(diameter, handbook)
    return (
        f"music wire of this diameter has {handbook / 1e9:g} GPa (Shigley, table 10-5; {min(moduli) / 1e9:g} to "
        f"{max(moduli) / 1e9:g} over all diameters): k = {rate:.4f} N·m/rad and K_s = {_by_unity(rate):.2f} N·m/rad, "
        f"{1.0 - handbook / stated:.1%} less"
    )


def _inch_sizes() -> str:
    diameter, coil = from_paper("wire_diameter"), from_paper("coil_diameter")
    gauges = published_module().study.catalog.record("wires", "music_wire_gauge")
    sizes = [row["wire_diameter"] for row in gauges.table("sizes")]
    nearest = min(sizes, key=lambda size: abs(size - diameter))
    inches = [from_si(length, "in") for length in (diameter, coil, coil + diameter)]
    return (
        f"d = {inches[0]:.4f} in, D = {inches[1]:.4f} in, so an outer diameter of {inches[2]:.3f} in; "
        f"{from_si(nearest, 'in'):.3f} in is a stock size of music wire ({abs(nearest - diameter) * 1e6:.1f} µm off). "
        f"Makers of inch springs state torque in in·lbf: {published_rate() / to_si(1.0, 'lbf*in'):.2f} in·lbf/rad is "
        f"what stands in the table as {from_paper('torsion_rate'):g} N·m/rad"
    )


def _pretension() -> str:
    rate, count, stroke = published_rate(), from_paper("springs"), from_paper("stroke")
    values = published_values()
    place, offset, preload = values["placement_radius"], values["leg_offset"], values["preload_angle"]
    pin = 0.5 * place
    drawn = spring.output_stiffness(
        count, rate, preload, spring.leg_ratio(pin, place, 0.0, offset), spring.leg_curvature(pin, place, 0.0, offset)
    )
    return (
        f"no pretension is given, and a torsion spring bears load in its winding direction only: with less than "
        f"{stroke:g} rad half of the springs lift off and K_s = {0.5 * count * rate:.2f} N·m/rad, not "
        f"{_by_unity(rate):.2f}. Opposed pairs cancel it from the torque at rest, not from the stiffness where legs "
        f"pass by the coil: {preload:g} rad (assumed) and legs {offset * 1e3:.1f} mm off its axis (drawn here) give "
        f"{float(drawn):.2f} N·m/rad"
    )


def _symbols() -> str:
    rate, place = published_rate(), from_paper("placement_radius")
    turned = abs(float(spring.leg_ratio(OTHER_PIN, place, 0.0, 0.0)))
    first, other = (spring.output_stiffness(4, rate, 0.0, ratio, 0.0) for ratio in (turned, 1.0 / turned))
    return (
        f"only a ratio of one hides it: with pins at {OTHER_PIN * 1e3:g} mm spring and rotor turn in a ratio of "
        f"{turned:.2f}, and K_s is {first:.1f} or {other:.2f} N·m/rad as alpha is the one or the other, a factor of "
        f"{turned**4:.0f}"
    )


def _angles() -> str:
    place, rate = from_paper("placement_radius"), published_rate()
    radius, thickness = published_values()["pcl_outer_radius"], published_values()["pcl_thickness"]
    angles = []
    for name in ("release_angle", "stroke", "largest_rotation"):
        angle = from_paper(name)
        ratio = abs(float(spring.leg_ratio(0.5 * place, place, angle, 0.0)))
        strain = layer.shear_strain(radius, angle, thickness)
        angles.append(
            f"{angle:g} rad: {_by_unity(rate) * angle:.2f} N·m, melt sheared by {strain:.0%}, ratio {ratio:.3f}"
        )
    return (
        f"{'; '.join(angles)} (springs alone, {thickness * 1e3:g} mm of PCL, radial pins that give a ratio of one at "
        "rest). The release stays below the stroke; at the largest angle the ratio of one no longer holds"
    )


def _ratio() -> str:
    place, rate = from_paper("placement_radius"), published_rate()
    pins = (0.5 * place, OTHER_PIN)
    stiffness = [spring.output_stiffness(4, rate, 0.0, spring.leg_ratio(pin, place, 0.0, 0.0), 0.0) for pin in pins]
    strain = layer.shear_strain(40e-3, from_paper("stroke"), 1e-3)
    return (
        f"alpha/theta = p/(r - p) for a pin at radius p: one only at p = {pins[0] * 1e3:.1f} mm "
        f"(K_s {stiffness[0]:.2f}), K_s = {stiffness[1]:.1f} N·m/rad at p = {pins[1] * 1e3:g} mm; "
        f"a layer of 1 mm is sheared by {strain:.0%} at r = 40 mm"
    )


def _inertia() -> str:
    inertia = from_paper("inertia")
    stiffness = 4.0 * published_rate()
    return (
        f"{inertia:.3e} kg·m² as kg·mm²; on springs of {stiffness:.2f} N·m/rad that rings at "
        f"{motion.natural_frequency(stiffness, inertia):.1f} Hz"
    )


def _motion() -> str:
    stiffness, inertia = 4.0 * published_rate(), from_paper("inertia")
    growth = math.sqrt(stiffness / inertia)
    return (
        f"with K on the wrong side the springs push away from rest: a deflection would grow as exp({growth:.0f} t/s); "
        f"I theta'' + b theta' + K theta = T rings, and is critically damped at b = "
        f"{motion.critical_damping(stiffness, inertia):.4f} N·m·s/rad"
    )


_EACH_DECADE = 5  # Frequencies of a usual sweep in a decade
_POISSON = 0.3, 0.5  # Poisson's ratio of a stiff plastic and of a melt
_SURE = 0.1  # Share by which an uncorrected modulus may be low before it is called wrong


def _modes(temperature: float, fraction: float) -> list[tuple[float, float]]:
    """Return the relaxation spectrum of the paper's polymer at a temperature [K] and a solid fraction."""
    spectrum = polymer.spectrum(temperature, fraction, published_module().quantity("pcl_rheology"))
    return [(float(time), float(modulus)) for time, modulus in spectrum]


def _complex_modulus(temperature: float, fraction: float, frequency: float) -> float:
    """Return |G*| [Pa] at an angular frequency [rad/s]."""
    storage, loss = polymer.maxwell_moduli(frequency, _modes(temperature, fraction))
    return math.hypot(float(storage), float(loss))


def plate_torque(stress: float) -> float:
    """Return the torque [N*m] of a shear stress [Pa] at the plates' rim, linear to the axis: pi R^3/2 tau."""
    return 0.5 * math.pi * (0.5 * from_paper("plate_diameter")) ** 3 * stress


def plate_stiffness(modulus: float) -> float:
    """Return the torsional stiffness [N*m/rad] of a specimen between the plates: pi R^4 G/(2 h)."""
    return 0.5 * math.pi * (0.5 * from_paper("plate_diameter")) ** 4 * modulus / from_paper("plate_gap")


def _share(device: Instrument, unit: str) -> str:
    """Return a text such as `125 mN·m (100 to 230, assumed)`."""
    value, low, high = (from_si(number, unit) for number in (device.value, device.low, device.high))
    return f"{value:g} {unit.replace('*', '·').replace('uN', 'µN')} ({low:g} to {high:g}, {device.status})"


def _strain_as_rate() -> str:
    cold, strain = from_paper("below"), from_paper("relaxation_strain")
    modulus = _complex_modulus(cold, 1.0, 2.0 * math.pi)
    stress = modulus * strain
    yielding = published_module().values["pcl_tensile_yield"] / math.sqrt(3.0)
    rate, seconds = strain, from_paper("creep_time")
    melt = viscoelasticity.zero_shear_viscosity(_modes(from_paper("above"), 0.0)) * rate
    return (
        f"as a strain it asks of the solid at 30 °C {stress / 1e6:.1f} MPa, which yields in shear at "
        f"{yielding / 1e6:.1f} MPa, and {plate_torque(stress):.0f} N·m between 25 mm plates, where a rheometer gives "
        f"{_share(instrument('largest_torque'), 'mN*m')}. As a rate of 10 % a second it is {rate * seconds:.0%} after "
        f"{seconds:g} s, and {melt:.0f} Pa in the melt"
    )


def _frequency() -> str:
    highest, stated = from_paper("highest_frequency"), from_paper("beyond_frequency")
    hertz = highest / (2.0 * math.pi)
    return f"{highest:g} rad/s is {hertz:.2f} Hz: no point of the sweep lies above {from_si(stated, 'Hz'):g} Hz"


def _small_strain() -> str:
    hot, strain, lowest = from_paper("above"), from_paper("sweep_strain"), from_paper("lowest_frequency")
    least = instrument("least_torque")
    torque = plate_torque(_complex_modulus(hot, 0.0, lowest) * strain)
    sweep = np.geomspace(lowest, from_paper("highest_frequency"), 400)
    torques = np.array([plate_torque(_complex_modulus(hot, 0.0, float(frequency)) * strain) for frequency in sweep])
    reached = [float(np.interp(math.log(end), np.log(torques), sweep)) for end in (least.value, least.low, least.high)]
    angle = strain * from_paper("plate_gap") / (0.5 * from_paper("plate_diameter"))
    return (
        f"at {lowest:g} rad/s the melt answers with {torque * 1e6:.3f} µN·m to {angle * 1e6:.0f} µrad, where a "
        f"rheometer resolves {_share(least, 'uN*m')}: the sweep says something from about {reached[0]:.1f} rad/s "
        f"({reached[1]:.2f} to {reached[2]:.1f}) on"
    )


def _stiff_specimen() -> str:
    modulus = _complex_modulus(from_paper("below"), 1.0, 2.0 * math.pi)
    specimen, frame = plate_stiffness(modulus), instrument("torsional_stiffness")
    seen = [1.0 / (1.0 + specimen / stiffness) for stiffness in (frame.value, frame.low, frame.high)]
    sure = [
        _SURE / (1.0 - _SURE) * modulus * stiffness / specimen for stiffness in (frame.value, frame.low, frame.high)
    ]
    return (
        f"at 30 °C the specimen is a spring of {specimen:.0f} N·m/rad, drive, shaft and plates one of "
        f"{_share(frame, 'N*m/rad')}: uncorrected, {seen[0]:.1%} ({seen[1]:.1%} to {seen[2]:.1%}) of "
        f"G = {modulus / 1e6:.0f} MPa is read. Within 10 % it reads up to {sure[0] / 1e6:.1f} MPa "
        f"({sure[1] / 1e6:.2f} to {sure[2] / 1e6:.1f}); Liu et al. (10.1007/s00397-011-0560-3) found such a limit "
        "below the plateau modulus of most melts for these plates"
    )


def _loss_modulus() -> str:
    highest, least = from_paper("highest_frequency"), instrument("least_torque")
    hot = _modes(from_paper("above"), 0.0)
    storage, loss = (float(part) for part in polymer.maxwell_moduli(highest, hot))
    stated = from_paper("loss_modulus")
    torque = plate_torque(stated * from_paper("sweep_strain"))
    return (
        f"the melt's G'' at {highest:g} rad/s is {_pascal(loss)}, its tan(delta) {loss / storage:.2g}. A G'' of "
        f"{stated:g} Pa at 0.01 % answers with {torque * 1e12:.2g} pN·m, where a rheometer resolves "
        f"{_share(least, 'uN*m')}"
    )


def _adapted_moduli() -> str:
    shear = _complex_modulus(from_paper("below"), 1.0, 2.0 * math.pi)
    ends = [2.0 * (1.0 + ratio) for ratio in _POISSON]
    return (
        f"of an isotropic solid E is {ends[0]:.1f} to {ends[1]:.0f} times G, so that one curve follows from the other: "
        f"G = {shear / 1e6:.0f} MPa at 30 °C and 1 Hz here, E = {ends[0] * shear / 1e6:.0f} to "
        f"{ends[1] * shear / 1e6:.0f} MPa"
    )


_MINUTE = 60.0


def _sweep_time() -> str:
    lowest, at = from_paper("lowest_frequency"), from_paper("premelt")
    low, _, high = fractions_at(published_module(), at)
    period = 2.0 * math.pi / lowest
    decades = math.log10(from_paper("highest_frequency") / lowest)
    points = np.geomspace(lowest, from_paper("highest_frequency"), round(_EACH_DECADE * decades) + 1)
    taken = np.cumsum(2.0 * math.pi / points[::-1])
    in_time = points[::-1][taken < _MINUTE][-1]
    return (
        f"one period at {lowest:g} rad/s takes {period:.0f} s, and {len(points)} points of one period each "
        f"{taken[-1] / 60.0:.1f} min; from above, a minute comes down to {in_time:.1g} rad/s. An amplitude sweep of as "
        f"many periods takes a minute from {2.0 * math.pi * len(points) / _MINUTE:.0f} rad/s on. At 60 °C the solid "
        f"share lies between {low:.0%} and {high:.0%} by history, and crystals melt and form meanwhile"
    )


def _premelt() -> str:
    at, module = from_paper("premelt"), published_module()
    low, nominal, high = fractions_at(module, at)
    entry = module.values["pcl_grade"].entry("melting_end")
    ends = [from_si(end, "degC") for end in (entry.value, entry.low or entry.value, entry.high or entry.value)]
    equilibrium = module.values["pcl_equilibrium_melting_temperature"]
    moduli = [_complex_modulus(at, fraction, 2.0 * math.pi) for fraction in (low, nominal, high)]
    return (
        f"melting ends at {ends[0]:.0f} °C ({ends[1]:.0f} to {ends[2]:.0f}): at 60 °C {nominal:.0%} is still solid on "
        f"heating, from {low:.0%} (cooled from the melt) to {high:.0%} by history, and |G*| at 1 Hz is "
        f"{_pascal(moduli[1])}, from {_pascal(moduli[0])} to {_pascal(moduli[2])}. Crystals that are left start "
        f"the next freezing: melt above the equilibrium melting temperature, {from_si(equilibrium, 'degC'):.0f} °C"
    )


def _pascal(modulus: float) -> str:
    """Return a modulus in the unit in which it has one to three digits before the point."""
    for size, unit in ((1e6, "MPa"), (1e3, "kPa")):
        if modulus >= size:
            return f"{modulus / size:.3g} {unit}"
    return f"{modulus:.3g} Pa"
