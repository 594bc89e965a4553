"""The paper check's rows on springs: rate, output stiffness, pretension, wire, sizes and angles."""

import math

from tvimdesign.base.units import from_si, to_si
from tvimdesign.physics.layers import layer
from tvimdesign.physics.motions import motion
from tvimdesign.physics.springs import spring
from tvimdesign.report.paper.paper_case import (
    from_paper,
    published_module,
    published_rate,
    published_values,
    spring_rate,
)

OTHER_PIN = 38e-3
"""A pin elsewhere than the ratio of one asks [m]."""


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
