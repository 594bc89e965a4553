"""What a run's first screen does not wait for computes where solver and intervals leave a processor free.

Figures give way to parts as well.
"""

import psutil
from support import wait_until

from tvimdesign.report.output.plot_process import PlotProcess
from tvimdesign.report.run.parts_of_design import BackgroundPartsJob


def test_parts_and_figures_give_way_to_the_run() -> None:
    with BackgroundPartsJob(), PlotProcess(gives_way=True):
        assert wait_until(lambda: len(_priorities()) == 2)
        behind = _priorities()
    assert psutil.Process().nice() < behind["cad.jobs.main"] < behind["plot_process"]


def _priorities() -> dict[str, int]:
    """Return the niceness by name; Linux gives a process its command line once the program is loaded."""
    others = {" ".join(one.cmdline()): one.nice() for one in psutil.Process().children()}
    asked = ("cad.jobs.main", "plot_process")
    return {name: nice for name in asked for command, nice in others.items() if name in command}


def test_figures_that_a_command_waits_for_do_not_give_way() -> None:
    with PlotProcess():
        assert wait_until(lambda: bool(_priorities()))
        behind = _priorities()
    assert behind == {"plot_process": psutil.Process().nice()}


def test_parts_that_are_all_a_command_makes_give_no_way() -> None:
    with BackgroundPartsJob(gives_way=False):
        assert wait_until(lambda: bool(_priorities()))
        behind = _priorities()
    assert behind == {"cad.jobs.main": psutil.Process().nice()}
