"""The command line: answers at once, says what is wrong, exits with the right code."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from cad_designs import shipped_design
from support import ROOT, cases_of, wait_until

from tvimdesign.base.processes import communicate
from tvimdesign.cli.options import default_folder, name_of
from tvimdesign.simulation.virtual_tests import TESTS
from tvimdesign.study.design import design_json

HEAVY = ("casadi", "cadquery", "OCP", "pandas", "matplotlib", "scipy", "numpy", "pint")


def test_help_loads_no_heavy_library():
    code = f"""
import sys
sys.argv = ["tvimdesign", "--help"]
from tvimdesign.cli.main import main
try:
    main()
except SystemExit as ended:
    assert ended.code == 0, ended.code
found = sorted(set({HEAVY!r}) & set(sys.modules))
assert not found, found
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == 0, done.stderr
    assert "Commands:" in done.stdout


LIGHT = """
import sys
def light(code, *heavy):
    exec(code)
    assert not set(heavy) & set(sys.modules), (code, set(heavy) & set(sys.modules))
light("import tvimdesign.base.units, tvimdesign.catalog", "pint")
light("import tvimdesign.study", "casadi", "cadquery", "OCP", "pandas", "matplotlib", "scipy")
light("import tvimdesign.cad", "cadquery", "OCP", "vtk", "trimesh")
light("import tvimdesign.cli.commands", "casadi", "scipy")
light("from tvimdesign.report.run import first_screen, front_report, run_study", "matplotlib")
light("from tvimdesign.solve import result, search", "matplotlib", "scipy.stats")
light("from tvimdesign.solve.optimizer.multistart import unit_points; next(unit_points(16, 3, 1))", "scipy.stats")
"""
"""Each import loads none of the libraries behind it, nor have the ones before it."""


def test_imports_leave_libraries_to_those_who_need_them():
    done = subprocess.run([sys.executable, "-c", LIGHT], capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == 0, done.stderr


SHUTDOWN = """
atexit.register(os.kill, os.getpid(), signal.SIGINT)
atexit.register(os.kill, os.getpid(), signal.SIGTERM)
main._command = lambda: 3
"""
IN_A_STRING = """
main._command = lambda: exec("import os, signal; os.kill(os.getpid(), signal.SIGTERM)")
"""


@pytest.mark.parametrize(
    ("text", "code", "message"), [(SHUTDOWN, 3, ""), (IN_A_STRING, 128 + signal.SIGTERM, "interrupted; ")]
)
def test_an_interrupt_at_shutdown_or_in_a_string_ends_with_its_code(tmp_path, text, code, message):
    (tmp_path / "ends.py").write_text(f"import atexit, os, signal\nfrom tvimdesign.cli import main\n{text}main.main()")
    around = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(tmp_path)])}
    done = subprocess.run([sys.executable, "-m", "ends"], env=around, capture_output=True, text=True, check=False)
    assert done.returncode == code
    assert done.stderr.startswith(message)
    assert bool(done.stderr) == bool(message)


@pytest.mark.parametrize(
    "command",
    [[], ["run"], ["check"], ["new"], ["cad"], ["simulate"], ["compare"], ["paper-check"], ["rows"]],
    ids=lambda words: " ".join(words) or "tvimdesign",
)
def test_every_command_explains_itself(tvimdesign, command):
    done = tvimdesign(*command, "--help")
    assert done.returncode == 0
    assert "Usage:" in done.stdout
    assert "..." not in done.stdout.partition("Commands:")[2]  # no summary of a command is cut


@pytest.mark.gate
def test_a_new_study_is_valid_and_never_replaces_a_file(tvimdesign, tmp_path):
    file = tmp_path / "mine.yaml"
    assert tvimdesign("new", file).returncode == 0
    written = file.read_text()
    checked = tvimdesign("check", file)
    assert checked.returncode == 0, checked.stderr
    assert "valid" in checked.stdout
    again = tvimdesign("new", file)
    assert again.returncode == 2
    assert "exists already" in again.stderr
    assert file.read_text() == written


@pytest.mark.gate
def test_the_new_study_ends_with_a_module_to_build(process, tmp_path):
    file = tmp_path / "mine.yaml"
    process("new", file)
    done = process("run", file, "--no-cad", "--no-plots", "--out", tmp_path / "out", spread="on")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("Build it; 75 % of plausible cases are asked of each limit alone · ")


@cases_of("cli", "bad_input")
def test_bad_input_is_a_message_and_exit_code_2(tvimdesign, arguments, words):
    done = tvimdesign(*arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr


def test_a_process_says_and_ends_with_what_the_command_does(tvimdesign, process):
    done, here = process("check", "README.md"), tvimdesign("check", "README.md")
    assert (done.returncode, done.stdout, done.stderr) == (here.returncode, here.stdout, here.stderr)
    assert done.returncode == 2


def test_a_module_that_cannot_be_is_refused_by_check_and_run(tvimdesign, tmp_path):
    file = tmp_path / "inside_out.yaml"
    file.write_text("mode: shear\nmodule: {pcl_inner_radius: 35 mm, pcl_outer_radius: 28 mm}\n")
    for command in (["check", file], ["run", file, "--out", tmp_path / "out"]):
        done = tvimdesign(*command)
        assert done.returncode == 2
        assert "arc_width is -7 mm" in done.stderr


def test_errors_are_json_too_where_scripts_ask(tvimdesign, tmp_path):
    file = tmp_path / "wrong.yaml"
    file.write_text("mode: shear\nmodule:\n  coil_count: 3,25\n")
    done = tvimdesign("check", file, "--json")
    assert done.returncode == 2
    problem = json.loads(done.stdout)["problems"][0]
    assert (problem["line"], problem["path"]) == (3, "module.coil_count")


def test_a_requirement_nothing_can_change_is_named_with_what_could(tvimdesign, tmp_path):
    file = tmp_path / "small.yaml"
    file.write_text(
        "mode: shear\nvary: {current: [0.5 A, 2 A]}\n"
        'require: {envelope_diameter: "<= 100 mm"}\nminimize: response_time\n'
    )
    done = tvimdesign("run", file, "--no-cad", "--out", tmp_path / "out")
    assert done.returncode == 3
    assert "envelope_diameter <= 100 mm" in done.stderr
    assert "placement_radius" in done.stderr


def test_a_switch_that_never_ends_is_reported(tvimdesign, tmp_path):
    file = tmp_path / "weak.yaml"
    file.write_text("mode: shear\nmodule: {current: 0.2 A}\n")
    done = tvimdesign("run", file, "--no-cad", "--no-plots", "--out", tmp_path / "out")
    assert done.stdout.startswith("Do not build it: it never gets soft")
    assert "Warning: the switch never ends" in done.stdout
    assert "Times: never soft" in done.stdout
    assert json.loads((tmp_path / "out/results.json").read_text())["values"]["response_time"]["value"] is None


@pytest.mark.gate
def test_a_module_that_never_stiffens_is_reported_with_a_whole_folder(tvimdesign, tmp_path):
    # In free air an ampere heats the module more than it cools the layer.
    study = tmp_path / "study.yaml"
    study.write_text("mode: shear\nmodule: {cooling_current: 1 A}\n")
    done = tvimdesign("run", study, "--no-cad", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert "never stiff again" in done.stdout
    summary = (tmp_path / "out/summary.txt").read_text()
    assert re.search(r"stiffening_time\W+never", summary)
    assert re.search(r"cycle_time\W+never", summary)
    # As without that current: 227 s, which the slow tests hold against another integration.
    assert re.search(r"response_time\W+22\d", summary)
    reported = json.loads((tmp_path / "out/results.json").read_text())["values"]
    assert reported["stiffening_time"]["value"] is None
    assert reported["response_time"]["value"] > 0.0
    assert (tmp_path / "out/stiffening.csv").stat().st_size > 1000


@pytest.mark.gate
@pytest.mark.parametrize(
    ("number", "after"),
    [(signal.SIGINT, 0.5), (signal.SIGTERM, 0.5), pytest.param(signal.SIGINT, 1.0, marks=pytest.mark.slow)],
)
def test_an_interrupt_ends_with_its_code_and_a_reusable_folder(tvimdesign, tmp_path, number, after):
    out = tmp_path / "out"
    process = subprocess.Popen(
        [sys.executable, "-m", "tvimdesign", "run", "studies/wrist_joint.yaml", "--out", str(out)], cwd=ROOT,
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    assert wait_until((out / "unfinished/.run.json").exists)
    time.sleep(after)
    os.killpg(process.pid, number)
    _, message = communicate(process)
    assert process.returncode == 128 + number, message
    assert "interrupted" in message
    assert "Traceback" not in message
    assert json.loads((out / "manifest.json").read_text())["status"] == "interrupted"
    again = tvimdesign("run", "studies/paper_reconstructed.yaml", "--no-cad", "--no-plots", "--out", out, "--overwrite")
    assert again.returncode == 0, again.stderr


def test_cad_refuses_what_is_no_design(tvimdesign, process, tmp_path):
    os.mkfifo(tmp_path / "pipe.json")
    (tmp_path / "zero.json").symlink_to("/dev/zero")
    (tmp_path / "folder.json").mkdir()
    (tmp_path / "text.json").write_text("not JSON")
    released = design_json(shipped_design("paper_reconstructed")).decode()
    (tmp_path / "mode.json").write_text(released.replace('"mode": "shear"', '"mode": "bending"'))
    (tmp_path / "huge.json").write_text(released.replace('"wire_diameter": 0.00', '"wire_diameter": 1.00', 1))
    for name in ("pipe", "zero", "folder", "text", "mode", "huge"):
        words = ("cad", tmp_path / f"{name}.json", "--out", tmp_path / f"{name}_out")
        # Who reads these two never comes to an end.
        done = process(*words, limit=20.0) if name in {"pipe", "zero"} else tvimdesign(*words)
        assert done.returncode == 2, (name, done.stderr)
        assert "Traceback" not in done.stderr


def test_version_and_rows_are_those_of_the_package(tvimdesign):
    import tvimdesign as package

    assert tvimdesign("--version").stdout.strip() == package.__version__
    rows = json.loads(tvimdesign("rows", "--json").stdout)
    names = {row["name"] for row in rows}
    assert {"wire_diameter", "spring_material", "joint_stiffness@point", "response_time"} <= names
    assert all(row["description"] for row in rows)
    (wall,) = (row for row in rows if row["name"] == "motor_wall")
    assert wall["description"].endswith("of no effect while motor is none")
    blocks = {row["name"] for row in json.loads(tvimdesign("rows", "--mode", "compression", "--json").stdout)}
    assert {"block_depth", "vane_count", "joint_stiffness@point", "response_time"} <= blocks
    assert "pcl_thickness" not in blocks


def test_simulate_without_a_test_lists_the_tests_with_what_they_show(tvimdesign):
    done = tvimdesign("simulate", "studies/finger.yaml")
    assert done.returncode == 2  # nothing was tested: a script must not take it for done
    lines = {line.split()[0]: line.split()[1:] for line in done.stderr.splitlines() if line.startswith("  ")}
    assert lines.keys() == TESTS.keys()
    assert all(len(words) > 5 for words in lines.values())
    assert "--test release" in done.stderr
    assert not Path("results/finger-").exists()


@cases_of("cli", "folders")
def test_every_design_has_a_folder_of_its_own(design, parts, test):
    assert default_folder(Path(design)) == Path(parts).resolve()
    assert name_of(Path(design)) == test


def test_a_study_or_a_run_gives_its_name(tmp_path):
    assert default_folder(Path("studies/elbow.yaml")) == Path("results/elbow")
    assert (name_of(Path("studies/elbow.yaml")), name_of(tmp_path)) == ("elbow", tmp_path.name)
