"""Small studies that several tests begin from: their mode, what is given and what varies; each test asks its own."""

from support import sample_text

from tvimdesign.solve.nlp.solution import ActiveConstraint
from tvimdesign.study import Range, Study

FOUR_SIZES_IN_SHEAR = sample_text("four_sizes_in_shear")

ALGEBRAIC = sample_text("algebraic")
"""Springs with tolerances; nothing here waits for a working cycle."""


def with_limit_eased(study: Study, held: ActiveConstraint, share: float) -> Study:
    """Return the study with one limit, or one end of a range, eased by a share of its size."""
    name, sense = held.name.split(" ")[:2]
    factor = 1.0 + share if sense == "<=" else 1.0 - share
    if held.origin == "vary":
        vary = study.vary[name]
        assert isinstance(vary, Range)
        end = {"upper": vary.upper * factor} if sense == "<=" else {"lower": vary.lower * factor}
        return study.model_copy(update={"vary": {**study.vary, name: vary.model_copy(update=end)}})
    require = tuple(
        r.model_copy(update={"limit": r.limit * factor})
        if name in (r.output, *study.table.output(r.output).also_limited)
        else r
        for r in study.require
    )
    assert require != study.require
    return study.model_copy(update={"require": require})
