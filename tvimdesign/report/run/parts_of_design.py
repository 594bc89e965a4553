"""Makes the parts of a design into a folder, with their checks, and says which of those fail."""

from __future__ import annotations

import json
from pathlib import Path

from tvimdesign.base.errors import GeometryError
from tvimdesign.base.whole_files import write_whole
from tvimdesign.cad.cad_report import CadReport
from tvimdesign.report.output.progress import Progress
from tvimdesign.report.output.results_format import Parts

CAD_TIME_LIMIT = 300.0  # s


def make_parts_of(design: Path, out: Path, progress: Progress) -> CadReport:
    """Make the parts of a design.json beside their checks.json. Raises GeometryError where they cannot be made."""
    from tvimdesign.cad import make_cad

    progress("parts: starting the CAD kernel")
    report = make_cad(design, out, CAD_TIME_LIMIT, lambda text: progress(f"parts: {text}"))
    write_whole(out / "checks.json", (json.dumps(plain_report(report), indent=2) + "\n").encode())
    progress("")
    return report


def plain_report(report: CadReport) -> Parts:
    """The parts' checks, files and notes as plain data."""
    return {
        "checks": [check.plain() for check in report.checks], "files": list(report.files), "notes": list(report.notes)
    }  # fmt: skip


def refuse_failed(report: CadReport, out: Path) -> None:
    """Raise GeometryError where a check on the solids fails; the files are there."""
    if not report.failed:
        return
    worst = sorted(report.failed, key=lambda check: -abs(check.value))[:3]
    lines = [
        f"  {check.text}: {check.value:.4g}{check.unit and ' '}{check.unit}, limit {check.limit:.4g}"
        for check in worst
    ]  # fmt: skip
    raise GeometryError(
        f"the parts are written, but {len(report.failed)} of {len(report.checks)} checks fail, the worst:\n"
        + "\n".join(lines)
        + f"\nSee {out / 'checks.json'}, and which rules the design breaks."
    )
