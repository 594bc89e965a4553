"""The virtual tests by name; what a test needs is imported when it is asked for."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

from tvimdesign.base.errors import InputError

if TYPE_CHECKING:  # the command line lists the tests, and must not load numpy for that
    from tvimdesign.simulation.trial import Trial
    from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule


class VirtualTest(NamedTuple):
    """Location of a test, and its description."""

    function: str  # `module:function`; the function takes a `ResolvedModule` and returns a `Trial`
    shows: str  # In one line


TESTS: dict[str, VirtualTest] = {
    "frequency": VirtualTest(
        "tvimdesign.simulation.rheometer.oscillation:frequency",
        "storage and loss modulus of the PCL against frequency, at several temperatures",
    ),
    "amplitude": VirtualTest(
        "tvimdesign.simulation.rheometer.oscillation:amplitude",
        "up to which strain the moduli of the PCL do not depend on it",
    ),
    "temperature": VirtualTest(
        "tvimdesign.simulation.rheometer.oscillation:temperature",
        "moduli of the PCL while it cools and while it is heated: where it freezes, where it melts",
    ),
    "creep": VirtualTest(
        "tvimdesign.simulation.rheometer.transient:creep", "creep of the PCL under a stress, and its recovery"
    ),
    "relaxation": VirtualTest(
        "tvimdesign.simulation.rheometer.transient:relaxation", "how the stress in the PCL fades at a held strain"
    ),
    "release": VirtualTest(
        "tvimdesign.simulation.joint_tests.release:release",
        "the link let go from an angle, at every operating point: how it swings and settles",
    ),
    "sine": VirtualTest(
        "tvimdesign.simulation.joint_tests.sine:sine",
        "the link turned to and fro: torque against angle, stiffness and damping of the joint in motion",
    ),
}


def listing() -> str:
    """Return every test with what it shows, a line each."""
    width = max(map(len, TESTS))
    return "\n".join(f"  {name:<{width}}  {test.shows}" for name, test in TESTS.items())


def find_test(name: str) -> Callable[[ResolvedModule], Trial]:
    """Return the function of a test; raises InputError with the nearest name, or all, where there is none."""
    if not name:
        raise InputError(f"say which virtual test, with --test:\n{listing()}\nfor example: --test release")
    if name not in TESTS:
        close = get_close_matches(name.lower(), TESTS, n=1)
        hint = f"did you mean {close[0]}? " if close else ""
        raise InputError(f"no test is named {name[:60]!r}; {hint}there are: {', '.join(TESTS)}")
    module, _, function = TESTS[name].function.partition(":")
    trial: Callable[[ResolvedModule], Trial] = getattr(import_module(module), function)
    return trial
