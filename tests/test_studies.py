"""The studies that ship: each runs, and comes to what it promises."""

import hashlib
import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import plain_module
import pytest
import trimesh
from support import STUDIES, Command, study_path

from tvimdesign.report.output.results_format import results_schema
from tvimdesign.robot.joint_model import make_bodies
from tvimdesign.study import read_study

FILES = {
    "design.json", "equilibrium_stiffening.csv", "impedance.csv", "manifest.json", "report.html", "results.csv",
    "results.json", "softening.csv", "stiffening.csv", "study.resolved.json", "study.yaml", "summary.txt",
}  # fmt: skip
PLOTS = {"impedance.png", "cycle.png", "stiffness_and_damping.png", "power_and_energy.png", "torque.png"}
OPTIMISED = {"why.csv"}
MARKS = {"paper_reconstructed": (), "paper_compression": (pytest.mark.gate,), "paper_shear": (pytest.mark.gate,)}
"""The study that takes seconds, and those that the gate runs; the others are slow tests."""
UNDRAWN = {"paper_reconstructed", "paper_compression"}
"""Run without plots, as drawing takes longer than evaluating: other evaluated modules of their modes have the same."""
MESHED = 1e-3
"""Share of a length by which a body's mesh may be beside its solid."""
RUN = [*STUDIES, study_path("paper_shear"), study_path("paper_compression")]
"""The shipped studies, and two that take less to run."""
every = pytest.mark.parametrize("study", [pytest.param(path, id=path.stem) for path in RUN])
names = pytest.mark.parametrize(
    "study",
    [pytest.param(path, id=path.stem, marks=MARKS.get(path.stem, (pytest.mark.slow,))) for path in RUN],
)


class Runs:
    """Folders of the studies' runs without CAD, each run when a test first asks for it."""

    def __init__(self, tvimdesign: Command, under: Path) -> None:
        self._tvimdesign, self._under = tvimdesign, under

    def __getitem__(self, name: str) -> Path:
        out = self._under / name
        if not out.exists():
            plots = ["--no-plots"] if name in UNDRAWN else []
            done = self._tvimdesign("run", study_path(name), "--no-cad", *plots, "--out", out)
            assert done.returncode == 0, done.stderr
        return out


@pytest.fixture(scope="module")
def runs(tvimdesign: Command, tmp_path_factory: pytest.TempPathFactory) -> Runs:
    return Runs(tvimdesign, tmp_path_factory.mktemp("studies"))


def _results(folder: Path) -> dict[str, Any]:
    reported: dict[str, Any] = json.loads((folder / "results.json").read_text())
    return reported


def _front(folder: Path) -> list[dict[str, Any]]:
    """Points of the front; none where the study asks for no front."""
    points: list[dict[str, Any]] = _results(folder).get("front", {}).get("points", [])
    return points


@pytest.mark.gate
@names
def test_a_study_leaves_a_whole_folder(runs: Runs, study: Path) -> None:
    folder = runs[study.stem]
    expected = FILES | (OPTIMISED if _results(folder)["status"] == "optimal" else set())
    front = _front(folder)
    expected |= {"front.csv", "front.json"} if front else set()
    expected |= set() if study.stem in UNDRAWN else {"summary.pdf"}
    assert {path.name for path in folder.iterdir() if path.is_file()} == expected
    plots = set() if study.stem in UNDRAWN else PLOTS | ({"front.png"} if front else set())
    assert {path.name for path in folder.glob("plots/*")} == plots
    assert {path.name for path in folder.glob("front/*")} == {Path(point["design"]).name for point in front}
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["inputs"]["study"] == "sha256:" + hashlib.sha256(study.read_bytes()).hexdigest()
    for name, reported in manifest["files"].items():
        assert reported == "sha256:" + hashlib.sha256((folder / name).read_bytes()).hexdigest(), name
    assert manifest["libraries"]["casadi"]


@names
def test_a_study_s_results_keep_limits_ratings_and_the_schema(runs: Runs, study: Path) -> None:
    reported = _results(runs[study.stem])
    assert reported["feasible"], [check for check in reported["checks"] if not check["kept"]]
    assert reported["status"] in {"evaluated", "optimal"}
    assert reported["above_rating"] == []
    assert reported["accepted_in_vain"] == []
    jsonschema.validate(_results(runs[study.stem]), results_schema())


@names
def test_the_springs_of_a_study_hold_by_a_second_implementation(runs: Runs, study: Path) -> None:
    # Geometry and statics written a second time, which shares no code with what found the design.
    design, reported = json.loads((runs[study.stem] / "design.json").read_text()), _results(runs[study.stem])
    module = plain_module.with_strength({**design["values"], **design["choices"]}, design["values"])
    found = plain_module.statics(module)
    asked = {
        (one["output"], one["sense"]): one["limit"] for one in design["study"]["require"] if one["output"] in found
    }
    rules = {("preload_margin", ">="): 0.0, ("spring_static_safety", ">="): 1.0}
    assert plain_module.broken(module, rules | asked) == []
    if reported["status"] == "optimal":
        stiffness = {one["output"] for one in design["study"]["require"]} & {"spring_stiffness", "joint_stiffness@hot"}
        assert stiffness, "every optimum is asked for a stiffness"
        assert design["choices"]["transmission"] == "geometry"
        assert not reported["idealizations"]
    strain = {
        "shear": ("layer_strain", plain_module.layer_strain),
        "compression": ("block_strain", plain_module.block_strain),
    }
    name, of = strain[design["mode"]]
    assert design["values"][name] == pytest.approx(of(module), rel=1e-9)
    wider = {"envelope_diameter"} if design["choices"]["motor"] != "none" else set()  # the motor is
    for name in (one for one in plain_module.COMPARED if one not in wider):
        within = 1e-4 * max(abs(found[name]), 1e-2)
        assert design["values"][name] == pytest.approx(found[name], abs=within), name


@pytest.mark.slow
@every
def test_mass_inertia_and_envelope_of_a_study_are_those_of_its_solids(runs: Runs, study: Path, tmp_path: Path) -> None:
    path = runs[study.stem] / "design.json"
    values = json.loads(path.read_text())["values"]
    base, moving, report = make_bodies(path, tmp_path)
    assert not report.failed
    assert base.mass + moving.mass == pytest.approx(values["module_mass"], rel=1e-5)
    assert moving.about_axis() == pytest.approx(values["parts_inertia"], rel=1e-5)
    bounds = np.array([trimesh.load(tmp_path / body.mesh).bounds for body in (base, moving)])
    low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    assert max(high[:2].max(), -low[:2].min()) <= 0.5 * values["envelope_diameter"] * (1.0 + MESHED)
    assert high[2] - low[2] == pytest.approx(values["envelope_height"], abs=2e-5)


@names
def test_plots_are_pictures_with_something_on_them(runs: Runs, study: Path) -> None:
    import matplotlib.image as mpimg

    for path in runs[study.stem].glob("plots/*"):
        picture = mpimg.imread(path)
        assert picture.shape[0] > 300, path.name
        assert picture[..., :3].std() > 0.02, f"{path.name} is blank"


def test_the_published_module_is_the_paper_s(runs: Runs) -> None:
    values = _results(runs["paper_reconstructed"])["values"]
    # 1.4023, 5.61, 18.5 and 0.0966: from the paper's table by its own formula, worked by hand.
    assert values["spring_rate"]["value"] == pytest.approx(1.4023, rel=1e-4)
    assert values["spring_stiffness"]["value"] == pytest.approx(5.609, rel=1e-3)
    assert values["spring_natural_frequency"]["value"] == pytest.approx(18.5, rel=5e-3)
    assert values["critical_damping"]["value"] == pytest.approx(0.0966, rel=1e-3)
    assert values["pcl_area"]["value"] == pytest.approx(1579.2, rel=1e-4)  # the paper's Table I


@pytest.mark.gate
def test_the_re_optimised_module_is_better_in_all_it_was_asked_for(runs: Runs) -> None:
    before = _results(runs["paper_reconstructed"])["values"]
    after = _results(runs["paper_shear"])["values"]
    for name in ("envelope_volume", "module_mass", "response_time"):
        assert after[name]["value"] < before[name]["value"], name


def test_every_module_but_the_paper_s_holds_its_layer_and_its_melt() -> None:
    built = [path for path in STUDIES if not path.stem.startswith("paper_")]
    assert len(built) == 7
    for study in map(read_study, built):
        assert study.module["axial_preload"] != "none", study.name
        assert study.mode == "compression" or study.module["melt_lip"] == "rings", study.name


@pytest.mark.gate
def test_the_csv_holds_what_the_json_holds(runs: Runs) -> None:
    import csv

    folder = runs["paper_shear"]
    with (folder / "results.csv").open(encoding="utf-8-sig") as stream:
        rows = {row["name"]: row for row in csv.DictReader(stream)}
    values = _results(folder)["values"]
    assert rows.keys() == values.keys()
    assert float(rows["module_mass"]["value"]) == pytest.approx(values["module_mass"]["value"])


@pytest.mark.slow
def test_a_run_is_the_same_run_twice_in_another_process(process: Command, runs: Runs, tmp_path: Path) -> None:
    process("run", study_path("paper_shear"), "--no-cad", "--no-plots", "--out", tmp_path / "out")
    first, second = _results(runs["paper_shear"])["values"], _results(tmp_path / "out")["values"]
    assert first == second
