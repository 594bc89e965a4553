"""The joint for robot simulators: MJCF and URDF with masses, meshes, stiffness and relaxation, and tables of them."""
