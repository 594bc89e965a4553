"""Checks a study without answering it: its text, limits that cannot hold together, records with doubtful values."""

from __future__ import annotations

from tvimdesign.study import Study
from tvimdesign.study.record_checks import record_checks


def refuse_what_cannot_be(study: Study, *, proof: bool = True) -> Study:
    """Return the study. Raises InputError for what it asks and no module can be, InfeasibleError likewise.

    Limits that arithmetic alone cannot keep are looked for as well, which takes half a second, unless `proof` is not
    asked.
    """
    from tvimdesign.report.run.refusal import refuse_unfit
    from tvimdesign.solve.nlp.constraints import refuse_impossible

    (refuse_unfit if proof else refuse_impossible)(study)
    return study


def describe(study: Study) -> str:
    """One line on what a valid study asks, then one for each of its records that contradicts itself."""
    what = f"optimises {len(study.vary)} variables" if study.task == "optimize" else "evaluates one module"
    asked = f"{study.name}: valid; {what}, {len(study.require)} requirements ({study.mode} mode)."
    return "\n".join([asked, *record_checks(study)])
