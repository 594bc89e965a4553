"""Recordings of equations in the user's cache."""

import re
from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from support import study_path

from tvimdesign.device import table_for
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle import recordings
from tvimdesign.simulation.working_cycle.device_functions import STRUCTURES, DeviceFunctions, resolve_study
from tvimdesign.simulation.working_cycle.recordings import Recordings
from tvimdesign.study import given, read_study

COUNTED = ("holding_torque", "joint_stiffness@hot", "module_mass", "envelope_diameter")


@pytest.fixture
def tapes():
    x = ca.SX.sym("x", 3)
    value = x[0]
    for k in range(200):
        value = ca.sin(value * x[1 + k % 2]) + 0.1 * k
    return lambda: [Tape.of([x], [value, x[1] * value]), *Tape.parted([x[:2], x[2:]], [value])]


@pytest.fixture
def _cache(monkeypatch, tmp_path):
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "cache"))


@pytest.mark.usefixtures("_cache")
def test_stored_tapes_compute_to_the_bit_what_recorded_ones_do(tapes):
    recorded, written = tapes(), Recordings("a").tapes("all", 3, tapes)
    stored = Recordings("a").tapes("all", 3, lambda: pytest.fail("recorded twice"))
    for three in zip(recorded, written, stored, strict=True):
        at = np.linspace(0.3, 0.9, int(three[0].arguments[-1]))
        values = [[part.tolist() for part in tape.values(at)] for tape in three]
        assert values[0] == values[1] == values[2]


@pytest.mark.usefixtures("_cache")
def test_another_structure_name_or_code_has_records_of_its_own(tapes, monkeypatch):
    Recordings("a").tapes("all", 3, tapes)
    with pytest.raises(RuntimeError):
        Recordings("b").tapes("all", 3, _recorded)
    with pytest.raises(RuntimeError):
        Recordings("a").tapes("some", 3, _recorded)
    monkeypatch.setattr(recordings, "_code", lambda: "other equations")
    with pytest.raises(RuntimeError):
        Recordings("a").tapes("all", 3, _recorded)


@pytest.mark.usefixtures("_cache")
def test_equations_that_are_not_the_package_s_are_not_stored():
    model = resolve_study(read_study(study_path("paper_shear"))).functions
    own = DeviceFunctions(replace(model.table), {**model.words, **dict(zip(model.names, model.start, strict=True))},
                          model.points, model.cells)  # fmt: skip
    own.recordings(COUNTED).arrays("name", lambda: [np.zeros(1)])
    with pytest.raises(RuntimeError):
        own.recordings(COUNTED).arrays("name", _recorded)


@pytest.mark.parametrize("name", ["paper_shear", "paper_compression"])
def test_what_has_one_name_has_one_record(name, monkeypatch):
    """Devices with another record or option each: those whose recordings share a name have the same tape."""
    monkeypatch.setenv("TVIMDESIGN_CACHE", "")
    study = read_study(study_path(name))
    table, known = table_for(study.mode), given(study)
    seen: dict[str, list[list[list[float]]]] = {}
    others = [(row.name, option) for row in table.choices for option in row.options if option != known[row.name]]
    for choice, option in [("", ""), *others]:
        STRUCTURES.forget()
        changed = {**known, choice: option} if choice else known
        model = DeviceFunctions(table, changed, tuple(study.operating_points), study.solver.cells)
        arrays = Tape.of_function(model.outputs(COUNTED)).arrays()
        seen.setdefault(model.recordings(COUNTED)._structure, []).append([array.tolist() for array in arrays])
    assert len(seen) > 2
    assert all(tape == alike[0] for alike in seen.values() for tape in alike)
    assert any(len(alike) > 1 for alike in seen.values())


def test_code_that_records_or_writes_symbols_is_part_of_the_name():
    package = Path(recordings.__file__).parents[2]
    writing = {
        path.relative_to(package).as_posix()
        for path in package.rglob("*.py")
        if re.search(r"\.recordings\(|def _symbols\(self\)", path.read_text(encoding="utf-8"))
    }
    assert writing >= {"solve/nlp/mixture.py", "solve/batch/batch_model.py"}
    assert all(path.startswith(recordings.WRITERS) for path in writing)


def _recorded():
    raise RuntimeError("recorded")
