"""A study in Python: read from text and paths, changed by copies, refused with the call that made it wrong."""

import pytest
from support import ROOT, study_path

import tvimdesign as tvim

FILE = study_path("paper_shear")


def test_studies_are_files_by_path_or_shipped_name():
    from tvimdesign.study import read_study

    assert read_study(str(FILE)) == read_study(FILE) == tvim.load(str(FILE)).resolved == tvim.load(FILE).resolved
    assert tvim.example("finger").resolved == tvim.load(study_path("finger")).resolved
    with pytest.raises(tvim.InputError, match="did you mean 'finger'"):
        tvim.example("fingr")
    with pytest.raises(tvim.InputError, match="no such file"):
        tvim.load("nowhere.yaml")
    with pytest.raises(tvim.InputError, match="no such file"):
        tvim.read_design("nowhere.json")


def test_a_study_written_in_python_is_the_same_as_in_yaml():
    written = tvim.Study(
        name="A joint",
        mode="shear",
        module={"current": (1.5, "A"), "motor": "none"},
        vary={
            "wire_diameter": (1.2, 3, "mm"),
            "coil_count": [3, 8],
            "spring_material": {"choose": ["music_wire", "stainless_302"]},
        },
        require={"spring_stiffness": [">= 4 N.m/rad", "<= 6 N.m/rad"], "joint_damping@hot": ">= 0.5 N.m.s/rad"},
        minimize={"module_mass": 1, "response_time": 2},
        operating_points={"warm": {"temperature": tvim.Quantity(60.0, "degC"), "frequency": "2 Hz"}},
        solver={"starts": 2},
        write={"cad": False},
    )
    assert written.resolved == tvim.load(ROOT / "tests/studies/texts/study_of_python.yaml").resolved


def test_all_mistakes_of_a_study_in_python_are_reported_at_once():
    with pytest.raises(tvim.StudyError) as caught:
        tvim.Study(mode="shear", module={"curent": "1 A", "coil_count": "3,25"}, require={"module_mass": "<= 3 m"})
    paths = [problem.path for problem in caught.value.problems]
    assert paths == ["module.curent", "module.coil_count", "require.module_mass"]
    assert str(caught.value).startswith("Study(...): module.curent: no such input")


def test_copies_are_changed_by_paths_and_the_study_is_not(study):
    before = study.resolved
    fixed = study.set(pcl_thickness="1.2 mm").resolved
    assert fixed.module["pcl_thickness"] == pytest.approx(1.2e-3)
    assert set(before.vary) - set(fixed.vary) == {"pcl_thickness"}
    wider = study.vary(pcl_thickness=["0.5 mm", "3 mm"]).resolved.vary["pcl_thickness"].model_dump()
    assert (wider["lower"], wider["upper"]) == (pytest.approx(5e-4), pytest.approx(3e-3))
    stronger = study.require(holding_torque=">= 15 N.m").resolved.require
    assert [limit.limit for limit in stronger if limit.output == "holding_torque"] == [15.0]
    assert len(stronger) == len(before.require)
    assert study.minimize("module_mass").resolved.minimize == {"module_mass": 1.0}
    assert study.minimize(module_mass=1, cycle_time=3).resolved.minimize == {"module_mass": 1.0, "cycle_time": 3.0}
    assert study.resolved == before
    assert "current" not in study.vary(current=None).resolved.vary
    assert "holding_torque" not in {limit.output for limit in study.require(holding_torque=None).resolved.require}
    assert "stroke" not in study.set(stroke=None).resolved.module
    changed = study.set({"operating_points.hot.temperature": "90 degC", "solver.starts": 1}).resolved
    assert changed.operating_points["hot"]["temperature"] == pytest.approx(363.15)
    assert changed.solver.starts == 1
    with pytest.raises(tvim.StudyError) as caught:
        study.set(pcl_thickness="1,2 mm").check()
    assert str(caught.value).startswith("study.set(pcl_thickness='1,2 mm'): module.pcl_thickness: '1,2 mm': a decimal")


def test_a_copy_may_be_incomplete_until_it_is_used():
    study = tvim.Study(mode="shear").vary(coil_count=[3, 8])
    with pytest.raises(tvim.StudyError, match="`minimize` is missing"):
        study.check()
    assert study.minimize("module_mass").resolved.task == "optimize"


@pytest.mark.gate
def test_check_refuses_what_bounds_prove_impossible(study):
    (advice,) = study.check()  # its start is beyond a rating that its optimum keeps
    assert "stiffening_structure_margin" in advice
    assert study.accept("structure_temperature_margin", "stiffening_structure_margin").check() == []
    with pytest.raises(tvim.InfeasibleError, match="spring_stiffness"):
        study.require(spring_stiffness=">= 5000 N.m/rad").check()


def test_a_study_is_kept_as_a_file(study, tmp_path):
    changed = study.set(pcl_thickness="1.2 mm").require(module_mass="<= 200 g")
    again = tvim.load(changed.save(tmp_path / "changed.yaml"))
    assert again.resolved.model_dump(exclude={"name"}) == changed.resolved.model_dump(exclude={"name"})
    assert "# study.require(module_mass='<= 200 g')" in changed.text


def test_the_user_s_records_are_found(tmp_path):
    shipped = (ROOT / "tvimdesign/catalog/data/structure_materials/petg.yaml").read_text()
    (tmp_path / "mine/structure_materials").mkdir(parents=True)
    (tmp_path / "mine/structure_materials/dense.yaml").write_text(shipped.replace("value: 1270", "value: 1280"))
    study = tvim.Study(mode="shear", module={"structure_material": "dense"}, catalog="mine", folder=tmp_path)
    assert study.evaluate(progress=False)["structure_density"].magnitude == pytest.approx(1280.0)


def test_a_notebook_shows_what_the_study_says(study):
    shown = study.set(name="<b>bold</b>")._repr_html_()
    assert "&lt;b&gt;bold" in shown
    assert "<b>bold" not in shown
    assert "vary.pcl_thickness" in shown
    assert "0.6 mm to 2 mm" in shown
    assert "&gt;= 12 N.m" in shown
    assert "optimises 13 variables" in repr(study)


def test_ratings_are_accepted_by_name():
    study = tvim.Study(mode="shear", accept=["structure_temperature_margin"])
    assert study.resolved.accept == ("structure_temperature_margin",)
    assert study.accept("current_margin", "pcl_temperature_margin").resolved.accept == (
        "current_margin", "pcl_temperature_margin",
    )  # fmt: skip
    assert study.accept().resolved.accept == ()
    with pytest.raises(tvim.StudyError, match="structure_temperature_margin"):
        _ = study.accept("structure_temperature").resolved
