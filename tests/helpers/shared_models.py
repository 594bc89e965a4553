"""Equations and recordings that models of the same words have alike, written once in a process for all tests.

A table's equations hang on its records, options and counts of cells, not on the numbers put in: two models that differ
in numbers alone have the same. Writing them takes most of what it takes to evaluate a module, and hundreds of tests do.
What a process of its own does, such as the command line's tests that start one, shares nothing.
"""

from collections import OrderedDict
from collections.abc import Hashable, Iterator, Mapping, Sequence
from typing import Any

import pytest

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

MOST_MODELS = 10
"""Kinds of model whose equations are kept, those used last: each is some ten megabytes."""
EQUATIONS = ("_symbols", "_settled", "_known", "phases", "engines", "output_names", "functions")

_by_kind: OrderedDict[Hashable, DeviceFunctions] = OrderedDict()
_begin, _outputs = DeviceFunctions.__init__, DeviceFunctions.outputs


def kind(model: DeviceFunctions) -> Hashable:
    """Return what a model's equations hang on; tables and records are distinguished by identity."""
    words = tuple((name, word if isinstance(word, str) else id(word)) for name, word in model.words.items())
    rotor_cells = model.start[model.index["rotor_cells"]] if "rotor_cells" in model.index else None
    return id(model.table), model.points, model.cells, rotor_cells, tuple(model.names), words


def _like_the_last(self: DeviceFunctions, *given: Any, **more: Any) -> None:
    """Make a model, with the equations that the last one of its kind has written."""
    _begin(self, *given, **more)
    self.__dict__["functions"] = {}
    last = _by_kind.pop(kind(self), None)
    if last is not None:
        self.__dict__.update({name: last.__dict__[name] for name in EQUATIONS if name in last.__dict__})
    _by_kind[kind(self)] = self
    if len(_by_kind) > MOST_MODELS:
        _by_kind.popitem(last=False)


def _shared_outputs(self: DeviceFunctions, wanted: Sequence[str], instead: Mapping[str, float] | None = None) -> Any:
    """Return the function of some outputs, written once for all models of a kind."""
    built = self.__dict__["functions"]
    key = tuple(wanted), tuple((instead or {}).items())
    if key not in built:
        built[key] = _outputs(self, wanted, instead)
    return built[key]


@pytest.fixture(scope="session", autouse=True)
def _shared_models() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(DeviceFunctions, "__init__", _like_the_last)
        patch.setattr(DeviceFunctions, "outputs", _shared_outputs)
        yield
