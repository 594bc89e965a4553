"""A layer between two plates that shrinks in volume as it freezes, and the traction on its bond where it is held back.

Both plates are clamped at a hub; the layer begins a span away from it. Where it begins, the plates have not bent far
enough, and it pulls hardest. A strip of unit width, the layer as springs (Winkler) of the rate k [Pa/m], the plates'
flexural rigidities D in series, beta = (k/(4 D))^(1/4) and lambda = beta span. Sources: Timoshenko, Strength of
Materials, part II, ch. 1 (beam on an elastic foundation, semi-infinite); Timoshenko and Goodier, Theory of Elasticity,
sec. 6 (strain in one direction alone).
"""

from __future__ import annotations

from typing import Any


def volume_share(density_melt: Any, density_solid: Any) -> Any:
    """Return the share of the melt's volume that is lost on freezing [1]: 1 - rho_melt/rho_solid; densities
    [kg/m^3]."""
    return 1.0 - density_melt / density_solid


def linear_share(volume_share: Any) -> Any:
    """Return the share that a body with free sides loses of each length [1]: 1 - (1 - s)^(1/3) of its volume's share
    s."""
    return 1.0 - (1.0 - volume_share) ** (1.0 / 3.0)


def growth(density_melt: Any, density_solid: Any) -> Any:
    """Return the volume gained on melting over that of the solid [1]: rho_solid/rho_melt - 1; densities [kg/m^3]."""
    return density_solid / density_melt - 1.0


def confined_modulus(youngs_modulus: Any, poissons_ratio: Any) -> Any:
    """Return the modulus [Pa] of a body that can give way in one direction only, M = E (1 - nu)/((1 + nu)(1 - 2
    nu))."""
    return youngs_modulus * (1.0 - poissons_ratio) / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio))


def flexural_rigidity(youngs_modulus: Any, poissons_ratio: Any, thickness: Any) -> Any:
    """Return the flexural rigidity of a plate [N*m], D = E h^3/(12 (1 - nu^2)); modulus [Pa], thickness [m]."""
    return youngs_modulus * thickness**3 / (12.0 * (1.0 - poissons_ratio**2))


def decay_rate(foundation: Any, rigidity: Any) -> Any:
    """Return the length over which plates bend after a layer [1/m], beta = (k/(4 D))^(1/4); k [Pa/m], D [N*m]."""
    return (foundation / (4.0 * rigidity)) ** 0.25


def shear_rigidity(shear_modulus: Any, thickness: Any) -> Any:
    """Return the force per width that shears a plate by a unit angle [N/m], 5/6 G h; modulus [Pa], thickness [m]."""
    return 5.0 / 6.0 * shear_modulus * thickness


def edge_traction(shortened: Any, foundation: Any, rigidity: Any, shear: Any, span: Any) -> Any:
    """Return the traction [Pa] where a layer begins that would be `shortened` [m] and whose plates are clamped a `span`
    [m] away.

    p = k delta (1 + lambda)/(1 + lambda (1 + k/(beta^2 S)) + lambda^2 + lambda^3/3): all of k delta without a span,
    none far from the hub. S [N/m] is the plates' rigidity in shear over the span, in series.
    """
    rate = decay_rate(foundation, rigidity)
    slack = rate * span
    given_way = 1.0 + slack * (1.0 + foundation / (rate**2 * shear)) + slack**2 + slack**3 / 3.0
    return foundation * shortened * (1.0 + slack) / given_way


def edge_traction_of_force(line_force: Any, foundation: Any, rigidity: Any, span: Any) -> Any:
    """Return the traction [Pa] where a layer begins whose plates a force [N/m] parts at the hub, where they may move
    but not turn.

    p = V beta (1 + lambda).
    """
    rate = decay_rate(foundation, rigidity)
    return line_force * rate * (1.0 + rate * span)
