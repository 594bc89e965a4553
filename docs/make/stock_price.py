"""Runs and tables of docs/stock-price.md: ideal modules beside those one can order.

    python docs/make/stock_price.py [--only CASE] [--step NAME] [--runs FOLDER] [--table]

Each step of `stock_price.yaml` is a run of its own (minutes); the figures go to `stock_price.csv`, the tables to the
page. Shipped studies that were run into FOLDER/<study> are not run again. `--table` writes the tables from the figures
that are there.
"""

from __future__ import annotations

import argparse
import csv
import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PAGE = ROOT / "docs" / "stock-price.md"
FIGURES = HERE / "stock_price.csv"
OUTPUTS = {
    "module_mass": ("g", 1e3, "mass"), "envelope_diameter": ("mm", 1e3, "diameter"),
    "envelope_volume": ("cm³", 1e6, "volume"), "response_time": ("s", 1.0, "soft after"),
    "return_time": ("s", 1.0, "stiff again after"), "switch_energy": ("J", 1.0, "energy to soften"),
}  # fmt: skip
"""Unit on the page, its scale from SI, and the word at the head of the column."""

Figures = dict[tuple[str, str], dict[str, float | str]]


def cases() -> dict[str, dict[str, Any]]:
    """Read the studies and their steps."""
    loaded: dict[str, dict[str, Any]] = yaml.safe_load((HERE / "stock_price.yaml").read_text(encoding="utf-8"))
    return loaded


def study_of(case: str, step: int) -> dict[str, Any]:
    """Return the shipped study with the changes of a step and of those after it; a step's own come last."""
    study: dict[str, Any] = yaml.safe_load((ROOT / "studies" / f"{case}.yaml").read_text(encoding="utf-8"))
    for one in reversed(cases()[case]["steps"][step:]):
        for path, value in one["changes"].items():
            *sections, name = path.split(".")
            place = study
            for section in sections:
                place = place.setdefault(section, {})
            if value is None:
                place.pop(name, None)
            else:
                place[name] = value
    return study


def run(study: Mapping[str, Any]) -> dict[str, float | str]:
    """Return status and outputs (SI) of a study's optimum; raise RuntimeError if the run has none."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "study.yaml")
        path.write_text(yaml.safe_dump(dict(study), allow_unicode=True, sort_keys=False), encoding="utf-8")
        command = [sys.executable, "-m", "tvimdesign", "run", str(path), "--no-cad", "--no-plots"]
        done = subprocess.run(
            [*command, "--out", str(Path(folder, "out"))], cwd=ROOT, capture_output=True, text=True, check=False
        )
        design = Path(folder, "out", "design.json")
        if not design.exists():
            raise RuntimeError(f"{study['name']}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
        return figures_of(design)


def figures_of(design: Path) -> dict[str, float | str]:
    """Return status and outputs (SI) of a design."""
    answer = json.loads(design.read_text(encoding="utf-8"))
    return {"status": answer["status"]} | {name: answer["values"].get(name, float("nan")) for name in OUTPUTS}


def read_figures() -> Figures:
    """Read the figures of the last runs, by case and step."""
    if not FIGURES.exists():
        return {}
    with FIGURES.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {
        (row["case"], row["step"]): {"status": row["status"], **{name: float(row[name]) for name in OUTPUTS}}
        for row in rows
    }


def write_figures(figures: Figures) -> None:
    """Write all figures, in the order of the cases and steps."""
    with FIGURES.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["case", "step", "status", *OUTPUTS])
        for case, about in cases().items():
            for step in about["steps"]:
                if found := figures.get((case, step["name"])):
                    numbers = [f"{found[name]:.6g}" for name in OUTPUTS]
                    writer.writerow([case, step["name"], found["status"], *numbers])


def tables(figures: Figures) -> Iterator[str]:
    """Yield a table for each case: a row a step, and the ratio of the last to the first."""
    heads = " | ".join(f"{word} [{unit}]" for unit, _, word in OUTPUTS.values())
    for case, about in cases().items():
        steps = [step["name"] for step in about["steps"]]
        if (case, steps[0]) not in figures or (case, steps[-1]) not in figures:
            continue  # not run
        yield f"### {about['title']}\n\n[`studies/{case}.yaml`](../studies/{case}.yaml)\n"
        lines = [f"| | {heads} |", "|---|" + "---|" * len(OUTPUTS)]
        found = [(step, figures[case, step]) for step in steps if (case, step) in figures]
        for index, (name, values) in enumerate(found):
            shown = " | ".join(_shown(float(values[key]) * scale) for key, (_, scale, _) in OUTPUTS.items())
            lines.append(f"| {'' if index == 0 else '+ '}{name} | {shown} |")
        first, last = found[0][1], found[-1][1]
        costs = " | ".join(f"× {float(last[key]) / float(first[key]):.2f}" for key in OUTPUTS)
        yield "\n".join([*lines, f"| **price** | {costs} |"]) + "\n"


def _shown(number: float) -> str:
    return f"{number:.0f}" if abs(number) >= 100.0 else f"{number:.3g}"


def write_page(figures: Figures) -> None:
    """Put the tables between the page's two marks; the words around them stay."""
    text = PAGE.read_text(encoding="utf-8")
    inside = "<!-- tables -->\n\n" + "\n".join(tables(figures)) + "\n<!-- end -->"
    PAGE.write_text(re.sub(r"<!-- tables -->.*<!-- end -->", lambda _: inside, text, flags=re.DOTALL), encoding="utf-8")


def _found(case: str, step: int, runs: Path | None) -> dict[str, float | str]:
    """Return the figures of a step, from an existing run, a shipped study or a new run."""
    there = runs / case / "design.json" if runs else None
    if there and there.exists() and step == len(cases()[case]["steps"]) - 1:
        return figures_of(there)
    return run(study_of(case, step))


def main(arguments: Sequence[str]) -> int:
    """Run the requested cases and write figures and page; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", help="one case")
    parser.add_argument("--step", help="one step")
    parser.add_argument("--runs", type=Path, help="folder of runs of the shipped studies")
    parser.add_argument("--table", action="store_true", help="no runs: the tables from the figures there are")
    asked = parser.parse_args(arguments)
    figures = read_figures()
    for case, about in ({} if asked.table else cases()).items():
        for index, name in enumerate(step["name"] for step in about["steps"]):
            if asked.only in (None, case) and asked.step in (None, name):
                figures[case, name] = _found(case, index, asked.runs)
                print(f"{case}, {name}: {figures[case, name]}", flush=True)
                write_figures(figures)
    write_page(figures)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
