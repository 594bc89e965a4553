"""The categories, and what every record on each must say: the one list of required values, tables and words."""

from __future__ import annotations

from collections.abc import Mapping

from tvimdesign.catalog.category import Category, Columns
from tvimdesign.catalog.layer_materials import POLYMERS

CATEGORIES: Mapping[str, Category] = {
    "spring_materials": Category(
        values={"youngs_modulus": "GPa", "density": "kg/m^3", "yield_ratio": "1", "fatigue_strength_ratio": "1"},
        tables={
            "strength": Columns(
                {"wire_diameter_from": "mm", "wire_diameter_to": "mm", "coefficient": "MPa", "exponent": "1"},
                exact=True,
                rising=("wire_diameter_from", "wire_diameter_to"),
            )
        },
    ),
    "torsion_springs": Category(
        values={
            "wire_diameter": "mm",
            "outer_diameter": "mm",
            "coil_diameter": "mm",
            "coil_count": "1",
            "leg_length": "mm",
            "largest_torque": "mN*m",
            "deflection": "deg",
        },
        words={"spring_material": (), "hands": ("both",), "number": ()},
        rising=(("wire_diameter", "coil_diameter", "outer_diameter"),),
    ),
    "structure_materials": Category(
        values={
            "youngs_modulus": "GPa",
            "poissons_ratio": "1",
            "density": "kg/m^3",
            "thermal_conductivity": "W/m/K",
            "specific_heat": "J/kg/K",
            "yield_strength": "MPa",
            "yield_strength_across_layers": "MPa",
            "loss_factor": "1",
            "modulus_slope": "1/K",
            "softening_temperature": "degC",
            "softening_width": "K",
            "softened_share": "1",
            "softening_loss_factor": "1",
            "creep_share": "1",
            "creep_exponent": "1",
            "creep_energy": "kJ/mol",
            "service_temperature": "degC",
        },
        may_be_zero=("creep_share",),
    ),
    "processes": Category(
        values={
            "minimum_wall": "mm",
            "minimum_feature": "mm",
            "running_clearance": "mm",
            "minimum_running_clearance": "mm",
            "slip_clearance": "mm",
            "seat_clearance": "mm",
            "hole_compensation": "mm",
            "corner_radius": "mm",
            "corner_depth_ratio": "1",
            "pocket_depth_ratio": "1",
            "thread_engagement": "1",
            "clamp_stress": "MPa",
            "thinnest_wall": "mm",
            "overhang_angle": "deg",
            "bridge_span": "mm",
            "hole_depth_ratio": "1",
            "bed_length": "mm",
            "bed_width": "mm",
            "bed_height": "mm",
        },
        words={
            "method": ("printed", "milled"),
            "structure_material": (),
            "thread": ("self_tapping", "tapped"),
            "insert": ("none", "heat_set"),
        },
        may_be_zero=("hole_compensation",),
        rising=(("minimum_running_clearance", "running_clearance"), ("thinnest_wall", "minimum_wall")),
    ),
    "screws": Category(
        values={
            "nominal_diameter": "mm",
            "head_diameter": "mm",
            "head_height": "mm",
            "clearance_hole": "mm",
            "tap_drill": "mm",
            "hexagon_key": "mm",
            "density": "kg/m^3",
        },
        tables={"lengths": Columns({"length": "mm"})},
        words={"insert": (), "designation": ()},
        rising=(("tap_drill", "nominal_diameter", "clearance_hole", "head_diameter"),),
    ),
    "dowel_pins": Category(
        values={"diameter": "mm", "shear_strength": "MPa", "density": "kg/m^3"},
        tables={"lengths": Columns({"length": "mm"})},
        words={"designation": ()},
    ),
    "adhesives": Category(
        values={"shear_strength": "MPa", "service_temperature": "degC", "gap_fill": "mm", "density": "kg/m^3"}
    ),
    "inserts": Category(
        values={
            "nominal_diameter": "mm",
            "hole_diameter": "mm",
            "outer_diameter": "mm",
            "length": "mm",
            "minimum_wall": "mm",
            "mass": "g",
        },
        rising=(("nominal_diameter", "hole_diameter", "outer_diameter"),),
    ),
    "bearings": Category(
        values={
            "bore": "mm",
            "outer_diameter": "mm",
            "width": "mm",
            "inner_shoulder": "mm",
            "outer_shoulder": "mm",
            "mass": "g",
            "static_load_rating": "kN",
        },
        rising=(("bore", "inner_shoulder", "outer_shoulder", "outer_diameter"),),
    ),
    "wave_springs": Category(
        values={
            "inner_diameter": "mm",
            "outer_diameter": "mm",
            "thickness": "mm",
            "waves": "1",
            "free_height": "mm",
            "work_height": "mm",
            "youngs_modulus": "GPa",
            "density": "kg/m^3",
        },
        rising=(("inner_diameter", "outer_diameter"), ("thickness", "work_height", "free_height")),
    ),
    "sensor_flanges": Category(
        values={
            "pitch_diameter": "mm",
            "screw_count": "1",
            "thread_diameter": "mm",
            "tap_drill": "mm",
            "centring_diameter": "mm",
            "centring_depth": "mm",
            "pin_diameter": "mm",
            "pin_depth": "mm",
        },
        rising=(("tap_drill", "thread_diameter"), ("centring_diameter", "pitch_diameter")),
    ),
    "motors": Category(
        values={
            "stator_diameter": "mm",
            "stator_bore": "mm",
            "stator_length": "mm",
            "rotor_diameter": "mm",
            "rotor_bore": "mm",
            "rotor_length": "mm",
            "stator_mass": "g",
            "rotor_mass": "g",
            "rotor_inertia": "kg*mm^2",
            "torque_constant": "N*m/A",
            "continuous_torque": "N*m",
        },
        rising=(("rotor_bore", "rotor_diameter", "stator_bore", "stator_diameter"),),
    ),
    "encoders": Category(
        values={
            "magnet_diameter": "mm",
            "magnet_height": "mm",
            "magnet_density": "kg/m^3",
            "air_gap": "mm",
            "board_diameter": "mm",
            "board_height": "mm",
            "board_mass": "g",
            "resolution_bits": "1",
        },
        rising=(("magnet_diameter", "board_diameter"),),
    ),
    "polymers": POLYMERS,
    "heat_paths": Category(
        values={
            "cold_side_coefficient": "W/m^2/K",
            "sink_contact": "W/m^2/K",
            "sink_coefficient": "W/m^2/K",
            "hot_contact": "W/m^2/K",
            "spreader_contact": "W/m^2/K",
            "rotor_contact": "W/m^2/K",
            "rotor_coefficient": "W/m^2/K",
            "housing_coefficient": "W/m^2/K",
            "pad_edge_contact": "W/m^2/K",
        }
    ),
    "joints": Category(
        may_have={"moving_inertia": "kg*mm^2", "pin_friction": "1", "clamped_loss_factor": "1"},
    ),
    "peltiers": Category(
        values={
            "seebeck": "mV/K",
            "resistance": "ohm",
            "conductance": "W/K",
            "thickness": "mm",
            "area": "mm^2",
            "mass": "g",
            "specific_heat": "J/kg/K",
            "max_current": "A",
            "shear_modulus": "MPa",
            "max_temperature": "degC",
        },
        words={"form": ("flexible", "rigid"), "heat_source": ("pads", "layer")},
        usual_words={"heat_source": "pads"},
        may_be_zero=("seebeck",),  # a foil heater
        values_of={
            "rigid": {"length": "mm", "width": "mm"},
            "flexible": {"bulk_modulus": "GPa"},
            "layer": {"electrode_gap": "mm", "electrode_width": "mm"},
        },
    ),
    "spreaders": Category(
        values={
            "density": "kg/m^3",
            "thermal_conductivity": "W/m/K",
            "specific_heat": "J/kg/K",
            "shear_modulus": "GPa",
            "youngs_modulus": "GPa",
        },
    ),
    "thermal_fuses": Category(
        values={
            "rated_current": "A",
            "body_diameter": "mm",
            "body_length": "mm",
            "opening_band": "K",
            "working_margin": "K",
        },
        tables={
            "types": Columns(
                {"model": "1", "functioning_temperature": "degC", "holding_temperature": "degC"},
                rising=("holding_temperature", "functioning_temperature"),
            )
        },
        words={"designation": ()},
        may_have={"high_rated_current": "A"},
        rising=(("rated_current", "high_rated_current"),),
    ),
    "wires": Category(tables={"sizes": Columns({"wire_diameter": "mm"})}),
}
