"""What a run's first screen does not wait for computes where solver and intervals leave a processor free.

Figures give way to parts as well.
"""

import psutil
from support import wait_until

from tvimdesign.report.output.plot_process import PlotProcess
from tvimdesign.report.run.parts_of_design import BackgroundPartsJob


def test_parts_and_figures_give_way_only_where_others_wait() -> None:
    with BackgroundPartsJob(), PlotProcess(gives_way=True):
        assert wait_until(lambda: len(_priorities()) == 2)
        behind = _priorities()
    assert psutil.Process().nice() < behind["cad.jobs.main"] < behind["plot_process"]
    with PlotProcess():
        assert wait_until(lambda: bool(_priorities()))
        behind = _priorities()
    assert behind == {"plot_process": psutil.Process().nice()}
    with BackgroundPartsJob(gives_way=False):
        assert wait_until(lambda: bool(_priorities()))
        behind = _priorities()
    assert behind == {"cad.jobs.main": psutil.Process().nice()}


def _priorities() -> dict[str, int]:
    """Return the niceness by name; Linux gives a process its command line once the program is loaded."""
    others = {" ".join(one.cmdline()): one.nice() for one in psutil.Process().children()}
    asked = ("cad.jobs.main", "plot_process")
    return {name: nice for name in asked for command, nice in others.items() if name in command}
