"""The numbers of the paper check's rows on springs and on rheometry, by their names in the sentences.

The specimen is the paper's, between plates of 25 mm diameter 1 mm apart; what an instrument of its class can do is
assumed with a range in `paper_claims.yaml`, as no sheet of its maker was read.
"""

import math

import numpy as np

from tvimdesign.base.record import Entry
from tvimdesign.base.units import from_si
from tvimdesign.paper import paper_case
from tvimdesign.paper.paper_case import Values, ends, from_paper, instrument, published_module, published_rate
from tvimdesign.physics import spring
from tvimdesign.physics.layers import layer
from tvimdesign.physics.motions import motion
from tvimdesign.physics.polymers import polymer, viscoelasticity
from tvimdesign.simulation.working_cycle.curves import fractions_at

OTHER_PIN = 38e-3  # A pin elsewhere than the ratio of one asks [m]


def _torsion_rate() -> Values:
    rate, stated = published_rate(), from_paper("torsion_rate")
    needed = from_paper("wire_diameter") * (stated / rate) ** 0.25
    inch_pounds = from_si(rate, "lbf*in")
    return {"rate": rate, "inch_pounds": inch_pounds, "times": stated / rate, "stated": stated, "needed": 1e3 * needed}


def _output_stiffness() -> Values:
    rate, stroke = published_rate(), from_paper("stroke")
    return {"by_unity": _by_unity(rate), "by_line": from_paper("springs") * rate * stroke**2, "stroke": stroke}


def _by_unity(rate: float) -> float:
    """Return the output stiffness of the paper's springs with its ratio of one [N*m/rad]."""
    return float(spring.output_stiffness(from_paper("springs"), rate, 0.0, 1.0, 0.0))


def _implied() -> Values:
    stated, inertia, angle = (from_paper(name) for name in ("torsion_rate", "inertia", "largest_rotation"))
    implied, computed = _by_unity(stated), _by_unity(published_rate())
    diameter, wire = from_paper("wire_diameter"), published_module().values["spring_material"]
    factor = spring.inner_fibre_factor(spring.spring_index(diameter, from_paper("coil_diameter")))
    rows = [(row["coefficient"], row["exponent"]) for row in wire.table("strength")]
    return {
        "implied": implied, "computed": computed, "times": implied / computed, "angle": angle, "torque": stated * angle,
        "implied_hertz": motion.natural_frequency(implied, inertia),
        "hertz": motion.natural_frequency(computed, inertia),
        "stress": spring.bending_stress(stated * angle, diameter, factor) / 1e6,
        "strength": spring.tensile_strength(diameter, rows) / 1e6,
    }  # fmt: skip


def _modulus() -> Values:
    stated, diameter = from_paper("youngs_modulus"), from_paper("wire_diameter")
    steps = published_module().study.catalog.record("spring_materials", "music_wire").table("youngs_modulus_steps")
    moduli = [row["youngs_modulus"] for row in steps]
    of_wire = (row for row in steps if row["wire_diameter_from"] <= diameter < row["wire_diameter_to"])
    handbook = next(of_wire)["youngs_modulus"]
    rate = paper_case.spring_rate(diameter, handbook)
    return {
        "handbook": handbook / 1e9, "least": min(moduli) / 1e9, "most": max(moduli) / 1e9, "rate": rate,
        "stiffness": _by_unity(rate), "less": 1.0 - handbook / stated,
    }  # fmt: skip


def _inch_sizes() -> Values:
    diameter, coil = from_paper("wire_diameter"), from_paper("coil_diameter")
    gauges = published_module().study.catalog.record("wires", "music_wire_gauge")
    nearest = min((row["wire_diameter"] for row in gauges.table("sizes")), key=lambda size: abs(size - diameter))
    lengths = {"wire": diameter, "coil": coil, "outer": coil + diameter, "nearest": nearest}
    return {
        **{name: from_si(length, "in") for name, length in lengths.items()}, "off": abs(nearest - diameter) * 1e6,
        "inch_pounds": from_si(published_rate(), "lbf*in"), "stated": from_paper("torsion_rate"),
    }  # fmt: skip


def _pretension() -> Values:
    rate, count, stroke = published_rate(), from_paper("springs"), from_paper("stroke")
    names = ("placement_radius", "leg_offset", "preload_angle")
    place, offset, preload = (paper_case.published_values()[name] for name in names)
    pin = 0.5 * place
    drawn = spring.output_stiffness(
        count, rate, preload, spring.leg_ratio(pin, place, 0.0, offset), spring.leg_curvature(pin, place, 0.0, offset)
    )
    return {
        "stroke": stroke, "half": 0.5 * count * rate, "whole": _by_unity(rate), "preload": preload,
        "offset": offset * 1e3, "drawn": float(drawn),
    }  # fmt: skip


def _symbols() -> Values:
    rate, place = published_rate(), from_paper("placement_radius")
    turned = abs(float(spring.leg_ratio(OTHER_PIN, place, 0.0, 0.0)))
    first, other = (spring.output_stiffness(4, rate, 0.0, ratio, 0.0) for ratio in (turned, 1.0 / turned))
    return {"pin": OTHER_PIN * 1e3, "turned": turned, "first": first, "other": other, "factor": turned**4}


def _angles() -> Values:
    place, stiffness = from_paper("placement_radius"), _by_unity(published_rate())
    radius, thickness = (paper_case.published_values()[name] for name in ("pcl_outer_radius", "pcl_thickness"))
    angles = []
    for angle in map(from_paper, ("release_angle", "stroke", "largest_rotation")):
        ratio = abs(float(spring.leg_ratio(0.5 * place, place, angle, 0.0)))
        strain = layer.shear_strain(radius, angle, thickness)
        angles.append(f"{angle:g} rad: {stiffness * angle:.2f} N·m, melt sheared by {strain:.0%}, ratio {ratio:.3f}")
    return {"angles": "; ".join(angles), "thickness": thickness * 1e3}


def _ratio() -> Values:
    place, rate = from_paper("placement_radius"), published_rate()
    pins = (0.5 * place, OTHER_PIN)
    stiffness = [spring.output_stiffness(4, rate, 0.0, spring.leg_ratio(pin, place, 0.0, 0.0), 0.0) for pin in pins]
    strain = layer.shear_strain(40e-3, from_paper("stroke"), 1e-3)
    return {"pins": [pin * 1e3 for pin in pins], "stiffness": stiffness, "strain": strain}


def _inertia() -> Values:
    inertia, stiffness = from_paper("inertia"), 4.0 * published_rate()
    return {"inertia": inertia, "stiffness": stiffness, "hertz": motion.natural_frequency(stiffness, inertia)}


def _motion() -> Values:
    stiffness, inertia = 4.0 * published_rate(), from_paper("inertia")
    return {"growth": math.sqrt(stiffness / inertia), "critical": motion.critical_damping(stiffness, inertia)}


_EACH_DECADE = 5  # Frequencies of a usual sweep in a decade
_POISSON = 0.3, 0.5  # Poisson's ratio of a stiff plastic and of a melt
_SURE = 0.1  # Share by which an uncorrected modulus may be low before it is called wrong


def _modes(temperature: float, fraction: float) -> list[tuple[float, float]]:
    """Return the relaxation spectrum of the paper's polymer at a temperature [K] and a solid fraction."""
    spectrum = polymer.spectrum(temperature, fraction, published_module().quantity("pcl_rheology"))
    return [(float(time), float(modulus)) for time, modulus in spectrum]


def _complex_modulus(temperature: float, fraction: float, frequency: float = 2.0 * math.pi) -> float:
    """Return |G*| [Pa] at an angular frequency [rad/s], at 1 Hz unless given."""
    storage, loss = polymer.maxwell_moduli(frequency, _modes(temperature, fraction))
    return math.hypot(float(storage), float(loss))


def plate_torque(stress: float) -> float:
    """Return the torque [N*m] of a shear stress [Pa] at the plates' rim, linear to the axis: pi R^3/2 tau."""
    return 0.5 * math.pi * (0.5 * from_paper("plate_diameter")) ** 3 * stress


def plate_stiffness(modulus: float) -> float:
    """Return the torsional stiffness [N*m/rad] of a specimen between the plates: pi R^4 G/(2 h)."""
    return 0.5 * math.pi * (0.5 * from_paper("plate_diameter")) ** 4 * modulus / from_paper("plate_gap")


def _share(device: Entry) -> str:
    """Return a text such as `125 mN·m (100 to 230, assumed)`."""
    value, low, high = (from_si(number, device.unit) for number in ends(device))
    return f"{value:g} {device.unit.replace('*', '·').replace('uN', 'µN')} ({low:g} to {high:g}, {device.status})"


def _strain_as_rate() -> Values:
    strain, seconds = from_paper("relaxation_strain"), from_paper("creep_time")
    stress = _complex_modulus(from_paper("below"), 1.0) * strain
    melt = viscoelasticity.zero_shear_viscosity(_modes(from_paper("above"), 0.0)) * strain
    return {
        "stress": stress / 1e6, "yielding": published_module().values["pcl_tensile_yield"] / math.sqrt(3.0) / 1e6,
        "torque": plate_torque(stress), "device": _share(instrument("largest_torque")), "strain": strain * seconds,
        "seconds": seconds, "melt": melt,
    }  # fmt: skip


def _frequency() -> Values:
    highest, stated = from_paper("highest_frequency"), from_paper("beyond_frequency")
    return {"highest": highest, "hertz": highest / (2.0 * math.pi), "stated": from_si(stated, "Hz")}


def _small_strain() -> Values:
    hot, strain, lowest = from_paper("above"), from_paper("sweep_strain"), from_paper("lowest_frequency")
    least = instrument("least_torque")
    sweep = np.geomspace(lowest, from_paper("highest_frequency"), 400)
    torques = np.array([plate_torque(_complex_modulus(hot, 0.0, float(frequency)) * strain) for frequency in sweep])
    reached = [float(np.interp(math.log(end), np.log(torques), sweep)) for end in ends(least)]
    angle = strain * from_paper("plate_gap") / (0.5 * from_paper("plate_diameter"))
    return {
        "lowest": lowest, "torque": torques[0] * 1e6, "angle": angle * 1e6, "device": _share(least), "reached": reached
    }  # fmt: skip


def _stiff_specimen() -> Values:
    modulus, frame = _complex_modulus(from_paper("below"), 1.0), instrument("torsional_stiffness")
    specimen = plate_stiffness(modulus)
    seen = [1.0 / (1.0 + specimen / stiffness) for stiffness in ends(frame)]
    sure = [_SURE / (1.0 - _SURE) * modulus * stiffness / specimen / 1e6 for stiffness in ends(frame)]
    return {"specimen": specimen, "device": _share(frame), "seen": seen, "modulus": modulus / 1e6, "sure": sure}


def _loss_modulus() -> Values:
    highest, stated = from_paper("highest_frequency"), from_paper("loss_modulus")
    storage, loss = (float(part) for part in polymer.maxwell_moduli(highest, _modes(from_paper("above"), 0.0)))
    return {
        "highest": highest, "loss": _pascal(loss), "tangent": loss / storage, "stated": stated,
        "torque": plate_torque(stated * from_paper("sweep_strain")) * 1e12,
        "device": _share(instrument("least_torque")),
    }  # fmt: skip


def _adapted_moduli() -> Values:
    shear, factors = _complex_modulus(from_paper("below"), 1.0) / 1e6, [2.0 * (1.0 + ratio) for ratio in _POISSON]
    return {"ends": factors, "shear": shear, "tensile": [factor * shear for factor in factors]}


_MINUTE = 60.0


def _sweep_time() -> Values:
    lowest, highest = from_paper("lowest_frequency"), from_paper("highest_frequency")
    low, _, high = fractions_at(published_module(), from_paper("premelt"))
    points = np.geomspace(lowest, highest, round(_EACH_DECADE * math.log10(highest / lowest)) + 1)
    taken = np.cumsum(2.0 * math.pi / points[::-1])
    return {
        "lowest": lowest, "period": 2.0 * math.pi / lowest, "points": len(points), "minutes": taken[-1] / _MINUTE,
        "in_time": points[::-1][taken < _MINUTE][-1], "quick": 2.0 * math.pi * len(points) / _MINUTE,
        "low": low, "high": high,
    }  # fmt: skip


def _premelt() -> Values:
    at, module = from_paper("premelt"), published_module()
    fractions = fractions_at(module, at)
    melting = ends(module.values["pcl_grade"].entry("melting_end"))
    return {
        **dict(zip(("low", "nominal", "high"), fractions, strict=True)),
        "ends": [from_si(end, "degC") for end in melting],
        "moduli": [_pascal(_complex_modulus(at, fraction)) for fraction in fractions],
        "equilibrium": from_si(module.values["pcl_equilibrium_melting_temperature"], "degC"),
    }


def _pascal(modulus: float) -> str:
    """Return a modulus in the unit in which it has one to three digits before the point."""
    for size, unit in ((1e6, "MPa"), (1e3, "kPa")):
        if modulus >= size:
            return f"{modulus / size:.3g} {unit}"
    return f"{modulus:.3g} Pa"
