"""A melt sheared to and fro beyond its linear range, and its slow flow in a thin gap.

Wagner's equation is the stress sigma(t) = integral over the past of m(s) h(g) g ds, with the relative strain
g = gamma(t) - gamma(t - s), the memory m(s) = sum (G/tau) exp(-s/tau) of the relaxation spectrum, and the damping
function h. A melt is so strained only as far as it remembers: slow large motions stay linear, fast ones fall by h of
the whole strain. Published melts of polycaprolactone follow it [N].
Sources: [W] Wagner, Rheol. Acta 15 (1976) 136 (the equation); [S] Soskey and Winter, J. Rheol. 28 (1984) 625 (h);
[N] Noroozi, thesis, University of British Columbia (cIRcle 1.0073545), abstract; [F] Ferry, Viscoelastic Properties of
Polymers, 3rd ed., ch. 1 and 3; [L] Lodge, Elastic Liquids (1964) (normal stresses of a rubberlike liquid); [T] Tanner
and Keentok, J. Rheol. 27 (1983) 47 (edge fracture).

Slow flow of a viscous liquid between plates that it does not slip on, in a gap much thinner than it is wide
(Hele-Shaw). Sources: White, Viscous Fluid Flow, sec. 3-3 (flow between plates); Bird, Armstrong and Hassager,
Dynamics of Polymeric Liquids, vol. 1, sec. 1.3 (squeeze film); de Gennes, Brochard-Wyart and Quere, Capillarity and
Wetting Phenomena, ch. 1.
"""

from typing import Any

import numpy as np

from tvimdesign.physics.polymers.polymer import LINEAR_DROP, Modes, damping_function, maxwell_moduli

_PAST = 16  # nodes over one period of the past, cubed so that they crowd where memory is fresh
_RING = 4  # nodes over the face of a ring


def ring(radius_ratio: Any) -> list[tuple[Any, Any]]:
    """Return the strain over that at the rim [1], and share of a linear layer's torque [1], at nodes of an annular
    face.

    `radius_ratio` is inner over outer radius. Torque goes with r^3 dr, which is u du with u = r^2: Gauss's nodes in u.
    """
    nodes, weights = np.polynomial.legendre.leggauss(_RING)
    least = radius_ratio**2
    squares = [least + (1.0 - least) * 0.5 * (1.0 + float(node)) for node in nodes]
    torques = [float(weight) * square for weight, square in zip(weights, squares, strict=True)]
    return [(np.sqrt(square), torque / sum(torques)) for square, torque in zip(squares, torques, strict=True)]


def softening(strain: Any, limit: Any) -> Any:
    """Return the share by which the first harmonic of h(A cos) A cos falls [1]: 1 - (1/pi) integral of h(A cos) cos^2.

    With h = 1/(1 + z cos^2), z = a (A/gamma_L)^2 [S], and q = sqrt(1 + z): 1 - 2/(q (q + 1)), no difference of likes.
    """
    z = LINEAR_DROP / (1.0 - LINEAR_DROP) * (strain / limit) ** 2
    q = np.sqrt(1.0 + z)
    return z / (1.0 + q) * (q + 2.0) / (q * (q + 1.0))


def wagner_moduli(strain: Any, angular_frequency: Any, modes: Modes, limit: Any) -> tuple[Any, Any]:
    """Return the first-harmonic storage and loss modulus [Pa] of an oscillation of the amplitude `strain` [1] [W].

    `modes` holds (relaxation time [s], modulus [Pa]), `limit` the linear strain. The relative strain is
    2 gamma sin(w s/2) cos(w t - w s/2), so its phase integrates in closed form (`softening`), and the past, periodic
    but for exp(-s/tau), in one period: the linear moduli less integral of m(s) softening (2 sin^2(w s/2), sin(w s)).
    """
    storage, loss = maxwell_moduli(angular_frequency, modes)
    nodes, weights = np.polynomial.legendre.leggauss(_PAST)
    period = 2.0 * np.pi / angular_frequency
    for node, weight in zip(nodes, weights, strict=True):
        share = 0.5 * (1.0 + float(node))
        past = period * share**3
        memory: Any = 0.0
        for time, modulus in modes:
            memory = memory + modulus / time * np.exp(-past / time) / (1.0 - np.exp(-period / time))
        half = float(np.sin(np.pi * share**3))
        lost = memory * softening(2.0 * strain * half, limit) * (1.5 * float(weight) * share**2 * period)
        storage = storage - lost * 2.0 * half**2
        loss = loss - lost * float(np.sin(2.0 * np.pi * share**3))
    return storage, loss


def unrelaxed_moduli(strain: Any, angular_frequency: Any, modes: Modes, limit: Any) -> tuple[Any, Any]:
    """Return the storage and loss modulus [Pa] were the melt to remember the whole amplitude: h(gamma) times the linear
    ones.

    What an amplitude sweep well above the longest relaxation rate shows, and the least it can be below.
    """
    share = damping_function(strain, limit)
    storage, loss = maxwell_moduli(angular_frequency, modes)
    return share * storage, share * loss


def shear_stress(strain: Any, storage: Any, loss: Any) -> Any:
    """Return the amplitude of the shear stress [Pa], gamma |G*| [F]; with linear moduli it is the most a melt can
    resist with."""
    return strain * np.sqrt(storage**2 + loss**2)


def edge_strain(gap: Any, tension: Any, normal_ratio: Any, storage: Any) -> Any:
    """Return the amplitude of strain [1] at which surface tension no longer holds a layer's free edge [T].

    The second normal stress difference draws the edge in where |N2| > 2 Gamma/(3 t), with the gap t [m] and the
    tension Gamma [N/m]; |N2| = psi N1, and N1 = G' gamma^2 on the mean of an oscillation [L]. An order of magnitude.
    """
    return np.sqrt(2.0 * tension / (3.0 * gap * normal_ratio * storage))


def gap_speed(gradient: Any, gap: Any, viscosity: Any) -> Any:
    """Return the mean speed [m/s] in a gap [m] under a pressure gradient [Pa/m], h^2 g/(12 eta); viscosity [Pa s]."""
    return gap**2 * gradient / (12.0 * viscosity)


def gaps_in_series(length: Any, gap: Any, lip_length: Any, lip_gap: Any) -> Any:
    """Return the length [m] of a gap that resists the flow as that gap and a narrower one after it do: l + l_2
    (h/h_2)^3."""
    return length + lip_length * (gap / lip_gap) ** 3


def meniscus_pressure(surface_tension: Any, gap: Any) -> Any:
    """Return the pressure [Pa] that a surface between two edges a gap apart holds, 2 gamma/h; surface tension [N/m],
    gap [m]."""
    return 2.0 * surface_tension / gap


def squeeze_time(force: Any, viscosity: Any, length: Any, width: Any, thin: Any, thick: Any) -> Any:
    """Return the time [s] in which a force [N] takes a strip from one thickness to another [m], pressed thinner or
    pulled thicker.

    t = eta L w^3/(2 F) (1/h_1^2 - 1/h_2^2), of a strip of the width w that is much narrower than its length L [m] and
    keeps its width.
    """
    return viscosity * length * width**3 / (2.0 * force) * (1.0 / thin**2 - 1.0 / thick**2)
