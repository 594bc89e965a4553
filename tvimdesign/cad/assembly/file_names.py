"""Names of all files of a module's parts, relative to the folder they are written into."""

from __future__ import annotations

ASSEMBLY_STEP = "assembly.step"
ASSEMBLY_GLB = "assembly.glb"
ASSEMBLY_DATA = "assembly.json"
ASSEMBLY_NOTE = "assembly.md"
BILL_OF_MATERIALS = "bom.csv"
MODULE_SCRIPT = "module.py"
PREVIEW = "preview.png"
EXPLODED = "views/exploded.png"
SECTION = "views/section.png"
SPRING_SHEET = "springs/spring.pdf"
SPRING_TABLE = "springs/spring.csv"


def step(kind: str) -> str:
    """Return the part as it is to be, for machining and for reading into other CAD."""
    return f"step/{kind}.step"


def print_stl(kind: str) -> str:
    """Return the part lying as it is printed, its holes larger by the process's compensation."""
    return f"print/{kind}.stl"


def print_3mf(kind: str) -> str:
    """Return the same with unit, name, material and colour."""
    return f"print/{kind}.3mf"


def mesh_stl(kind: str) -> str:
    """Return triangles of a part that is bought, as it is: to look at and to simulate with."""
    return f"mesh/{kind}.stl"


def drawing_dxf(kind: str) -> str:
    """Return the drawing of a part that is made of the structure's material."""
    return f"drawings/{kind}.dxf"


def drawing_pdf(kind: str) -> str:
    """Return the same drawing, to print."""
    return f"drawings/{kind}.pdf"
