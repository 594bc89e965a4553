"""Whether the casting jig gives the part: it goes together without a cut, keeps its thickness, and holds the melt."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import cadquery as cq

from tvimdesign.cad.cad_report import SolidCheck, at_most, finding
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import cylinder, polar
from tvimdesign.cad.inspection.size_checks import TOUCHING, interference_checks
from tvimdesign.cad.parts import casting_jig

_PART = "casting_jig"
_NEEDLE = 0.05
"""Radius of the upright needle by which the gap between mould and lid is measured [mm]."""
_EXACT = 1e-6


def casting_checks(dims: Dimensions, kind: str, solids: Mapping[str, cq.Solid]) -> Iterator[SolidCheck]:
    """Hold mould and lid against the part of a kind that is cast in them; all three stand as they are drawn."""
    part, mould, lid = (solids[name] for name in (kind, "casting_mould", "casting_lid"))
    yield from interference_checks(dict(solids), "in the casting jig")
    wanted = dims.pcl_thickness if kind == "pcl_arc" else dims.vane_height - dims.running_clearance
    off = abs(gap(dims, mould, lid) - wanted)
    text = f"the gap between mould and lid is {gap(dims, mould, lid):.4g} mm, the part's thickness {wanted:.4g} mm"
    yield finding(_PART, "gap", off, _EXACT, "mm", at_most(off, _EXACT), text)
    room = casting_jig.dam(dims, part).cut(mould, part).Volume()
    text = f"{room:.3g} mm3 of the dam are open beside the part"
    yield finding(_PART, "melt", room, TOUCHING, "mm^3", at_most(room, TOUCHING), text)


def gap(dims: Dimensions, mould: cq.Solid, lid: cq.Solid) -> float:
    """Way from the mould's floor to the lid's face, measured near the part's inner edge, where no key is [mm]."""
    inner, outer = dims.pcl_inner_radius, dims.pcl_outer_radius
    needle = cylinder(_NEEDLE, -100.0, 100.0, polar(inner + 0.05 * (outer - inner), 0.0))
    floor, face = mould.intersect(needle).BoundingBox(), lid.intersect(needle).BoundingBox()
    return float(face.zmin - floor.zmax)
