"""Small studies that several tests begin from: their mode, what is given and what varies; each test asks its own."""

FOUR_SIZES_IN_SHEAR = """
mode: shear
vary:
  wire_diameter: [1.5 mm, 3 mm]
  coil_diameter: [12 mm, 30 mm]
  pcl_thickness: [0.6 mm, 2 mm]
  current: [0.5 A, 2 A]
"""

COMPRESSION_BLOCKS = """  pcl_outer_radius: [18 mm, 30 mm]
  block_height: [4 mm, 14 mm]
  block_depth: [2 mm, 8 mm]
  vane_thickness: [2 mm, 6 mm]
  current: [0.5 A, 2.5 A]
require:
  spring_stiffness: ">= 5 N.m/rad"
  holding_torque: ">= 5 N.m"
  peak_power: "<= 9 W"
accept: [peltier_temperature_margin]
minimize: {envelope_volume: 1, module_mass: 1, response_time: 1}
"""
"""What varies in a block of a compression module, and what is asked of it; begins within `vary`."""
