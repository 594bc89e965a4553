"""Files in the layouts of instruments go through without an option: right value and interval, or a next step."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import layouts
import pytest
from measured_files import holds, measured
from melt_layouts import LAYOUTS, Layout

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.measure_files import Measured
from tvimdesign.simulation.measurement.record_file import as_recorded


def through(place: Path, made: Callable[[], bytes]) -> Measured:
    path = place / f"{made.__name__}.txt"
    path.write_bytes(made())
    return measured(path)


@pytest.mark.parametrize("made", layouts.FLOW, ids=lambda made: made.__name__)
def test_flow_curves(tmp_path: Path, made: Callable[[], bytes]) -> None:
    done = through(tmp_path, made)
    assert done.kind.name == "flow_curve"
    assert holds(done.measurement.record_values["zero_shear_viscosity"], layouts.VISCOSITY)


@pytest.mark.parametrize("made", layouts.AMPLITUDE, ids=lambda made: made.__name__)
def test_amplitude_sweeps(tmp_path: Path, made: Callable[[], bytes]) -> None:
    done = through(tmp_path, made)
    assert done.kind.name == "amplitude_sweep"
    assert holds(done.measurement.record_values["linear_strain_melt"], layouts.LIMIT)
    flagged = "3 of 30 rows are flagged by the instrument (ME- 3)"
    assert any(flagged in note for note in done.measurement.notes) == (made is layouts.rheocompass_amplitude)


@pytest.mark.parametrize("made", [*layouts.WITH_MASS, *layouts.WITHOUT_MASS], ids=lambda made: made.__name__)
def test_calorimeters(tmp_path: Path, made: Callable[[], bytes]) -> None:
    done = through(tmp_path, made)
    assert done.kind.name == "dsc"
    assert not done.measurement.fit.misfit
    values = done.measurement.record_values
    assert values["melting_start"].value - 273.15 == pytest.approx(layouts.MELTS_FROM, abs=0.3)
    assert values["melting_end"].value - 273.15 == pytest.approx(layouts.MELTS_TO, abs=0.3)
    assert ("latent_heat" in values) == (made in layouts.WITH_MASS)
    if made in layouts.WITH_MASS:
        assert values["latent_heat"].value == pytest.approx(1e3 * layouts.HEAT, rel=0.03)
    else:
        assert "--set sample_mass='5.2 mg' gives it" in done.measurement.notes[-1]
    if made is layouts.setaram:
        assert any("not used: Index, Furnace Temperature (°C)" in line for line in done.read())


@pytest.mark.parametrize("layout", LAYOUTS, ids=lambda layout: layout.data.__name__)
def test_melts(tmp_path: Path, layout: Layout) -> None:
    path = tmp_path / f"{layout.data.__name__}{layout.ending}"
    path.write_bytes(layout.data())
    if layout.refusal:
        with pytest.raises(InputError, match=layout.refusal):
            measured(path)
        return
    done = measured(path)
    assert done.kind.name == layout.kind
    values = done.measurement.record_values
    assert not done.measurement.fit.misfit
    assert {name: holds(as_recorded(values[name]), truth) for name, truth in layout.truth.items()} == dict.fromkeys(
        layout.truth, True
    )


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
