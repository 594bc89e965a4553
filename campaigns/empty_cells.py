"""Attacks on empty cells of an atlas: random search and differential evolution look for a module in each.

python campaigns/empty_cells.py results/atlas --cells 30 --seed 1
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from attack import Attack

from tvimdesign.solve.torque_time_map import EMPTY
from tvimdesign.study.atlas_studies import Atlas
from tvimdesign.sweep.atlas import AtlasCell, cells_of, study_of


def drawn(folder: Path, plan: Atlas, count: int, seed: int) -> list[AtlasCell]:
    """Draw empty cells, with the hardware whose design comes nearest."""
    empty = [cell for cell in cells_of(plan, folder) if cell.status == EMPTY and cell.values]
    places = np.random.default_rng(seed).choice(len(empty), min(count, len(empty)), replace=False)
    return [empty[place] for place in sorted(places)]


def main() -> None:
    """Attack the cells and print those that hold a module."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--cells", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", action="append", default=[])
    options = parser.parse_args()
    plan, wrong = Atlas.read().only(tuple(options.kind)), 0
    cells = drawn(options.folder, plan, options.cells, options.seed)
    for place, cell in enumerate(cells, start=1):
        holds = Attack(study_of(plan, cell)).finds_a_design(options.seed + place)
        wrong += holds
        print(
            f"{place} of {len(cells)}: {cell.name} on {cell.hardware}: {'holds a module' if holds else 'empty'}",
            flush=True,
        )
    print(f"{wrong} of {len(cells)} empty cells hold a module")


if __name__ == "__main__":
    main()
