"""The command `fit`: a folder, a record, kinds listed, and errors with exit code 2."""

import json
from collections.abc import Callable
from pathlib import Path

import layouts
import pytest
from support import Command

WEIGHTS = "mass [g]; angle [deg]\n0; 0.9\n100; 5.1\n200; 9.3\n300; 13.4\n200; 9.8\n100; 5.6\n0; 1.4\n"


@pytest.fixture
def weights(tmp_path: Path) -> Path:
    path = tmp_path / "weights.csv"
    path.write_text(WEIGHTS)
    return path


def test_a_fit_writes_its_folder_and_its_record(tvimdesign: Command, weights: Path, tmp_path: Path) -> None:
    sizes = ("wire_diameter=2.413 mm", "coil_diameter=24.41 mm", "coil_count=3.25", "arm=100 mm")
    done = tvimdesign("fit", weights, *(word for size in sizes for word in ("--set", size)), "--record", "my_wire",
                      "--out", "out", cwd=tmp_path)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "angle: 'angle [deg]' in °, 0.9 to 13.4" in done.stdout
    assert "spring_material: my_wire" in done.stdout
    files = {path.name for path in (tmp_path / "out").iterdir()}
    assert files >= {"fit.json", "residuals.csv", "fit.png", "manifest.json"}
    data = json.loads((tmp_path / "out/fit.json").read_text())
    assert [one["name"] for one in data["parameters"]] == ["stiffness", "zero_angle", "friction"]
    assert data["record"] == "my_records/spring_materials/my_wire.yaml"
    assert (tmp_path / data["record"]).exists()
    rows = (tmp_path / "out/residuals.csv").read_text(encoding="utf-8-sig").splitlines()
    assert len(rows) == 1 + 7


def test_a_fit_without_a_record_keeps_its_folder_and_json_has_it(
    tvimdesign: Command, weights: Path, tmp_path: Path
) -> None:
    done = tvimdesign(
        "fit", weights, "--set", "arm=100 mm", "--record", "mine", "--no-plots", "--out", "out", cwd=tmp_path
    )
    assert done.returncode == 4
    assert "torque_angle: nothing in it is a value of a record" in " ".join(done.stderr.split())
    assert json.loads((tmp_path / "out/fit.json").read_text())["record"] is None
    done = tvimdesign("fit", weights, "--set", "arm=100 mm", "--no-plots", "--json", cwd=tmp_path)
    printed = json.loads(done.stdout)
    assert printed.pop("folder") == "results/weights-fit"
    assert printed.pop("not_done") == []
    assert printed == json.loads((tmp_path / "results/weights-fit/fit.json").read_text())


@pytest.mark.gate
@pytest.mark.parametrize("made", [
    layouts.plain_flow, layouts.haake_amplitude, layouts.ta_universal, layouts.trios_dsc, layouts.setaram,
    layouts.mettler, layouts.netzsch, layouts.plain_dsc,
], ids=lambda made: made.__name__)  # fmt: skip
def test_a_file_goes_through_without_an_option(tvimdesign: Command, tmp_path: Path, made: Callable[[], bytes]) -> None:
    (tmp_path / "data.txt").write_bytes(made())
    done = tvimdesign("fit", "data.txt", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    data = json.loads((tmp_path / "results/data-fit/fit.json").read_text())
    values = {entry["name"]: entry for entry in (*data["parameters"], *data["derived"])}
    kind, name, truth = {
        layouts.plain_flow: ("flow_curve", "zero_shear_viscosity", layouts.VISCOSITY),
        layouts.haake_amplitude: ("amplitude_sweep", "linear_strain", 100.0 * layouts.LIMIT),
    }.get(made, ("dsc", "melting_end", layouts.MELTS_TO))
    assert (data["kind"], data["misfit"]) == (kind, "")
    assert values[name]["value"] == pytest.approx(truth, rel=0.15)
    assert (tmp_path / "results/data-fit/fit.png").exists()


def test_kinds_are_listed(tvimdesign: Command) -> None:
    listed = tvimdesign("fit", "--kinds").stdout
    assert "columns: angle, torque or mass or force" in listed
    assert set(json.loads(tvimdesign("fit", "--kinds", "--json").stdout)) == {
        "torque_angle", "frequency_sweep", "temperature_ramp", "creep", "relaxation", "melt", "amplitude_sweep", "dsc",
        "pad", "release", "sine", "frozen_torque", "heating_log", "flow_curve",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "give at least one FILE"),
        (["nowhere.csv"], "there is no such file"),
        (["weights.csv"], "--set arm=...: needed"),
        (["weights.csv", "--set", "arm"], "expected a name, `=` and a value"),
        (["weights.csv", "--as", "spring"], "no kind of measurement is named 'spring'"),
        (["weights.csv", "--columns", "weights.csv"], "expected quantities with their columns"),
    ],
)
def test_what_is_wrong_is_said(tvimdesign: Command, weights: Path, words: list[str], said: str) -> None:
    done = tvimdesign("fit", *words, "--no-plots", cwd=weights.parent)
    assert done.returncode == 2
    assert said in done.stderr
