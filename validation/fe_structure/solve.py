"""FE of the frozen joint as drawn: housing on its feet, pads, PCL, rotor, all tied; the core's top turns as one.

python solve.py PARTS [...]: each a folder written by export_parts.py. Prints the joint's stiffness and each part's
share of the compliance as 1/C_i with C_i = 2 U_i/T^2 [N*m/rad], U_i its strain energy: the C_i add up to the whole.
What carries no torque (journal, hub above the floor, pins, posts) is cut away: it would touch its neighbour.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
import time
from pathlib import Path

import numpy as np
import yaml
from netgen.libngpy._meshing import NgException
from netgen.occ import Cylinder, Dir, Glue, HalfSpace, OCCGeometry, Pnt, Vec
from ngsolve import (
    CF,
    TET,
    VOL,
    BilinearForm,
    CGSolver,
    Grad,
    GridFunction,
    Id,
    IfPos,
    InnerProduct,
    Integrate,
    IntegrationRule,
    Mesh,
    Preconditioner,
    Sym,
    TaskManager,
    Trace,
    VectorH1,
    dx,
    sqrt,
    x,
    y,
    z,
)  # fmt: skip

RUBBERLIKE = 0.45  # Poisson's ratio of pads


def tube(inner: float, outer: float, bottom: float, top: float):
    """Ring about the axis [mm]."""
    whole = Cylinder(Pnt(0, 0, bottom), Dir(0, 0, 1), r=outer, h=top - bottom)
    return whole - Cylinder(Pnt(0, 0, bottom - 1), Dir(0, 0, 1), r=inner, h=top - bottom + 2) if inner else whole


def sectors(mm: dict[str, float], bottom: float, top: float, wider: float = 0.0, ledge: float = 0.0) -> list:
    """One sector with sharp corners for each arc of PCL, wider on each side, or narrower by a ledge [mm]."""
    inner, outer = mm["pcl_inner_radius"] - wider + ledge, mm["pcl_outer_radius"] + wider - ledge
    half, found = 0.5 * mm["arc_span"] - ledge / mm["pcl_inner_radius"], []
    for arc in range(round(mm["arc_count"])):
        middle = 2 * np.pi * arc / mm["arc_count"] + np.pi / mm["spring_count"]
        shape = tube(inner, outer, bottom, top)
        for sense in (-1, 1):
            side = middle + sense * half
            out = Vec(-sense * np.sin(side), sense * np.cos(side), 0)
            shape *= HalfSpace(Pnt(wider * out.x, wider * out.y, 0), out)
        found.append(shape)
    return found


def parts(folder: Path, mm: dict[str, float]) -> list:
    """Solids that carry the torque, named."""

    def read(name: str):
        return OCCGeometry(str(folder / f"{name}.step")).shape

    far = 500.0
    bottom, top = mm["rotor_bottom_level"], mm["rotor_top_level"]
    blocks = mm.get("vane_count", 0.0) > 0.0
    journal = mm["pcl_inner_radius"] - 0.3 if blocks else far
    rotor = read("rotor") - tube(0, journal, -far, bottom) - tube(mm["pin_radius"] - mm["pin_diameter"], far, top, far)
    if blocks:
        inside = 0.5 * (mm["hub_radius"] + mm["pcl_inner_radius"])
        housing = read("housing") - tube(0, inside, 0.0, far) - tube(mm["pcl_outer_radius"] + 0.5, far, 0.0, far)
    else:
        wall = tube(mm["housing_inner_radius"], mm["housing_outer_radius"], 0.0, mm["rim_level"])
        housing = (read("housing") - tube(0, far, 0.0, far)) + wall  # bosses of the wall left out
        pads, floor = -mm["peltier_thickness"], -mm["floor_thickness"]
        for filling in sectors(mm, pads - 0.2, 0.0, wider=PAD_GAP):  # else the rounded pockets' edges stay in its face
            housing += filling
        for hole in (*sectors(mm, pads, 1.0, wider=PAD_GAP), *sectors(mm, floor - 1.0, pads, ledge=mm["window_ledge"])):
            housing -= hole  # corners sharp: where a radius leaves a tenth of a millimetre straight no mesh is found
    found = [(rotor, "rotor", SIZES["plate"]), (housing, "housing", SIZES["housing"])]
    for path in sorted(folder.glob("*.step")):
        number = int(path.stem.split("_")[-1]) if path.stem[-1].isdigit() else 0
        for kind, label, parity in (("pcl", "pcl", 1), ("peltier_pad", "pad", 0)):
            if path.stem.startswith(kind) and (not blocks or number % 2 == parity):  # blocks of one sense are pressed
                found.append((read(path.stem), label, SIZES["layer"]))
    if not blocks:
        found = [part for part in found if part[1] != "pad"]
        found += [(pad, "pad", SIZES["layer"]) for pad in sectors(mm, -mm["peltier_thickness"], 0.0)]
    for shape, label, size in found:
        for solid in shape.solids:
            solid.name, solid.maxh = label, size
    return [shape for shape, _, _ in found]


FOOT, EDGE = float(os.environ.get("FOOT", "0.5")), float(os.environ.get("EDGE", "2"))  # mm; zero: as the layer
PAD_GAP = float(os.environ.get("PAD_GAP", "0.2"))  # mm; zero: tied to the walls of their pockets
SIZES = {"plate": 6.0, "housing": 12.0, "layer": float(os.environ.get("LAYER", "5"))}  # mm


def solve(folder: Path, order: int = 2) -> dict[str, float]:
    """Stiffness of the joint at the core's top and of each part [N*m/rad]; stresses at 1 N*m [MPa]."""
    began = time.time()
    inputs = json.loads((folder / "inputs.json").read_text())
    mm, values = inputs["mm"], inputs["values"]
    whole = Glue(parts(folder, mm))
    _refine(whole, mm)
    ground = -mm["floor_thickness"] - mm["foot_height"]
    top = mm["link_bottom_level"]
    for face in whole.faces:
        centre, low, high = face.center, face.bounding_box[0].z, face.bounding_box[1].z
        flat, wide = high - low < 1e-4, face.bounding_box[1].x - face.bounding_box[0].x
        beside = abs((centre.x**2 + centre.y**2) ** 0.5 - mm["placement_radius"]) < 0.2
        if flat and abs(low - top) < 1e-3:
            face.name = "turned"
        elif flat and abs(low - ground) < 1e-3 and _stands(beside, wide, mm):
            face.name = "fixed"
        else:
            face.name = "free"
    named = [face.name for face in whole.faces]
    print(folder.name, "feet", named.count("fixed"), "tops", named.count("turned"), file=sys.stderr, flush=True)
    mesh = Mesh(
        OCCGeometry(whole).GenerateMesh(maxh=12.0, grading=0.6, curvaturesafety=1.0, segmentsperedge=0.5)
    ).Curve(order)
    youngs = values["structure_youngs_modulus"] * 1e-6
    shear = {"pcl": values["storage_modulus@cold"] * 1e-6, "pad": values["peltier_shear_modulus"] * 1e-6}
    poisson = {"pcl": values["pcl_poissons_ratio"], "pad": RUBBERLIKE}
    own = values["structure_poissons_ratio"]
    mu = mesh.MaterialCF({**shear, "rotor": youngs / 2 / (1 + own), "housing": youngs / 2 / (1 + own)})
    nu = mesh.MaterialCF({**poisson, "rotor": own, "housing": own})
    lame = 2 * mu * nu / (1 - 2 * nu)
    space = VectorH1(mesh, order=order, dirichlet="turned|fixed")
    u, v = space.TnT()

    def stress(strain):
        return 2 * mu * strain + lame * Trace(strain) * Id(3)

    with TaskManager():
        form = BilinearForm(InnerProduct(stress(Sym(Grad(u))), Sym(Grad(v))) * dx, symmetric=True, condense=True)
        pre = Preconditioner(form, "bddc")
        form.Assemble()
        found = GridFunction(space)
        found.Set(CF((-y, x, 0)), definedon=mesh.Boundaries("turned"))
        right = found.vec.CreateVector()
        right.data = -form.mat * found.vec
        inverse = CGSolver(form.mat, pre.mat, tol=1e-7, maxiter=600)
        change = found.vec.CreateVector()
        right.data += form.harmonic_extension_trans * right
        change.data = inverse * right
        found.vec.data += change
        found.vec.data += form.harmonic_extension * found.vec
        found.vec.data += form.inner_solve * right
        strain = Sym(Grad(found))
        density = InnerProduct(stress(strain), strain)  # twice the energy
        core = IfPos(mm["core_radius"] + 0.01 - sqrt(x * x + y * y), 1, 0)
        total = Integrate(density, mesh)
        shares = {name: Integrate(density, mesh, definedon=mesh.Materials(name)) for name in ("pcl", "pad", "housing")}
        if mm.get("vane_count"):
            stands = IfPos(z, 1, 0)
            hangs = IfPos(mm["rotor_bottom_level"] - z, 1, 0)
            shares["housing_vanes"] = Integrate(stands * density, mesh, definedon=mesh.Materials("housing"))
            shares["housing"] -= shares["housing_vanes"]
            shares["rotor_vanes"] = Integrate(hangs * density, mesh, definedon=mesh.Materials("rotor"))
        shares["core"] = Integrate(core * density, mesh, definedon=mesh.Materials("rotor"))
        shares["plate"] = Integrate((1 - core) * density, mesh, definedon=mesh.Materials("rotor"))
        shares["plate"] -= shares.get("rotor_vanes", 0.0)
    torque = total  # N*mm at one radian
    result = {"elements": mesh.ne, "unknowns": space.ndof, "hub": total * 1e-3}
    result |= {name: torque**2 / share * 1e-3 for name, share in shares.items()}
    result |= _stresses(mesh, stress(strain), mm, torque) | _foot(mesh, stress(strain), mm, torque)
    if not mm.get("vane_count"):
        result |= _edges(mesh, stress(strain), mm, torque)
    return result | {"seconds": time.time() - began}


def _stands(beside: bool, wide: float, mm: dict[str, float]) -> bool:
    """Whether a face at the ground is what holds the housing: a torque sensor's flange, or else a foot; no skirt."""
    if mm["flange_outer_radius"]:
        return not beside and wide < 2 * mm["flange_outer_radius"] + 0.1
    return beside and wide < 3 * mm["mount_boss_radius"]


def _refine(whole, mm) -> None:
    """Make elements small where stress is looked at: the core's foot, and the edges of the arcs."""
    top, low, high = mm["rotor_top_level"], -0.01, mm.get("pcl_thickness", -1.0) + 0.01
    for edge in whole.edges:
        box = edge.bounding_box
        flat = box[1].z - box[0].z < 1e-4
        wide = max(box[1].x - box[0].x, box[1].y - box[0].y)
        centre = edge.center
        if flat and abs(box[0].z - top) < 1e-3 and wide < 2.02 * mm["core_radius"]:
            if np.hypot(centre.x, centre.y) < mm["core_radius"] + 0.01 and wide > 0.5 * mm["core_radius"]:
                edge.maxh = FOOT
        elif EDGE and flat and low < box[0].z < high and np.hypot(centre.x, centre.y) > mm["core_radius"] + 0.5:
            edge.maxh = EDGE


def _mises(tensor):
    deviator = tensor - Trace(tensor) / 3 * Id(3)
    return sqrt(1.5 * InnerProduct(deviator, deviator))


def _foot(mesh, tensor, mm, torque) -> dict[str, float]:
    """Core's von Mises stress [MPa] at one newton metre beside its foot, a mean over the first millimetre above it."""
    angles, levels = np.meshgrid(np.linspace(0, 2 * np.pi, 73)[:-1], (np.arange(10) + 0.5) / 10)
    radius = mm["core_radius"] * 0.998
    places = radius * np.cos(angles), radius * np.sin(angles), mm["rotor_top_level"] + levels
    along = _sampled(mesh, _mises(tensor), *places) * 1e3 / torque
    mean = np.nanmean(along, axis=0)
    return {"foot_highest": np.nanmax(mean), "foot_mean": np.nanmean(mean),
            "foot_lower_half": np.nanmax(np.nanmean(along[:5], axis=0))}  # fmt: skip


def _sampled(mesh, field, *places):
    """Field at places [mm]; nan where the mesh's curved elements leave one out."""
    found = np.full(places[0].shape, np.nan)
    for index in np.ndindex(found.shape):
        with contextlib.suppress(NgException):
            found[index] = field(mesh(*(float(axis[index]) for axis in places)))
    return found


def _edges(mesh, tensor, mm, torque) -> dict[str, float]:
    """Layer's shear [MPa] at one newton metre, means over one thickness in from the arcs' edges.

    Of the whole inner and outer edges and ends, and the highest of all stretches of two millimetres along them.
    """
    inner, outer, span, thick = (
        mm[name] for name in ("pcl_inner_radius", "pcl_outer_radius", "arc_span", "pcl_thickness")
    )
    deep = (np.arange(3) + 0.5) / 3 * thick
    level = (np.arange(3) + 0.5) / 3 * thick
    found, highest = {}, 0.0
    sliding = sqrt(tensor[0, 2] ** 2 + tensor[1, 2] ** 2)
    for name in ("inner", "outer", "end"):
        length = (outer - inner) if name == "end" else span * (inner if name == "inner" else outer)
        count = max(int(length / 0.5), 4)
        share = (np.arange(count) + 0.5) / count
        means = []
        for arc in range(round(mm["arc_count"])):
            for sense in (-1, 1) if name == "end" else (1,):
                way, inward, up = np.meshgrid(share, deep, level, indexing="ij")
                if name == "end":
                    radius = inner + (outer - inner) * way
                    turn = sense * (0.5 * span - inward / radius)
                else:
                    radius = inner + inward if name == "inner" else outer - inward
                    turn = span * (way - 0.5)
                turn = turn + 2 * np.pi * arc / round(mm["arc_count"]) + np.pi / mm["spring_count"]
                values = _sampled(mesh, sliding, radius * np.cos(turn), radius * np.sin(turn), up)
                means.append(np.nanmean(values, axis=(1, 2)) * 1e3 / torque)
        stretch = max(round(2.0 * count / length), 1)
        running = [np.convolve(one, np.ones(stretch) / stretch, "valid").max() for one in means]
        found[f"edge_{name}"] = float(np.nanmean(means))
        highest = max(highest, *running)
    return found | {"edge_highest": highest}


def _stresses(mesh, tensor, mm, torque) -> dict[str, float]:
    """Layer's shear and core's von Mises stress [MPa] at one newton metre."""
    points = mesh.MapToAllElements(IntegrationRule(TET, 2), VOL)
    material = np.array([e.mat for e in mesh.Elements(VOL)])
    each = len(points) // len(material)
    names = np.repeat(material, each)
    mises = np.asarray(_mises(tensor)(points)).ravel() * 1e3 / torque
    sliding = np.asarray(sqrt(tensor[0, 2] ** 2 + tensor[1, 2] ** 2)(points)).ravel() * 1e3 / torque
    level = np.asarray(z(points)).ravel()
    layer = sliding[names == "pcl"]
    shaft = (names == "rotor") & (level > mm["rotor_top_level"] + 1.0) & (level < mm["link_bottom_level"] - 1.0)
    plain = shaft & (level < mm["link_bottom_level"] - mm["link_screw_depth"] - 1.0)
    return {"layer_peak": layer.max(), "layer_99": np.quantile(layer, 0.99), "layer_mean": layer.mean(),
            "core_mises": mises[shaft].max(), "core_mises_below_holes": mises[plain].max() if plain.any() else 0.0,
            "core_mises_99": np.quantile(mises[shaft], 0.99)}  # fmt: skip


if __name__ == "__main__":
    for name in sys.argv[1:]:
        found = solve(Path(name))
        print(yaml.safe_dump({Path(name).name: {k: float(f"{v:.4g}") for k, v in found.items()}}), flush=True)
