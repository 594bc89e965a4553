"""Shared code of the solvers: stress, readings of a field, arguments, and the files they write."""

import argparse
import contextlib
import ctypes
import json
import os
import resource
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from netgen.libngpy._meshing import NgException
from ngsolve import BND, H1, GridFunction, Id, InnerProduct, Mesh, Sym, Trace, sqrt

Results = dict[str, float]


def stress(strain: Any, shear: Any, lame: Any, dilation: Any = None) -> Any:
    """Return the stress of an isotropic body by its shear modulus and Lame's first constant [N/mm^2].

    Of a given dilation, too.
    """
    return 2 * shear * strain + lame * (Trace(strain) if dilation is None else dilation) * Id(3)


def mises(tensor: Any) -> Any:
    """Return Von Mises stress."""
    deviator = tensor - Trace(tensor) / 3 * Id(3)
    return sqrt(1.5 * InnerProduct(deviator, deviator))


def lame_of(shear: Any, poisson: Any) -> Any:
    """Return Lame's first constant by shear modulus and Poisson's ratio."""
    return 2 * shear * poisson / (1 - 2 * poisson)


def strain_of(moved: Any) -> Any:
    """Return small strain of a displacement."""
    from ngsolve import Grad

    return Sym(Grad(moved))


def sampled(mesh: Any, field: Any, *places: Any) -> Any:
    """Return the field at places [mm]; nan where the mesh's curved elements leave one out."""
    values = np.full(places[0].shape, np.nan)
    for index in np.ndindex(values.shape):
        with contextlib.suppress(NgException):
            values[index] = field(mesh(*(float(axis[index]) for axis in places)))
    return values


def write_field(path: Path, mesh: Any, field: Any, moved: Any) -> None:
    """Write surface triangles of a mesh with a field on their corners, and how far each corner moves [mm]."""
    smooth = GridFunction(H1(mesh, order=1))
    smooth.Set(field)
    values = np.array(smooth.vec.FV().NumPy()[: mesh.nv])
    points = np.array([vertex.point for vertex in mesh.vertices])
    triangles = np.array([[corner.nr for corner in element.vertices] for element in mesh.Elements(BND)])
    ways = np.zeros_like(points)
    for axis in range(3):
        smooth.Set(moved[axis])
        ways[:, axis] = smooth.vec.FV().NumPy()[: mesh.nv]
    np.savez_compressed(path, points=points, triangles=triangles, values=values, ways=ways)


PER_EDGE: dict[str, float] = {"segmentsperedge": 1.0}
FINER: tuple[dict[str, float], ...] = ({}, PER_EDGE, {**PER_EDGE, "curvaturesafety": 2.0}, {**PER_EDGE, "grading": 0.3})
"""Further sizes, tried in turn until the mesher gets a mesh of all faces."""


def meshed(geometry: Any, order: int, **sizes: float) -> Any:
    """Return curved mesh of a geometry; where some faces get none, a mesh of more elements. Raises ValueError."""
    for finer in FINER:
        with tempfile.TemporaryFile("w+") as output, _printing_into(output.fileno()):
            mesh = _mesh_of(geometry, **{**sizes, **finer})
            output.seek(0)
            if mesh is not None and "NOT ALL FACES" not in output.read():
                return Mesh(mesh).Curve(order)
    raise ValueError(f"no mesh of all faces is found, not with {FINER[-1]} either")


def _mesh_of(geometry: Any, **sizes: float) -> Any:
    """Return mesher's mesh, or None where it gives up; of some geometries it leaves faces out and says so in print."""
    try:
        return geometry.GenerateMesh(**sizes)
    except NgException:
        return None


@contextlib.contextmanager
def _printing_into(file: int) -> Iterator[None]:
    """Redirect what compiled code prints on standard output into a file for a while."""
    compiled = ctypes.CDLL(None)
    sys.stdout.flush()
    compiled.fflush(None)
    usual = os.dup(1)
    os.dup2(file, 1)
    try:
        yield
    finally:
        compiled.fflush(None)
        os.dup2(usual, 1)
        os.close(usual)


def main(solve: Callable[..., Results], about: str | None) -> None:
    """Solve the parts of a folder and write the results as JSON, to four figures."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", type=Path)
    parser.add_argument("results", type=Path)
    parser.add_argument("--coarser", type=float, default=1.0, help="all elements larger by this")
    parser.add_argument("--field", type=Path, help="file for the stress on the surface")
    arguments = parser.parse_args()
    results = solve(arguments.parts, coarser=arguments.coarser, field=arguments.field)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6 if sys.platform == "linux" else 0.0  # GB
    written = {name: float(f"{value:.4g}") for name, value in results.items()}
    written |= {"seconds": round(time.process_time(), 1), "gigabytes": round(memory, 2)}
    arguments.results.write_text(json.dumps(written, indent=1) + "\n")
