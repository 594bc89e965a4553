"""Runs the code of docs/python.md in order, and writes what each line prints behind its `# ->`."""

import ast
import re
import tempfile
from contextlib import chdir, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/python.md"
_BLOCK = re.compile(r"(?<=^```python\n).*?(?=^```)", re.M | re.S)


def executed(page: str, folder: Path) -> tuple[str, dict[str, Any]]:
    """Return the page with the numbers that its code prints now, and the names that the code leaves.

    Parameters
    ----------
    page : str
        Text of the page.
    folder : Path
        Empty folder that the code runs in; it gets the studies and the measured data that the page names.
    """
    (folder / "studies").symlink_to(ROOT / "studies")
    measured = (ROOT / "docs/how-to/measure.md").read_text(encoding="utf-8")
    (folder / "weights.csv").write_text(measured.partition('title="weights.csv"\n')[2].partition("```")[0])
    names: dict[str, Any] = {}
    with chdir(folder):
        return _BLOCK.sub(lambda block: _with_output(block[0], names), page), names


def _with_output(code: str, names: dict[str, Any]) -> str:
    """Execute a block statement by statement; return it with what each prints."""
    lines = code.splitlines()
    for statement in ast.parse(code).body:
        printed = StringIO()
        with redirect_stdout(printed):
            exec(compile(ast.Module([statement], []), "docs/python.md", "exec"), names)
        for place in range(statement.lineno - 1, statement.end_lineno or 0):
            before, mark, _ = lines[place].partition("# ->")
            if mark:
                lines[place] = f"{before}# -> {printed.getvalue().strip()}"
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        now, _ = executed(PAGE.read_text(encoding="utf-8"), Path(folder))
    PAGE.write_text(now, encoding="utf-8")
