"""Count private words in names, messages, docstrings and docs, and fail if a floor has more than its allowance.

    python .ci/words/words.py [--list FLOOR] [--update]

`words.yaml` lists the words and what to write instead; `allowed.json` holds the counts of each floor. `--list` prints
every find of a floor, such as tvimdesign/study. `--update` lowers the allowances to the counts of now; it raises none.
"""

from __future__ import annotations

import argparse
import ast
import io
import json
import re
import subprocess
import sys
import tokenize
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import yaml

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
ALLOWED = HERE / "allowed.json"
RULES: dict[str, Any] = yaml.safe_load((HERE / "words.yaml").read_text(encoding="utf-8"))
PHRASES = [(re.compile(pattern, re.IGNORECASE), instead) for pattern, instead in RULES["phrases"].items()]
CODE = ("tvimdesign", "tests", "campaigns", "benchmarks", "validation", "docs/make", "release", ".ci")
PLAIN = ("*.js", "*.jinja", "*.yaml")
"""Other files with texts for people: the page's code and templates, labels, warnings."""
FEWEST_WORDS = 3
"""A text of fewer words is no message."""
Function = ast.FunctionDef | ast.AsyncFunctionDef


class Find(NamedTuple):
    """A private word: its kind, where it stands, and what to write instead."""

    kind: str
    line: int
    text: str
    instead: str


def in_code(source: str) -> Iterator[Find]:
    """Yield what a module's names, messages, docstrings and comments have."""
    tree, docstrings = ast.parse(source), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | Function):
            first = node.body[0] if node.body else None
            if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
                docstrings.add(first.value)
                yield from in_docstring(node, str(first.value.value), first.lineno)
        for name in names_of(node):
            yield from in_name(name, getattr(node, "lineno", 0))
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in docstrings:
            yield from in_text("message", node.value, node.lineno)
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield from in_text("message", token.string.lstrip("# "), token.start[0])


def names_of(node: ast.AST) -> Iterator[str]:
    """Yield the names that a node defines."""
    match node:
        case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
            yield node.name
        case ast.arg():
            yield node.arg
        case ast.Name(ctx=ast.Store()):
            yield node.id
        case ast.Attribute(ctx=ast.Store()):
            yield node.attr


def in_name(name: str, line: int) -> Iterator[Find]:
    """Yield the private words of a name."""
    plain = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower().strip("_")
    if plain in RULES["names"]:
        yield Find("name", line, name, RULES["names"][plain])
    for part, instead in RULES["parts"].items():
        if plain != part and f"_{part}_" in f"_{plain}_":
            yield Find("name", line, name, instead)
    if name.startswith("test_") and len(name) > RULES["longest_test_name"]:
        yield Find("long test name", line, name, f"at most {RULES['longest_test_name']} letters")


def in_docstring(node: ast.AST, text: str, line: int) -> Iterator[Find]:
    """Yield a start that is no description, and the private words."""
    starts = list(RULES["docstring_starts"])
    if isinstance(node, Function) and not is_described_thing(node):
        starts += RULES["function_starts"]
    for start in starts:
        if re.match(rf"{start}\b", text.strip()):
            yield Find("docstring", line, text.strip().splitlines()[0], "a verb first, for a class or module a noun")
            break
    yield from in_text("message", text, line)


def is_described_thing(node: Function) -> bool:
    """Return whether a function is a quantity of the module or a property."""
    properties = {"property", "cached_property"}
    return [argument.arg for argument in node.args.args] == ["m"] or any(
        isinstance(decorator, ast.Name) and decorator.id in properties for decorator in node.decorator_list
    )


def in_text(kind: str, text: str, line: int) -> Iterator[Find]:
    """Yield the private phrases of a text."""
    if len(text.split()) < FEWEST_WORDS:
        return
    for pattern, instead in PHRASES:
        for match in pattern.finditer(text):
            yield Find(kind, line + text.count("\n", 0, match.start()), match[0], instead)


def floors() -> dict[str, dict[Path, list[Find]]]:
    """Return all finds by floor and file."""
    finds: dict[str, dict[Path, list[Find]]] = defaultdict(dict)
    for path in sorted(path for folder in CODE for path in (ROOT / folder).rglob("*.py")):
        finds[floor_of(path)][path] = list(in_code(path.read_text(encoding="utf-8")))
    for path in sorted(path for pattern in PLAIN for path in (ROOT / "tvimdesign").rglob(pattern)):
        if "vendor" not in path.parts:
            finds[floor_of(path)][path] = list(in_text("message", path.read_text(encoding="utf-8"), 1))
    for path in sorted([*(ROOT / "docs").rglob("*.md"), ROOT / "README.md", ROOT / "CHANGELOG.md"]):
        finds["docs"][path] = list(in_text("docs", path.read_text(encoding="utf-8"), 1))
    return finds


def floor_of(path: Path) -> str:
    """Return the folder that a file is counted with."""
    parts = path.relative_to(ROOT).parts
    return "/".join(parts[: 2 if parts[0] in {"tvimdesign", "tests"} and len(parts) > 2 else 1])


def counts_of(files: Iterable[list[Find]]) -> dict[str, int]:
    """Return how many finds of each kind there are."""
    return dict(sorted(Counter(find.kind for finds in files for find in finds).items()))


def changed_files() -> set[Path]:
    """Return the files that differ from the last commit, or else those of the last commit."""
    for versions in (["HEAD"], ["HEAD~1", "HEAD"]):
        command = ["git", "-C", str(ROOT), "diff", "--name-only", *versions]
        names = subprocess.run(command, capture_output=True, text=True, check=False).stdout.split()
        if names:
            return {ROOT / name for name in names}
    return set()


def write_allowed(counts: dict[str, dict[str, int]]) -> None:
    """Write the allowances, without those of nothing."""
    lines = [f"{json.dumps(floor)}: {json.dumps(kinds)}" for floor, kinds in counts.items() if any(kinds.values())]
    ALLOWED.write_text("{\n" + ",\n".join(lines) + "\n}\n")


def show(files: dict[Path, list[Find]], kinds: Iterable[str]) -> None:
    """Print the finds of some kinds."""
    for path, finds in files.items():
        for find in finds:
            if find.kind in kinds:
                print(f"{path.relative_to(ROOT)}:{find.line}: {find.kind}: {find.text!r}; write: {find.instead}")


def main() -> int:
    """Compare the counts with the allowances; 1 if a floor has more."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", metavar="FLOOR", help="print every find of a floor")
    parser.add_argument("--update", action="store_true", help="lower the allowances to the counts of now")
    given = parser.parse_args()
    finds = floors()
    if given.list:
        files = finds.get(given.list, {})
        show(files, {find.kind for of_file in files.values() for find in of_file})
        return 0
    counts = {floor: counts_of(files.values()) for floor, files in finds.items()}
    allowed: dict[str, dict[str, int]] = json.loads(ALLOWED.read_text()) if ALLOWED.exists() else counts
    failed, changed = False, changed_files()
    for floor, of_floor in counts.items():
        limits = allowed.get(floor, {})
        more = {kind: count for kind, count in of_floor.items() if count > limits.get(kind, 0)}
        if more:
            failed = True
            show({path: of_file for path, of_file in finds[floor].items() if path in changed} or finds[floor], more)
            excess = ", ".join(f"{count} x {kind}, allowed {limits.get(kind, 0)}" for kind, count in more.items())
            print(f"{floor}: {excess}")
    if given.update or not ALLOWED.exists():
        write_allowed({
            floor: {kind: min(count, limits.get(kind, 0)) for kind, count in counts[floor].items()}
            for floor, limits in allowed.items() if floor in counts
        })  # fmt: skip
    total = Counter[str]()
    for of_floor in counts.values():
        total.update(of_floor)
    print("private words: " + ", ".join(f"{count} x {kind}" for kind, count in sorted(total.items())))
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
