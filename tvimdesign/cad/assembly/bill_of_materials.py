"""The bill of materials: what a module is put together from, how often, of what, and how heavy."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import cadquery as cq

from tvimdesign.base.whole_files import TABLE_ENCODING
from tvimdesign.cad.assembly import file_names
from tvimdesign.cad.assembly.product_data import product
from tvimdesign.cad.geometry.kinds import KINDS, SPRINGS, kind_of
from tvimdesign.cad.geometry.production import PRODUCTION
from tvimdesign.device.fixtures.tang import BONDED
from tvimdesign.study.design import Design


@dataclass(frozen=True)
class Item:
    """One kind of part."""

    kind: str
    quantity: int
    made: bool
    material: str
    """Record of the catalogue."""
    title: str
    """What the catalogue calls it, with the maker's number where there is one."""
    mass: float
    """Of one [g]."""
    papers: tuple[str, ...]
    """Files it is made or bought from."""


def bill(design: Design, titles: Mapping[str, str], placed: Mapping[str, cq.Solid]) -> list[Item]:
    """Count the placed parts by kind; masses are those of the solids."""
    groups: dict[str, list[cq.Solid]] = {}
    for name, solid in placed.items():
        groups.setdefault(kind_of(name), []).append(solid)
    items = []
    for kind, solids in groups.items():
        what = product(design, kind)
        mass = solids[0].Volume() * what.density * 1e-6
        title = titles.get(KINDS[kind].material, what.material)
        made = PRODUCTION[kind].down != "bought"
        items.append(Item(kind, len(solids), made, what.material, title, mass, _papers(kind)))
    return items


def consumables(design: Design, titles: Mapping[str, str]) -> list[Item]:
    """What is bought and used up, and drawn in no file: the adhesive of the tangs, all of it as one."""
    if design.choices.get("tang_hold") != BONDED:
        return []
    mass = 1e3 * design.value("tang_adhesive_mass")
    record = str(design.choices["tang_adhesive"])
    return [Item("tang_adhesive", 1, False, record, titles.get("tang_adhesive", record), mass, ())]


def _papers(kind: str) -> tuple[str, ...]:
    """Files a part is made from, or ordered by."""
    if kind in SPRINGS:
        return (file_names.SPRING_SHEET, file_names.SPRING_TABLE)
    if PRODUCTION[kind].down == "bought":
        return (file_names.step(kind),)
    drawing = (file_names.drawing_pdf(kind),) if PRODUCTION[kind].drawn else ()
    return (file_names.step(kind), *drawing, file_names.print_3mf(kind))


def bill_csv(items: Sequence[Item]) -> bytes:
    """The bill as CSV, a row for each kind of part."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["item", "part", "quantity", "made_or_bought", "catalogue_record", "title", "mass_each_g",
                     "mass_all_g", "files"])  # fmt: skip
    for number, one in enumerate(items, start=1):
        writer.writerow([
            number, one.kind, one.quantity, "made" if one.made else "bought", one.material, one.title,
            f"{one.mass:.3f}", f"{one.mass * one.quantity:.3f}", " ".join(one.papers),
        ])  # fmt: skip
    return stream.getvalue().encode(TABLE_ENCODING)
