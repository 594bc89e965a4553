"""The table of a module, and in which direction its outputs are better."""

import ast
import inspect
import re
import textwrap
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import cases_of

from tvimdesign.device import MODES, Choice, Input, Output, Table, table_for
from tvimdesign.device.table.module import Module, names_read

NAME = "x"


def helper(m: Module) -> Any:
    return m.from_helper


def everywhere(m: Module) -> Any:
    first, last = m.first, m.last
    if first:
        return helper(m) + m.record.value("x") + f"{m.in_text}"
    if m.second:
        return [m.in_list * i for i in m.over if m.when] + sorted(last, key=lambda number: number * m.in_lambda)
    return {name: sorted(name, key=lambda m: m.of_another) for name in m.table("names")}


def test_reads_in_branches_nested_functions_and_helpers_are_seen():
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
        lambda m: getattr(m, NAME),
        lambda m: helper(m.x) + max(m, m.x),
        lambda m: max(m) + 1,
        lambda m: [helper for helper in m.x if helper(m)],
        lambda m: sorted(m.x, key=lambda place: place == m),
        lambda m: setattr(m, "x", 1),
        assigned,
        renamed,
    ],
)
def test_other_uses_of_the_module_are_refused(function):
    with pytest.raises(ValueError, match=r"may only read attributes of 'm'|must not assign to 'm'"):
        names_read(function)


@pytest.mark.parametrize("function", [lambda: 1, lambda m, n: m.x + n, lambda *m: m, lambda m, *, n: m.x + n])
def test_only_the_module_is_a_parameter(function):
    with pytest.raises(ValueError, match="must have one parameter, the module"):
        names_read(function)


@pytest.mark.parametrize("mode", MODES)
def test_source_says_the_same_as_the_bytecode(mode):
    for row in (row for row in table_for(mode).outputs if row.function.__name__ != "<lambda>"):  # of margins.yaml
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


def test_a_table_is_built_of_what_is_read():
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
def test_a_wrong_table_is_refused_by_name(quantities, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        Table(tuple(quantities))


TABLE = table_for("shear")


@cases_of("device_module", "follows")
@settings(max_examples=15, deadline=None)
@given(factor=st.floats(1.005, 1.25), seed=st.integers(0, 2**20))
def test_result_follows_its_input(source, result, sign, factor, seed, inputs):
    random = np.random.default_rng(seed)
    # Not the geometry's own module but one near it; what does not depend on the source stays out of the way.
    module = {row.name: inputs[row.name] * random.uniform(0.92, 1.08) for row in TABLE.inputs if row.variable}
    before = {**inputs, **module}
    after = {**before, source: _changed(source, before[source], factor)}
    low, high = (TABLE.evaluate(given, [result])[result] for given in (before, after))
    assert sign * (high - low) > 0.0


def _changed(name: str, value: float, factor: float) -> float:
    return value + 20.0 * (factor - 1.0) if name.startswith("temperature") else value * factor


@pytest.mark.gate
@settings(max_examples=12, deadline=None)
@given(
    change=st.sampled_from(
        [
            ("current", 1.2, -1.0),  # more heat
            ("pcl_thickness", 0.7e-3, 1.0),  # more to melt, and a longer way
            ("rotor_thickness", 2.5e-3, 1.0),  # more to warm
            ("hot_contact", 5e2, -1.0),  # above 2.6e3 hardly anything follows: 1e-4, most of it at the layer's corner
            ("ambient_temperature", 283.15, -1.0),
            ("pcl_latent_heat", 60e3, 1.0),
            ("target_temperature", 365.0, 1.0),
            ("pcl_conductivity_melt", 0.15, -1.0),
        ]
    ),
    shares=st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)).filter(lambda pair: abs(pair[0] - pair[1]) > 0.05),
)
def test_response_time_follows_its_input(change, shares, unity, simulator):
    name, lowest, sign = change
    span = 15.0 if name.endswith("temperature") else 0.6 * lowest
    times = []
    for share in sorted(shares):
        place = unity.start.copy()
        place[unity.index[name]] = lowest + share * span
        times.append(simulator.run(place).values["far_face_time"])
    assert sign * (times[1] - times[0]) > 0.0
