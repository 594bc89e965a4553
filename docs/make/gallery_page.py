"""Makes the gallery from the study files: name, description, mode, picture and file of each."""

from __future__ import annotations

from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
REPORTS = ROOT / "results"
"""Where runs have left their reports: one folder for each study."""


def reports() -> dict[str, Path]:
    """Reports of the shipped studies that runs have left, by study; front and comparison included."""
    names = (path.stem for path in sorted((ROOT / "studies").glob("*.yaml")))
    found = {name: REPORTS / name / "report.html" for name in names}
    return {name: path for name, path in found.items() if path.exists()}


def gallery_page() -> str:
    """The gallery as Markdown. Raises FileNotFoundError where a study has no picture."""
    parts = [
        "# Gallery of the studies",
        "",
        "Every file in `studies/` runs as it is: `tvimdesign run studies/NAME.yaml`. The code makes the pictures,",
        "of the module a run comes to: on the left whole, on the right opened. `make pictures` makes them again.",
        "The README's table has sizes and times. A link to a report stands here where this site was built with reports",
        "(`make gallery`). A report carries the files of its parts.",
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
