"""Which pieces of work make a module's files: each kind of part, the checks, the assembly, the papers, the pictures."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from math import dist
from pathlib import Path

import cadquery as cq
import numpy as np
from OCP.BinTools import BinTools
from OCP.TopoDS import TopoDS_Shape

from tvimdesign.base.errors import GeometryError
from tvimdesign.base.units import from_si
from tvimdesign.cad import cad_report
from tvimdesign.cad.assembly.assembly import MODULES, drawn_part, free_spring, installed_coils, one_solid, place
from tvimdesign.cad.assembly.assembly_data import assembly_data, glb_bytes, instances
from tvimdesign.cad.assembly.assembly_note import assembly_note, written_steps
from tvimdesign.cad.assembly.bill_of_materials import as_ordered, beside, bill, bill_csv, fixtures
from tvimdesign.cad.assembly.heater_leads import heater_order
from tvimdesign.cad.assembly.module_script import module_script
from tvimdesign.cad.assembly.wiring import wiring_svg
from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.drawing.assembly_sheet import assembly_sheet
from tvimdesign.cad.drawing.drawing_requirements import DrawingRequirements, drawing_requirements
from tvimdesign.cad.drawing.drawings import part_sheet, plate_outline
from tvimdesign.cad.drawing.spring_sheet import spring_csv, spring_lines, spring_sheet
from tvimdesign.cad.export import print_files
from tvimdesign.cad.export.mesh import CHORD, Mesh, read_mesh, solid_mesh, write_mesh
from tvimdesign.cad.export.print_files import Laid
from tvimdesign.cad.export.step_file import Product, product, read_part, validation, write_assembly, write_part
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.features import tight_box
from tvimdesign.cad.geometry.kinds import KINDS, PRODUCTION, SPRINGS, STRUCTURE, Production, is_of_structure, kind_of
from tvimdesign.cad.inspection.inspect import casting_checks, module_checks, part_checks, setting_checks
from tvimdesign.cad.inspection.size_checks import POSITIONS, clearance_checks, rest_checks
from tvimdesign.cad.jobs.worker import Job, Turn, Work
from tvimdesign.cad.parts import jigs
from tvimdesign.cad.parts.common_parts import reamed_places
from tvimdesign.study import Design

PICTURES = "pictures"  # The work without which a module can still be made: a machine may not be able to render
_SOLID, _MESH, _PRINTED = "solid.bin", "mesh.npz", "printed.npz"
_READ_BACK = 1e-6  # How far a part may be from what its STEP file says, relative; centroids in mm


def build_plan(dims: Dimensions) -> list[Work]:
    """Return all pieces of work for a module."""
    kinds = tuple(MODULES[dims.mode].drawn(dims))
    coils = SPRINGS if dims.spring_count else ()
    parts = [
        Work(name=kind, do=partial(_part, kind), turn=_turn(kind), words=f"drawing: {_words(kind)}") for kind in kinds
    ]
    made = [
        Work(
            name=f"{kind}_for_makers",
            do=partial(_for_makers, kind),
            needs=(kind,),
            named=PRODUCTION[kind].drawn,
            turn=Turn.LATE,
            words=f"drawings and print files: {_words(kind)}",
        )
        for kind in kinds
        if PRODUCTION[kind].drawn or PRODUCTION[kind].down != "bought"
    ]
    springs = [Work(name=kind, do=partial(_spring, kind), words=f"drawing: {_words(kind)}") for kind in coils]
    setting = [
        Work(name=jigs.FORK, do=_setting_fork, named=True),
        Work(name="inspect_setting", do=_inspect_setting, needs=("housing", "rotor", jigs.FORK)),
        Work(name="spring_sheet", do=_spring_sheet, named=True),
    ]
    clearances = [
        Work(
            name=f"interference_{index + 1}",
            do=partial(_clearances, share),
            needs=kinds,
            words=f"collisions of parts, position {index + 1} / {len(POSITIONS)} of the stroke",
        )
        for index, share in enumerate(POSITIONS)
    ]
    inspections = [
        Work(name=f"inspect_{kind}", do=partial(_inspect, kind), needs=(kind,), words=f"checking: {_words(kind)}")
        for kind in kinds
        if is_of_structure(kind)
    ]
    return [
        Work(name=PICTURES, do=_pictures, needs=kinds, turn=Turn.FIRST),  # before all else, once the parts are there
        *parts,
        *made,
        *springs,
        Work(name="sizes", do=_sizes, needs=kinds, words="volumes and inertias"),
        *clearances,
        *inspections,
        *(Work(name=kind, do=partial(_casting_jig, kind), named=True) for kind in jigs.DRAWN),
        *(setting if coils else ()),
        Work(name=jigs.TRIAL, do=_test_pieces, named=True),
        Work(name="plates", do=_plates, needs=_plated(kinds, bool(coils)), named=True, words="print beds"),
        Work(name="inspect_casting", do=_inspect_casting, needs=(jigs.part_of(kinds), *jigs.DRAWN)),
        Work(name="inspect_module", do=_inspect_module, needs=kinds),
        Work(name="assembly", do=_assembly, needs=kinds, named=True, words="assembly files"),
        Work(name="assembly_drawing", do=_assembly_sheet, needs=kinds, named=True),
        Work(name="script", do=_script, named=True, words="script of the parts"),
        Work(name="bill_and_note", do=_bill_and_note, needs=kinds, named=True, words="bill of materials"),
    ]


def _plated(kinds: Sequence[str], has_springs: bool) -> tuple[str, ...]:
    """Return the work that a print bed needs: meshes to lay on it, and parts to count copies of."""
    made = [f"{kind}_for_makers" for kind in kinds if is_of_structure(kind)]
    return (*kinds, *made, *jigs.DRAWN, *((jigs.FORK,) if has_springs else ()))


def _words(kind: str) -> str:
    return kind.replace("_", " ")


def _turn(kind: str) -> Turn:
    """Return when a part is made: one process starts with the housing, the other with the first small part, then the
    rotor."""
    return Turn.SECOND if kind == "rotor" else Turn.FIRST


def _part(kind: str, job: Job) -> list[SolidCheck]:
    """Make one part: its solid, which others wait for, and its STEP."""
    solid = drawn_part(job.dims, kind)
    _keep(job.folder / "kept" / _SOLID, solid)
    write_mesh(job.folder / "kept" / _MESH, solid_mesh(solid))
    return _step(job.folder, solid, product(job.design, kind))


def _for_makers(kind: str, job: Job) -> list[SolidCheck]:
    """Make what a part is printed or milled from."""
    solid, what = _solids(job.needs)[kind], product(job.design, kind)
    if PRODUCTION[kind].drawn:
        requirements = drawing_requirements(kind, job.dims, job.design.choices)
        if kind == "heater" and (order := heater_order(job.design)):
            requirements = replace(requirements, notes=[f"{words[0].upper()}{words[1:]}." for words in order])
        if is_of_structure(kind) and (treatment := job.titles.get(cad_report.TREATMENT)):
            notes = [*requirements.notes, f"Before reaming: {treatment}, as its strength is counted."]
            requirements = replace(requirements, notes=notes)
        _sheet(job, kind, solid, what, requirements)
        if outline := plate_outline(solid):
            _write(job.folder, cad_report.cut_dxf(kind), outline)
    return [] if PRODUCTION[kind].down == "bought" else [_print(job, kind, solid, what, PRODUCTION[kind])]


def _sheet(job: Job, kind: str, solid: cq.Solid, what: Product, requirements: DrawingRequirements) -> None:
    """Write the drawing of a part or a fixture."""
    material = KINDS[kind].material if kind in KINDS else STRUCTURE
    sheet = part_sheet(kind, solid, what, job.design.name, requirements, job.titles.get(material, ""))
    _write(job.folder, cad_report.drawing_dxf(kind), sheet.dxf())
    _write(job.folder, cad_report.drawing_pdf(kind), sheet.pdf())


def _casting_jig(kind: str, job: Job) -> list[SolidCheck]:
    """Make one piece of the jig that the PCL is cast in."""
    cast = jigs.part_of(tuple(MODULES[job.dims.mode].drawn(job.dims)))
    solid = one_solid(kind, lambda: jigs.DRAWN[kind](job.dims, drawn_part(job.dims, cast)))
    return _fixture(job, kind, solid)


def _setting_fork(job: Job) -> list[SolidCheck]:
    """Make the fork that holds the rotor while its springs are set."""
    solid = one_solid(jigs.FORK, lambda: jigs.fork(job.dims))
    return _fixture(job, jigs.FORK, solid)


def _test_pieces(job: Job) -> list[SolidCheck]:
    """Make what a printer is tried with: its holes as drawn, for they say by how much others are to be widened."""
    if job.design.choices["making_method"] == "milled":
        return []
    solid, what = one_solid(jigs.TRIAL, lambda: jigs.trial(job.dims)), _of_structure(job, jigs.TRIAL)
    return [*_step(job.folder, solid, what), _print(job, jigs.TRIAL, solid, what, jigs.MAKING[jigs.TRIAL], wider=0.0)]


def _fixture(job: Job, kind: str, solid: cq.Solid) -> list[SolidCheck]:
    """Write a fixture, which is made of what the structure is made of."""
    _keep(job.folder / "kept" / _SOLID, solid)
    what = _of_structure(job, kind)
    _sheet(job, kind, solid, what, drawing_requirements(kind, job.dims, job.design.choices))
    return [*_step(job.folder, solid, what), _print(job, kind, solid, what, jigs.MAKING[kind])]


def _of_structure(job: Job, fixture: str) -> Product:
    of = str(job.design.choices[STRUCTURE])
    return Product(name=fixture, colour=jigs.COLOUR, material=of, density=job.design.value("structure_density"))


def _spring(kind: str, job: Job) -> list[SolidCheck]:
    """Make one spring as its maker delivers it."""
    return _step(job.folder, free_spring(job.dims, kind), product(job.design, kind))


def _step(folder: Path, solid: cq.Solid, what: Product) -> list[SolidCheck]:
    """Write a part's STEP file, and compare what is read back with what the file says it must be."""
    path = _place(folder, cad_report.step(what.name))
    written = write_part(path, solid, what)
    read, reported = read_part(path)
    measured = validation(read)
    off = max(abs(measured.volume / properties.volume - 1.0) for properties in (reported, written))
    off = max(off, abs(measured.area / reported.area - 1.0))
    beside = dist(measured.centroid, reported.centroid)
    if beside > off:  # else it is less than that over any size; the tightest box takes as long as all else here
        off = max(off, beside / max(tight_box(solid).DiagonalLength, 1.0))
    text = f"{what.name}: volume, area and centroid read back from STEP as the file says they are"
    return [SolidCheck(cad_report.step(what.name), off, _READ_BACK, off <= _READ_BACK, text)]


def _print(
    job: Job, kind: str, solid: cq.Solid, what: Product, making: Production, *, wider: float | None = None
) -> SolidCheck:
    """Write what a printer gets, upright holes `wider`, by default by the process's compensation.

    A mesh that does not close is a check that fails, and its files are left out.
    """
    wider = job.dims.hole_compensation if wider is None else wider
    name = cad_report.print_stl(kind)
    try:
        lying = print_files.as_printed(solid, making, wider, reamed_places(job.dims))
        body, distance = print_files.printed_mesh(kind, lying)
    except GeometryError as error:
        return SolidCheck(name, 1.0, 0.0, False, str(error))
    write_mesh(job.folder / "kept" / _PRINTED, Mesh(body.vertices, body.faces))
    _write(job.folder, cad_report.print_3mf(kind), print_files.threemf_bytes(body, what))
    _write(job.folder, name, print_files.stl_bytes(body))
    text = f"{kind}: its mesh is watertight and nowhere further than stated from the part [mm]"
    return SolidCheck(name, distance, CHORD, distance <= CHORD, text)


def _plates(job: Job) -> list[SolidCheck]:
    """Lay the printed parts on beds, and the casting jig if their material bears its heat."""
    if job.design.choices["making_method"] == "milled":
        return []
    meshes = {need: folder / _PRINTED for need, folder in job.needs.items() if (folder / _PRINTED).exists()}
    module = MODULES[job.dims.mode]
    drawn = _solids({kind: job.needs[kind] for kind in module.drawn(job.dims)})
    counts = Counter(kind_of(name) for name in module.stand(job.dims, drawn, 0.0))
    counts |= Counter({jigs.FORK: jigs.FORK_COUNT})
    if from_si(job.design.value("structure_service_temperature"), "degC") >= jigs.CAST_AT:
        counts |= Counter([*jigs.DRAWN])
    parts = {need.removesuffix("_for_makers"): print_files.closed(need, _mesh(path)) for need, path in meshes.items()}
    copies = [kind for kind in parts for _ in range(counts[kind])]
    spots = print_files.lay_out(
        [np.asarray(parts[kind].vertices)[:, :2] for kind in copies], (job.dims.bed_length, job.dims.bed_width)
    )
    known = {name: job.titles[name] for name in cad_report.PRINT_TEMPERATURES if name in job.titles}
    density, config = job.design.value("structure_density"), ""
    about = job.titles.get(STRUCTURE, str(job.design.choices[STRUCTURE]))
    if len(known) == len(cad_report.PRINT_TEMPERATURES):  # of a filament that is printed at home
        config, about = (
            print_files.slicer_config(job.dims, density, known),
            print_files.description(job.dims, about, known),
        )
    beds = 1 + max((spot.bed for spot in spots if spot), default=-1)
    for number in range(beds):
        laid = []
        for kind, body in parts.items():
            lying = zip(copies, spots, strict=True)
            places = [(at.x, at.y, at.turned) for copy, at in lying if copy == kind and at and at.bed == number]
            what = _of_structure(job, kind) if kind in jigs.MAKING else product(job.design, kind)
            laid += [Laid(body, what, places)] if places else []
        title = f"{job.design.name}, bed {number + 1} of {beds}"
        _write(job.folder, cad_report.plate_3mf(number + 1), print_files.plate_bytes(title, laid, about, config))
    outside = spots.count(None)
    text = f"print beds: {beds}; parts on them: {len(copies) - outside}; too large for one, with room around: {outside}"
    return [SolidCheck(cad_report.plate_3mf(1), float(outside), 0.0, True, text, warned=bool(outside))]


def _sizes(job: Job) -> list[SolidCheck]:
    return rest_checks(job.design, job.dims, _solids(job.needs))


def _clearances(share: float, job: Job) -> list[SolidCheck]:
    return clearance_checks(job.dims, _solids(job.needs), share, _meshes(job.needs))


def _inspect(kind: str, job: Job) -> list[SolidCheck]:
    return part_checks(job.design, job.dims, kind, _solids(job.needs)[kind], _meshes(job.needs)[kind])


def _inspect_setting(job: Job) -> list[SolidCheck]:
    return list(setting_checks(job.dims, _solids(job.needs)))


def _inspect_casting(job: Job) -> list[SolidCheck]:
    return list(casting_checks(job.dims, jigs.part_of(tuple(job.needs)), _solids(job.needs)))


def _inspect_module(job: Job) -> list[SolidCheck]:
    return list(module_checks(job.design, job.dims, _solids(job.needs), _meshes(job.needs)))


def _assembly(job: Job) -> list[SolidCheck]:
    """Make the module at rest as STEP and GLB, and what programs that show it need to know of its parts."""
    drawn = _solids(job.needs)
    placed = place(job.dims, drawn)
    products = {name: product(job.design, kind_of(name)) for name in placed}
    write_assembly(job.folder / "out" / cad_report.ASSEMBLY_STEP, job.design.name, placed, products)
    meshed = instances(job.dims, drawn, placed, _meshes(job.needs))
    _write(job.folder, cad_report.ASSEMBLY_GLB, glb_bytes(meshed))
    items = bill(job.design, job.titles, placed)
    _write(job.folder, cad_report.ASSEMBLY_DATA, assembly_data(job.design, job.dims, items, meshed))
    return []


def _assembly_sheet(job: Job) -> list[SolidCheck]:
    """Make the drawing of the whole module, its parts numbered as in the bill."""
    drawn = _solids(job.needs)
    placed = place(job.dims, drawn)
    items = as_ordered(bill(job.design, job.titles, placed))
    meshed = instances(job.dims, drawn, placed, _meshes(job.needs))
    sheet = assembly_sheet(job.design.name, items, placed, meshed, installed_coils(job.dims))
    _write(job.folder, cad_report.drawing_dxf(cad_report.ASSEMBLY), sheet.dxf())
    _write(job.folder, cad_report.drawing_pdf(cad_report.ASSEMBLY), sheet.pdf())
    return []


def _spring_sheet(job: Job) -> list[SolidCheck]:
    """Make what the spring maker needs."""
    lines = spring_lines(job.design, job.dims, job.titles)
    _write(job.folder, cad_report.SPRING_TABLE, spring_csv(lines))
    _write(job.folder, cad_report.SPRING_SHEET, spring_sheet(job.design, job.dims, lines).pdf())
    return []


def _script(job: Job) -> list[SolidCheck]:
    """Make the script that draws the parts with CadQuery alone."""
    _write(job.folder, cad_report.MODULE_SCRIPT, module_script(job.design, job.dims))
    return []


def _bill_and_note(job: Job) -> list[SolidCheck]:
    """Make what there is of each part, and how they go together."""
    items = bill(job.design, job.titles, place(job.dims, _solids(job.needs)), fits(job.design, job.dims))
    extra = [*beside(job.design, job.titles), *fixtures(job.design, job.titles)]
    _write(job.folder, cad_report.BILL_OF_MATERIALS, bill_csv([*items, *extra]))
    _write(job.folder, cad_report.WIRING, wiring_svg(job.design, [*items, *extra]))
    _write(job.folder, cad_report.ASSEMBLY_NOTE, assembly_note(job.design, job.dims, items, extra))
    return []


def fits(design: Design, dims: Dimensions) -> dict[str, str]:
    """Return tolerance classes of the seats that bearings and dowel pins go into, by kind, as the drawings have
    them."""
    classes: dict[str, list[str]] = {}
    for kind in MODULES[dims.mode].drawn(dims):
        if PRODUCTION[kind].drawn:
            for seat in drawing_requirements(kind, dims, design.choices).seats:
                if seat.mates and seat.fit:
                    classes.setdefault(seat.mates, []).append(f"{kind.replace('_', ' ')} ⌀{seat.size:.4g} {seat.fit}")
    return {kind: ", ".join(seats) for kind, seats in classes.items()}


def _pictures(job: Job) -> list[SolidCheck]:
    """Make the module whole and opened, taken apart, and cut through."""
    from tvimdesign.cad.render.pictures import write_exploded, write_preview, write_section, write_steps

    drawn = _solids(job.needs)
    solids = place(job.dims, drawn)
    placed = instances(job.dims, drawn, solids, _meshes(job.needs))
    write_preview(_place(job.folder, cad_report.PREVIEW), job.dims, drawn, placed)
    items = bill(job.design, job.titles, solids)
    numbers = {kind: number for number, item in enumerate(as_ordered(items), start=1) for kind in item.solids}
    write_exploded(_place(job.folder, cad_report.EXPLODED), placed, numbers)
    write_section(_place(job.folder, cad_report.SECTION), solids, placed)
    written = enumerate(written_steps(job.design, job.dims, items), start=1)
    steps = {cad_report.step_picture(number): step.shown(list(placed)) for number, step in written}
    write_steps(job.folder / "out", placed, steps)
    return []


def _keep(path: Path, solid: cq.Solid) -> None:
    if not BinTools.Write_s(solid.wrapped, str(path)):
        raise GeometryError(f"{path}: cannot be written; is the disk full?")


def _solids(needs: Mapping[str, Path]) -> dict[str, cq.Solid]:
    """Return the solids that other pieces of work have built, by kind."""
    solids = {}
    for kind, folder in needs.items():
        shape = TopoDS_Shape()
        if not BinTools.Read_s(shape, str(folder / _SOLID)):
            raise GeometryError(f"{kind}: its kept solid cannot be read; delete the folder of kept results")
        solids[kind] = cq.Shape.cast(shape)
    return solids


def _meshes(needs: Mapping[str, Path]) -> dict[str, Mesh]:
    return {kind: _mesh(folder / _MESH) for kind, folder in needs.items()}


_mesh = lru_cache(maxsize=256)(read_mesh)  # a child does several pieces of work; what is kept does not change


def _write(folder: Path, name: str, data: bytes) -> None:
    _place(folder, name).write_bytes(data)


def _place(folder: Path, name: str) -> Path:
    path = folder / "out" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    return path
