"""A pair of small studies that can be compared: three variables each, one start, the same task."""

from pathlib import Path

from tvimdesign.study import read_study
from tvimdesign.study.conditions import Case

_TASK = """require:
  spring_stiffness: ">= 5 N.m/rad"
  holding_torque: ">= 5 N.m"
accept: [structure_temperature_margin, stiffening_structure_margin, heater_temperature_margin,
         cold_side_temperature_margin]
minimize: {module_mass: 1, response_time: 1}
operating_points:
  cold: {temperature: 30 degC, frequency: 1 Hz}
  hot: {temperature: 100 degC, frequency: 1 Hz}
solver: {starts: 1}
"""
SHEAR = (
    """mode: shear
module:
  response_criterion: softening
  current: 1.5 A
  stroke: 0.104 rad
  pin_diameter: 5 mm
vary:
  wire_diameter: [2 mm, 3 mm]
  pcl_outer_radius: [32 mm, 42 mm]
  pcl_thickness: [0.6 mm, 2 mm]
"""
    + _TASK
)
COARSE = SHEAR.replace("{starts: 1}", "{starts: 1, cells: 6, fineness: 0.67}")
"""The first on half the cells, for what does not hang on how exact its times are: half the work."""
COMPRESSION = (
    """mode: compression
module:
  response_criterion: softening
  current: 1.5 A
  stroke: 0.104 rad
  coil_diameter: 12.02 mm
  coil_count: 6.6
  core_radius: 8 mm
  link_dowel: iso_8734_2
  rotor_rim: 7.5 mm
  pcl_inner_radius: 13 mm
  pcl_outer_radius: 24 mm
  block_height: 11.964 mm
  block_depth: 4 mm
  vane_thickness: 4 mm
vary:
  wire_diameter: [2 mm, 3 mm]
  block_height: [5 mm, 13 mm]
  block_depth: [3.5 mm, 6 mm]
"""
    + _TASK
)


def written(folder: Path, **texts: str) -> list[Path]:
    """Study files of these texts, named after the keywords."""
    paths = []
    for name, text in texts.items():
        paths.append(folder / f"{name}.yaml")
        paths[-1].write_text(text)
    return paths


def cases(folder: Path, *texts: str) -> list[Case]:
    """Studies of these texts as the comparison takes them."""
    paths = written(folder, **{f"study_{i}": text for i, text in enumerate(texts)})
    studies = [(path, read_study(path)) for path in paths]
    return [Case(path, study) for path, study in studies]
