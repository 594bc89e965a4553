"""A small table and a small catalogue to read studies against, so that these tests do not move with the real ones."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from tvimdesign.base.errors import CatalogError, InputError
from tvimdesign.device import Choice, Event, Input, Output, Table
from tvimdesign.device import Path as PathRow
from tvimdesign.device.table.quantity import PHASES
from tvimdesign.study import Study, StudyError, read_tree
from tvimdesign.study.tree import tree_of_text


def _input(name: str, unit: str, lower: float, upper: float, **more: Any) -> Input:
    more = {"variable": True, "description": name.replace("_", " ").capitalize()} | more
    return Input(name=name, unit=unit, group="module", lower=lower, upper=upper, **more)


def _choice(name: str, **more: Any) -> Choice:
    return Choice(name=name, description=name.replace("_", " ").capitalize(), group="module", **more)


def _output(name: str, unit: str, function: Callable[..., Any], kind: type[Output] = Output, **more: Any) -> Output:
    return kind(name=name, unit=unit, description=name.replace("_", " "), group="results", function=function, **more)


@pytest.fixture(scope="session")
def table() -> Table:
    return Table(
        (
            _choice("spring_material", default="music_wire", category="spring_materials"),
            _choice("peltier", default="flexible_1600", category="heaters"),
            _choice("rate_model", default="bending", options=("bending", "smi")),
            _input("wire_diameter", "mm", 0.5e-3, 5e-3, default=2.413e-3),
            _input("coil_diameter", "mm", 5e-3, 60e-3, default=24e-3),
            _input("coil_count", "1", 1.0, 20.0, default=3.25),
            _input("arc_count", "1", 1.0, 8.0, default=4.0, integer=True),
            _input("pcl_thickness", "mm", 0.2e-3, 5e-3),
            _input("current", "A", 0.05, 20.0, default=1.5),
            _input("cooling_current", "A", 0.0, 20.0, default=0.2),
            _input("placement_radius", "mm", 10e-3, 200e-3, default=57e-3, variable=False),
            _input("youngs_modulus", "GPa", 1e9, 400e9, variable=False, record=("spring_material", "youngs_modulus")),
            _input("temperature", "degC", 223.15, 473.15, variable=False, per_point=True),
            _input("frequency", "Hz", 0.0, 1000.0, variable=False, per_point=True, default=1.0),
            _output("joint_stiffness", "N*m/rad", lambda m: m.wire_diameter + m.temperature, per_point=True),
            _output("module_mass", "g", lambda m: m.wire_diameter),
            _output("envelope_diameter", "mm", lambda m: 2 * m.placement_radius + m.coil_diameter),
            _output("impedance_range", "1", lambda m: m.joint_stiffness_at_cold),
            _output("moduli", "1", lambda m: [m.wire_diameter], hidden=True),
            _output("face_temperature", "degC", lambda m: m.state[0], instant=True),
            _output("response_time", "s", lambda m: m.state[0], Event, phase="softening"),
            _output("switch_energy", "J", lambda m: m.state[0], PathRow, phase="softening", reduce="integral"),
            _output("words", "1", lambda m: [m.peltier, m.rate_model], hidden=True),
            _output("counts", "1", lambda m: [m.coil_count, m.arc_count], hidden=True),
            _output("rest", "1", lambda m: [m.pcl_thickness, m.youngs_modulus, m.frequency], hidden=True),
        ),
        PHASES,
    )


@dataclass
class SmallRecord:
    name: str
    values: dict[str, float] = field(default_factory=dict)
    sizes: list[dict[str, float]] = field(default_factory=list)

    def has(self, name: str) -> bool:
        return name in self.values

    def value(self, name: str) -> float:
        if name not in self.values:
            raise CatalogError(f"{self.name} has no value {name!r}")
        return self.values[name]

    def table(self, name: str) -> list[dict[str, float]]:
        if name != "sizes":
            raise CatalogError(f"{self.name} has no table {name!r}")
        return self.sizes


class SmallCatalog:
    """Stands in for the catalogue: the same calls, four shelves."""

    def __init__(self, extra_folder: Path | None = None) -> None:
        if extra_folder is not None and (extra_folder / "broken").exists():
            raise CatalogError(f"{extra_folder} is broken\nin two ways")
        wire = [{"wire_diameter": mm / 1000} for mm in (3.2, 1.0, 1.6, 2.0, 2.413, 1.6)]
        self.categories = {
            "spring_materials": [
                SmallRecord("music_wire", {"youngs_modulus": 203.4e9}),
                SmallRecord("stainless_302", {"youngs_modulus": 193e9}),
                SmallRecord("mystery_steel"),
            ],
            "heaters": [SmallRecord("flexible_1600"), SmallRecord("qc_17")],
            "wires": [SmallRecord("metric", sizes=wire), SmallRecord("quarter_coils", sizes=[{"coil_count": 3.25}])],
        }

    def names(self, category: str) -> list[str]:
        return [record.name for record in self.categories[category]]

    def record(self, category: str, name: str) -> SmallRecord:
        for record in self.categories[category]:
            if record.name == name:
                return record
        raise CatalogError(f"no record {name!r} on the shelf {category}")


@pytest.fixture(scope="session")
def catalog() -> SmallCatalog:
    return SmallCatalog()


@pytest.fixture(scope="session")
def make_catalog() -> type[SmallCatalog]:
    return SmallCatalog


@pytest.fixture(scope="session")
def table_of(table: Table) -> Callable[[str], Table]:
    def find(mode: str) -> Table:
        if mode == "shear":
            return table
        raise InputError(f"mode {mode!r} is not one of: shear")

    return find


@pytest.fixture(scope="session")
def read(table_of: Callable[[str], Table]) -> Callable[..., Study]:
    """Read a study's text against the small table and catalogue."""

    def read_text(text: str, name: str = "x.yaml", folder: Path = Path()) -> Study:
        return read_tree(tree_of_text(text, name, name, folder), table_of, SmallCatalog)

    return read_text


@pytest.fixture(scope="session")
def problems(read: Callable[..., Study]) -> Callable[..., list[str]]:
    """Read a study that is wrong and return its problems, one a line."""

    def refuse(text: str, **more: Any) -> list[str]:
        with pytest.raises(StudyError) as caught:
            read(text, **more)
        return str(caught.value).splitlines()

    return refuse
