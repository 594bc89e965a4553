"""Readings of the solved joint: stresses at the core's foot, along the arcs' edges, the largest in layer and core,
and the forces on its feet."""

from typing import Any

import elastic
import foot_surface
import ngsolve as ngs
import numpy as np
from elastic import Results
from ngsolve import BND, CF, TET, VOL, GridFunction, IfPos, InnerProduct, IntegrationRule, atan2, dx, sqrt, x, y, z

STRETCH = 2.0  # Length along an edge over which its highest stress is a mean [mm]


def at_foot(mesh: Any, tensor: Any, mm: Results, torque: float) -> Results:
    """Return core's von Mises stress [MPa] at one newton metre at its foot, the highest mean over a millimetre along
    its
    surface, of a sharp foot that over the first millimetre above it."""
    angles = np.linspace(0, 2 * np.pi, 73)[:-1]
    radius, height = (row[:, None] for row in foot_surface.places(mm["core_radius"], mm.get("foot_fillet", 0.0)))
    places = radius * np.cos(angles), radius * np.sin(angles), mm["rotor_top_level"] + height + 0.0 * angles
    highest = foot_surface.highest_mean(elastic.sampled(mesh, elastic.mises(tensor), *places) * 1e3 / torque)
    return {"foot_highest": highest.max(), "foot_mean": highest.mean()}


def at_plate(mesh: Any, tensor: Any, mm: Results, torque: float) -> Results:
    """Return rotor plate's von Mises stress [MPa] at one newton metre beside the core's foot, a mean over thickness
    and the
    first millimetre: the highest of all stretches of two millimetres around the core, and the mean around it."""
    low, high = mm["rotor_bottom_level"], mm["rotor_top_level"]
    outward, angles, levels = np.meshgrid(
        (np.arange(4) + 0.5) / 4, np.linspace(0, 2 * np.pi, 73)[:-1], low + (np.arange(8) + 0.5) / 8 * (high - low),
        indexing="ij",
    )  # fmt: skip
    radius = mm["core_radius"] + outward
    along = elastic.sampled(mesh, elastic.mises(tensor), radius * np.cos(angles), radius * np.sin(angles), levels)
    around = np.nanmean(along, axis=(0, 2)) * 1e3 / torque
    stretch = max(round(STRETCH / (2 * np.pi * mm["core_radius"]) * len(around)), 1)
    running = np.convolve(np.concatenate([around, around[: stretch - 1]]), np.ones(stretch) / stretch, "valid")
    return {"plate_mises": running.max(), "plate_mises_mean": around.mean()}


def at_edges(mesh: Any, tensor: Any, mm: Results, torque: float) -> Results:
    """Return layer's shear [MPa] at one newton metre, means over one thickness in from the arcs' edges.

    Of the whole inner and outer edges and ends, and the highest of all stretches of two millimetres along them.
    """
    inner, outer, span, thick = (
        mm[name] for name in ("pcl_inner_radius", "pcl_outer_radius", "arc_span", "pcl_thickness")
    )
    deep = (np.arange(3) + 0.5) / 3 * thick
    level = (np.arange(3) + 0.5) / 3 * thick
    stresses: Results = {}
    highest = 0.0
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
                values = elastic.sampled(mesh, sliding, radius * np.cos(turn), radius * np.sin(turn), up)
                means.append(np.nanmean(values, axis=(1, 2)) * 1e3 / torque)
        stretch = max(round(STRETCH * count / length), 1)
        running = [np.convolve(mean, np.ones(stretch) / stretch, "valid").max() for mean in means]
        stresses[f"edge_{name}"] = float(np.nanmean(means))
        highest = max(highest, *running)
    return stresses | {"edge_highest": highest}


def at_seats(mesh: Any, tensor: Any, mm: Results, torque: float) -> Results:
    """Return the shear [MPa] at one newton metre of the adhesive around the spreaders, along its inner and outer rims.

    Means over its height, in the middle of its width: the mean of all rims, and the highest over two millimetres.
    """
    inner, outer, span = (mm[name] for name in ("pcl_inner_radius", "pcl_outer_radius", "arc_span"))
    half, shears = 0.5 * mm["spreader_gap"], Results()
    levels = -(np.arange(4) + 0.5) / 4 * mm["spreader_depth"]
    around = tensor[0, 1] * (x * x - y * y) + (tensor[1, 1] - tensor[0, 0]) * x * y
    sliding = around / (x * x + y * y)
    for name, radius in (("inner", inner - half), ("outer", outer + half)):
        count = max(int(span * radius / 0.5), 8)
        means = []
        for arc in range(round(mm["arc_count"])):
            turn = span * ((np.arange(count) + 0.5) / count - 0.5)
            turn, up = np.meshgrid(
                turn + 2 * np.pi * arc / mm["arc_count"] + np.pi / mm["spring_count"], levels, indexing="ij"
            )
            values = elastic.sampled(mesh, sliding, radius * np.cos(turn), radius * np.sin(turn), up)
            means.append(np.abs(np.nanmean(values, axis=1)) * 1e3 / torque)
        stretch = max(round(STRETCH * count / (span * radius)), 1)
        running = [np.convolve(mean, np.ones(stretch) / stretch, "valid").max() for mean in means]
        shears |= {f"seat_{name}": float(np.nanmean(means)), f"seat_{name}_highest": float(np.nanmax(running))}
    return shears


def in_bodies(mesh: Any, tensor: Any, mm: Results, torque: float) -> Results:
    """Return layer's shear and core's von Mises stress [MPa] at one newton metre."""
    points = mesh.MapToAllElements(IntegrationRule(TET, 2), VOL)
    material = np.array([e.mat for e in mesh.Elements(VOL)])
    each = len(points) // len(material)
    names = np.repeat(material, each)
    mises = np.asarray(elastic.mises(tensor)(points)).ravel() * 1e3 / torque
    sliding = np.asarray(sqrt(tensor[0, 2] ** 2 + tensor[1, 2] ** 2)(points)).ravel() * 1e3 / torque
    level = np.asarray(z(points)).ravel()
    layer = sliding[names == "pcl"]
    shaft = (names == "rotor") & (level > mm["rotor_top_level"] + 1.0) & (level < mm["link_bottom_level"] - 1.0)
    plain = shaft & (level < mm["link_bottom_level"] - mm["link_screw_depth"] - 1.0)
    return {"layer_peak": layer.max(), "layer_99": np.quantile(layer, 0.99), "layer_mean": layer.mean(),
            "core_mises": mises[shaft].max(), "core_mises_below_holes": mises[plain].max() if plain.any() else 0.0,
            "core_mises_99": np.quantile(mises[shaft], 0.99)}  # fmt: skip


def at_feet(space: Any, tensor: Any, torque: float, count: int) -> Results:
    """Return largest force on a foot [N] at one newton metre, across its screw and along it, from the feet's reactions.

    Feet stand evenly around the axis. The work of the stress on a field that moves one foot alone is its reaction.
    """
    mesh = space.mesh
    ground = [mesh[corner].point for facet in mesh.Elements(BND) if facet.mat == "fixed" for corner in facet.vertices]
    angles = np.array([np.arctan2(point[1], point[0]) for point in ground])
    pitch = 2.0 * np.pi / count
    first = np.angle(np.mean(np.exp(1j * count * angles))) / count
    v = space.TestFunction()
    work = ngs.LinearForm(InnerProduct(tensor, elastic.strain_of(v)) * dx).Assemble()
    motion, across, along = GridFunction(space), [], []
    for foot in range(count):
        turned = atan2(y * np.cos(first + foot * pitch) - x * np.sin(first + foot * pitch),
                       x * np.cos(first + foot * pitch) + y * np.sin(first + foot * pitch))  # fmt: skip
        near = IfPos(0.5 * pitch - turned, 1, 0) * IfPos(turned + 0.5 * pitch, 1, 0)
        force = []
        for way in np.eye(3):
            motion.Set(CF(tuple(near * part for part in way)), definedon=mesh.Boundaries("fixed"))
            force.append(InnerProduct(work.vec, motion.vec) * 1e3 / torque)
        across.append(np.hypot(*force[:2]))
        along.append(abs(force[2]))
    return {"foot_across": max(across), "foot_along": max(along)}
