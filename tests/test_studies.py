"""The studies that ship: each runs, comes to what it promises, can be ordered, and becomes parts."""

import hashlib
import json
import re
from pathlib import Path
from time import process_time
from typing import Any

import cadquery as cq
import jsonschema
import numpy as np
import plain_module
import pytest
import trimesh
import yaml
from answers import shipped_answer
from cad_designs import as_it_starts
from support import STUDIES, TASKS, Command, study_path

from tvimdesign.cad.assembly.assembly import MODULES
from tvimdesign.cad.assembly.bill_of_materials import Item, as_ordered, beside, bill, fixtures
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.jobs.main import _titles
from tvimdesign.report.output.tables import results_schema
from tvimdesign.robot.joint_model import make_bodies
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study, read_study_text
from tvimdesign.study.conditions import Case, refuse_unequal
from tvimdesign.study.sections.tolerances import standard_tolerances
from tvimdesign.study.study import Options

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
    "study", [pytest.param(path, id=path.stem, marks=MARKS.get(path.stem, (pytest.mark.slow,))) for path in RUN]
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
def test_a_study_leaves_a_whole_folder(runs, study):
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


@pytest.mark.gate
@names
def test_a_study_s_results_keep_limits_ratings_and_the_schema(runs, study):
    reported = _results(runs[study.stem])
    assert reported["feasible"], [check for check in reported["checks"] if not check["met"]]
    assert reported["status"] in {"evaluated", "optimal"}
    assert reported["above_rating"] == []
    assert reported["accepted_in_vain"] == []
    jsonschema.validate(_results(runs[study.stem]), results_schema())


@names
def test_the_springs_of_a_study_hold_by_a_second_implementation(runs, study):
    # Geometry and statics written a second time, which shares no code with what found the design.
    design, reported = json.loads((runs[study.stem] / "design.json").read_text()), _results(runs[study.stem])
    module = plain_module.with_strength({**design["values"], **design["choices"]}, design["values"])
    statics = plain_module.statics(module)
    required = {
        (limit["output"], limit["sense"]): limit["limit"]
        for limit in design["study"]["require"]
        if limit["output"] in statics
    }
    rules = {("preload_margin", ">="): 0.0, ("spring_static_safety", ">="): 1.0}
    assert plain_module.broken(module, rules | required) == []
    if reported["status"] == "optimal":
        stiffness = {limit["output"] for limit in design["study"]["require"]} & {
            "spring_stiffness",
            "joint_stiffness@hot",
            "softened_stiffness",
        }
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
    for name in (name_of for name_of in plain_module.COMPARED if name_of not in wider):
        within = 1e-4 * max(abs(statics[name]), 1e-2)
        assert design["values"][name] == pytest.approx(statics[name], abs=within), name


@pytest.mark.slow
@every
def test_mass_inertia_and_envelope_of_a_study_are_those_of_its_solids(runs, study, tmp_path):
    path = runs[study.stem] / "design.json"
    values = json.loads(path.read_text())["values"]
    base, moving, report = make_bodies(path, tmp_path)
    assert not report.failed
    assert base.mass + moving.mass == pytest.approx(values["module_mass"], rel=1e-5)
    assert moving.about_axis() == pytest.approx(values["parts_inertia"], rel=1e-5)
    bounds = np.array([trimesh.load(tmp_path / body.mesh).bounds for body in (base, moving)])
    for body, (lowest, highest) in zip((base, moving), bounds, strict=True):
        assert (tmp_path / body.mesh).stat().st_size < 2e6
        assert np.all((lowest < body.centre) & (body.centre < highest))
    low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    assert max(high[:2].max(), -low[:2].min()) <= 0.5 * values["envelope_diameter"] * (1.0 + MESHED)
    assert high[2] - low[2] == pytest.approx(values["envelope_height"], abs=2e-5)


@names
def test_plots_are_pictures_with_something_on_them(runs, study):
    import matplotlib.image as mpimg

    for path in runs[study.stem].glob("plots/*"):
        picture = mpimg.imread(path)
        assert picture.shape[0] > 300, path.name
        assert picture[..., :3].std() > 0.02, f"{path.name} is blank"


@pytest.mark.gate
def test_the_re_optimised_module_is_better_in_all_it_was_asked_for(runs):
    before = _results(runs["paper_reconstructed"])["values"]
    after = _results(runs["paper_shear"])["values"]
    for name in ("envelope_volume", "module_mass", "response_time"):
        assert after[name]["value"] < before[name]["value"], name


def test_every_module_but_the_paper_s_holds_its_layer_and_its_melt():
    built = [path for path in STUDIES if not path.stem.startswith("paper_")]
    assert len(built) == 7
    for study in map(read_study, built):
        assert study.module["axial_preload"] != "none", study.name
        assert study.mode == "compression" or study.module["melt_lip"] == "rings", study.name


@pytest.mark.slow
def test_a_run_is_the_same_run_twice_in_another_process(process, runs, tmp_path):
    process("run", study_path("paper_shear"), "--no-cad", "--no-plots", "--out", tmp_path / "out")
    first, second = _results(runs["paper_shear"])["values"], _results(tmp_path / "out")["values"]
    assert first == second


PAPER = "paper_"
"""How the names of the paper's own modules begin: they stay as it has them, advice and all."""
ORDERED = [path for path in STUDIES if not path.stem.startswith(PAPER)]
to_order = pytest.mark.parametrize("path", ORDERED, ids=lambda path: str(path.stem))
PAIR = ("wrist_joint", "wrist_compression")
"""Studies of the two modes that are asked the same."""


@to_order
def test_a_study_requires_a_yield_of_parts_one_can_buy(path):
    study = read_study(path)
    assert not study.accept
    assert study.robust is not None
    assert study.robust.share == pytest.approx(0.95)
    assert set(standard_tolerances(study.table)) <= set(study.tolerances), "`standard: true`, and what differs from it"
    free = study.vary.get("heater_module")
    heaters = free.values if isinstance(free, Options) else [study.module.get("heater_module", "flexible_1600")]
    assert "flexible_1600" not in heaters, "no maker's table has it"
    assert study.module.get("process", "print_petg") != "print_petg"
    assert study.tolerances["preload_angle"].adjustable == (study.module.get("preload_adjuster") == "rotary")


def test_both_of_the_pair_are_asked_the_same_and_may_be_compared():
    shear, compression = pair = [read_study(study_path(name)) for name in PAIR]
    refuse_unequal([Case(study_path(name), study) for name, study in zip(PAIR, pair, strict=True)])
    both = (shear.module.keys() & compression.module.keys()) - shear.vary.keys() - compression.vary.keys()
    assert {key: shear.module[key] for key in both} == {key: compression.module[key] for key in both}
    only_compression = {row.name for row in compression.table.outputs} - {row.name for row in shear.table.outputs}
    required = {
        (limit.output, limit.sense, limit.limit)
        for limit in compression.require
        if limit.output not in only_compression
    }
    assert required == {(limit.output, limit.sense, limit.limit) for limit in shear.require}
    for what in ("minimize", "operating_points", "robust"):
        assert getattr(shear, what) == getattr(compression, what), what
    both = shear.tolerances.keys() & compression.tolerances.keys()
    assert {key: shear.tolerances[key] for key in both} == {key: compression.tolerances[key] for key in both}
    assert shear.module["process"] == compression.module["process"]


@pytest.mark.slow
@pytest.mark.parametrize("path", [*ORDERED, *TASKS], ids=lambda path: str(path.stem))
def test_a_study_comes_to_an_optimum_that_95_percent_of_the_modules_keep(path):
    result = shipped_answer(path.stem)
    assert result.design.status == "optimal"
    assert result.design.accepting == ()
    assert result.feasible
    assert result.solution is not None
    assert result.solution.yield_reached is not None
    assert result.solution.yield_reached.together >= 0.95
    values = result.design.values
    borne = values["load_safety"] * values["task_torque@cold"] if path in TASKS else 0.0
    assert values["holding_torque"] >= borne * (1.0 - 1e-6)


LONGER = 1.5
"""Processor time of a study over that of the same one without its task."""


@pytest.mark.slow
@pytest.mark.parametrize("path", TASKS, ids=lambda path: str(path.stem))
def test_a_task_takes_no_longer_than_its_torque(path):
    values, text = shipped_answer(path.stem).design.values, yaml.safe_load(path.read_text())
    del text["task"]
    struck = values["impact_torque@cold"] if text["require"].pop("impact_torque_margin", None) else 0.0
    torque = max(struck, values["load_safety"] * values["task_torque@cold"])
    text["require"]["holding_torque"] = f">= {torque} N.m"
    plain = read_study_text(yaml.safe_dump(text, allow_unicode=True))
    times = []
    for study in (plain, read_study(path)):
        start = process_time()
        answer(study)
        times.append(process_time() - start)
    assert times[1] < LONGER * times[0]


STANDARDS = r"ISO \d{3,}|EN \d{5}|ASTM A\d+|JIS G \d{4}|AWG \d+|\b606\d\b"
MAKERS = (
    r"ball bearing 6[78]\d\d|\b1MA10-|\bCP30\d{3}|\b9AR\b|\b5MA3SPF|\bG4A01\d{3}C|\bDF\d{3}S: |\bT[12]0\d{3}|Capa 6\d00"
    r"|DP760|\bB57(?:540G|862S)\d+|\bAMF58B-\d+|\bILM\d\d|\bAS50\d\d|ULTEM \d+"
)
NUMBERED = re.compile(f"{STANDARDS}|{MAKERS}")
TO_SIZE = {
    "preload_spring": r"flat wire, [\d.]+ x [\d.]+ x [\d.]+ mm, .* waves, .* free, wound to order",
    "heater": r"to the outline of its STEP file; resistance [\d.]+ ohm each, .* W each, at [\d.]+ V",
    "heater_lead": r"Lead of [\d.]+ mm; it comes with its heater",
    "liner": r"[\d.]+ mm thick, to the outline of its STEP file",
    "filament": r"of 1\.75 mm",
    **dict.fromkeys(("cover_insert", "link_insert", "retainer_insert", "adjuster_insert"), r"M\d"),
}  # fmt: skip
"""Kinds that are made to sizes the bill tells, as no table of a maker was to be read."""
RATED = {
    "thermal_grease", "heat_conducting_adhesive", "polyimide_film", "thread_locker", "motor_adhesive", "mould_release",
    "supply", "driver", "controller", "controller_supply", "wire_sleeve", "crimp_splice", "grease",
    "divider_resistor", "thread_patch", "gap_pad", "sealing_tape",
}  # fmt: skip
"""Kinds that any shop has, by a rating that the bill tells."""
FIGURE = re.compile(r"\d+(\.\d+)? (°C|V|A)\b")


def bought(path: Path) -> list[Item]:
    """Return the lines of the bill that are bought, of a study as it starts, as if it had been through its cycle."""
    design = as_it_starts(read_study(path))
    design.values.update(peak_heater_temperature=356.0, peak_cold_side_temperature=340.0, peak_current=2.0)
    design.values.update(stiffening_peak_current=0.5, peak_voltage=9.0, stiffening_peak_voltage=1.0)
    titles = _titles(design)
    kinds = MODULES[design.mode].kinds(dimensions(design))
    parts = bill(design, titles, {f"{kind}_1": cq.Solid.makeBox(1.0, 1.0, 1.0) for kind in kinds})
    return [item for item in as_ordered([*parts, *beside(design, titles), *fixtures(design, titles)]) if not item.made]


@pytest.mark.parametrize("path", ORDERED, ids=lambda path: str(path.stem))
def test_bought_items_have_a_number_a_standard_or_sizes_to_order_by(path):
    items = bought(path)
    assert {"heater", "polymer", "thermal_cutout", "spring_right", "link_screw"} <= {line.kind for line in items}
    for item in items:
        ways = (
            NUMBERED.search(item.title),
            re.search(TO_SIZE.get(item.kind, "^$"), item.title),
            FIGURE.search(item.title) if item.kind in RATED else None,
        )
        assert any(ways), f"{item.kind}: {item.title}"


MADE = ("elbow_printed", "elbow_machined", "wrist_joint", "wrist_compression", "paper_shear", "machined_compression",
        "driven_joint", *(path.stem for path in TASKS))  # fmt: skip
"""Studies whose parts are made: the others differ from these in dimensions alone."""


@pytest.mark.slow
@pytest.mark.parametrize("study", [study_path(name) for name in MADE], ids=MADE)
def test_a_study_becomes_parts_that_pass_every_check(tvimdesign, tmp_path, study):
    done = tvimdesign("run", study, "--no-plots", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    cad = tmp_path / "out/cad"
    assert all(check["ok"] for check in json.loads((cad / "checks.json").read_text())["checks"])
    mode = json.loads((tmp_path / "out/design.json").read_text())["mode"]
    pcl = {"shear": "pcl_arc", "compression": "pcl_block"}[mode]
    parts = ("housing", "rotor", "link", "retainer", pcl, "heater", "spring_left", "spring_right")
    for part in parts:
        assert (cad / f"step/{part}.step").stat().st_size > 500
    for part in parts[:5]:
        assert (cad / f"print/{part}.3mf").stat().st_size > 500
    for part in parts[:4]:
        assert (cad / f"drawings/{part}.pdf").stat().st_size > 10_000
    for name in ("assembly.step", "assembly.glb", "preview.png", "views/exploded.png", "views/section.png"):
        assert (cad / name).stat().st_size > 10_000
    for name in ("bom.csv", "assembly.md", "springs/spring.csv", "springs/spring.pdf"):
        assert (cad / name).stat().st_size > 500
