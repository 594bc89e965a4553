"""Print files: parts as they are printed, with wider holes and known mesh error, and where they lie on the bed."""

import io
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import ceil, degrees, hypot, sqrt
from typing import NamedTuple
from xml.sax.saxutils import escape, quoteattr

import cadquery as cq
import numpy as np
import trimesh
from manifold3d import Error, Manifold, Mesh64
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf
from OCP.gp import gp_Dir, gp_Pnt
from scipy.signal import fftconvolve
from scipy.spatial import ConvexHull

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.export.mesh import Array, Mesh, face_meshes
from tvimdesign.cad.export.step_file import Product
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.features import holes, tight_box
from tvimdesign.cad.geometry.kinds import Production

LINE = 0.4  # Width of a printed line [mm] of the commonest nozzle, which is as wide
LAYER, THIN_LAYER = 0.2, 0.1
"""Height of a layer [mm], half of a line, and of the thinnest; assumed: such a nozzle prints 0.1 to 0.3."""
GAP = 5.0  # Between parts on the bed [mm]; assumed, 3 to 10: supports stand in it
CELL = 2.0  # Side of the squares in which a bed is filled [mm]
_MARGIN = 0.5 * GAP + CELL / sqrt(2.0)
"""How far from a part the middle of a square may lie that has something of half of the gap around it [mm]."""
SLICER_CONFIG = "Metadata/Slic3r_PE.config"
"""Where PrusaSlicer keeps its settings in a 3MF, a line each behind a semicolon; it skips the first line."""
SLICER_LAYERS = "Metadata/Prusa_Slicer_layer_config_ranges.xml"
"""Where it keeps the heights of layers, by the number of an object and ranges of its height."""
_ROUNDING = 1e-6


class Spot(NamedTuple):
    """Place of a part: its bed, the corner of its box nearest the origin [mm], turned by 90 degrees or not."""

    bed: int
    x: float
    y: float
    turned: bool


def lay_out(outlines: Sequence[Array], bed: tuple[float, float]) -> list[Spot | None]:
    """Lay parts on as few beds as it takes, the largest first, each as near the front as it can be; all in mm.

    An outline is the points of a part, from above; what counts is their convex hull. Parts keep `GAP` from each other
    and half of it from the edge. One that is too large for a bed gets None. What lies on a bed is around its middle.
    """
    cells = int(bed[0] / CELL), int(bed[1] / CELL)
    taken: list[NDArray[np.bool_]] = []
    spots: list[Spot | None] = [None] * len(outlines)
    hulls = [points[ConvexHull(points).vertices] for points in outlines]
    for index in sorted(range(len(hulls)), key=lambda each: (-ConvexHull(hulls[each]).volume, each)):
        ways = [(_covered(hulls[index]), False), (_covered(_turned(hulls[index])), True)]
        ways = [
            (mask, is_turned) for mask, is_turned in ways if mask.shape[0] <= cells[0] and mask.shape[1] <= cells[1]
        ]
        number = 0
        while ways and spots[index] is None:
            taken += [np.zeros(cells, dtype=np.bool_)] if number == len(taken) else []
            places = [(*place, is_turned) for mask, is_turned in ways if (place := _first_free(taken[number], mask))]
            if places:
                y, x, is_turned = min(places)
                mask = next(mask for mask, way in ways if way == is_turned)
                taken[number][x : x + mask.shape[0], y : y + mask.shape[1]] |= mask
                spots[index] = Spot(number, CELL * x + _MARGIN, CELL * y + _MARGIN, is_turned)
            number += 1
    shifts = []
    for covered in taken:
        ends = [CELL * (1 + int(np.flatnonzero(covered.any(axis=axis)).max())) for axis in (1, 0)]
        shifts.append([0.5 * (side - end) for side, end in zip(bed, ends, strict=True)])
    return [spot and spot._replace(x=spot.x + shifts[spot.bed][0], y=spot.y + shifts[spot.bed][1]) for spot in spots]


def _turned(points: Array) -> Array:
    return np.stack((-points[:, 1], points[:, 0]), axis=1)


def _covered(points: Array) -> NDArray[np.bool_]:
    """Return the squares that a hull covers with half of the gap around it; its box starts `_MARGIN` from the first."""
    low, high = points.min(axis=0) - _MARGIN, points.max(axis=0) + _MARGIN
    x, y = (low[axis] + CELL * (np.arange(ceil((high[axis] - low[axis]) / CELL)) + 0.5) for axis in (0, 1))
    sides = ConvexHull(points).equations  # normals outwards, and the way from there to the origin
    away = sides[:, 0, None, None] * x[:, None] + sides[:, 1, None, None] * y + sides[:, 2, None, None]
    return np.asarray(away.max(axis=0) <= _MARGIN)


def _first_free(taken: NDArray[np.bool_], mask: NDArray[np.bool_]) -> tuple[int, int] | None:
    """Return row and column nearest the front, then the left, where a mask covers no square that is taken."""
    shared = fftconvolve(taken.astype(float), mask[::-1, ::-1].astype(float), mode="valid")
    x, y = np.nonzero(shared < 0.5)
    return min(zip(y.tolist(), x.tolist(), strict=True), default=None)


def walls(dims: Dimensions) -> int:
    """Return how many lines of plastic go around everything: as many as make the thinnest wall of the process."""
    return ceil(dims.minimum_wall / LINE - _ROUNDING)


def description(dims: Dimensions, material: str, temperatures: Mapping[str, str]) -> str:
    """Return the settings in words, for any slicer; `temperatures` [degC] by their names."""
    heat = "".join(f", {name.removesuffix('_temperature')} at {value} °C" for name, value in temperatures.items())
    layers = f"layers of {LAYER:g} mm, in PrusaSlicer such that flat faces lie between two"
    return f"{material}: {LINE:g} mm nozzle, {layers}, {walls(dims)} walls, infill 100 %{heat}"


def slicer_config(dims: Dimensions, density: float, temperatures: Mapping[str, str]) -> str:
    """Return the settings for PrusaSlicer; `density` in kg/m3.

    Supports stand where faces lean more than the process bears, on the bed only, and end a layer short of the part.
    """
    length, width = dims.bed_length, dims.bed_width
    settings = {
        "printer_technology": "FFF",
        "bed_shape": f"0x0,{length:g}x0,{length:g}x{width:g},0x{width:g}",
        "max_print_height": f"{dims.bed_height:g}",
        "nozzle_diameter": f"{LINE:g}",
        "extrusion_width": f"{LINE:g}",
        "layer_height": f"{LAYER:g}",
        "first_layer_height": f"{LAYER:g}",
        "perimeters": f"{walls(dims)}",
        "fill_density": "100%",
        "fill_pattern": "rectilinear",
        "skirts": "0",
        "support_material": "1",
        "support_material_buildplate_only": "1",
        "support_material_contact_distance": f"{LAYER:g}",
        "support_material_threshold": f"{90.0 - degrees(dims.overhang_angle):.0f}",
        "filament_density": f"{1e-3 * density:g}",
    }
    for name in ("temperature", "bed_temperature"):
        value = temperatures["nozzle_temperature" if name == "temperature" else name]
        settings |= {name: value, f"first_layer_{name}": value}
    return "".join(
        f"; {line}\n" for line in ("tvimdesign", "", *(f"{name} = {text}" for name, text in settings.items()))
    )


def fitted_layers(body: trimesh.Trimesh) -> list[tuple[float, float, float]]:
    """Return ranges of height above the first layer, and the height of their layers [mm]: flat faces lie between two.

    Of faces that are nearer to one another than the thinnest layer, the largest does.
    """
    flat = np.abs(body.face_normals[:, 2]) > 1.0 - _ROUNDING
    heights, of_triangle = np.unique(body.triangles_center[flat, 2].round(_DIGITS[1]), return_inverse=True)
    areas = np.bincount(of_triangle, body.area_faces[flat])
    ends = [0.0, LAYER]
    for height in heights[np.argsort(-areas, kind="stable")].tolist():
        if height > LAYER and min(abs(height - end) for end in ends) > THIN_LAYER - _ROUNDING:
            ends.append(height)
    return [(low, high, (high - low) / max(1, round((high - low) / LAYER))) for low, high in pairwise(sorted(ends)[1:])]


_DIGITS = (6, 5, 7)
"""Decimals of a millimetre to which a mesh's vertices are merged. A coordinate can lie where one rounding splits it
from its neighbour of the next face; not where three do."""
_SAME = 1e-4  # Axes [mm] that are nearer than that are one
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
_TYPES = "http://schemas.openxmlformats.org/package/2006/content-types"
_EPOCH = (1980, 1, 1, 0, 0, 0)  # The time of every entry of a 3MF archive, so that the same part gives the same file


def with_wider_holes(solid: cq.Solid, compensation: float, reamed: Sequence[tuple[float, float]] = ()) -> cq.Solid:
    """Return the part with its upright holes wider by `compensation` [mm on the diameter].

    Holes whose axes are `reamed` stay as they are: they come out small, and a reamer brings them to their size.
    """
    if not compensation > 0.0:
        return solid
    tools = [
        cq.Solid.makeCylinder(
            hole.radius + 0.5 * compensation, hole.top - hole.bottom, cq.Vector(hole.x, hole.y, hole.bottom),
            cq.Vector(0, 0, 1),
        )
        for hole in holes(solid)
        if not any(hypot(hole.x - x, hole.y - y) < _SAME for x, y in reamed)
    ]  # fmt: skip
    return _one_solid(solid.cut(*tools)) if tools else solid


def as_printed(
    solid: cq.Solid, making: Production, hole_compensation: float, reamed: Sequence[tuple[float, float]] = ()
) -> cq.Solid:
    """Return the part with wider holes (`with_wider_holes`), lying as it is printed.

    What lies on the bed is at z = 0, the part's own axis at x = y = 0.
    """
    wider = with_wider_holes(solid, hole_compensation, reamed)
    lying = wider.rotate(cq.Vector(), cq.Vector(1, 0, 0), 180.0) if making.down == "top" else wider
    return _one_solid(lying.translate(cq.Vector(0, 0, -tight_box(lying).zmin)), moved=True)


def _one_solid(shape: cq.Shape, *, moved: bool = False) -> cq.Solid:
    """Return the solid of a shape; one that was only `moved` is as valid as before."""
    solids = shape.Solids()
    if len(solids) != 1 or not (moved or solids[0].isValid()):
        raise GeometryError(f"with its holes compensated for printing it comes out as {len(solids)} solids")
    return solids[0]


def printed_mesh(name: str, solid: cq.Solid) -> tuple[trimesh.Trimesh, float]:
    """Triangulate a part; returns a closed mesh and the largest distance of its triangles from the part [mm]."""
    patches = face_meshes(solid)
    worst = max(_distance(face, mesh) for face, mesh in patches)
    first = np.cumsum([0] + [len(mesh.vertices) for _, mesh in patches])
    faces = np.concatenate([mesh.faces + start for (_, mesh), start in zip(patches, first, strict=False)])
    return closed(name, Mesh(np.concatenate([mesh.vertices for _, mesh in patches]), faces)), worst


def closed(name: str, mesh: Mesh) -> trimesh.Trimesh:
    """Return a mesh with its vertices merged; raises GeometryError where it does not enclose a body.

    At the tip of a cone a triangle may have two corners at one place: it is left out.
    """
    for digits in _DIGITS:
        body = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
        body.merge_vertices(digits_vertex=digits, merge_norm=True, merge_tex=True)
        corners = body.faces
        body.update_faces(np.all(corners != np.roll(corners, 1, axis=1), axis=1))
        if body.is_watertight and body.volume > 0.0:
            return body
    raise GeometryError(f"{name}: its triangle mesh is not watertight; the STEP file is sound, print from that")


def _distance(face: cq.Face, mesh: Mesh) -> float:
    """Return largest distance [mm] of the middles of triangles and of their edges from the face they stand for."""
    corners = mesh.vertices[mesh.faces]
    middles = [corners.mean(axis=1), *(0.5 * (corners[:, place] + corners[:, (place + 1) % 3]) for place in range(3))]
    return float(np.max(_from_surface(face, np.concatenate(middles))))


def _from_surface(face: cq.Face, points: Array) -> Array:
    """Return distance of points from the surface of a face: in closed form where there is one, else by projection."""
    surface = BRepAdaptor_Surface(face.wrapped)
    kind = face.geomType()
    if kind == "PLANE":
        plane = surface.Plane()
        above: Array = (points - _xyz(plane.Location())) @ _xyz(plane.Axis().Direction())
        return np.asarray(np.abs(above))
    if kind == "CYLINDER":
        cylinder = surface.Cylinder()
        beside = np.cross(points - _xyz(cylinder.Location()), _xyz(cylinder.Axis().Direction()))
        return np.asarray(np.abs(np.linalg.norm(beside, axis=1) - cylinder.Radius()))
    if kind == "TORUS":
        torus = surface.Torus()
        out, up = _about(torus.Location(), torus.Axis().Direction(), points)
        return np.asarray(np.abs(np.hypot(out - torus.MajorRadius(), up) - torus.MinorRadius()))
    whole = surface.Surface().Surface().Transformed(surface.Trsf())
    return np.array([GeomAPI_ProjectPointOnSurf(gp_Pnt(*point), whole).LowerDistance() for point in points.tolist()])


def _about(place: gp_Pnt, axis: gp_Dir, points: Array) -> tuple[Array, Array]:
    """Return how far points are from an axis, and how far along it from a place on it [mm]."""
    away, along = points - _xyz(place), _xyz(axis)
    return np.asarray(np.linalg.norm(np.cross(away, along), axis=1)), np.asarray(away @ along)


def _xyz(of: gp_Pnt | gp_Dir) -> Array:
    return np.array([of.X(), of.Y(), of.Z()])


def stl_bytes(body: trimesh.Trimesh) -> bytes:
    """Return a mesh as binary STL in millimetres."""
    return bytes(body.export(file_type="stl"))


def threemf_bytes(body: trimesh.Trimesh, product: Product) -> bytes:
    """Return a mesh as 3MF: millimetres, the part's name, its material with its colour."""
    return plate_bytes(product.name, [Laid(body, product)])


@dataclass(frozen=True, eq=False)
class Laid:
    """A part as it is printed, and where its copies lie."""

    body: trimesh.Trimesh
    product: Product
    places: Sequence[tuple[float, float, bool]] = ()
    """Corner of the box of each copy [mm], and whether it is turned by 90 degrees; none of what lies as it is."""

    def transforms(self) -> list[str]:
        """Return attributes of the items: rows of a rotation about z, and the way to the place."""
        (left, front, _), (_, back, _) = self.body.bounds.tolist()
        attributes = []
        for x, y, is_turned in self.places:
            rows, start = ("0 1 0 -1 0 0 0 0 1", (-back, left)) if is_turned else ("1 0 0 0 1 0 0 0 1", (left, front))
            attributes.append(f' transform="{rows} {x - start[0]:.9g} {y - start[1]:.9g} 0"')
        return attributes or [""]


def plate_bytes(title: str, parts: Sequence[Laid], description: str = "", config: str = "") -> bytes:
    """Return parts on a bed as 3MF, with their settings in words, and in a file of their own for a slicer."""
    resources, items = [], []
    for number, part in enumerate(parts):
        product, material, thing = part.product, 2 * number + 1, 2 * number + 2
        colour = "#" + "".join(f"{round(255 * share):02X}" for share in product.colour)
        points = "".join(f'<vertex x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>' for x, y, z in part.body.vertices.tolist())
        triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in part.body.faces.tolist())
        resources.append(
            f'<basematerials id="{material}"><base name={quoteattr(product.material)} displaycolor="{colour}"/>'
            f'</basematerials><object id="{thing}" type="model" name={quoteattr(product.name)} pid="{material}" '
            f'pindex="0"><mesh><vertices>{points}</vertices><triangles>{triangles}</triangles></mesh></object>'
        )
        items += [f'<item objectid="{thing}"{transform}/>' for transform in part.transforms()]
    about = f'<metadata name="Description">{escape(description)}</metadata>' if description else ""
    model = (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<model unit="millimeter" xml:lang="en-US" xmlns="{_CORE}">'
        f'<metadata name="Title">{escape(title)}</metadata><metadata name="Application">tvimdesign</metadata>{about}'
        f"<resources>{''.join(resources)}</resources><build>{''.join(items)}</build></model>\n"
    )
    kinds = {"config": "text/plain", "xml": "application/xml"} if config else {}
    plain = "".join(f'<Default Extension="{end}" ContentType="{kind}"/>' for end, kind in kinds.items())
    types = (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<Types xmlns="{_TYPES}">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
        f"{plain}</Types>\n"
    )
    relations = (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<Relationships xmlns="{_RELATIONS}"><Relationship '
        'Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>'
        "</Relationships>\n"
    )
    entries = {"[Content_Types].xml": types, "_rels/.rels": relations, "3D/3dmodel.model": model}
    if config:
        entries |= {SLICER_CONFIG: config, SLICER_LAYERS: _layers_xml(parts)}
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, text in entries.items():
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3
            archive.writestr(entry, text.encode())
    return stream.getvalue()


def _layers_xml(parts: Sequence[Laid]) -> str:
    objects = []
    for number, part in enumerate(parts, start=1):
        ranges = "".join(
            f'<range min_z="{low:.9g}" max_z="{high:.9g}"><option opt_key="extruder">0</option>'
            f'<option opt_key="layer_height">{layer:.9g}</option></range>'
            for low, high, layer in fitted_layers(part.body)
        )
        objects.append(f'<object id="{number}">{ranges}</object>')
    return f'<?xml version="1.0" encoding="utf-8"?>\n<objects>{"".join(objects)}</objects>\n'


@lru_cache(maxsize=64)
def body_of(name: str, mesh: Mesh) -> Manifold:
    """Return the body that a mesh encloses. Raises GeometryError where it encloses none."""
    merged = closed(name, mesh)
    body = Manifold(Mesh64(np.array(merged.vertices, dtype=np.float64), np.array(merged.faces, dtype=np.uint64)))
    if body.status() != Error.NoError:
        raise GeometryError(f"{name}: its triangle mesh is no body: {body.status()}")
    return body


def mesh_of(body: Manifold) -> Mesh:
    """Return the triangles of a body."""
    triangles = body.to_mesh64()
    return Mesh(np.array(triangles.vert_properties[:, :3]), np.array(triangles.tri_verts, dtype=np.int64))
