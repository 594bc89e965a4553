"""Table and figure of docs/devices.md: published devices beside the shipped studies.

python docs/make/devices.py
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import matplotlib as mpl
import yaml
from matplotlib.figure import Figure

from tvimdesign.base.units import parse_quantity

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/devices.md"
UNITS = {
    "torque": "N.m",
    "mass": "kg",
    "soft_after": "s",
    "stiff_after": "s",
    "cycle": "s",
    "energy": "J",
    "density": "N.m/kg",
}
COLUMNS = ("ratio", *UNITS)
MARKS = {"thermal": "o", "jamming": "s", "magnetorheological": "^", "electroadhesive": "D", "motor": "P"}


def devices() -> list[dict[str, Any]]:
    """Read the published devices."""
    records: list[dict[str, Any]] = yaml.safe_load((ROOT / "docs/devices.yaml").read_text(encoding="utf-8"))
    return records


def axes_of(device: dict[str, Any]) -> tuple[float | None, float | None]:
    """Return full cycle in s and torque over mass in N.m/kg; None where the text lacks it."""
    given = {name: parse_quantity(device[name], unit) for name, unit in UNITS.items() if name in device}
    cycle = given.get("cycle")
    if "soft_after" in given and "stiff_after" in given:
        cycle = given["soft_after"] + given["stiff_after"]
    density = given["torque"] / given["mass"] if {"torque", "mass"} <= set(given) else given.get("density")
    return cycle, density


def studies() -> dict[str, tuple[float, float]]:
    """Return softening time in s and torque requested over mass in N.m/kg of the studies that ask a torque."""
    densities = {}
    text = (ROOT / "docs/studies.md").read_text(encoding="utf-8")
    for name, mass, soft in re.findall(r"^\| \[(\w+)\].* (\d+) g, (\d+) s \|$", text, re.M):
        requested = re.search(r'holding_torque: ">= (\S+) N.m"', (ROOT / f"studies/{name}.yaml").read_text())
        if requested:
            densities[name] = (float(soft), float(requested[1]) / float(mass) * 1e3)
    return densities


def draw(path: Path) -> None:
    """Draw torque over mass against time; a device with one axis stands at the margin of the other."""
    mpl.rcParams["svg.hashsalt"] = "devices"
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    axes = figure.subplots()
    axes.set(xscale="log", yscale="log", xlim=(3e-4, 1e3), ylim=(3, 400))
    axes.set(xlabel="full cycle [s]; studies: softening alone", ylabel="torque held over mass [N·m/kg]")
    for device in devices():
        cycle, density = axes_of(device)
        if cycle or density:
            place = (cycle or 3.6e-4, density or 3.4)
            axes.plot(
                *place, MARKS[device["kind"]], color="tab:blue", fillstyle="full" if cycle and density else "none"
            )
            axes.annotate(device["name"], place, (4, 5), textcoords="offset points", fontsize=7, rotation=25)
    for name, place in studies().items():
        axes.plot(*place, "*", color="tab:red")
        axes.annotate(name, place, (-4, 2), textcoords="offset points", fontsize=6, ha="right")
    figure.savefig(path, metadata={"Date": None})


def table() -> str:
    """Return the table of the page."""
    heads = ("device", "kind", *(name.replace("_", " ") for name in COLUMNS))
    lines = [f"|{'|'.join(heads)}|", "|---" * len(heads) + "|"]
    for device in devices():
        lines.append(f"|{'|'.join(str(device.get(name, '')) for name in ('name', 'kind', *COLUMNS))}|")
    return "\n".join(lines)


if __name__ == "__main__":
    draw(ROOT / "docs/pictures/devices.svg")
    head = PAGE.read_text(encoding="utf-8").split("|device|")[0]
    PAGE.write_text(head + table() + "\n", encoding="utf-8")
