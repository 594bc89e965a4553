"""The complete set of a module's files, against plain calls of the CAD kernel for the same solids, meshes and files.

The plain row is what one would write with CadQuery: the same solids, STEP by the kernel's own writer, STL and GLB of
the kernel's own triangles (of the springs, too), hidden-line views to DXF and PDF, the same three pictures. It names,
checks and keeps nothing, and runs in one process. Processor time is compared, child processes included, the least of
some runs in turn; the wall time beside it is this machine's, with all else that it does.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tvimdesign.solve.result import answer
from tvimdesign.study import read_study
from tvimdesign.study.design import write_design

ROOT = Path(__file__).resolve().parents[1]
STUDY = ROOT / "tests/studies/paper_shear.yaml"
CHECKS = ("interference", "sizes", "inspect")


def plain(design: Path, out: Path) -> None:
    """Write the files with plain calls."""
    import cadquery as cq
    import ezdxf
    from ezdxf.addons.drawing.matplotlib import qsave
    from OCP.BRepLib import BRepLib
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
    from OCP.HLRAlgo import HLRAlgo_Projector
    from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape
    from OCP.StlAPI import StlAPI_Writer

    from tvimdesign.cad.assembly.assembly import drawn_parts, free_spring, place
    from tvimdesign.cad.assembly.assembly_data import instances
    from tvimdesign.cad.geometry.dimensions import dimensions
    from tvimdesign.cad.geometry.kinds import PRODUCTION
    from tvimdesign.cad.render.pictures import write_exploded, write_preview, write_section
    from tvimdesign.study.design import read_design

    dims = dimensions(read_design(design))
    drawn = drawn_parts(dims)
    for kind, solid in {**drawn, **{kind: free_spring(dims, kind) for kind in ("spring_right", "spring_left")}}.items():
        cq.exporters.export(cq.Workplane(solid), str(out / f"{kind}.step"))
        BRepMesh_IncrementalMesh(solid.wrapped, 0.05, False, 0.15, False)
        writer = StlAPI_Writer()
        writer.ASCIIMode = False
        writer.Write(solid.wrapped, str(out / f"{kind}.stl"))
        if not PRODUCTION[kind].drawn:
            continue
        document = ezdxf.new("R2010", setup=True)
        for towards_viewer in ((0, 0, 1), (0, -1, 0)):
            algorithm = HLRBRep_Algo()
            algorithm.Add(solid.wrapped)
            algorithm.Projector(HLRAlgo_Projector(gp_Ax2(gp_Pnt(), gp_Dir(*towards_viewer), gp_Dir(1, 0, 0))))
            algorithm.Update()
            algorithm.Hide()
            shapes = HLRBRep_HLRToShape(algorithm)
            for shape in (shapes.VCompound(), shapes.OutLineVCompound(), shapes.HCompound()):
                if shape is not None and not shape.IsNull():
                    BRepLib.BuildCurves3d_s(shape)
                    for edge in cq.Shape.cast(shape).Edges():
                        points = [edge.positionAt(share / 16).toTuple()[:2] for share in range(17)]
                        document.modelspace().add_lwpolyline(points)
        document.saveas(out / f"{kind}.dxf")
        qsave(document.modelspace(), str(out / f"{kind}.pdf"))
    placed = place(dims, drawn)
    assembly = cq.Assembly()
    for name, solid in placed.items():
        assembly.add(cq.Workplane(solid.located(cq.Location())), name=name, loc=solid.location())
    assembly.export(str(out / "assembly.step"))
    assembly.export(str(out / "assembly.glb"), tolerance=0.05, angularTolerance=0.15)
    meshes = instances(dims, drawn, placed)
    write_preview(out / "preview.png", dims, drawn, meshes)
    write_exploded(out / "exploded.png", meshes)
    write_section(out / "section.png", placed, meshes)


def files_only(design: Path, out: Path) -> None:
    """Make the files as shipped, without the checks of sizes and interference that the plain row has none of."""
    from tvimdesign.cad.make import load_kernel

    load_kernel()  # as the process that makes parts does, before anything else loads it whole
    from tvimdesign.cad.jobs import build_plan
    from tvimdesign.cad.jobs.main import run

    every = build_plan.build_plan
    build_plan.build_plan = lambda dims: [job for job in every(dims) if not job.name.startswith(CHECKS)]
    run(design, out, lambda **_: None)


def whole(design: Path, out: Path) -> None:
    """Make everything as shipped."""
    from tvimdesign.cad import make_cad

    make_cad(design, out)


ROWS = {"plain": plain, "files_only": files_only, "whole": whole}
LABELS = {
    "plain": "plain calls of the kernel",
    "files_only": "tvimdesign, the files",
    "whole": "tvimdesign, the files and all checks",
    "again": "tvimdesign, nothing changed",
}


def timed(row: str, design: Path, cache: str) -> tuple[float, float]:
    """Processor and wall time [s] of one row in a fresh process; `kept` is the folder of kept results, or none."""
    with tempfile.TemporaryDirectory() as out:
        before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        subprocess.run(
            [sys.executable, __file__, "--row", "whole" if row == "again" else row, "--out", out, str(design)],
            check=True, env={**os.environ, "TVIMDESIGN_CACHE": cache, "PYTHONPATH": str(ROOT)},
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return used, time.perf_counter() - started


def main() -> None:
    """Time every row and print the table, or do one row."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("design", nargs="?", type=Path, help="its design.json; if none, the optimum of paper_shear")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--row", choices=ROWS, help=argparse.SUPPRESS)
    parser.add_argument("--out", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.row:
        ROWS[given.row](given.design, given.out)
        return
    best: dict[str, tuple[float, float]] = {}
    with tempfile.TemporaryDirectory() as cache:
        design = given.design or write_design(answer(read_study(STUDY)).design, Path(cache) / "design.json")
        timed("whole", design, cache)
        for _ in range(given.runs):
            for row in LABELS:
                seconds = timed(row, design, cache if row == "again" else "")
                best[row] = min(seconds, best.get(row, seconds))
    print("| | processor time, s | over plain | wall time, s |\n|---|---|---|---|")
    for row, (used, wall) in best.items():
        print(f"| {LABELS[row]} | {used:.1f} | {used / best['plain'][0]:.2f} | {wall:.1f} |")


if __name__ == "__main__":
    main()
