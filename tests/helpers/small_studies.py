"""Small studies that several tests begin from: their mode, what is given and what varies; each test asks its own."""

from tvimdesign.solve.nlp.solution import ActiveConstraint
from tvimdesign.study import Range, Study

FOUR_SIZES_IN_SHEAR = """
mode: shear
vary:
  wire_diameter: [1.5 mm, 3 mm]
  coil_diameter: [12 mm, 30 mm]
  pcl_thickness: [0.6 mm, 2 mm]
  current: [0.5 A, 2 A]
"""

ALGEBRAIC = """
mode: shear
module: {transmission: unity, placement_radius: 60 mm, pin_diameter: 6 mm}
vary: {wire_diameter: [1.5 mm, 3.2 mm], coil_count: [3, 8]}
require: {spring_stiffness: ">= 5 N.m/rad"}
accept: [structure_temperature_margin, stiffening_structure_margin, heater_temperature_margin]
minimize: springs_mass
tolerances: {wire_diameter: 0.05 mm, coil_diameter: {row: coil_diameter_tolerance}, spring_youngs_modulus: 2 %}
solver: {starts: 1}
"""
"""Springs with tolerances; nothing here waits for a working cycle."""

COMPRESSION_BLOCKS = """  pcl_outer_radius: [18 mm, 30 mm]
  block_height: [4 mm, 14 mm]
  block_depth: [2 mm, 8 mm]
  vane_thickness: [2 mm, 6 mm]
  current: [0.5 A, 2.5 A]
require:
  spring_stiffness: ">= 5 N.m/rad"
  holding_torque: ">= 5 N.m"
  peak_power: "<= 9 W"
accept: [heater_temperature_margin]
minimize: {envelope_volume: 1, module_mass: 1, response_time: 1}
"""
"""What varies in a block of a compression module, and what is asked of it; begins within `vary`."""


def with_limit_eased(study: Study, held: ActiveConstraint, share: float) -> Study:
    """Return the study with one limit, or one end of a range, eased by a share of its size."""
    name, sense = held.name.split(" ")[:2]
    factor = 1.0 + share if sense == "<=" else 1.0 - share
    if held.origin == "vary":
        vary = study.vary[name]
        assert isinstance(vary, Range)
        end = {"upper": vary.upper * factor} if sense == "<=" else {"lower": vary.lower * factor}
        return study.model_copy(update={"vary": {**study.vary, name: vary.model_copy(update=end)}})
    require = tuple(
        r.model_copy(update={"limit": r.limit * factor})
        if name in (r.output, *study.table.output(r.output).also_limited)
        else r
        for r in study.require
    )
    assert require != study.require
    return study.model_copy(update={"require": require})
