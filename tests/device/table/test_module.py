"""Which quantities a function of the module reads, and tables that are refused when they are built."""

import ast
import inspect
import re
import textwrap
from collections.abc import Callable
from typing import Any

import pytest

from tvimdesign.device import MODES, Choice, Input, Output, Table, table_for
from tvimdesign.device.table.module import Module, names_read


def helper(m: Module) -> Any:
    return m.from_helper


def everywhere(m: Module) -> Any:
    first, last = m.first, m.last
    if first:
        return helper(m) + m.record.value("x") + f"{m.in_text}"
    if m.second:
        return [m.in_list * i for i in m.over if m.when] + sorted(last, key=lambda one: one * m.in_lambda)
    return {name: sorted(name, key=lambda m: m.of_another) for name in m.table("names")}


def test_reads_in_branches_nested_functions_and_helpers_are_seen() -> None:
    assert set(names_read(everywhere)) == {
        "first", "last", "from_helper", "record", "in_text", "second", "in_list", "over", "when", "in_lambda", "table",
    }  # fmt: skip


def assigned(m: Module) -> Any:
    m = m.other
    return m.x


def renamed(m: Module) -> Any:
    n = m
    return n.x


@pytest.mark.parametrize(
    "function",
    [
        lambda m: getattr(m, "x"),  # noqa: B009 - the call is what is refused
        lambda m: helper(m.x) + max(m, m.x),
        lambda m: max(m) + 1,
        lambda m: [helper for helper in m.x if helper(m)],
        lambda m: sorted(m.x, key=lambda one: one == m),
        lambda m: setattr(m, "x", 1),
        assigned,
        renamed,
    ],
)
def test_other_uses_of_the_module_are_refused(function: Callable[[Module], Any]) -> None:
    with pytest.raises(ValueError, match=r"may only read attributes of 'm'|must not assign to 'm'"):
        names_read(function)


@pytest.mark.parametrize("function", [lambda: 1, lambda m, n: m.x + n, lambda *m: m, lambda m, *, n: m.x + n])
def test_only_the_module_is_a_parameter(function: Callable[..., Any]) -> None:
    with pytest.raises(ValueError, match="must have one parameter, the module"):
        names_read(function)


@pytest.mark.parametrize("mode", MODES)
def test_source_says_the_same_as_the_bytecode(mode: str) -> None:
    for row in table_for(mode).outputs:
        (m,) = inspect.signature(row.function).parameters
        called = {row.function}
        read: set[str] = set()
        while called:
            function = called.pop()
            nodes = list(ast.walk(ast.parse(textwrap.dedent(inspect.getsource(function)))))
            read |= {n.attr for n in nodes if isinstance(n, ast.Attribute) and ast.unparse(n.value) == m}
            calls = [n for n in nodes if isinstance(n, ast.Call) and [ast.unparse(a) for a in n.args] == [m]]
            called |= {function.__globals__[ast.unparse(n.func)] for n in calls}
        assert read == set(row.reads), row.name


def output(name: str, function: Callable[[Module], Any]) -> Output:
    return Output(name=name, unit="1", description="", group="", function=function)


WIDTH = Input(name="width", unit="mm", description="", group="")
DEPTH = Input(name="depth", unit="mm", description="", group="", read_by="cad")
STEEL = Choice(name="steel", description="", group="")
DENSITY = Input(name="density", unit="kg/m^3", description="", group="", record=("steel", "density"))


def test_a_table_is_built_of_what_is_read() -> None:
    table = Table((WIDTH, DEPTH, STEEL, DENSITY, output("mass", lambda m: m.width**3 * m.density)))
    assert table.evaluate({"width": 2.0, "density": 3.0}, ["mass"]) == {"mass": 24.0}


@pytest.mark.parametrize(
    ("quantities", "message"),
    [
        ([WIDTH, output("area", lambda m: m.widht**2)], "the quantity 'area' reads 'widht', which is no quantity"),
        ([output("a", lambda m: m.b), output("b", lambda m: m.a)], "quantities depend on one another: a -> b -> a"),
        ([output("a", lambda m: m.a)], "quantities depend on one another: a -> a"),
        ([WIDTH], "nothing reads the input 'width'"),
        ([STEEL], "nothing reads the input 'steel'"),
        ([WIDTH, WIDTH], "two quantities are named 'width'"),
        ([output("a", lambda m: max(m) + 1)], "the function of the quantity 'a' may only read attributes of 'm'"),
    ],
)
def test_a_wrong_table_is_refused_by_name(quantities: list[Any], message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        Table(tuple(quantities))
