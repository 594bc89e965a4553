"""The virtual tests by name; what a test needs is imported when it is asked for."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from importlib import import_module
from typing import TYPE_CHECKING

from tvimdesign.base.errors import InputError

if TYPE_CHECKING:  # the command line lists the tests, and must not load numpy for that
    from tvimdesign.simulation.resolved_module import ResolvedModule
    from tvimdesign.virtual_tests.trial import Trial

TESTS: dict[str, str] = {
    "frequency": "tvimdesign.virtual_tests.rheometer.oscillation:frequency",
    "amplitude": "tvimdesign.virtual_tests.rheometer.oscillation:amplitude",
    "temperature": "tvimdesign.virtual_tests.rheometer.oscillation:temperature",
    "creep": "tvimdesign.virtual_tests.rheometer.transient:creep",
    "relaxation": "tvimdesign.virtual_tests.rheometer.transient:relaxation",
    "release": "tvimdesign.virtual_tests.joint_tests.release:release",
    "sine": "tvimdesign.virtual_tests.joint_tests.sine:sine",
    "step": "tvimdesign.virtual_tests.joint_tests.step_test:step",
}
"""`module:function` by name; the function takes a `Rig` and returns a `Trial`."""


def find_test(name: str) -> Callable[[ResolvedModule], Trial]:
    """The function of a test; raises InputError with the nearest name where there is none."""
    if name not in TESTS:
        close = get_close_matches(name.lower(), TESTS, n=1)
        hint = f"did you mean {close[0]}? " if close else ""
        raise InputError(f"no test is named {name[:60]!r}; {hint}there are: {', '.join(TESTS)}")
    module, _, function = TESTS[name].partition(":")
    found: Callable[[ResolvedModule], Trial] = getattr(import_module(module), function)
    return found
