"""The spread of a module in sentences: how many modules are good, what to tighten first, what the free angle does."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tvimdesign.device import Table
from tvimdesign.solve.nlp.constraints import in_words
from tvimdesign.solve.nlp.spread import Yield
from tvimdesign.solve.uncertainty.tolerance import Kept, Preload, Spread

_GOOD = 0.9973
"""Yield from which a limit is no concern: three standard deviations to either side."""
_ON_THE_LIMIT = 0.1
"""C_pk below which no tolerance helps, only another design."""
_BENT = 0.1
"""Difference of the two standard deviations from which an output is not linear within the tolerances."""
_NAMED = 3
_CARRIED = 0.2
"""Share of a limit's variance from which a contributor counts as carrying it."""


def sentences(found: Spread, preload: Preload | None, table: Table) -> list[str]:
    """Return what people should know, the most important first."""
    worst = [kept for kept in found.kept if _broken_at_worst(found, kept)]
    corners = "no limit is broken" if not worst else f"{len(worst)} of {len(found.kept)} limits are broken"
    said = [
        f"What varies from part to part: {_percent(found.together)} of the modules keep every limit; in the worst case "
        f"{corners}."
    ]
    said += _what_first(found, table)
    if preload is not None:
        said.append(free_angle(preload))
    said += _caveats(found)
    return said


def _percent(share: Yield) -> str:
    return f"{100 * share.share:.3g} % ({100 * share.low:.3g} to {100 * share.high:.3g} %)"


def _broken_at_worst(found: Spread, kept: Kept) -> bool:
    i = found.outputs.index(kept.limit.output)
    end = found.worst.high[i] if kept.limit.sense == "<=" else found.worst.low[i]
    return not float(kept.limit.residual(end)) <= 1e-9


def of_concern(found: Spread) -> list[Kept]:
    """Limits that too many modules break, the worst first."""
    return sorted((kept for kept in found.kept if kept.share.share < _GOOD), key=lambda kept: kept.share.share)


def _what_first(found: Spread, table: Table) -> Iterator[str]:
    """Yield what to tighten, limit by limit; where the mean stands on the limit, that tightening does not help."""
    concern = of_concern(found)
    if not concern:
        yield f"Every limit is kept by {100 * _GOOD:g} % of the modules and more: nothing needs to be tightened."
        return
    on_limit = [kept for kept in concern if kept.capability < _ON_THE_LIMIT]
    if on_limit:
        names = ", ".join(in_words(kept.limit, table) for kept in on_limit[:_NAMED])
        more = f" and {len(on_limit) - _NAMED} more" if len(on_limit) > _NAMED else ""
        yield (
            f"The mean stands on or beyond {names}{more}: no tolerance mends that. Move the design away from the "
            "limit, as a study with `robust: {sigma: 3}` does."
        )
    mendable = [kept for kept in concern if kept not in on_limit] or concern
    lost = {contributor.name: 0.0 for contributor in found.contributors}
    for kept in mendable:
        i = found.outputs.index(kept.limit.output)
        for j, name in enumerate(lost):
            lost[name] += (1.0 - kept.share.share) * float(found.shares[i, j])
    first = max(lost, key=lambda name: lost[name])
    j = list(lost).index(first)
    led = _led_by(found, mendable, j)
    yield f"Tighten {first} first: {'; '.join(_halved(found, kept, j, table) for kept in led)}."


def _led_by(found: Spread, concern: list[Kept], j: int) -> list[Kept]:
    """Return the limits of concern that one contributor carries most of."""
    shares = {kept.limit.name: float(found.shares[found.outputs.index(kept.limit.output), j]) for kept in concern}
    carried = [kept for kept in concern if shares[kept.limit.name] >= _CARRIED] or concern[:1]
    return sorted(carried, key=lambda kept: -shares[kept.limit.name])[:2]


def _halved(found: Spread, kept: Kept, j: int, table: Table) -> str:
    """Return what a contributor carries of a limit's spread, and what half its tolerance would do."""
    i = found.outputs.index(kept.limit.output)
    share = float(found.shares[i, j])
    carried = (
        f"it carries {100 * share:.0f} % of the variance behind {in_words(kept.limit, table)}, which "
        f"{100 * kept.share.share:.3g} % keep"
    )
    if kept.capability < _ON_THE_LIMIT:
        return carried
    able = kept.capability / math.sqrt(1.0 - 0.75 * share)
    return f"{carried}; with half its tolerance C_pk would be {able:.2f} instead of {kept.capability:.2f}"


def free_angle(preload: Preload) -> str:
    """Return what the springs' free angle does to the joint, and what adjusting the preload does about it."""
    by = " by DIN 2194, grade 2" if preload.by_row else ""
    left = math.degrees(preload.adjusted)
    adjusted = f"to within ±{left:.2g}°" if left > 0.0 else "out"
    return (
        f"The free-angle tolerance of these springs (±{math.degrees(preload.as_bought):.1f}°{by}) is "
        f"{preload.over_stroke:.1f} times the stroke: as bought, {100 * preload.yield_as_bought.share:.3g} % of the "
        f"modules keep all limits that hang on the preload; with the preload adjusted {adjusted}, "
        f"{100 * preload.yield_adjusted.share:.3g} % do."
    )


def _caveats(found: Spread) -> Iterator[str]:
    rss, drawn = found.deviation, found.drawn.deviation
    spread = rss > 1e-9 * np.abs(found.nominal)
    bent = [
        name for i, name in enumerate(found.outputs)
        if spread[i] and abs(drawn[i] - rss[i]) > _BENT * rss[i]
    ]  # fmt: skip
    if bent:
        yield f"Not linear within the tolerances, so trust Monte Carlo rather than root-sum-square: {', '.join(bent)}."
    turned = [name for i, name in enumerate(found.outputs) if spread[i] and not found.worst.by_sign[i]]
    if turned:
        names = ", ".join(turned)
        yield f"Not monotonic within the tolerances, so the worst corner is not where derivatives point: {names}."
    never = [
        f"{name} {100 * found.drawn.never[i]:.2g} %" for i, name in enumerate(found.outputs) if found.drawn.never[i]
    ]
    if never:
        yield f"Share of the modules in which it never happens: {', '.join(never)}; means leave these out."
    if found.left_out:
        yield f"Not in this, as they never happen or hang on a current profile: {', '.join(found.left_out)}."
