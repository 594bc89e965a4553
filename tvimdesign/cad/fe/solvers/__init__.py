"""Scripts for an interpreter that has netgen and ngsolve: they cannot share a process with the CAD kernel.

Each file is run by its path and imports nothing of the package:
`python joint.py PARTS FOUND.json [--coarser 1.6] [--field FIELD.npz]`; `export_parts` writes PARTS.
"""
