"""Comparison of the model's values of a design with those of FE on its parts, a row each.

All screws are tightened to `link_clamp_stress`. What is across a foot's screw, or turns the link on the core, goes by
friction first, with the coefficient between link and core; what is left shears the foot's screw, or the link's pins
where there are any and its screws where there are none. Equivalent stress by VDI 2230-1:2015 (`physics/solids`).
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record, own_data
from tvimdesign.cad.fe.run_solvers import Solved, export_parts, require_fe, run_solvers
from tvimdesign.cad.make import load_kernel
from tvimdesign.physics.motions import motion
from tvimdesign.physics.motions.contacts import tightened_force
from tvimdesign.physics.solids import fasteners, plates, structure, wedge
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_design
from tvimdesign.study import Design

DRAWN = {"leg_model": "bending", "transmission": "geometry"}  # Idealizations that the drawn parts do not have
SOLVERS = ("joint", "spring", "screws", "link")


@dataclass(frozen=True)
class Compared:
    """One quantity by the model and by FE."""

    name: str
    unit: str
    meaning: str
    model: float
    fe: float
    coarse: float  # By FE on the coarser mesh

    @property
    def ratio(self) -> float:
        """Model over FE."""
        return self.model / self.fe

    @property
    def mesh_change(self) -> float:
        """Share by which the finer mesh differs from the coarser."""
        return self.fe / self.coarse - 1.0


def refuse_other_parts(module: ResolvedModule) -> None:
    """Raise InputError for parts that the solvers do not draw."""
    if module.study.mode == "lock":
        raise InputError("verify: FE compares springs as well, and a lock has none")
    if module.values["link_fit"] == "spigot":
        raise InputError("verify: FE draws a flat link on dowel pins or screws, and this one has a spigot")
    form = module.values.get("heater_form", "flexible")
    if form != "flexible" and module.study.mode == "compression":
        raise InputError(
            f"verify: heater_form is {form}; FE draws rigid modules below an arc, in a vane only pads cut to the PCL"
        )


def refuse_unsolvable(design: Design, python: str) -> None:
    """Raise InputError for an interpreter without solvers, and for parts that they do not draw."""
    require_fe(python)
    refuse_other_parts(resolve_design(design))


def compare_with_fe(
    design: Design, work: Path, python: str, progress: Callable[[str], None]
) -> tuple[list[Compared], dict[str, Solved]]:
    """Export the parts and solve in a folder of work; return the rows and what each solver found."""
    load_kernel()
    module = resolve_design(design)
    progress("verify: drawing the parts")
    export_parts(design, work / "parts")
    solved = run_solvers(SOLVERS, work / "parts", work, python, lambda text: progress(f"verify: {text}"))
    return compared(module, solved), solved


def compared(module: ResolvedModule, solved: Mapping[str, Solved]) -> list[Compared]:
    """Return all rows, the largest difference first; a row that one of the two lacks is left out."""
    model = at_loads(module, model_values(module))
    fine = at_loads(module, fe_values(module, {name: fe_solution.fine for name, fe_solution in solved.items()}))
    coarse = at_loads(module, fe_values(module, {name: fe_solution.coarse for name, fe_solution in solved.items()}))
    both = [name for name in fine if name in model and name in coarse]
    words: Mapping[str, tuple[str, str]] = own_data(__file__, "model_comparison.yaml")
    rows = [Compared(name, *words[name], model[name], fine[name], coarse[name]) for name in both]
    return sorted(rows, key=lambda row: -abs(math.log(row.ratio)))


def at_loads(module: ResolvedModule, rows: Mapping[str, float]) -> dict[str, float]:
    """Scale rows with stresses to full winding of the springs and the torque the joint holds, from one newton metre."""
    names = ("held_spring_rate", "spring_winding", "holding_torque")
    rate, winding, held = (float(module.table.evaluate(_drawn(module), names)[name]) for name in names)
    torques = {"coil_stress": rate * winding, "tang_stress": rate * winding}
    torques |= dict.fromkeys(("core_stress", "plate_stress", "edge_traction", "seat_traction", "foot_force"), held)
    return {name: value * torques.get(name, 1.0) for name, value in rows.items()}


def _drawn(module: ResolvedModule) -> dict[str, Any]:
    return {**module.values, **DRAWN}


def model_values(module: ResolvedModule) -> dict[str, float]:
    """Return what the model says, by row; stiffness in N*m/rad, stress in MPa at one newton metre, frequency in Hz."""
    shear = module.study.mode != "compression"
    names = [
        "spring_rate", "held_spring_rate", "coil_stress_per_angle", "tang_stress_per_angle", "structure_stiffness",
        "pcl_stiffness@cold", "core_stiffness", "plate_stiffness", "floor_stiffness", "link_stiffness",
        "tilt_compliance", "core_holding_torque", "cold_layer_strength", "holding_torque", "spring_stiffness",
        "link_friction_torque", "spring_count", "placement_radius", "rotor_thickness", "core_radius",
        *(("layer_edge_traction",) if shear else ("rotor_vane_stiffness", "housing_vane_stiffness")),
    ]  # fmt: skip
    inputs = _drawn(module)
    values = {name: float(value) for name, value in module.table.evaluate(inputs, names).items()}
    hub = structure.series(values["pcl_stiffness@cold"], values["structure_stiffness"])
    yields = values["core_holding_torque"] * float(inputs["holding_safety"])
    rows = {
        "spring_rate": values["spring_rate"],
        "coil_stress": values["coil_stress_per_angle"] / values["held_spring_rate"] * 1e-6,
        "tang_stress": values["tang_stress_per_angle"] / values["held_spring_rate"] * 1e-6,
        "hub": hub, "core": values["core_stiffness"], "link": values["link_stiffness"],
        "link_in_play": _in_play(hub, values["link_stiffness"], values["tilt_compliance"]),
        "natural_frequency": float(
            motion.natural_frequency(values["spring_stiffness"] + hub, inputs["moving_inertia"])
        ),
        "core_stress": values["cold_layer_strength"] / yields * 1e-6,
        "link_friction_torque": values["link_friction_torque"],
        "foot_force": 1.0 / (values["spring_count"] * values["placement_radius"]),
        "plate_stress": plate_stress(module, values["rotor_thickness"], values["core_radius"]) * 1e-6,
    }  # fmt: skip
    rows |= screw_rows(
        module, Carried(rows["foot_force"] * values["holding_torque"], 0.0, rows["link_friction_torque"])
    )
    plate, floor = values["plate_stiffness"], values["floor_stiffness"]
    if shear:
        traction = values["layer_edge_traction"] / values["holding_torque"] * 1e-6
        return {**rows, "plate": plate, "floor": floor, "edge_traction": traction, **_seats(module)}
    return {**rows, **_vanes(values["rotor_vane_stiffness"], plate, values["housing_vane_stiffness"], floor)}


def _in_play(hub: float, link: float, tilt: float) -> float:
    """Return the stiffness at the link's end while the core is free to lean."""
    return 1.0 / (1.0 / hub + 1.0 / link + tilt)


def _seats(module: ResolvedModule) -> dict[str, float]:
    """Return the shear of the adhesive around spreaders at 1 N*m [MPa], if the module has any."""
    path = module.table.evaluate(_drawn(module), ("seat_path",))["seat_path"]
    return {} if path is None else {"seat_traction": 1e-6 * float(max(path.inner_traction, path.outer_traction))}


def plate_stress(module: ResolvedModule, thickness: float, core: float) -> float:
    """Return the plate's von Mises stress at 1 N*m [Pa], a mean over its thickness and 1 mm beside the core.

    All torque shears it; vanes that hang from it cup it besides (`wedge.foot_bending`, over the plain core's stress).
    The core's fillet bears with it, and its holes turn the torque aside.
    """
    names = ("core_screw_bores", "core_dowel_bores", "link_bottom_level", "rotor_top_level", "foot_fillet")
    screws, dowels, top, bottom, fillet = module.table.evaluate(_drawn(module), names).values()
    felt = structure.felt_at_foot(core, top - bottom, screws, dowels)
    beside = plates.thicker_by_fillet(thickness, fillet, structure.FOOT_MEAN)
    return _mean_plate_stress(module, thickness, core) * beside * float(plates.highest_around(felt))


def _mean_plate_stress(module: ResolvedModule, thickness: float, core: float) -> float:
    """Return the mean stress around a core with a sharp foot and no holes [Pa]."""
    sheared = structure.mises(plates.shear_beside_core(1.0, thickness, core, structure.FOOT_MEAN))
    if module.study.mode != "compression":
        return float(sheared)
    names = ("block_lean_out", "block_between", "vanes_plate")
    lean, block, plate = module.table.evaluate(_drawn(module), names).values()
    of_core = structure.mises(1.0 / structure.shaft_torque(1.0, core))
    at = core / (core + 0.5 * structure.FOOT_MEAN)  # a moment on each length falls with the radius
    bent = wedge.foot_bending(lean, block.arm, core, plate) * of_core * at
    return float(plates.mean_with_bending(sheared, bent) if bent else sheared)


def fe_values(module: ResolvedModule, fe_results: Mapping[str, Mapping[str, float]]) -> dict[str, float]:
    """Return what FE finds, by the same rows."""
    names = ("link_friction_torque", "link_bolt_circle_radius")
    friction, circle = (float(module.table.evaluate(_drawn(module), names)[name]) for name in names)
    joint = fe_results["joint"]
    held = float(module.table.evaluate(_drawn(module), ("holding_torque",))["holding_torque"])
    slip = friction * fe_results["screws"]["friction_radius"] * 1e-3 / circle
    link, spring = fe_results["link"]["link"], fe_results["spring"]
    return {
        **screw_rows(module, Carried(joint["foot_across"] * held, joint["foot_along"] * held, slip)),
        **joint_rows(joint), "natural_frequency": joint["frequency"],
        "spring_rate": spring["rate"], "coil_stress": spring["fibre_max"], "tang_stress": spring["bend_mises"],
        "link": link, "link_in_play": _in_play(joint["hub"], link, joint["tilt"]), "foot_force": joint["foot_across"],
        "link_friction_torque": slip,
    }  # fmt: skip


def joint_rows(joint: Mapping[str, float]) -> dict[str, float]:
    """Return the rows that FE gives of the frozen joint: vanes on their base, the core at its highest stress."""
    rows = {"hub": joint["hub"], "core": joint["core"], "core_stress": max(joint["core_mises"], joint["foot_highest"])}
    rows |= {"plate_stress": joint["plate_mises"]} if "plate_mises" in joint else {}
    plate, floor = joint["plate"], joint["housing"]
    if "rotor_vanes" in joint:
        return {**rows, **_vanes(joint["rotor_vanes"], plate, joint["housing_vanes"], floor)}
    seats = {"seat_traction": max(joint["seat_inner"], joint["seat_outer"])} if "seat_outer" in joint else {}
    return {**rows, "plate": plate, "floor": floor, "edge_traction": joint["edge_highest"], **seats}


def _vanes(rotor: float, plate: float, housing: float, floor: float) -> dict[str, float]:
    return {
        "rotor_vanes_and_plate": structure.series(rotor, plate),
        "housing_vanes_and_floor": structure.series(housing, floor),
    }


_MPA = 1e-6


class Carried(NamedTuple):
    """Loads that screws and pins carry."""

    across: float  # Force across the screw of the foot that takes most [N]
    along: float  # Force along it [N]
    slip: float  # Torque that friction under the link screws holds [N*m]


class _Tightened(NamedTuple):
    """A screw of a joint, tightened."""

    diameter: float
    pitch: float
    force: float
    twist: float

    def stress(self, along: float, across: float) -> float:
        """Return the equivalent stress [MPa] with forces along and across it [N]."""
        combined = fasteners.combined_stress(self.force + along, across, self.twist, self.diameter, self.pitch)
        return float(combined) * _MPA


def screw_rows(module: ResolvedModule, carried: Carried) -> dict[str, float]:
    """Return stresses [MPa] by row; none of missing pins, or of pins that friction relieves."""
    names = ("holding_torque", "link_bolt_circle_radius", "link_dowel_circle_radius", "link_screw_count")
    values = {name: float(value) for name, value in module.table.evaluate(module.values, names).items()}
    friction = float(module.values["link_friction"])
    left = max(values["holding_torque"] - carried.slip, 0.0)
    pins = 0.0 if isinstance(module.values["link_fit"], str) and module.values["link_fit"] == "clearance" else left
    link = _tightened(module, "link_screw")
    sheared = (left - pins) / (values["link_screw_count"] * values["link_bolt_circle_radius"])
    rows = {"link_screw_stress": link.stress(0.0, sheared)}
    if pins:
        diameter, count = (float(module.values[name]) for name in ("link_dowel_diameter", "link_dowel_count"))
        force = pins / (count * values["link_dowel_circle_radius"])
        rows["link_pin_shear"] = force / (0.25 * math.pi * diameter**2) * _MPA
    foot = _tightened(module, "mount_screw")
    rows["foot_screw_stress"] = foot.stress(carried.along, max(carried.across - friction * foot.force, 0.0))
    return rows


def _tightened(module: ResolvedModule, choice: str) -> _Tightened:
    screw = module.values[choice]
    assert isinstance(screw, Record)
    diameter, drill = (float(screw.value(name)) for name in ("nominal_diameter", "tap_drill"))
    head = 0.5 * float(screw.value("head_diameter") + screw.value("clearance_hole"))
    pitch = diameter - drill
    force = float(tightened_force(module.values["link_clamp_stress"], diameter))
    friction = fasteners.thread_friction(module.values["nut_factor"], diameter, pitch, head)
    torque = fasteners.thread_torque(force, diameter, pitch, friction)
    return _Tightened(diameter, pitch, force, float(fasteners.twist_stress(torque, diameter, pitch)))
