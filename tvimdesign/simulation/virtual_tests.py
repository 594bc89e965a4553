"""The virtual tests by name; what a test needs is imported when it is asked for."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import own_data

if TYPE_CHECKING:  # the command line lists the tests, and must not load numpy for that
    from tvimdesign.simulation.trial import Trial
    from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule


class VirtualTest(NamedTuple):
    """Location of a test, and its description."""

    function: str  # `module:function`
    shows: str  # In one line


TESTS = {name: VirtualTest(**listed) for name, listed in own_data(__file__, "virtual_tests.yaml").items()}


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
