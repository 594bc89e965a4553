"""Exports the parts of a design for FE, and runs the solvers beside this process, two at once."""

import json
import os
import shutil
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tvimdesign.base.errors import InputError, SimulationError
from tvimdesign.base.processes import CommandGroup, ProcessorTimeError
from tvimdesign.study import Design

SOLVERS = Path(__file__).with_name("solvers")
COARSER = 1.6  # How much larger the elements of the second mesh are, by which the first is judged
PROCESSOR_LIMIT = 1800.0  # Processor time [s] after which a solver is stopped: ten times that of the slowest
_TO_IMPORT = 120.0  # s of processor time
AT_ONCE = 2


@dataclass(frozen=True)
class Solved:
    """Results of a solver for some parts."""

    fine: dict[str, float]  # By the names in its file; stiffness in N*m/rad, stress in MPa at one newton metre
    coarse: dict[str, float]  # Values on the coarser mesh
    field: Path  # Surface and its stress: `points`, `triangles`, `values`, `ways`

    def write_picture(self, path: Path, title: str) -> None:
        """Write the picture of the field as PNG."""
        from tvimdesign.cad.render.render import write_field_picture

        with np.load(self.field) as field:
            points, triangles, values, ways = (field[part] for part in ("points", "triangles", "values", "ways"))
        write_field_picture(path, points, triangles, values, ways, title)


def require_fe(python: str) -> None:
    """Raise InputError where an interpreter has no netgen and ngsolve, with what to do."""
    if shutil.which(python) is None:
        raise InputError(f"--fe-python {python}: there is no such program; name a Python that has ngsolve")
    try:
        with CommandGroup() as commands:
            tried = commands.run([python, "-c", "import netgen.occ, ngsolve"], _TO_IMPORT)
    except ProcessorTimeError as error:
        raise InputError(f"verify: {python} cannot import ngsolve: {error}; name another Python") from error
    if tried.returncode:
        raise InputError(
            f"verify: {python} cannot import netgen and ngsolve; pip install 'tvimdesign[fe]', or name a Python that "
            "has them: --fe-python PATH"
        )


def run_solvers(
    names: Sequence[str], parts: Path, work: Path, python: str, progress: Callable[[str], None]
) -> dict[str, Solved]:
    """Solve the parts of a folder on two meshes by each solver; files go into `work`. Raises SimulationError."""

    def run(name: str, coarser: float) -> dict[str, float]:
        mesh = "fine" if coarser == 1.0 else "coarse"
        to = work / f"{name}_{mesh}.json"
        command = [python, SOLVERS / f"{name}.py", parts, to, "--coarser", f"{coarser}"]
        command += ["--field", work / f"{name}.npz"] if coarser == 1.0 else []
        progress(f"solving the {name} on a {mesh} mesh")
        _run(commands, [str(word) for word in command], f"{name}, {mesh} mesh")
        results: dict[str, float] = json.loads(to.read_text(encoding="utf-8"))
        return results

    # The longest first: the two of a pair then end at about the same time.
    # If one fails, or an interrupt comes, the commands are stopped before the executor waits for them.
    with ThreadPoolExecutor(AT_ONCE) as executor, CommandGroup() as commands:
        futures = {(name, coarser): executor.submit(run, name, coarser) for coarser in (1.0, COARSER) for name in names}
        results = {key: future.result() for key, future in futures.items()}
    return {name: Solved(results[name, 1.0], results[name, COARSER], work / f"{name}.npz") for name in names}


def _run(commands: CommandGroup, command: list[str], about: str) -> None:
    alone = {**os.environ, "OMP_NUM_THREADS": "1", "NGS_NUM_THREADS": "1"}
    try:
        done = commands.run(command, PROCESSOR_LIMIT, env=alone)
    except ProcessorTimeError as error:
        raise SimulationError(f"verify: {about}: {error}") from error
    if done.returncode or "NOT ALL FACES" in done.stdout:
        last = (done.stderr.strip() or done.stdout.strip() or "it said nothing").splitlines()[-1]
        raise SimulationError(f"verify: {about}: {last}")


def export_parts(design: Design, folder: Path) -> None:
    """Write housing, rotor, link, all pads and PCL, one spring, and `inputs.json`: sizes in mm, values in SI.

    Of a base that is clamped below the housing the feet bear, as in the model: the housing has these in one piece.
    """
    import cadquery as cq

    from tvimdesign.cad.assembly.assembly import MODULES
    from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
    from tvimdesign.cad.geometry.spring_solids import installed_coil, spring_solid

    folder.mkdir(parents=True, exist_ok=True)
    dims, module = dimensions(design), MODULES[design.mode]
    dims = Dimensions(dims.mode, {**dims.by_name, "base_height": 0.0, "base_sill": 0.0})
    kinds = (*module.made, *(["spreader"] if dims.spreader_depth else []))
    drawn = {kind: module.drawn(dims)[kind](dims) for kind in kinds}
    shapes = {kind: drawn[kind] for kind in ("housing", "rotor", "link")}
    shapes |= module.stand_heaters(dims, drawn, 0.0)
    shapes["spring"] = spring_solid(installed_coil(dims))
    for name, shape in shapes.items():
        cq.exporters.export(cq.Workplane(shape), str(folder / f"{name}.step"))
    coil = installed_coil(dims)
    numbers = {"mode": design.mode, "name": design.name, "values": design.values, "mm": dict(dims.by_name),
               "coil": {"turns": coil.turns, "diameter": coil.diameter, "leg_azimuth": coil.leg_azimuth,
                        "end_level": coil.end_level, "start_level": coil.start_level}}  # fmt: skip
    (folder / "inputs.json").write_text(json.dumps(numbers, indent=1))
