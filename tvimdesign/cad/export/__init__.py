"""Files other programs read: STEP, 3MF and STL, with meshes of a known error."""
