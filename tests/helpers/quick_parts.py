"""The child process that makes parts, with one set of checks on the solids instead of all: a third of the work.

Run as `tvimdesign.cad.jobs.main` is. What is left out has tests of its own in `tests/cad/inspection/`.
"""

import sys

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.jobs import build_plan as plan
from tvimdesign.cad.jobs import main as job
from tvimdesign.cad.jobs.worker import Work

_whole = plan.build_plan


def quick_plan(dims: Dimensions) -> list[Work]:
    """Return the pieces of work without inspections, and with the interferences at one end of the stroke."""
    left_out = ("inspect_", "interference_")
    return [work for work in _whole(dims) if not work.name.startswith(left_out) or work.name == "interference_2"]


if __name__ == "__main__":
    plan.build_plan = quick_plan
    sys.exit(job.main(sys.argv[1:]))
