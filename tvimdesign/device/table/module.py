"""The module as a quantity's function sees it, and the names it reads, by bytecode: 7 ms for all, 100 by source."""

import inspect
import sys
from collections.abc import Callable, Iterator, Mapping
from dis import opmap
from types import CodeType, FunctionType, SimpleNamespace
from typing import Any


class Module(SimpleNamespace):
    """Hold the values of a module's quantities as attributes."""


def names_read(function: Callable[[Module], Any]) -> tuple[str, ...]:
    """Return the attributes of the module that a function reads, whichever branch it takes.

    Nested functions and comprehensions count, and so do functions of the same file that are called with the module
    alone. Raises ValueError if the function uses the module in any other way: then nobody can tell what it reads.
    """
    code = function.__code__
    if code.co_argcount != 1 or code.co_kwonlyargcount or code.co_flags & (inspect.CO_VARARGS | inspect.CO_VARKEYWORDS):
        raise ValueError("must have one parameter, the module")
    return tuple(dict.fromkeys(_attributes(code, code.co_varnames[0], function.__globals__)))


_CACHE, _EXTENDED, _GLOBAL = opmap["CACHE"], opmap["EXTENDED_ARG"], opmap["LOAD_GLOBAL"]
_LOCAL = frozenset(code for name, code in opmap.items() if "_FAST" in name)
_CELL = frozenset(code for name, code in opmap.items() if "_DEREF" in name)
_TWO_LOCALS = frozenset(code for name, code in opmap.items() if name.count("_FAST") == 2)  # since Python 3.13
_LOAD = frozenset(code for name, code in opmap.items() if name.startswith("LOAD") and "CLEAR" not in name) | _TWO_LOCALS
_ATTRIBUTE = frozenset(opmap[name] for name in ("LOAD_ATTR", "LOAD_METHOD") if name in opmap)
_CALL = frozenset(opmap[name] for name in ("PRECALL", "CALL") if name in opmap)
_NAME_SHIFT = 1 if sys.version_info >= (3, 12) else 0


def _attributes(code: CodeType, m: str, known: Mapping[str, Any]) -> Iterator[str]:
    """Follow each load of the variable `m` to what is done with its value."""
    cells = tuple(name for name in code.co_cellvars if name not in code.co_varnames)
    place = (*code.co_varnames, *cells, *code.co_freevars).index(m)
    # A variable that a nested function reads is in a cell.
    watched = _CELL if m in (*code.co_cellvars, *code.co_freevars) else _LOCAL
    loaded, before, called, extended = False, 0, 0, 0
    for operation, argument in zip(code.co_code[::2], code.co_code[1::2], strict=True):
        if operation == _CACHE:
            continue
        index, extended = extended | argument, 0
        if operation == _EXTENDED:
            extended = index << 8
        elif loaded:
            loaded = False
            if operation in _ATTRIBUTE:
                yield code.co_names[index >> _NAME_SHIFT]
                continue
            function = known.get(code.co_names[called >> 1]) if before == _GLOBAL else None
            if not (operation in _CALL and index == 1 and isinstance(function, FunctionType)):
                raise ValueError(f"may only read attributes of {m!r}, or pass it alone to a function of its file")
            yield from names_read(function)
        elif operation in watched:
            places = (index >> 4, index & 15) if operation in _TWO_LOCALS else (index,)
            loaded = places[-1] == place and operation in _LOAD
            if place in places[:-1] or (place in places and not loaded):
                raise ValueError(f"must not assign to {m!r}, or pass it on with other values")
            if not loaded:
                before = operation
        else:
            before, called = operation, index
    for constant in code.co_consts:
        if isinstance(constant, CodeType) and m in constant.co_freevars:
            yield from _attributes(constant, m, known)
