"""Makes the parts of a design into a folder, with their checks, and says which of those fail."""

import json
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Self

from tvimdesign.base.atomic_files import atomic_write, make_folder
from tvimdesign.base.errors import GeometryError
from tvimdesign.base.processes import Niceness, set_low_priority
from tvimdesign.cad.cad_report import CadReport, SolidCheck
from tvimdesign.report.output.results_format import Parts
from tvimdesign.report.output.terminal import Progress
from tvimdesign.study.design import Design, write_design

_DESIGN_COPY = ".design.json.part"
"""The design as the parts are asked for, beside them: it is removed once they are made."""


def make_parts_of(design: Path, out: Path, progress: Progress) -> CadReport:
    """Make the parts of a design.json beside their checks.json. Raises GeometryError where they cannot be made."""
    with BackgroundPartsJob() as parts:
        parts.begin_with(design, out)
        return parts.finish(progress)


class BackgroundPartsJob:
    """Parts made while a run goes on: the CAD kernel is loaded as the solver works, and begins with the answer."""

    def __init__(self, mode: str = "", *, gives_way: bool = True) -> None:
        """Start the process that loads the kernel, and reads the table of the mode that is known to come.

        By default its priority is lower than the solver's; its parts but the first have a still lower one.
        """
        from tvimdesign.cad.make import PartsProcess

        self._stack = ExitStack()
        self._process = self._stack.enter_context(PartsProcess(mode=mode))
        if gives_way:
            set_low_priority(self._process.process, Niceness.LOW)
        self._out = Path()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.stop()

    def stop(self) -> None:
        """End the process if it has not ended: nothing more is written into the folder."""
        self._stack.close()
        (self._out / _DESIGN_COPY).unlink(missing_ok=True)

    def begin(self, design: Design, out: Path) -> None:
        """Let the parts be made into a folder, and come back at once."""
        make_folder(out)
        design_file = out / _DESIGN_COPY
        self.begin_with(write_design(design, design_file), out)

    def begin_with(self, design: Path, out: Path) -> None:
        """Do so with a design.json, which is read while this goes on."""
        self._out = out
        self._process.begin(design, out)

    def finish(self, progress: Progress) -> CadReport:
        """Wait for the parts, and write their checks.json. Raises GeometryError where they cannot be made."""
        progress("parts: starting the CAD kernel")
        try:
            report = self._process.finish(lambda text: progress(f"parts, {text}"))
        finally:
            self.stop()
        atomic_write(self._out / "checks.json", (json.dumps(plain_report(report), indent=2) + "\n").encode())
        progress("")
        return report


def plain_report(report: CadReport) -> Parts:
    """Return the parts' checks, files and notes as plain data."""
    return {
        "checks": [check.plain() for check in report.checks], "files": list(report.files), "notes": list(report.notes)
    }  # fmt: skip


def refuse_failed(report: CadReport) -> None:
    """Raise GeometryError where a check on the solids fails; the files are there."""
    if not report.failed:
        return
    worst = sorted(report.failed, key=lambda check: -abs(check.value))[:3]
    lines = [
        f"  {check.text}: {check.value:.4g}{check.unit and ' '}{check.unit}, limit {check.limit:.4g}" for check in worst
    ]
    raise GeometryError(
        f"the parts are written, but {len(report.failed)} of {len(report.checks)} checks fail, the worst:\n"
        + "\n".join(lines)
        + "\nSee checks.json beside the parts, and which rules the design violates."
    )


def in_short(checks: Sequence[SolidCheck]) -> str:
    """Return how many checks passed, how many did not, and the worst of those."""
    worst = worst_first(checks)
    clauses = [f"{sum(check.level == 'pass' for check in checks)} of {len(checks)} checks on the solids passed"]
    for level in ("failure", "warning"):
        missed = [check.text for check in worst if check.level == level]
        if missed:
            clauses.append(f"{len(missed)} {level}{'s' if len(missed) > 1 else ''}, the worst: {missed[0]}")
    return "; ".join([*clauses, "cad/checks.json"] if worst else clauses)


def worst_first(checks: Sequence[SolidCheck]) -> list[SolidCheck]:
    """Return failures, then warnings, those that miss their limit by the most first."""
    rank = {"failure": 0, "warning": 1}
    reported = [check for check in checks if check.level in rank]
    missed = {check.name: abs(check.value - check.limit) / max(abs(check.limit), 1e-9) for check in reported}
    return sorted(reported, key=lambda check: (rank[check.level], -missed[check.name], check.name))
