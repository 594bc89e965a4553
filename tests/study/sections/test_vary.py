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
    result = read(_study(name, form)).vary[name]
    assert type(result) is type(expected)
    for found_value, value in zip(_flat(result), _flat(expected), strict=True):
        assert found_value == (value if isinstance(value, str | None) else pytest.approx(value))


def test_the_modules_value_is_the_start(read: Read) -> None:
    def start(module: str, form: str = "[1 mm, 2 mm]") -> float | None:
        result = read(_study("wire_diameter", form, module)).vary["wire_diameter"]
        assert isinstance(result, Range)
        return result.start

    assert start("") is None
    assert start("wire_diameter: 1.5 mm") == pytest.approx(1.5e-3)
    assert start("wire_diameter: 2 mm") == pytest.approx(2e-3)
    assert start("wire_diameter: 1.5 mm", "{from: 1 mm, to: 2 mm, start: 1.2 mm}") == pytest.approx(1.2e-3)


@pytest.mark.parametrize(
    ("name", "form", "value"),
    [
        ("arc_count", "{choose: [3, 6]}", "3"),
        ("arc_count", "{choose: [3, 6]}", "4"),
        ("wire_diameter", "{catalog: metric}", "1.2 mm"),
        ("peltier", "{choose: [qc_17]}", "qc_17"),
    ],
)
def test_the_modules_value_may_lie_within_the_options(read: Read, name: str, form: str, value: str) -> None:
    assert read(_study(name, form, f"{name}: {value}")).module[name] is not None
