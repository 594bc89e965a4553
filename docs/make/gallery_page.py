"""Gallery page made from the study files: name, description, mode, picture and file of each."""

from __future__ import annotations

from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
REPORTS = ROOT / "results"
"""Folder of the runs, one a study."""


def reports() -> dict[str, Path]:
    """Return the reports of shipped studies that exist, by study."""
    names = (path.stem for path in sorted((ROOT / "studies").glob("*.yaml")))
    paths = {name: REPORTS / name / "report.html" for name in names}
    return {name: path for name, path in paths.items() if path.exists()}


def gallery_page() -> str:
    """Return the gallery as Markdown; raise FileNotFoundError if a study has no picture."""
    parts = [
        "# Gallery of the studies",
        "",
        "Run a study with `tvimdesign run studies/NAME.yaml`. The pictures (`make pictures`) show the result of a run,",
        "whole and opened. [Studies](studies.md) has sizes and times. `make gallery` adds reports with their parts.",
        "",
    ]  # fmt: skip
    for path in sorted((ROOT / "studies").glob("*.yaml")):
        study = yaml.safe_load(path.read_text(encoding="utf-8"))
        picture = f"pictures/studies/{path.stem}.png"
        if not (ROOT / "docs" / picture).exists():
            raise FileNotFoundError(f"docs/{picture} is missing: `make pictures` makes it")
        varied = len(study.get("vary", {}))
        done = f"optimises {varied} variables" if varied else "evaluated as it stands"
        parts += [
            f"## {study['name']}",
            "",
            f"![{study['name']}: whole and opened]({picture})",
            "",
            str(study.get("description", "")).strip(),
            "",
            f"Mode: {study['mode']}; {done}. File: [`studies/{path.name}`](../studies/{path.name}).",
            "",
            *([f"[Report of a run](reports/{path.stem}.html){{target=_blank}}", ""] if path.stem in reports() else []),
        ]
    return "\n".join(parts)
