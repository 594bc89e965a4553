"""Files in the layouts of instruments go through without an option: right value and interval, or a next step."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml
from measured_files import holds, measured

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.record_file import as_recorded

FILES = Path(__file__).with_name("instrument_files")
TRUTH = [
    pytest.param(path, truth, id=path.relative_to(FILES).as_posix())
    for pattern, truth in yaml.safe_load((FILES / "truth.yaml").read_text()).items()
    for path in sorted(FILES.glob(pattern))
]
WITH_MASS = ("netzsch", "ta_universal", "trios_dsc")


@pytest.mark.parametrize(("path", "truth"), TRUTH)
def test_rheometers(path: Path, truth: Mapping[str, Any]) -> None:
    if "refusal" in truth:
        with pytest.raises(InputError, match=truth["refusal"]):
            measured(path)
        return
    one = measured(path)
    done = one.measurement
    assert one.kind.name == truth["kind"]
    assert not done.fit.misfit
    held = {name: holds(as_recorded(done.record_values[name]), value) for name, value in truth["values"].items()}
    assert held == dict.fromkeys(truth["values"], True)
    flagged = "3 of 30 rows are flagged by the instrument (ME- 3)"
    assert any(flagged in note for note in done.notes) == path.match("amplitude/rheocompass.txt")


@pytest.mark.parametrize("path", sorted(FILES.glob("dsc/*")), ids=lambda path: path.stem)
def test_calorimeters(path: Path) -> None:
    done = measured(path)
    assert done.kind.name == "dsc"
    assert not done.measurement.fit.misfit
    values = done.measurement.record_values
    assert values["melting_start"].value - 273.15 == pytest.approx(50.0, abs=0.3)
    assert values["melting_end"].value - 273.15 == pytest.approx(62.0, abs=0.3)
    assert ("latent_heat" in values) == (path.stem in WITH_MASS)
    if path.stem in WITH_MASS:
        assert values["latent_heat"].value == pytest.approx(60e3, rel=0.03)
    else:
        assert "--set sample_mass='5.2 mg' gives it" in done.measurement.notes[-1]
    if path.stem == "setaram":
        assert any("not used: Index, Furnace Temperature (°C)" in line for line in done.read())


@pytest.mark.parametrize(
    ("head", "row", "message"),
    [
        ("time [s];gadget [V2];strain [1]", "{0};{0};0.{0}", r"(?s)--set stress=...: needed.*not used: 'gadget"),
        ("depth [mm];width [mm]", "{0};{0}", r"(?s)of no kind there is .*The nearest: .* needs .*not used: 'depth"),
    ],
)
def test_a_refusal_says_what_was_not_used(tmp_path: Path, head: str, row: str, message: str) -> None:
    path = tmp_path / "x.csv"
    path.write_text("\n".join([head, *(row.format(i) for i in range(1, 9))]) + "\n")
    with pytest.raises(InputError, match=message):
        measured(path)


def test_columns_decide_for_a_kind(tmp_path: Path) -> None:
    path = tmp_path / "stand.csv"
    rows = "\n".join(f"{i};{i % 5};{i / 10};{i}" for i in range(12))
    path.write_text(f"cycle;time [s];angle [deg];torque [N.m]\n{rows}\n")
    with pytest.raises(InputError, match="time does not rise"):  # taken as sine, by the cycles
        measured(path)
