"""Writes STEP AP242 in millimetres: named, coloured solids with material and density, the same bytes every time."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import cadquery as cq
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRepGProp import BRepGProp
from OCP.gp import gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Reader, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_StepModelType
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import (
    XCAFDoc_Area,
    XCAFDoc_Centroid,
    XCAFDoc_ColorType,
    XCAFDoc_DocumentTool,
    XCAFDoc_ShapeTool,
    XCAFDoc_Volume,
)

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.geometry.kinds import KINDS, Rgb
from tvimdesign.study import Design

_STYLES = re.compile(r"^#(\d+) = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION\('',", re.MULTILINE)
_NUMBER = re.compile(r"#(\d+)")
_COLOUR = re.compile(r"^#(\d+) = COLOUR_RGB\(.*\n", re.MULTILINE)
_CONTEXT = re.compile(r",#(\d+)\);")


def in_fixed_order(text: str) -> str:
    """Sort the blocks of colours at the end of a STEP file by the part they belong to, and renumber them.

    Each block is one presentation with the entities it refers to; its last reference is the part's context, which
    stands earlier in the file and has the same number every time. A colour that parts share stands in the first block.
    """
    starts = [match.start() for match in _STYLES.finditer(text)]
    if len(starts) < 2:
        return text
    end = text.index("ENDSEC;", starts[-1])
    # One entity a line: where the kernel breaks lines depends on the numbers.
    blocks = [re.sub(r"\n +", "", text[first:last]) for first, last in pairwise([*starts, end])]
    first_number = min(int(number[1]) for block in blocks if (number := _NUMBER.match(block)))
    blocks.sort(key=_context)
    blocks = _colours_where_first_used(blocks)
    old = [int(number) for block in blocks for number in re.findall(r"^#(\d+) =", block, re.MULTILINE)]
    new = {number: first_number + index for index, number in enumerate(old)}
    tail = _NUMBER.sub(lambda match: f"#{new.get(int(match[1]), int(match[1]))}", "".join(blocks))
    return text[: starts[0]] + tail + text[end:]


def _colours_where_first_used(blocks: list[str]) -> list[str]:
    """Write each colour after the first line that refers to it; the kernel writes it with the part it meets first."""
    colours = {match[1]: match[0] for block in blocks for match in _COLOUR.finditer(block)}
    written = []
    for block in blocks:
        lines = []
        for line in _COLOUR.sub("", block).splitlines(keepends=True):
            lines.append(line)
            lines += [colours.pop(number) for number in _NUMBER.findall(line) if number in colours]
        written.append("".join(lines))
    return written


def plain_text(text: str) -> bytes:
    """Encode a STEP file: letters beyond ASCII are written as ISO 10303-21 has them, hexadecimal between X2 and X0."""

    def escaped(letters: re.Match[str]) -> str:
        return "\\X2\\" + letters[0].encode("utf-16-be").hex().upper() + "\\X0\\"

    return re.sub(r"[^\x00-\x7f]+", escaped, text).encode("ascii")


def _context(block: str) -> int:
    match = _CONTEXT.search(block.partition("\n")[0])
    return int(match[1]) if match else 0


_TIME = "2000-01-01T00:00:00"  # The time in the header, so that the same design gives the same file


@dataclass(frozen=True, kw_only=True)
class Product:
    """Data of a part in a STEP file beside its shape."""

    name: str
    colour: Rgb
    material: str
    density: float  # kg/m^3


def product(design: Design, kind: str) -> Product:
    """Return what a STEP file says of a kind of part."""
    made_of = KINDS[kind]
    material = design.choices.get(made_of.material, made_of.material)
    return Product(name=kind, colour=made_of.colour, material=material, density=design.value(made_of.density))


class _Document:
    """An XCAF document: products, and one assembly of them."""

    def __init__(self) -> None:
        self.document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
        XCAFApp_Application.GetApplication_s().InitDocument(self.document)
        main = self.document.Main()
        self.shapes = XCAFDoc_DocumentTool.ShapeTool_s(main)
        self.colours = XCAFDoc_DocumentTool.ColorTool_s(main)
        self.materials = XCAFDoc_DocumentTool.MaterialTool_s(main)
        self.shapes.SetAutoNaming_s(False)

    def add(self, solid: cq.Solid, product: Product) -> TDF_Label:
        """Add a product. It is the solid itself: a compound around it would lose the material."""
        label = self.shapes.AddShape(solid.wrapped.Located(TopLoc_Location()), False)
        _name(label, product.name)
        colour = Quantity_Color(*product.colour, Quantity_TOC_sRGB)
        self.colours.SetColor(label, colour, XCAFDoc_ColorType.XCAFDoc_ColorGen)
        self.materials.SetMaterial(
            label, _text(product.material), _text(""), product.density * 1e-3, _text("mass density"), _text("g/cm^3")
        )
        return label

    def write(self, path: Path, name: str) -> None:
        """Write the document as one STEP file, whole or not at all."""
        writer = STEPCAFControl_Writer()
        for key, value in (("write.step.schema", "AP242DIS"), ("write.step.unit", "MM"), ("xstep.cascade.unit", "MM")):
            Interface_Static.SetCVal_s(key, value)
        writer.SetColorMode(True)
        writer.SetNameMode(True)
        writer.SetMaterialMode(True)
        writer.SetPropsMode(True)
        writer.Transfer(self.document, STEPControl_StepModelType.STEPControl_AsIs)
        header = APIHeaderSection_MakeHeader(writer.ChangeWriter().Model(False))
        header.SetName(_text(name))
        header.SetTimeStamp(_text(_TIME))
        for index in range(1, header.NbAuthor() + 1):
            header.SetAuthorValue(index, _text("tvimdesign"))
        for index in range(1, header.NbOrganization() + 1):
            header.SetOrganizationValue(index, _text("tvimdesign"))
        header.SetOriginatingSystem(_text("tvimdesign"))
        with TemporaryDirectory(dir=path.parent, prefix=f".{path.name}.") as folder:
            beside = Path(folder) / path.name
            if writer.Write(str(beside)) != IFSelect_ReturnStatus.IFSelect_RetDone:
                raise GeometryError(f"{name}: the CAD kernel could not write {path}")
            atomic_write(path, plain_text(in_fixed_order(beside.read_text("utf-8"))))


@dataclass(frozen=True)
class Validation:
    """Validation properties of a part in a STEP file, in millimetres."""

    volume: float
    area: float
    centroid: tuple[float, float, float]


def validation(solid: cq.Solid) -> Validation:
    """Return what a solid comes to."""
    filled, skin = GProp_GProps(), GProp_GProps()
    BRepGProp.VolumeProperties_s(solid.wrapped, filled)
    BRepGProp.SurfaceProperties_s(solid.wrapped, skin)
    middle = filled.CentreOfMass()
    return Validation(filled.Mass(), skin.Mass(), (middle.X(), middle.Y(), middle.Z()))


def write_part(path: Path, solid: cq.Solid, product: Product) -> Validation:
    """Write one part with the properties by which a reader checks what arrived; return these."""
    document = _Document()
    written = validation(solid.located(cq.Location()))
    label = document.add(solid, product)
    # Parts alone have these properties of AP242: in an assembly the kernel hangs those of a part that stands at the
    # origin on a shape aspect, where other programs do not look.
    XCAFDoc_Volume.Set_s(label, written.volume)
    XCAFDoc_Area.Set_s(label, written.area)
    XCAFDoc_Centroid.Set_s(label, gp_Pnt(*written.centroid))
    document.write(path, product.name)
    return written


def write_assembly(path: Path, name: str, placed: Mapping[str, cq.Solid], products: Mapping[str, Product]) -> None:
    """Write placed solids as one assembly, both by name; solids that share their geometry become one product."""
    document = _Document()
    top = document.shapes.NewShape()
    _name(top, name)
    known: list[tuple[cq.Solid, TDF_Label]] = []
    for instance, solid in placed.items():
        label = next((label for other, label in known if other.wrapped.IsPartner(solid.wrapped)), None)
        if label is None:
            label = document.add(solid, products[instance])
            known.append((solid, label))
        component = document.shapes.AddComponent(top, label, solid.wrapped.Location())
        _name(component, instance)
    document.shapes.UpdateAssemblies()
    document.write(path, name)


def _text(text: str) -> TCollection_HAsciiString:
    return TCollection_HAsciiString(text)


def _name(label: TDF_Label, name: str) -> None:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name, True))


def read_part(path: Path) -> tuple[cq.Solid, Validation]:
    """Read a part back with its validation properties; raises GeometryError where the file has no one solid or none."""
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader = STEPCAFControl_Reader()
    reader.SetPropsMode(True)
    if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone or not reader.Transfer(document):
        raise GeometryError(f"{path.name}: the CAD kernel cannot read it")
    labels = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(labels)
    attributes = (XCAFDoc_Volume(), XCAFDoc_Area(), XCAFDoc_Centroid())
    # Asking for an attribute that is not there takes the process with it.
    if labels.Length() != 1 or not all(labels.Value(1).IsAttribute(attribute.GetID_s()) for attribute in attributes):
        raise GeometryError(f"{path.name}: does not read back as one part with volume, area and centroid")
    for attribute in attributes:
        labels.Value(1).FindAttribute(attribute.GetID_s(), attribute)
    volume, area, centroid = attributes
    solids = cq.Shape.cast(XCAFDoc_ShapeTool.GetShape_s(labels.Value(1))).Solids()
    if len(solids) != 1:
        raise GeometryError(f"{path.name}: reads back as {len(solids)} solids")
    where = centroid.Get()
    return solids[0], Validation(volume.Get(), area.Get(), (where.X(), where.Y(), where.Z()))
