"""The section `vary`: ranges, lists and catalogue choices, good and bad."""

from collections.abc import Callable
from typing import Any

import pytest

from tvimdesign.study import Options, Range, Study, Vary

Read = Callable[..., Study]
Refuse = Callable[..., list[str]]


def _study(name: str, form: str, module: str = "") -> str:
    return f"mode: shear\nminimize: module_mass\nmodule: {{{module}}}\nvary:\n  {name}: {form}\n"


def _flat(vary: Vary) -> list[Any]:
    return [*vary.values, vary.source] if isinstance(vary, Options) else [vary.lower, vary.upper, vary.start]


@pytest.mark.parametrize(
    ("name", "form", "expected"),
    [
        ("wire_diameter", "[1.5 mm, 3.2 mm]", Range(lower=1.5e-3, upper=3.2e-3)),
        ("wire_diameter", "[0.5 mm, 5 mm]", Range(lower=0.5e-3, upper=5e-3)),
        ("wire_diameter", "{from: 1.5 mm, to: 0.32 cm}", Range(lower=1.5e-3, upper=3.2e-3)),
        ("coil_count", "{from: 2, to: 4, start: 4}", Range(lower=2, upper=4, start=4)),
        ("coil_count", "{choose: [3.25, '4.25']}", Options(values=(3.25, 4.25))),
        ("coil_count", "{catalog: quarter_coils}", Options(values=(3.25,), source="quarter_coils")),
        ("coil_count", "{from: 3, to: 4, step: 0.25}", Options(values=(3.0, 3.25, 3.5, 3.75, 4.0))),
        ("coil_count", "{from: 3, to: 3.9, step: 0.5}", Options(values=(3.0, 3.5))),
        ("wire_diameter", "{from: 1 mm, to: 1.3 mm, step: 0.1 mm}", Options(values=(1e-3, 1.1e-3, 1.2e-3, 1.3e-3))),
        ("arc_count", "{choose: [3, 4]}", Options(values=(3.0, 4.0))),
        ("arc_count", "{from: 3, to: 6}", Options(values=(3.0, 4.0, 5.0, 6.0))),
        ("arc_count", "{from: 2, to: 6, step: 2}", Options(values=(2.0, 4.0, 6.0))),
        ("peltier", "{choose: [qc_17]}", Options(values=("qc_17",))),
        ("rate_model", "{choose: [smi, bending]}", Options(values=("smi", "bending"))),
        ("wire_diameter", "{catalog: metric}", Options(values=(1e-3, 1.6e-3, 2e-3, 2.413e-3, 3.2e-3), source="metric")),
        ("wire_diameter", "{catalog: metric, from: 1.6 mm, to: 2 mm}", Options(values=(1.6e-3, 2e-3), source="metric")),
        ("wire_diameter", "{catalog: metric, to: 1.7 mm}", Options(values=(1e-3, 1.6e-3), source="metric")),
        ("wire_diameter", "{catalog: metric, from: 2.1 mm}", Options(values=(2.413e-3, 3.2e-3), source="metric")),
    ],
)
def test_forms(read: Read, name: str, form: str, expected: Vary) -> None:
    found = read(_study(name, form)).vary[name]
    assert type(found) is type(expected)
    for found_value, value in zip(_flat(found), _flat(expected), strict=True):
        assert found_value == (value if isinstance(value, str | None) else pytest.approx(value))


@pytest.mark.parametrize(
    ("name", "form", "said"),
    [
        ("wire_diameter", "[3 mm, 1 mm]", "5:18: vary.wire_diameter: the range is upside down: from 3 mm to 1 mm"),
        (
            "wire_diameter",
            "[3 mm, 0.3 cm]",
            "the range ends where it begins, at 3 mm; expected from < to; to fix it, set",
        ),
        ("wire_diameter", "[1 mm, 2 mm, 3 mm]", "a list of 3 does not fit here; expected a range [1 mm, 2 mm]"),
        ("wire_diameter", "[1 mm]", "a list of 1 does not fit here"),
        ("wire_diameter", "[]", "the list is empty"),
        ("wire_diameter", "{}", "a mapping (name: value) does not fit here; expected a range"),
        ("wire_diameter", "1 mm", "5:18: vary.wire_diameter: the value '1 mm' does not fit here; expected a range"),
        ("wire_diameter", "", "no value does not fit here"),
        (
            "wire_diameter",
            "[0.1 mm, 2 mm]",
            "5:19: vary.wire_diameter[0]: '0.1 mm' is below the lower limit 0.5 mm; exp",
        ),
        ("wire_diameter", "[1 mm, 6 mm]", "5:25: vary.wire_diameter[1]: '6 mm' is above the upper limit 5 mm"),
        ("wire_diameter", "[1, 2 mm]", "vary.wire_diameter[0]: '1': say the unit"),
        ("wire_diameter", "{from: 1 mm}", "'to' missing"),
        ("wire_diameter", "{start: 1 mm}", "'from' and 'to' missing"),
        (
            "wire_diameter",
            "{from: 1 mm, to: 2 mm, start: 3 mm}",
            "vary.wire_diameter.start: 3 mm lies outside the range",
        ),
        (
            "wire_diameter",
            "{from: 1 mm, to: 2 mm, strt: 1 mm}",
            "no such key; expected one of from, to, start; did you",
        ),
        ("wire_diameter", "{choose: [1 mm], from: 2 mm}", "vary.wire_diameter.from: no such key beside 'choose'"),
        ("wire_diameter", "{choose: []}", "vary.wire_diameter.choose: the list is empty"),
        ("wire_diameter", "{choose: 1 mm}", "vary.wire_diameter.choose: the value '1 mm' does not fit here"),
        (
            "wire_diameter",
            "{choose: [1 mm, 0.1 cm]}",
            "vary.wire_diameter.choose[1]: '0.1 cm' stands twice in the list",
        ),
        (
            "wire_diameter",
            "{catalog: metrik}",
            "no such record in the category wires: 'metrik'; expected one of metric, qu",
        ),
        ("wire_diameter", "{catalog: [metric]}", "vary.wire_diameter.catalog: a list does not fit here"),
        (
            "wire_diameter",
            "{catalog: metric, start: 2 mm}",
            "no such key beside 'catalog'; expected one of catalog, from",
        ),
        ("wire_diameter", "{catalog: metric, from: 3 mm, to: 1 mm}", "the range is upside down"),
        (
            "wire_diameter",
            "{catalog: metric, from: 4 mm}",
            "metric has no size from 4 mm to 5 mm; expected part of 1 mm",
        ),
        ("coil_diameter", "{catalog: metric}", "metric lists no coil_diameter, only wire_diameter"),
        (
            "arc_count",
            "[3, 6]",
            "vary.arc_count: counts whole things, which a range cannot hold; expected a list of whole",
        ),
        ("arc_count", "{from: 6, to: 3}", "vary.arc_count: the range is upside down"),
        ("arc_count", "{from: 3, to: 6, step: 0.5}", "vary.arc_count.step: counts whole things; expected a whole step"),
        ("arc_count", "{from: 3, to: 6, start: 4}", "no such key; expected one of from, to, step"),
        ("coil_count", "{from: 3, to: 4, step: 0}", "vary.coil_count.step: a step of that size leads nowhere"),
        ("coil_count", "{from: 3, to: 4, step: 0.001}", "vary.coil_count: 1001 sizes from end to end"),
        ("coil_count", "{from: 3, step: 0.25}", "'to' missing"),
        ("wire_diameter", "{from: 1 mm, to: 2 mm, step: 0.1}", "vary.wire_diameter.step: '0.1': say the unit"),
        ("arc_count", "{choose: [3.5]}", "vary.arc_count.choose[0]: '3.5' is not a whole number"),
        ("peltier", "[qc_17]", "a list does not fit here; expected a list of names {choose: [...]}"),
        ("peltier", "{choose: [qc_71]}", "vary.peltier.choose[0]: no such record in the category peltiers: 'qc_71'"),
        ("peltier", "{from: 1, to: 2}", "expected a list of names"),
        (
            "placement_radius",
            "[20 mm, 30 mm]",
            "vary.placement_radius: cannot be varied; expected one of wire_diameter",
        ),
        ("temperature", "[20 degC, 30 degC]", "belongs to the operating points and cannot be varied"),
        ("module_mass", "[20 g, 30 g]", "is a result and cannot be varied"),
        ("wire_diamter", "[1 mm, 2 mm]", "5:3: vary.wire_diamter: no such variable; expected one of"),
    ],
)
def test_refusals(problems: Refuse, name: str, form: str, said: str) -> None:
    lines = problems(_study(name, form))
    assert len(lines) == 1
    assert said in lines[0]


def test_the_modules_value_is_the_start(read: Read, problems: Refuse) -> None:
    def start(module: str, form: str = "[1 mm, 2 mm]") -> float | None:
        found = read(_study("wire_diameter", form, module)).vary["wire_diameter"]
        assert isinstance(found, Range)
        return found.start

    assert start("") is None
    assert start("wire_diameter: 1.5 mm") == pytest.approx(1.5e-3)
    assert start("wire_diameter: 2 mm") == pytest.approx(2e-3)
    assert start("wire_diameter: 1.5 mm", "{from: 1 mm, to: 2 mm, start: 1.2 mm}") == pytest.approx(1.2e-3)
    (line,) = problems(_study("wire_diameter", "[1 mm, 2 mm]", "wire_diameter: 2.5 mm"))
    assert line.startswith("x.yaml:3:25: module.wire_diameter: '2.5 mm' lies outside what `vary` allows")
    assert "expected 1 mm to 2 mm" in line


@pytest.mark.parametrize(
    ("name", "form", "value", "fits"),
    [
        ("arc_count", "{choose: [3, 6]}", "3", True),
        ("arc_count", "{choose: [3, 6]}", "4", True),
        ("arc_count", "{choose: [3, 6]}", "7", False),
        ("wire_diameter", "{catalog: metric}", "1.2 mm", True),
        ("wire_diameter", "{catalog: metric, from: 1.5 mm}", "1.2 mm", False),
        ("peltier", "{choose: [qc_17]}", "qc_17", True),
        ("peltier", "{choose: [qc_17]}", "flexible_1600", False),
    ],
)
def test_the_modules_value_must_be_within_the_options(
    read: Read, problems: Refuse, *, name: str, form: str, value: str, fits: bool
) -> None:
    text = _study(name, form, f"{name}: {value}")
    if fits:
        assert read(text).module[name] is not None
    else:
        assert "lies outside what `vary` allows" in problems(text)[0]


def test_vary_and_minimize_come_together(problems: Refuse) -> None:
    (line,) = problems("mode: shear\nvary: {coil_count: [2, 3]}")
    assert line.startswith("x.yaml:2:7: vary: there is nothing to improve: `minimize` is missing")
    (line,) = problems("mode: shear\nminimize: module_mass")
    assert line.startswith("x.yaml:2:11: minimize: nothing may change: `vary` is missing")
