"""Measure the sentences of what users read: README, docs, the help of commands, and texts of warnings.

    python .ci/words/prose.py [--list]

Fails if a text's mean sentence has `MEAN` words or more, or a sentence has more than `LONGEST`. Code, tables, headings
and formulas are no sentences; `code` in a sentence is one word. `--list` prints the mean of each text.
"""

from __future__ import annotations

import argparse
import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from statistics import fmean

import yaml

ROOT = Path(__file__).parents[2]
MEAN, LONGEST = 18.0, 35
YAML_TEXTS = ("tvimdesign/report/run/blocks/warnings.yaml",)
_BLOCKS = re.compile(r"^(```|~~~).*?^\1[^\n]*$|^\$\$.*?\$\$|^---\n.*?^---$|<!--.*?-->", re.DOTALL | re.MULTILINE)
_END = re.compile(r"(?<=[.!?])[\"')*]*\s+(?=[\"'(*`\[]*[A-Z0-9])|(?<=:)\s*$")
_ABBREVIATIONS = re.compile(r"\b(e\.g|i\.e|Fig|Figs|eq|eqs|cf|No|vs|al|ch|sec|p|pp|Sect|ed|Dr)\.\s", re.IGNORECASE)


def sentences_of_markdown(text: str) -> Iterator[tuple[str, int]]:
    """Yield the sentences of a page, each with the line of the paragraph that it stands in."""
    text = _BLOCKS.sub(lambda match: "\n" * match[0].count("\n"), text)
    paragraph: list[str] = []
    began = 1
    for number, line in enumerate([*text.splitlines(), ""], start=1):
        bare = line.strip()
        if not bare or re.match(r"#|\||!\[|<|\$|!!!|={3,}|-{3,}", bare) or line.startswith(("    ", "\t")):
            yield from ((sentence, began) for sentence in sentences("\n".join(paragraph)))
            paragraph, began = [], number + 1
            continue
        if re.match(r"([-*+]|\d+\.)\s", bare):
            yield from ((sentence, began) for sentence in sentences("\n".join(paragraph)))
            paragraph, began = [], number
            bare = re.sub(r"^([-*+]|\d+\.)\s+", "", bare)
        paragraph.append(bare)


def sentences(text: str) -> Iterator[str]:
    """Yield the sentences of a paragraph."""
    text = re.sub(r"`[^`]+`", "Code", " ".join(text.split()))
    text = re.sub(r"\$[^$]+\$", "Formula", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = _ABBREVIATIONS.sub(lambda match: match[0].replace(".", ""), text)
    yield from (part for part in _END.split(text) if len(part.split()) > 2)


def texts() -> Iterator[tuple[str, list[tuple[str, int]]]]:
    """Yield each text's name with its sentences and their lines."""
    for path in sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]):
        yield str(path.relative_to(ROOT)), list(sentences_of_markdown(path.read_text(encoding="utf-8")))
    for path in sorted((ROOT / "tvimdesign/cli").glob("*.py")):
        yield str(path.relative_to(ROOT)), list(sentences_of_help(path))
    for name in YAML_TEXTS:
        data = yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))
        pairs = [(sentence, 1) for text in strings(data) for sentence in sentences(text)]
        yield name, pairs


def sentences_of_help(path: Path) -> Iterator[tuple[str, int]]:
    """Yield the sentences of the docstrings and of the `help` of options in a file of commands."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef) and (docstring := ast.get_docstring(node)):
            for paragraph in docstring.split("\n\n"):
                yield from ((sentence, node.lineno) for sentence in sentences(paragraph))
        if isinstance(node, ast.keyword) and node.arg == "help" and isinstance(node.value, ast.Constant):
            yield from ((sentence, node.value.lineno) for sentence in sentences(str(node.value.value)))


def strings(data: object) -> Iterator[str]:
    """Yield all texts for people within plain data: those of `say` and `text`."""
    if isinstance(data, dict):
        for key, value in data.items():
            if key in {"say", "text"} and isinstance(value, str):
                yield value
            else:
                yield from strings(value)


def main() -> int:
    """Report the means and the sentences that are too long; 1 if there are any."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="print the mean of each text")
    given = parser.parse_args()
    failed, every = False, list[int]()
    for name, pairs in texts():
        counts = [len(sentence.split()) for sentence, _ in pairs]
        every += counts
        for (sentence, line), count in zip(pairs, counts, strict=True):
            if count > LONGEST:
                failed = True
                print(f"{name}:{line}: {count} words, at most {LONGEST}: {sentence[:140]}")
        if counts and (given.list or fmean(counts) >= MEAN):
            print(f"{name}: mean {fmean(counts):.1f} words in {len(counts)} sentences")
            failed = failed or fmean(counts) >= MEAN
    print(f"prose: mean {fmean(every):.1f} words in {len(every)} sentences, the longest {max(every)}")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
