"""Conduction with melting, pads and losses on the cells of `heat_grid`, for one implicit step; SI and degC.

Heat content is piecewise straight in temperature, melting between two of them. The pads' current pumps heat from the
cold side to the hot one and heats their legs evenly. Trilinear elements.
"""

from collections import defaultdict
from typing import Any, NamedTuple

import heat_lines
import ngsolve as ng
import numpy as np
from heat_grid import PADS
from netgen.meshing import Element2D, Element3D, FaceDescriptor, Mesh, MeshPoint, Pnt

STEFAN_BOLTZMANN = 5.670374419e-8
KELVIN = 273.15
WELL = 100.0
"""Conductivity of a pad's sides through their thickness [W/m K]."""
ALONG_PADS = 6.0
"""Of pads in their plane, where the design has none: in compression; assumed, as in shear by default."""
EDGE_CONTACT = 150.0
"""Between the rim of a pad and what it stands on or leans against [W/m2 K], where the design has none: likewise."""
OUTSIDE = ("inner", "rotor", "housing", "cold", "none", "chamber")
"""Faces to the air: of polymer, of rotor and link, of the housing, of the pads' cold sides, those of no flow, and those
to the air that is shut in around blocks."""


def edge_contact(values: dict[str, float]) -> float:
    """Return the conductance between the rim of a pad and what it leans against [W/m2 K]."""
    return values.get("pad_edge_contact", EDGE_CONTACT)


class Meshed(NamedTuple):
    """A mesh, and which of its corners are those of each cell."""

    mesh: Any
    cells: dict[str, Any]
    """Indices (along, around, up) of each material's cells, shape (3, count)."""
    corners: Any
    """Numbers of the corners by index, -1 where there is none."""


def meshed(points: Any, names: Any, enclosed: Any) -> Meshed:
    """Return hexahedra of all named cells, with named faces to the air; `enclosed` says which air is shut in."""
    mesh = Mesh(dim=3)
    materials = sorted(set(names.ravel()) - {""})
    for number, name in enumerate(OUTSIDE, 1):
        mesh.Add(FaceDescriptor(surfnr=number, domin=1, domout=0, bc=number))
        mesh.SetBCName(number - 1, name)
    for number, name in enumerate(materials, 1):
        mesh.SetMaterial(number, name)
    corners = -np.ones(points.shape[:3], dtype=int)
    numbers: dict[tuple[int, int, int], Any] = {}

    def corner(i: int, j: int, k: int) -> Any:
        if (i, j, k) not in numbers:
            corners[i, j, k] = len(numbers)
            numbers[i, j, k] = mesh.Add(MeshPoint(Pnt(*map(float, points[i, j, k]))))
        return numbers[i, j, k]

    cells = defaultdict(list)
    around, shut = np.pad(names, 1, constant_values="outside"), np.pad(enclosed, 1)
    for i, j, k in np.argwhere(names != ""):
        name = names[i, j, k]
        low, high = ([corner(i + a, j + b, k + c) for a, b in _SQUARE] for c in (0, 1))
        mesh.Add(Element3D(materials.index(name) + 1, low + high))
        cells[name].append((i, j, k))
        for axis, side in _SIDES:
            beyond = [i + 1, j + 1, k + 1]
            beyond[axis] += 2 * side - 1
            if around[tuple(beyond)] in ("", "outside"):
                plane = axis != 2 and around[tuple(beyond)] == "outside" and not (axis == 0 and side)
                four = [[i, j, k] for _ in _SQUARE]
                for place, (a, b) in zip(four, _SQUARE, strict=True):
                    place[axis] += side
                    place[(axis + 1) % 3] += a
                    place[(axis + 2) % 3] += b
                kind = "none" if plane else _outside(name, shut[tuple(beyond)])
                mesh.Add(Element2D(OUTSIDE.index(kind) + 1, [corner(*place) for place in four]))
    return Meshed(ng.Mesh(mesh), {name: np.array(own).T for name, own in cells.items()}, corners)


_SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))
_SIDES = tuple((axis, side) for axis in range(3) for side in (0, 1))


def _outside(name: str, air: str) -> str:
    """Return the kind of a face of a part to some air. In a slot the cold sides alone lose heat, through its one
    opening; the
    housing loses it outside, not to the room it closes."""
    if air == "chamber":
        return "chamber"
    if air in ("slot", "room") and name == "housing":
        return "none"
    kinds = {"layer": "inner", "rotor": "rotor", "link": "rotor", "key": "inner", "housing": "housing", "cold": "cold"}
    return kinds.get(name, "none")


def clipped(t: Any, low: float, high: float) -> Any:
    """`t` between two limits."""
    return ng.IfPos(t - low, ng.IfPos(t - high, high, t), low)


class Heated:
    """The residual of one implicit step, with its length, weights and current as parameters."""

    def __init__(self, values: dict[str, float], found: Meshed, grid: heat_lines.Grid, sink: bool) -> None:
        """Write it down; `values` are the design's."""
        self.values, self.mesh, self.grid = values, found.mesh, grid
        self.space = ng.H1(self.mesh, order=1)
        self.now, self.before, self.last = (ng.GridFunction(self.space) for _ in range(3))
        self.guess = ng.GridFunction(self.space)
        self.step, self.current = ng.Parameter(1.0), ng.Parameter(0.0)
        self.weights = [ng.Parameter(one) for one in (1.0, 1.0, 0.0)]
        """Of the heat content now, a step ago and two steps ago."""
        self.sink, self.chamber = (ng.Parameter(values["ambient_temperature"] - KELVIN) for _ in range(2))
        t, v = self.space.TnT()
        new, old, older = self.weights
        content = new * self.heat(t) - old * self.heat(self.before) + older * self.heat(self.last)
        self.form = ng.BilinearForm(self.space, symmetric=True)
        self.form += (content / self.step * v).Compile() * ng.dx
        self.form += self._conducted(t, v).Compile() * ng.dx
        self._pads(t, v)
        self._losses(t, v, sink)

    def heat(self, t: Any) -> Any:
        """Heat content of a volume [J/m3] above 0 degC."""
        v = self.values
        start, width = self._melting()
        solid, melt = v["pcl_specific_heat_solid"], v["pcl_specific_heat_melt"]
        within = clipped(t, start, start + width) - start
        pcl = solid * clipped(t, -1e3, start) + (v["pcl_latent_heat"] / width + 0.5 * (solid + melt)) * within
        pcl += melt * (clipped(t, start + width, 1e4) - start - width)
        structure = v["structure_density"] * v["structure_specific_heat"]
        pad = v["peltier_density"] * v["peltier_specific_heat"]
        bodies = {"layer": v["pcl_density"] * pcl, "key": v["pcl_density"] * pcl, "link": self._link() * t}
        bodies |= dict.fromkeys(("rotor", "housing"), structure * t) | dict.fromkeys(PADS, pad * t)
        if "spreader" in self.mesh.GetMaterials():
            bodies["spreader"] = v["spreader_density"] * v["spreader_specific_heat"] * t
        return self.mesh.MaterialCF(bodies, default=0.0)

    def _melting(self) -> tuple[float, float]:
        """Return where melting begins [degC], and over how many kelvin it goes on."""
        start, end = (self.values[f"pcl_melting_{side}"] for side in ("start", "end"))
        return start - KELVIN, end - start

    def _link(self) -> float:
        """Heat capacity of link and retainer over the volume of the disc that stands for them [J/m3 K]."""
        v, mm = self.values, self.grid.mm
        height = 1e-3 * (self.grid.up.ends[-1] - mm["link_bottom_level"])
        hole = self.grid.along.ends[0] * 1e-3
        disc = np.pi * (v["core_radius"] ** 2 - hole**2) * height
        return float((v["link_mass"] + v["retainer_mass"]) * v["structure_specific_heat"] / disc)

    def _conducted(self, t: Any, v: Any) -> Any:
        outwards = self._outwards()

        def parts(one: Any) -> tuple[Any, Any, Any]:
            slope = ng.grad(one)
            along = outwards[0] * slope[0] + outwards[1] * slope[1]
            return along, outwards[0] * slope[1] - outwards[1] * slope[0], slope[2]

        pairs = zip(self._conductivities(), parts(t), parts(v), strict=True)
        return sum(k * one * other for k, one, other in pairs)

    def _outwards(self) -> tuple[Any, Any]:
        """Return direction along which a cell's first conductivity counts: from the axis, of pads that stand along
        their face.

        Their legs conduct some sixty times as well along the pad as through it, so that some degrees count.
        """
        radius = ng.sqrt(ng.x**2 + ng.y**2)
        if not self.grid.upright:
            return ng.x / radius, ng.y / radius
        face = heat_lines.face_angle(self.grid.mm) + self.grid.middle
        found = []
        for one, of_face in ((ng.x, np.cos(face)), (ng.y, np.sin(face))):
            pads = dict.fromkeys(PADS, ng.CF(float(of_face)))
            found.append(self.mesh.MaterialCF(pads, default=one / radius))
        return found[0], found[1]

    def _conductivities(self) -> list[Any]:
        """Return conductivities along, around and up the axis [W/m K].

        Of polymer and air at the expected temperatures.
        """
        c, t = self.values, self.guess
        start, width = self._melting()
        molten = (clipped(t, start, start + width) - start) / width
        pcl = c["pcl_conductivity_solid"] + molten * (c["pcl_conductivity_melt"] - c["pcl_conductivity_solid"])
        shine = c["surface_emissivity"] / (2.0 - c["surface_emissivity"])
        gap = c["running_clearance"] if self.grid.upright else c["pcl_thickness"]
        radiated = 4.0 * STEFAN_BOLTZMANN * shine * (t + KELVIN) ** 3 * gap
        alike = {"layer": pcl, "key": pcl, "rotor": c["structure_conductivity"], "housing": c["structure_conductivity"],
                 "link": c["structure_conductivity"], "spreader": c.get("spreader_conductivity", 1.0)}  # fmt: skip
        thin = heat_lines.THIN * 1e-3
        sheets = {"near": c["hot_contact"] * thin, "far": c["rotor_contact"] * thin,
                  "spread": c.get("spreader_contact", 1.0) * thin,
                  "edge": edge_contact(c) * self.grid.slot * 1e-3}  # fmt: skip
        if "heater_adhesive_conductivity" in c:
            sheets["seat"] = c["heater_adhesive_conductivity"] / c["spreader_gap"] * self.grid.slot * 1e-3
        legs = c["peltier_conductance"] / c["peltier_area"] * (1.0 - 2.0 * heat_lines.PAD_FILM) * self._pad_depth()
        beside = c.get("pad_conductivity", ALONG_PADS)
        through = {"hot": WELL, "legs": legs, "cold": WELL}
        found = []
        for axis in range(3):
            pads = through if axis == (1 if self.grid.upright else 2) else dict.fromkeys(PADS, beside)
            air = c["air_conductivity"] + (radiated if axis == 2 else 0.0)
            lip = c["rotor_contact"] * self.grid.slot * 1e-3 if axis == 0 else c["air_conductivity"]
            found.append(self.mesh.MaterialCF({**alike, **sheets, **pads, "air": air, "lip": lip}))
        return found

    def _pad_depth(self) -> float:
        mm = self.grid.mm
        return float(1e-3 * (mm["pad_depth"] - (0.0 if self.grid.upright else mm["spreader_depth"])))

    def _pads(self, t: Any, v: Any) -> None:
        """Heat the current pumps and makes, spread over what the grid has of the pads: their area is as designed."""
        c, mesh = self.values, self.mesh
        count = 2.0 * self.grid.mm["vane_count" if self.grid.upright else "arc_count"]
        share = c["heated_area"] / count / c["peltier_area"]  # modules' worth in this part of the ring
        current = self.current / c.get("heater_strings", 1.0)
        volume = {name: ng.Integrate(1.0, mesh, definedon=mesh.Materials(name)) for name in PADS}
        pumped = share * c["peltier_seebeck"] * current * (t + KELVIN)
        self.form += -pumped / volume["hot"] * v * ng.dx("hot")
        self.form += pumped / volume["cold"] * v * ng.dx("cold")
        self.form += -share * c["peltier_resistance"] * current**2 / volume["legs"] * v * ng.dx("legs")

    def _losses(self, t: Any, v: Any, sink: bool) -> None:
        c, air = self.values, self.values["ambient_temperature"]
        coefficients = {"inner": "housing", "rotor": "rotor", "housing": "housing", "cold": "cold_side"}
        for name, kind in coefficients.items():
            if name == "cold" and sink:
                self.form += c["sink_contact"] * (t - self.sink) * v * ng.ds(name)
                continue
            radiated = c["surface_emissivity"] * STEFAN_BOLTZMANN * ((t + KELVIN) ** 4 - air**4)
            self.form += (c[f"{kind}_coefficient"] * (t + KELVIN - air) + radiated) * v * ng.ds(name)
        shut = c["housing_coefficient"] + 4.0 * c["surface_emissivity"] * STEFAN_BOLTZMANN * air**3
        self.form += shut * (t - self.chamber) * v * ng.ds("chamber")
