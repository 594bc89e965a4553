"""Opens the files of a module with programs that did not write them: a slicer, and another build of a CAD kernel.

Every 3MF and STL must be manifold as it is and slice; a plate with settings must be sliced into the layers it asks for.
Every STEP part must have the volume its own validation property states. Both programs are Debian's packages
`prusa-slicer` and `gmsh`; if one is missing, a line says so and the exit code is 3. The kernel in gmsh is OpenCASCADE
too, of another version and build: another kernel is in no package.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import trimesh

from tvimdesign.cad import make_cad
from tvimdesign.cad.export.print_files import SLICER_LAYERS
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study
from tvimdesign.study.design import read_design, write_design

ROOT = Path(__file__).resolve().parents[1]
STUDIES = ("elbow_printed", "wrist_compression")
WANTED = ("prusa-slicer", "gmsh")
VOLUME = re.compile(r"VOLUME_MEASURE\(\s*([0-9.E+-]+)\)")
SAME, MESH = 1e-6, 1e-4
"""How far volumes may be from each other, relative: of solids; of meshes, held in single precision."""
DIGIT = 1e-3  # Last digit of a height in the slicer's code [mm]


def main() -> int:
    """Make the files of each design and check them; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("designs", nargs="*", type=Path, help="their design.json; if none, two studies")
    missing = [name for name in WANTED if not shutil.which(name)]
    if missing:
        print(f"not installed: {', '.join(missing)}; on Debian: apt-get install {' '.join(missing)}")
        return 3
    designs = [read_design(path) for path in parser.parse_args().designs] or [
        answer(read_study(ROOT / f"studies/{name}.yaml")).design for name in STUDIES
    ]
    bad = 0
    for design in designs:
        with tempfile.TemporaryDirectory() as made:
            folder = Path(made) / "cad"
            report = make_cad(write_design(design, Path(made) / "design.json"), folder)
            print(f"{design.name}: {len(report.files)} files")
            for name in report.files:
                if name.startswith(("print/", "mesh/", "step/")):
                    problem = _kernel(folder / name) if name.endswith(".step") else _slicer(folder / name)
                    bad += bool(problem)
                    print(f"  {name:28} {problem or 'as written'}")
    print("all as written" if not bad else f"{bad} files are not read as they were written")
    return 1 if bad else 0


def _plate(path: Path) -> str:
    """Return which heights that a plate's layers must come to are none of the slicer's; nothing where all are."""
    with zipfile.ZipFile(path) as archive:
        if SLICER_LAYERS not in archive.namelist():
            return ""
        ends = {float(end) for end in re.findall(r'max_z="([0-9.]+)"', archive.read(SLICER_LAYERS).decode())}
    with tempfile.TemporaryDirectory() as folder:
        code = Path(folder) / "plate.gcode"
        _run(["prusa-slicer", "--export-gcode", "--output", str(code), str(path)])
        heights = [float(height) for height in re.findall(r"^G1 Z([0-9.]+)", code.read_text(), re.MULTILINE)]
    missed = sorted(end for end in ends if min(abs(height - end) for height in heights) > DIGIT)
    return f"no layer ends at {missed} mm" if missed else ""


def _slicer(path: Path) -> str:
    """Return why a mesh does not slice as it is; nothing where it does."""
    if path.name.startswith("plate_"):
        return _plate(path)
    reported = _run(["prusa-slicer", "--info", str(path)])
    facts = dict(line.split(" = ") for line in reported.splitlines() if " = " in line)
    if facts.get("manifold", "").strip() != "yes":
        return f"not manifold: {reported.strip().splitlines()[-1:]}"
    if any("repair" in name or "fixed" in name or "reversed" in name for name in facts):
        return "was repaired when read"
    volume, ours = float(facts["volume"]), trimesh.load_mesh(path.with_suffix(".stl")).volume
    if abs(volume / ours - 1.0) > MESH:
        return f"{volume} mm3, written as {ours}"
    if path.parent.name != "print":
        return ""
    with tempfile.TemporaryDirectory() as folder:
        code = Path(folder) / "part.gcode"
        how = ["--export-gcode", "--layer-height", "0.2", "--support-material", "--output", str(code)]
        _run(["prusa-slicer", *how, str(path)])
        return "" if code.exists() and code.stat().st_size > 1000 else "does not slice"


def _kernel(path: Path) -> str:
    """Return why another kernel reads another part; nothing where it reads the same volume."""
    script = (
        f'SetFactory("OpenCASCADE");\nv() = ShapeFromFile("{path.resolve()}");\n'
        'Printf("solids %g", #v());\nPrintf("volume %.12g", Mass Volume{v(0)});\n'
    )
    with tempfile.NamedTemporaryFile("w", suffix=".geo") as file:
        file.write(script)
        file.flush()
        reported = _run(["gmsh", "-", file.name])
    solids, volume = (re.search(rf"^{word} ([0-9.e+-]+)\s*$", reported, re.MULTILINE) for word in ("solids", "volume"))
    stated = VOLUME.search(re.sub(r"\n\s*", "", path.read_text()))
    if not solids or not volume or not stated:
        return "cannot be read"
    if float(solids[1]) != 1 or abs(float(volume[1]) / float(stated[1]) - 1.0) > SAME:
        return f"{solids[1]} solids, {volume[1]} mm3; the file says {stated[1]}"
    return ""


def _run(command: list[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True, timeout=300.0, check=False)
    return done.stdout + done.stderr


if __name__ == "__main__":
    sys.exit(main())
