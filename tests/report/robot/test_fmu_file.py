"""The FMU's file: a description that FMPy finds no fault in, sources, and what is said without a compiler."""

import os
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path
from threading import Thread

import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from robot_models import module_of
from support import ROOT, are_gone

from tvimdesign.base.errors import InputError
from tvimdesign.robot.fmu_file import compiled, write_fmu


@pytest.fixture(scope="module")
def without_compiler(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("CC", "no-such-compiler")
        written = write_fmu(module_of("shear"), tmp_path_factory.mktemp("fmu") / "joint.fmu")
    assert written.platform == ""
    assert "no C compiler was found (cc, gcc, clang, or the one that CC names)" in written.summary
    return written.path


def test_the_description_is_without_fault_and_all_sources_are_there(without_compiler: Path) -> None:
    assert validate_fmu(str(without_compiler)) == []
    (build,) = read_model_description(str(without_compiler)).buildConfigurations
    with zipfile.ZipFile(without_compiler) as archive:
        names = archive.namelist()
    assert {f"sources/{name}" for part in build.sourceFileSets for name in part.sourceFiles} <= set(names)
    assert not [name for name in names if name.startswith("binaries")]


def test_current_and_angle_go_in_and_torque_and_temperatures_come_out(without_compiler: Path) -> None:
    description = read_model_description(str(without_compiler))
    found = {variable.name: variable for variable in description.modelVariables}
    inputs = {name for name, variable in found.items() if variable.causality == "input"}
    assert inputs == {"current", "angle", "ambient_temperature"}
    assert {found[name].causality for name in ("torque", "temperature_far_face", "frozen")} == {"output"}
    cells = module_of("shear").study.solver.cells
    assert f"temperature_cell_{cells}" in found
    assert f"temperature_cell_{cells + 1}" not in found
    resolved = module_of("shear")
    assert float(found["stroke"].start) == pytest.approx(float(resolved.quantity("stroke")))
    assert float(found["ambient_temperature"].start) == pytest.approx(float(resolved.quantity("ambient_temperature")))


def test_a_compiler_that_fails_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", f"{sys.executable} -c 'import sys; sys.exit(\"no room\")'")
    with pytest.raises(InputError, match="cannot build the FMU"):
        compiled({"one.c": ""}, ".so", tmp_path)


COMPILER = """
import os, subprocess, sys, tempfile, time
own = tempfile.mkstemp()[1]
worker = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
open(os.environ["TOLD"] + ".part", "w").write(f"{worker.pid} {own}")
os.rename(os.environ["TOLD"] + ".part", os.environ["TOLD"])
time.sleep(600)
"""


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="Windows has no process groups, by which these end")
def test_an_interrupt_ends_the_compiler_s_processes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    told = tmp_path / "told"
    (tmp_path / "cc.py").write_text(COMPILER)
    monkeypatch.setenv("CC", f"{sys.executable} {tmp_path / 'cc.py'}")
    monkeypatch.setenv("TOLD", str(told))
    (tmp_path / "beside").mkdir()

    def interrupt() -> None:
        while not told.exists():
            time.sleep(0.02)
        os.kill(os.getpid(), signal.SIGINT)

    Thread(target=interrupt, daemon=True).start()
    with pytest.raises(KeyboardInterrupt):
        compiled({"one.c": ""}, ".so", tmp_path / "beside")
    number, own = told.read_text().split()
    assert are_gone([int(number)])
    assert Path(own).parent == tmp_path / "beside"


KILLED = """
import sys
from pathlib import Path
from tvimdesign.robot.fmu_file import compiled
compiled({"one.c": ""}, ".so", Path(sys.argv[1]))
"""


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="Windows has no process groups, by which these end")
def test_all_that_a_compiler_started_ends_with_a_command_that_is_killed(tmp_path: Path) -> None:
    told = tmp_path / "told"
    (tmp_path / "cc.py").write_text(COMPILER)
    own = {"CC": f"{sys.executable} {tmp_path / 'cc.py'}", "TOLD": str(told), "PYTHONPATH": str(ROOT)}
    with subprocess.Popen([sys.executable, "-c", KILLED, str(tmp_path)], env={**os.environ, **own}) as parent:
        while not told.exists() and parent.poll() is None:
            time.sleep(0.02)
        parent.kill()
    number = int(told.read_text().split()[0])
    assert are_gone([number])
