"""Studies, settings on the command line, sweeps, and the records that studies name."""

from __future__ import annotations

import json
import random
from functools import cache
from pathlib import Path

import yaml

from fuzzing.kind import ROOT, Drawn, Kind
from fuzzing.mutations import ODD, encoded, mutated_data, mutated_text, paths
from tvimdesign.catalog import Catalog
from tvimdesign.solve.nlp.constraints import refuse_impossible
from tvimdesign.study import read_study, read_tree
from tvimdesign.study.tree import tree_of_file
from tvimdesign.sweep.plan import plan_of

BASE = ROOT / "tests/studies/paper_shear.yaml"
RECORDS = ROOT / "tvimdesign/catalog/data"
_FAST = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_NAMES = ["pcl_thickness", "require.holding_torque", "vary.current", "solver.starts", "operating_points.hot", "motor"]
_LIKELY = ["1 mm", ">= 5 N.m", "[1 A, 2 A]", "{from: 1, to: 2}", "[0.6 mm, 2 mm]", ">= 9 N.m", "3", "none"]
_SWEEPS = [
    "over: {pcl_thickness: {from: 0.6 mm, to: 2 mm, count: 12}, wire_diameter: [2 mm, 2.4 mm]}\n",
    "over:\n  current: {from: 0.5 A, to: 8 A, count: 5, spacing: logarithmic}\n  spring_wire: [music_wire]\n",
    "method: sobol\ncount: 5\nseed: 9\nover:\n  current: {from: 1 A, to: 2 A}\n  pcl_thickness: [0.6 mm, 2 mm]\n",
    "method: latin_hypercube\ncount: 8\nover: {require.holding_torque: ['>= 5 N.m']}\noutputs: [module_mass]\n",
    "method: list\nover: {current: [1 A, 2 A], pcl_thickness: [1 mm, 2 mm]}\ntask: evaluate\n",
]


@cache
def _texts() -> list[str]:
    return [path.read_text(encoding="utf-8") for path in sorted((ROOT / "studies").glob("*.yaml"))]


def _study(draw: random.Random) -> Drawn:
    return Drawn("input.yaml", mutated_text(draw.choice(_texts()), draw))


def _settings(draw: random.Random) -> Drawn:
    odd = [str(odd_value) for odd_value in ODD]
    names, values = _NAMES if draw.random() < 0.8 else odd, _LIKELY if draw.random() < 0.5 else odd
    chosen = [f"{draw.choice(names)}={draw.choice(values)}" for _ in range(draw.choice((1, 1, 3)))]
    data = [mutated_text(text, draw).decode("utf-8", "replace") if draw.random() < 0.5 else text for text in chosen]
    return Drawn("input.json", json.dumps(data).encode())


def _use_settings(path: Path) -> None:
    read_tree(tree_of_file(BASE, json.loads(path.read_bytes())))


def _sweep(draw: random.Random) -> Drawn:
    block = mutated_text(draw.choice(_SWEEPS), draw).decode("utf-8", "replace")
    text = draw.choice(
        ("mode: shear\n", "mode: compression\n", "mode: shear\nvary: {current: [1 A, 2 A]}\nminimize: module_mass\n")
    )
    return Drawn("input.yaml", encoded(text + "sweep:\n" + "".join(f"  {line}\n" for line in block.split("\n"))))


def _use_sweep(path: Path) -> None:
    """Do what `sweep` does before its first cell; return the texts of its first and last cell."""
    plan = plan_of(tree_of_file(path))
    plan.texts(0)
    plan.texts(plan.count - 1)


@cache
def _records() -> list[tuple[str, str, str, list[tuple[object, ...]]]]:
    """Path within the catalogue, text, the same as JSON, and its places, of every record."""
    records = []
    for path in sorted(RECORDS.rglob("*.yaml")):
        text = path.read_text(encoding="utf-8")
        plain = yaml.load(text, Loader=_FAST)
        records.append((path.relative_to(RECORDS).as_posix(), text, json.dumps(plain, default=str), list(paths(plain))))
    return records


def _record(draw: random.Random) -> Drawn:
    name, text, as_json, places = draw.choice(_records())
    if draw.random() < 0.5:  # JSON is YAML
        text = json.dumps(mutated_data(as_json, places, draw), indent=draw.choice((None, 1)), ensure_ascii=False)
    return Drawn(name, mutated_text(text, draw) if draw.random() < 0.8 else encoded(text))


def _use_record(path: Path) -> None:
    Catalog(path.parent.parent).record(path.parent.name, path.stem)


STUDIES = Kind(_study, lambda path: refuse_impossible(read_study(path)))
SETTINGS = Kind(_settings, _use_settings)
SWEEPS = Kind(_sweep, _use_sweep)
RECORD_FILES = Kind(_record, _use_record)
