"""Studies of the atlas: a kind of module on each set of hardware, with ranges far beyond those that `size` writes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from importlib.resources import files
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import plain_data
from tvimdesign.base.units import parse_quantity
from tvimdesign.study.reader import read_tree
from tvimdesign.study.sizing import JointTask, diameters, study_text
from tvimdesign.study.study import Study
from tvimdesign.study.tree import tree_of_values

WIDER = 1.7  # Factor on the largest of what scales with a module; its square root divides the least


@dataclass(frozen=True)
class Atlas:
    """Plan of an atlas: torques [N*m], cycle times [s], and kinds of modules."""

    torques: tuple[float, ...]
    cycles: tuple[float, ...]
    softness: float  # Most hot stiffness [N*m/rad] over the torque held [N*m]
    kinds: Mapping[str, Any]
    common: Mapping[str, Any]
    hardware: tuple[str, ...]

    @classmethod
    def read(cls, path: Path | None = None) -> Atlas:
        """Read a plan, the shipped one without a path. Raises InputError for a plan that lacks a part."""
        text = (path or Path(str(files("tvimdesign.study").joinpath("atlas.yaml")))).read_text(encoding="utf-8")
        plan = plain_data(text)
        missing = {"torques", "cycles", "softness", "kinds"} - set(plan)
        if missing:
            raise InputError(f"{path}: an atlas has {', '.join(sorted(missing))}")
        return cls(
            tuple(sorted(parse_quantity(value, "N*m") for value in plan["torques"])),
            tuple(sorted(parse_quantity(value, "s") for value in plan["cycles"])),
            parse_quantity(plan["softness"], "N*m/rad"), plan["kinds"], plan.get("study", {}),
            tuple(plan.get("hardware", diameters())),
        )  # fmt: skip

    def only(self, kinds: tuple[str, ...]) -> Atlas:
        """Return the plan with some of its kinds. Raises InputError for a kind it lacks."""
        for kind in kinds:
            if kind not in self.kinds:
                raise InputError(f"no kind {kind!r} in the atlas; it has {', '.join(self.kinds)}")
        return replace(self, kinds={kind: self.kinds[kind] for kind in kinds or self.kinds})

    @cached_property
    def families(self) -> tuple[tuple[str, str], ...]:
        """Kind and set of hardware of each family of designs."""
        return tuple((kind, hardware) for kind in self.kinds for hardware in self.hardware)

    def study(self, kind: str, hardware: str) -> Study:
        """Return the study of a family: the lightest module, whatever it holds. Raises StudyError."""
        entry = self.kinds[kind]
        task = JointTask(
            torque=1.0, stiffness=(1.0, 1.0), diameter=diameters()[hardware], time=1.0, voltage=24.0,
            current=float("inf"), stroke=0.104, assumes_stroke=False, process=entry.get("process", ""),
        )  # fmt: skip
        values = plain_data(study_text(task, hardware, f"{entry['title']}, {hardware}", widen=WIDER))
        for limit in ("joint_stiffness@hot", "holding_torque", "envelope_diameter", "response_time"):
            values["require"].pop(limit)
        values.pop("robust")
        for part in (self.common, entry.get("study", {})):
            _merge(values, part)
        for name, factors in entry.get("scaled", {}).items():
            least, start, most = (f"{1e3 * factor * task.diameter:.3g} mm" for factor in factors)
            values["vary"][name] = {"from": least, "to": most, "start": start}
        return read_tree(tree_of_values(values, f"{kind} on {hardware}", Path()))


def _merge(values: dict[str, Any], part: Mapping[str, Any]) -> None:
    """Set what a part of a study has, level by level; nothing (`null`) removes an entry."""
    for name, value in part.items():
        if value is None:
            values.pop(name, None)
        elif isinstance(value, Mapping) and isinstance(values.get(name), dict) and not {"from", "choose"} & set(value):
            _merge(values[name], value)
        else:
            values[name] = value
