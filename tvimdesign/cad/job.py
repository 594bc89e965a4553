"""The child process that makes the parts: `python -m tvimdesign.cad.job DESIGN OUT`, a line of JSON for each step.

It runs on its own because a boolean operation of the CAD kernel can hang or crash, and a process can be ended.
"""

from __future__ import annotations

import json
import os
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any, TextIO

from tvimdesign.errors import TvimError
from tvimdesign.study.design import read_design


def run(design_path: Path, out: Path, lines: TextIO) -> None:
    """Build, check and write; tells `lines` each step, then the report, then the picture or why there is none."""

    def say(**message: Any) -> None:
        lines.write(json.dumps(message) + "\n")
        lines.flush()

    def progress(step: str) -> None:
        say(progress=step)

    started = time.perf_counter()
    design = read_design(design_path)
    progress("loading the CAD kernel")
    from tvimdesign.cad.assembly import drawn_parts, place
    from tvimdesign.cad.checks import all_checks
    from tvimdesign.cad.dimensions import dimensions
    from tvimdesign.cad.export import export, instances

    dims = dimensions(design)
    drawn = drawn_parts(dims, progress)
    checks = [asdict(check) for check in all_checks(design, dims, drawn, progress)]
    files, meshes = export(design, dims, drawn, out, progress)
    checks += [asdict(check) for check in meshes]
    say(checks=checks, files=files, seconds=time.perf_counter() - started)
    # The picture comes last: where the graphics driver takes the process with it, the parts are there.
    progress("drawing the picture")
    from tvimdesign.cad.preview import write_preview

    write_preview(out / "preview.png", dims, drawn, instances(dims, drawn, place(dims, drawn)))
    say(picture="preview.png", seconds=time.perf_counter() - started)


def main(arguments: list[str]) -> int:
    """Run the job; returns the exit code. An error is a line of JSON too."""
    # The kernel prints to standard output from C++; the parent reads only what is written to this copy of it.
    lines = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    try:
        design_path, out = (Path(argument) for argument in arguments)
        run(design_path, out, lines)
    except TvimError as error:
        lines.write(json.dumps({"error": str(error), "code": error.exit_code}) + "\n")
        return error.exit_code
    finally:
        lines.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
