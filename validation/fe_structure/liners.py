"""FE of a module whose liners are stiffer, softer, or free beside the walls of their recess; makes liners.csv anew.

    FE/bin/python validation/fe_structure/liners.py PARTS

FE/bin/python has netgen-mesher and ngsolve. PARTS is the folder of exported parts that run.py leaves of
`elbow_machined`. Of each row the liner's shear modulus [GPa] and the gap beside it [mm] are told, and what the layer
bears [MPa at 1 N m]: along inner rim, outer rim and ends, and the highest of two millimetres of these.
"""

from __future__ import annotations

import csv
import json
import shutil
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tvimdesign/cad/fe/solvers"))
import joint

TABLE = Path(__file__).with_name("liners.csv")
ROWS = ((0.4, 0.0), (1.0, 0.0), (3.0, 0.0), (26.48, 0.0), (1.0, 0.2))
"""Modulus over that of the module's liner, the last but one that of the plate; gap beside the liner [mm]."""
RESULTS = ("edge_inner", "edge_outer", "edge_end", "edge_highest")


def solved(parts: Path, stiffer: float, gap: float) -> tuple[str, ...]:
    """Return a row of the table."""
    with tempfile.TemporaryDirectory() as folder:
        own = Path(shutil.copytree(parts, Path(folder) / "parts"))
        inputs = json.loads((own / "inputs.json").read_text())
        inputs["values"]["liner_youngs_modulus"] *= stiffer
        inputs["mm"]["liner_gap"] = gap
        (own / "inputs.json").write_text(json.dumps(inputs))
        results = joint.solve(own)
    values = inputs["values"]
    shear = values["liner_youngs_modulus"] * 0.5e-9 / (1.0 + values["liner_poissons_ratio"])
    return (f"{shear:.4g}", f"{gap:g}", *(f"{results[name]:.4g}" for name in RESULTS))


def main() -> None:
    """Solve all rows and write the table."""
    rows = [solved(Path(sys.argv[1]), *row) for row in ROWS]
    with TABLE.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([("shear_modulus", "gap", *RESULTS), *rows])


if __name__ == "__main__":
    main()
