"""Uncertainty of a run's design, computed in a process that loads the compiler and scipy while the solver works.

Run as `python -m tvimdesign.report.run.uncertainty_process`: reads three lines of JSON on standard input, a study, for
which it prepares, its design and whether its yield is known, and prints what `Uncertainty` says of that.
`UncertaintyProcess` is the other end. An error of the package is printed as `{"error": ...}`.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import signal
import subprocess
import sys
from importlib import import_module
from typing import Any

from tvimdesign.base.child_process import follow_parent, start_child
from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.errors import TvimError
from tvimdesign.base.processes import (
    CHECK_EVERY,
    FedProcess,
    Niceness,
    ProcessorLimit,
    ProcessorTimeError,
)
from tvimdesign.study import Study
from tvimdesign.study.design import Design

STEP = "yield and intervals"
"""Name of what the process computes."""
PROCESSOR_LIMIT = 600.0
"""Seconds of processor time; it takes about two."""
SPREAD = "TVIMDESIGN_SPREAD"
"""Variable of the environment: `off` leaves yield and ranges out, where many runs share few processors."""


def uncertainty_process(study: Study) -> contextlib.AbstractContextManager[UncertaintyProcess | None]:
    """Return the process for a study; None in its place if the environment leaves it out."""
    return contextlib.nullcontext() if os.environ.get(SPREAD) == "off" else UncertaintyProcess(study)


class UncertaintyProcess(FedProcess):
    """A process that has the compiler and scipy loaded by the time there is a design; stopped if there never is."""

    def __init__(self, study: Study) -> None:
        """Start it, and let it compile the study's module."""
        self.begun = False
        """True once a design was asked for."""
        child = start_child(
            "tvimdesign.report.run.uncertainty_process",
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, encoding="utf-8",
        )  # fmt: skip
        super().__init__(child, Niceness.LOW)  # to the solver
        self.send(study.model_dump_json())

    def begin(self, design: Design, *, yield_known: bool = False) -> None:
        """Ask for a design's, without its yield if that is known, and come back at once."""
        self.begun = True
        self.send(design.model_dump_json())
        self.send(json.dumps(yield_known))
        self.send_no_more()

    def finish(self, deadline: Deadline = NEVER) -> dict[str, Any]:
        """Return what `Uncertainty` says of the design. Raises TvimError, with how to get it, if the process fails.

        Raises TimeOverError if the deadline passes first.
        """
        try:
            reply = self._reply(deadline)
        except ProcessorTimeError as error:
            reason = str(error)
        else:
            code = self.child.returncode
            uncertainty: dict[str, Any] = (
                json.loads(reply) if code == 0 else {"error": f"its process ended with code {code}"}
            )
            if "error" not in uncertainty:
                return uncertainty
            reason = uncertainty["error"]
        raise TvimError(
            f"the uncertainty of the design could not be computed: {reason}; "
            "run the study again, or `tvimdesign tolerate` with the results folder for the yield alone"
        )

    def _reply(self, deadline: Deadline) -> str:
        """Return the output of the process. Raises ProcessorTimeError, TimeOverError."""
        watch = ProcessorLimit(self.child.pid, PROCESSOR_LIMIT)
        while True:
            deadline.check(STEP)
            with contextlib.suppress(subprocess.TimeoutExpired):
                return str(self.child.communicate(timeout=min(CHECK_EVERY, deadline.remaining))[0])
            watch.check()


def main() -> None:
    """Compile for the study, wait for its design, print what there is to say of that."""
    follow_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle
    gc.disable()  # a third of the time; the process is short
    import_module("scipy.special")  # loaded while the solver works, used when modules are drawn
    from tvimdesign.report.run.uncertainty_data import MODULES, Uncertainty

    study = Study.model_validate_json(sys.stdin.readline())
    try:
        uncertainty = Uncertainty(study)
        uncertainty.prepare()
        line = sys.stdin.readline()
        if line:
            design, yield_known = Design.model_validate_json(line), json.loads(sys.stdin.readline())
            print(json.dumps(uncertainty.data(design, 0 if yield_known else MODULES), allow_nan=False))
    except TvimError as error:
        print(json.dumps({"error": str(error)}))


if __name__ == "__main__":
    main()
