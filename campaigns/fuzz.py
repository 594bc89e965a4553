"""Hands in mutated studies, settings, records and designs: each is read, or refused in words within two seconds.

    python campaigns/fuzz.py [--inputs 2000] [--seed 1] [--kinds studies settings records designs] [--json FILE]

An input that ends in anything but an error of this package, takes longer than two seconds or leaves a file behind is a
failure; it is printed, and kept in campaigns/corpus/, whose files are tried first by the next campaign.
"""

from __future__ import annotations

import argparse
import copy
import hashlib
import json
import os
import random
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import yaml

from tvimdesign.base.errors import RenamedWarning, TvimError
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.catalog import Catalog
from tvimdesign.simulation.working_cycle.resolved_module import resolve_design
from tvimdesign.solve.nlp.constraints import refuse_impossible
from tvimdesign.study import read_study, read_tree
from tvimdesign.study.design import read_design
from tvimdesign.study.result_study import result_text
from tvimdesign.study.tree import tree_of_file

ROOT = Path(__file__).resolve().parents[1]
CORPUS = Path(__file__).with_name("corpus")
SLOW = 2.0  # s
ODD: list[Any] = [
    None, True, 0, -1, 1e308, 1e-320, 10**400, "", "x", "nan", "inf", "-0", "1,5 mm", "1e999 mm", "0 mm", "1 K", "N.m",
    [], {}, [1], {"a": 1}, [["x"]], "[/bold]", "../../etc/passwd", "\u202e", "\ud800", "a\x00b", "!!python/none", "*a",
    "&a [*a]", "shear", "compression", "music_wire", ">= 5", "<= nan", ">= 1 N.m", "{choose: []}", "9" * 5000, "mm",
    "1 mm mm", "%", "5 %", "$(touch x)", "`id`", "https://example.org", "\u00b5m", "1 \u2126", "true", "~", "1_000",
    "é" * 300,
]  # fmt: skip
LETTERS = "{}[]:,-#&*!|>'\"%@`~\t\n 0123456789eE.mKNré\x00\x07\ufeff"
Try = Callable[[Path], None]


def mutated_text(text: str, draw: random.Random) -> bytes:
    """A text with some letters, words or lines changed, or cut somewhere; not always UTF-8."""
    for _ in range(draw.choice((1, 1, 1, 2, 5))):
        lines, place = text.split("\n"), draw.randrange(len(text) + 1)
        row = draw.randrange(len(lines))
        change = draw.randrange(7)
        if change == 0:
            text = text[:place] + draw.choice(LETTERS) + text[place + draw.randrange(2) :]
        elif change == 1:
            text = "\n".join(lines[:row] + lines[row + 1 :])
        elif change == 2:
            text = "\n".join([*lines[:row], lines[row], lines[draw.randrange(len(lines))], *lines[row + 1 :]])
        elif change == 3:
            head, colon, _ = lines[row].partition(":")
            text = "\n".join([*lines[:row], f"{head}{colon} {draw.choice(ODD)}", *lines[row + 1 :]])
        elif change == 4:
            words = lines[row].split(" ")
            words[draw.randrange(len(words))] = str(draw.choice(ODD))
            text = "\n".join([*lines[:row], " ".join(words), *lines[row + 1 :]])
        elif change == 5:
            text = "\n".join([*lines[:row], "  " * draw.randrange(3) + lines[row], *lines[row + 1 :]])
        else:
            text = text[:place]
    data = text.encode("utf-8", "surrogatepass")
    return data if draw.random() < 0.98 else data.replace(b"e", bytes([draw.randrange(256)]), 1)


def paths(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every place in plain data but the whole."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield (*path, key)
        yield from paths(value, (*path, key))


def mutated_data(plain: Any, places: list[tuple[Any, ...]], draw: random.Random) -> Any:
    """Plain data with a value or two changed, renamed or taken away."""
    changed = copy.deepcopy(plain)
    for _ in range(draw.choice((1, 1, 2, 4))):
        path, node = draw.choice(places), changed
        try:
            for one in path[:-1]:
                node = node[one]
            kind = draw.random()
            if kind < 0.25:
                del node[path[-1]]
            elif kind < 0.4 and isinstance(node, dict):
                node[str(draw.choice(ODD))] = node.pop(path[-1])
            else:
                node[path[-1]] = copy.deepcopy(draw.choice(ODD))
        except (KeyError, IndexError, TypeError):  # an earlier change took the place away
            continue
    return changed


def studies(draw: random.Random) -> Callable[[Path], Try]:
    """Mutated texts of the shipped studies; those that are read are looked at as `check` first does."""
    texts = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "studies").glob("*.yaml"))]

    def write(folder: Path) -> Try:
        (folder / "input.yaml").write_bytes(mutated_text(draw.choice(texts), draw))
        return lambda folder: refuse_impossible(read_study(folder / "input.yaml"))

    return write


def settings(draw: random.Random) -> Callable[[Path], Try]:
    """Mutated `--set NAME=VALUE` on a shipped study; the file holds the settings."""
    names = [
        "pcl_thickness",
        "require.holding_torque",
        "vary.current",
        "solver.starts",
        "operating_points.hot",
        "motor",
    ]
    values = ["1 mm", ">= 5 N.m", "[1 A, 2 A]", "{from: 1, to: 2}", *(str(odd) for odd in ODD)]

    def write(folder: Path) -> Try:
        chosen = [
            f"{draw.choice([*names, *map(str, ODD)])}={draw.choice(values)}" for _ in range(draw.choice((1, 1, 3)))
        ]
        data = [mutated_text(one, draw).decode("utf-8", "replace") for one in chosen]
        (folder / "input.json").write_text(json.dumps(data))
        study = ROOT / "studies/paper_shear.yaml"
        return lambda folder: read_tree(tree_of_file(study, json.loads((folder / "input.json").read_text()))) and None

    return write


def records(draw: random.Random) -> Callable[[Path], Try]:
    """Mutated records of the catalogue in a folder of a user's own."""
    data = ROOT / "tvimdesign/catalog/data"
    files = sorted(data.rglob("*.yaml"))

    def write(folder: Path) -> Try:
        source = draw.choice(files)
        text = source.read_text(encoding="utf-8")
        if draw.random() < 0.5:
            plain = yaml.safe_load(text)
            text = yaml.safe_dump(mutated_data(plain, list(paths(plain)), draw), allow_unicode=True)
        own = folder / source.parent.relative_to(data)
        own.mkdir(parents=True)
        (own / source.name).write_bytes(mutated_text(text, draw))
        return lambda folder: Catalog(folder).record(own.name, source.stem) and None

    return write


def designs(draw: random.Random) -> Callable[[Path], Try]:
    """Mutated designs: resolved for tests, turned into dimensions for parts and into a study."""
    plains = [json.loads(path.read_text()) for path in sorted((ROOT / "cad").glob("*/design.json"))]
    every = [[path for path in paths(plain) if path[0] != "solution"] for plain in plains]
    few = [[path for path in one if path[0] != "values"] for one in every]

    def write(folder: Path) -> Try:
        number = draw.randrange(len(plains))
        places = (every if draw.random() < 0.3 else few)[number]
        text = json.dumps(mutated_data(plains[number], places, draw), indent=draw.choice((None, 2)))
        data = text.encode() if draw.random() < 0.8 else mutated_text(text, draw)
        (folder / "input.json").write_bytes(data)
        return use_design

    return write


def use_design(folder: Path) -> None:
    """What `simulate`, `cad` and `new --from` do first with a design."""
    design = read_design(folder / "input.json")
    resolve_design(design)
    dimensions(design)
    result_text(design, "input.json", folder)


KINDS = {"studies": studies, "settings": settings, "records": records, "designs": designs}


def fault_of(use: Try, folder: Path) -> str:
    """What is wrong with how an input is taken; empty where nothing is."""
    before, began = set(folder.rglob("*")), time.monotonic()
    try:
        use(folder)
    except TvimError as error:
        if not str(error).strip():
            return "an error without words"
    except Exception as error:  # what is looked for
        last = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__} in {Path(last.filename).name}:{last.name}: {str(error)[:120]!r}"
    if time.monotonic() - began > SLOW:
        return f"{time.monotonic() - began:.1f} s"
    left = set(folder.rglob("*")) - before
    return f"leaves {', '.join(path.name for path in left)}" if left else ""


def campaign(kind: str, inputs: int, seed: int) -> Counter[str]:
    """So many inputs of a kind: how many, how many faults, and the distinct ones printed."""
    write, count, told = KINDS[kind](random.Random(f"{kind} {seed}")), Counter[str](), set[str]()
    with tempfile.TemporaryDirectory(prefix="fuzz-") as place:
        os.chdir(place)
        for number in range(inputs):
            folder = Path(place) / str(number)
            folder.mkdir()
            use = write(folder)
            fault = fault_of(use, folder)
            count["inputs"] += 1
            count["failures"] += bool(fault)
            if fault and fault.partition(":")[0] not in told:
                told.add(fault.partition(":")[0])
                print(f"{kind} {number}: {fault}; kept as {kept(folder, kind)}", flush=True)
            for path in sorted(folder.rglob("*"), reverse=True):
                path.rmdir() if path.is_dir() else path.unlink()
            folder.rmdir()
        if strangers := list(Path(place).iterdir()):
            count["failures"] += 1
            print(f"{kind}: left behind {strangers}")
        os.chdir(ROOT)
    return count


def kept(folder: Path, kind: str) -> str:
    """Keep an input in the corpus, by its hash."""
    source = next(path for path in sorted(folder.rglob("*")) if path.is_file())
    CORPUS.mkdir(exist_ok=True)
    data = source.read_bytes()
    kept_as = CORPUS / f"{kind}-{hashlib.sha256(data).hexdigest()[:12]}{source.suffix}"
    kept_as.write_bytes(data)
    return kept_as.name


def known_failures() -> list[str]:
    """The inputs that failed in an earlier campaign and still do."""
    uses: dict[str, Try] = {
        "studies": lambda folder: refuse_impossible(read_study(folder / "input.yaml")),
        "designs": use_design,
        "settings": lambda folder: read_tree(
            tree_of_file(ROOT / "studies/paper_shear.yaml", json.loads((folder / "input.json").read_text()))
        ) and None,
    }  # fmt: skip
    found = []
    for path in sorted(CORPUS.glob("*-*")):
        use = uses.get(path.name.partition("-")[0])
        with tempfile.TemporaryDirectory(prefix="fuzz-") as place:
            (Path(place) / f"input{path.suffix}").write_bytes(path.read_bytes())
            if use and (fault := fault_of(use, Path(place))):
                found.append(f"{path.name}: {fault}")
    return found


def main() -> int:
    """Run the campaign; 1 where an input failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--inputs", type=int, default=2000, help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--json", type=Path, help="file for the figures")
    asked = parser.parse_args()
    warnings.simplefilter("ignore", RenamedWarning)
    known = known_failures()
    print(*known, sep="\n", end="\n" * bool(known))
    told, place = {}, Path.cwd()
    for kind in asked.kinds:
        began = time.monotonic()
        count = campaign(kind, asked.inputs, asked.seed)
        told[kind] = dict(count)
        print(f"{kind}: {dict(count)} in {time.monotonic() - began:.0f} s", flush=True)
    if asked.json:
        (place / asked.json).write_text(json.dumps(told, indent=2) + "\n")
    return int(bool(known) or any(count.get("failures") for count in told.values()))


if __name__ == "__main__":
    sys.exit(main())
