"""The child process that makes the rigid bodies: `python -m tvimdesign.cad.jobs.bodies_main DESIGN OUT SECONDS`."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, TextIO

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.cad.jobs import main as build_main
from tvimdesign.study.design import Design, read_design

BODIES = "bodies.json"
"""Mass properties of both bodies, in SI."""
MESHES = "meshes"
BASE, MOVING = "base", "moving"
"""What stands with the housing, and what turns with the rotor."""


def run(design_path: Path, out: Path, _part_limit: float, lines: TextIO) -> None:
    """Write mass properties and meshes of both bodies; tells `lines` each step, then what the checks found."""

    def say(**message: Any) -> None:
        lines.write(json.dumps(message) + "\n")
        lines.flush()

    started = time.perf_counter()
    design = read_design(design_path)
    say(progress="loading the CAD kernel")
    from tvimdesign.cad.assembly.assembly import drawn_parts, place
    from tvimdesign.cad.geometry.dimensions import dimensions
    from tvimdesign.cad.inspection.size_checks import size_checks
    from tvimdesign.cad.jobs.rigid_bodies import body_stl, coarse_meshes

    dims = dimensions(design)
    drawn = drawn_parts(dims, lambda part: say(progress=part))
    placed = place(dims, drawn)
    checks = [asdict(check) for check in size_checks(design, placed)]
    say(progress="meshes")
    meshes, bodies = coarse_meshes(dims, drawn), names_of_bodies(placed)
    (out / MESHES).mkdir(exist_ok=True)
    for body, names in bodies.items():
        atomic_write(out / MESHES / f"{body}.stl", body_stl(meshes, placed, names))
    atomic_write(out / BODIES, (json.dumps(_weighed(design, placed, bodies), indent=2) + "\n").encode())
    files = [BODIES, *(f"{MESHES}/{body}.stl" for body in bodies)]
    say(checks=checks, files=files, notes=[], reused=[], seconds=time.perf_counter() - started)


def names_of_bodies(placed: Mapping[str, Any]) -> dict[str, list[str]]:
    """Return the names of the placed parts of each body: springs, pads and PCL stand with the housing."""
    from tvimdesign.cad.geometry.kinds import TURNING, kind_of

    turning = [name for name in placed if kind_of(name) in TURNING]
    return {BASE: [name for name in placed if name not in turning], MOVING: turning}


def _weighed(design: Design, placed: Mapping[str, Any], bodies: Mapping[str, list[str]]) -> dict[str, Any]:
    """Return mass properties of each body as plain data."""
    from tvimdesign.cad.geometry.kinds import KINDS, kind_of
    from tvimdesign.cad.jobs.rigid_bodies import of_solid, together

    return {
        body: together(of_solid(placed[name], design.value(KINDS[kind_of(name)].density)) for name in names).plain()
        for body, names in bodies.items()
    }


if __name__ == "__main__":
    sys.exit(build_main.main(sys.argv[1:], run))
