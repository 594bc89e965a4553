"""What a run's first screen does not wait for computes where solver and intervals leave a processor free."""

import psutil

from tvimdesign.report.figures.plot_process import PlotProcess
from tvimdesign.report.run.parts_of_design import PartsAhead


def test_parts_and_figures_give_way_to_the_run() -> None:
    with PartsAhead(), PlotProcess():
        others = {" ".join(one.cmdline()): one.nice() for one in psutil.Process().children()}
    behind = [nice for command, nice in others.items() if "cad.build.main" in command or "plot_process" in command]
    assert len(behind) == 2
    assert min(behind) > psutil.Process().nice()
