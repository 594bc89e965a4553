"""Records that making the parts returns, without the CAD kernel, and the names of all files."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from tvimdesign.base.errors import GeometryError

Level = Literal["pass", "warning", "failure"]


@dataclass(frozen=True)
class SolidCheck:
    """One comparison of the solids with the design."""

    name: str
    value: float  # In `unit`; without one a relative deviation, a ratio or a number of things
    limit: float
    ok: bool  # True if the part can be made and used; with a warning it can, at a price that `text` says
    text: str  # Description of the check, for people
    warned: bool = False
    part: str = ""  # The part, or the two parts, it is about
    place: Sequence[float] | None = None  # Where the value was found, in the module's coordinates [mm]
    unit: str = ""
    resolution: float = 0.0  # How far apart the samples lie that the value was found from, in mm; 0 where it is exact

    @property
    def level(self) -> Level:
        """ "pass", "warning" or "failure"."""
        return "failure" if not self.ok else "warning" if self.warned else "pass"

    def fields(self) -> dict[str, Any]:
        """Return the fields it is made of again."""
        return dict(vars(self))

    def plain(self) -> dict[str, Any]:
        """Return all of it for a JSON file."""
        return self.fields() | {"level": self.level, "basis": "sampled" if self.resolution else "exact"}


@dataclass(frozen=True)
class CadReport:
    """The files that were written and the checks that were made."""

    folder: Path
    files: tuple[str, ...]  # Relative to the folder
    checks: tuple[SolidCheck, ...]
    seconds: float
    notes: tuple[str, ...] = field(default=())
    """What is missing and why, such as the picture on a machine that cannot render."""

    reused: tuple[str, ...] = field(default=())
    """The parts and checks that were kept from before, because nothing they hang on has changed."""

    @property
    def failed(self) -> tuple[SolidCheck, ...]:
        """The checks that did not hold: the parts are there to be looked at, not to be made."""
        return tuple(check for check in self.checks if not check.ok)

    def plain(self) -> dict[str, Any]:
        """Return checks, files and notes as plain data."""
        return {
            "checks": [check.plain() for check in self.checks], "files": list(self.files), "notes": list(self.notes)
        }  # fmt: skip

    def refuse_failed(self) -> None:
        """Raise GeometryError where a check on the solids fails; the files are there."""
        if not self.failed:
            return
        worst = sorted(self.failed, key=lambda check: -abs(check.value))[:3]
        lines = [
            f"  {check.text}: {check.value:.4g}{check.unit and ' '}{check.unit}, limit {check.limit:.4g}"
            for check in worst
        ]
        raise GeometryError(
            f"the parts are written, but {len(self.failed)} of {len(self.checks)} checks fail, the worst:\n"
            + "\n".join(lines)
            + "\nSee checks.json beside the parts, and which rules the design violates."
        )


def at_least(value: float, limit: float, failing: float | None = None) -> Level:
    """Return the level of a value that must not be less than a limit.

    A failure below `failing`, which is the limit itself.
    """
    if value >= limit:
        return "pass"
    return "failure" if failing is None or not value >= failing else "warning"


def at_most(value: float, limit: float) -> Level:
    """Return the level of a value that must not be more than a limit, a failure where it is."""
    return "pass" if value <= limit else "failure"


def finding(
    part: str, what: str, value: float, limit: float, unit: str, level: Level, text: str,
    *, place: Iterable[float] | None = None, resolution: float = 0.0,
) -> SolidCheck:  # fmt: skip
    """Return a check of one part, its value in `unit`, found at `place` by samples `resolution` [mm] apart."""
    return SolidCheck(
        name=f"{part}: {what}", value=float(value), limit=float(limit), ok=level != "failure", text=f"{part}: {text}",
        warned=level == "warning", part=part, place=None if place is None else tuple(round(float(x), 3) for x in place),
        unit=unit, resolution=resolution,
    )  # fmt: skip


ASSEMBLY = "assembly"  # Name of the drawing of the whole module, among those of the parts
ASSEMBLY_STEP = "assembly.step"
ASSEMBLY_GLB = "assembly.glb"
ASSEMBLY_DATA = "assembly.json"
ASSEMBLY_NOTE = "assembly.md"
TREATMENT = "treatment"  # Word of a material's record, and of the titles: what its specimens had undergone
PRINT_TEMPERATURES = ("nozzle_temperature", "bed_temperature")
"""Values of a material's record, and of the titles, in degC: how it is printed."""
BILL_OF_MATERIALS = "bom.csv"
MODULE_SCRIPT = "module.py"
PREVIEW = "preview.png"
EXPLODED = "views/exploded.png"
SECTION = "views/section.png"
WIRING = "views/wiring.svg"
SPRING_SHEET = "springs/spring.pdf"
SPRING_TABLE = "springs/spring.csv"
step_picture = "views/step_{:02d}.png".format
"""The picture of a step of the assembly note, in which parts come into their places."""
step = "step/{}.step".format  # The part as it is to be, for machining and for reading into other CAD
print_stl = "print/{}.stl".format  # The part lying as it is printed, its holes larger by the process's compensation
print_3mf = "print/{}.3mf".format  # Meshes with unit, name, material and colour
plate_3mf = "print/plate_{}.3mf".format
"""A bed full of parts as they are printed, counted from 1, with the settings of their process."""
drawing_dxf = "drawings/{}.dxf".format  # The drawing of a part that is made of the structure's material
cut_dxf = "drawings/{}_cut.dxf".format  # The outline of a part that is a plate, for a laser or a water jet
drawing_pdf = "drawings/{}.pdf".format  # That drawing, to print
