"""The virtual tests by name; what a test needs is imported when it is asked for."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from importlib import import_module
from typing import TYPE_CHECKING

from tvimdesign.errors import InputError

if TYPE_CHECKING:  # the command line lists the tests, and must not load numpy for that
    from tvimdesign.solve.rig import Rig
    from tvimdesign.solve.trial import Trial

TESTS: dict[str, str] = {
    "frequency": "tvimdesign.solve.oscillation:frequency",
    "amplitude": "tvimdesign.solve.oscillation:amplitude",
    "temperature": "tvimdesign.solve.oscillation:temperature",
    "creep": "tvimdesign.solve.transient:creep",
    "relaxation": "tvimdesign.solve.transient:relaxation",
    "release": "tvimdesign.solve.motion:release",
    "sine": "tvimdesign.solve.motion:sine",
    "step": "tvimdesign.solve.motion:step",
}
"""`module:function` by name; the function takes a `Rig` and returns a `Trial`."""


def find_test(name: str) -> Callable[[Rig], Trial]:
    """The function of a test; raises InputError with the nearest name where there is none."""
    if name not in TESTS:
        close = get_close_matches(name.lower(), TESTS, n=1)
        hint = f"did you mean {close[0]}? " if close else ""
        raise InputError(f"no test is named {name[:60]!r}; {hint}there are: {', '.join(TESTS)}")
    module, _, function = TESTS[name].partition(":")
    found: Callable[[Rig], Trial] = getattr(import_module(module), function)
    return found
