"""The joint for robot simulators: MJCF and URDF with masses, meshes, stiffness and relaxation, an FMU, and tables."""
