"""Melt in a thin gap between two plates: what flows along it, what squeezes it out, what its surface holds back.

Slow flow of a viscous liquid between plates that it does not slip on, in a gap much thinner than it is wide
(Hele-Shaw). Sources: White, Viscous Fluid Flow, sec. 3-3 (flow between plates); Bird, Armstrong and Hassager,
Dynamics of Polymeric Liquids, vol. 1, sec. 1.3 (squeeze film); de Gennes, Brochard-Wyart and Quere, Capillarity and
Wetting Phenomena, ch. 1.
"""

from __future__ import annotations

from typing import Any


def gap_speed(gradient: Any, gap: Any, viscosity: Any) -> Any:
    """Mean speed [m/s] in a gap [m] under a pressure gradient [Pa/m], h^2 g/(12 eta); viscosity [Pa s]."""
    return gap**2 * gradient / (12.0 * viscosity)


def gaps_in_series(length: Any, gap: Any, lip_length: Any, lip_gap: Any) -> Any:
    """Length [m] of a gap that resists the flow as that gap and a narrower one after it do: l + l_2 (h/h_2)^3."""
    return length + lip_length * (gap / lip_gap) ** 3


def meniscus_pressure(surface_tension: Any, gap: Any) -> Any:
    """Pressure [Pa] that a surface between two edges a gap apart holds, 2 gamma/h; surface tension [N/m], gap [m]."""
    return 2.0 * surface_tension / gap


def squeeze_time(force: Any, viscosity: Any, length: Any, width: Any, thin: Any, thick: Any) -> Any:
    """Time [s] in which a force [N] takes a strip from one thickness to another [m], pressed thinner or pulled thicker.

    t = eta L w^3/(2 F) (1/h_1^2 - 1/h_2^2), of a strip of the width w that is much narrower than its length L [m] and
    keeps its width.
    """
    return viscosity * length * width**3 / (2.0 * force) * (1.0 / thin**2 - 1.0 / thick**2)
