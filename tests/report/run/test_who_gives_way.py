"""What a run's first screen does not wait for computes where solver and intervals leave a processor free.

Figures give way to parts as well.
"""

import time

import psutil

from tvimdesign.report.figures.plot_process import PlotProcess
from tvimdesign.report.run.parts_of_design import PartsAhead

# A process that has just begun has no command line yet: Linux gives it one only once the program is loaded.
NAMED_WITHIN_S = 30.0


def test_parts_and_figures_give_way_to_the_run() -> None:
    with PartsAhead(), PlotProcess():
        begun = time.monotonic()
        while len(behind := _priorities()) < 2 and time.monotonic() - begun < NAMED_WITHIN_S:
            time.sleep(0.02)
    assert len(behind) == 2
    assert psutil.Process().nice() < behind["cad.build.main"] < behind["plot_process"]


def _priorities() -> dict[str, int]:
    others = {" ".join(one.cmdline()): one.nice() for one in psutil.Process().children()}
    asked = ("cad.build.main", "plot_process")
    return {name: nice for name in asked for command, nice in others.items() if name in command}


def test_parts_that_are_all_a_command_makes_give_no_way() -> None:
    with PartsAhead(gives_way=False):
        begun = time.monotonic()
        while not (behind := _priorities()) and time.monotonic() - begun < NAMED_WITHIN_S:
            time.sleep(0.02)
    assert behind == {"cad.build.main": psutil.Process().nice()}
