"""Helpers of the command line, and what it says of faults."""

import json
import resource
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from cad_designs import shipped_design
from support import ROOT, STUDIES, environment, run_process, study_path

from tvimdesign.cli import options
from tvimdesign.study import read_study
from tvimdesign.study.design import write_design
from tvimdesign.study.written_studies import examples

WRONG = ("--set", "pcl_thickness=1,2 mm", "--set", "require.holding_torque=15 N.m")


@pytest.mark.parametrize(
    "command",
    [["run"], ["check"], ["simulate", "--test", "creep"], ["compare", "studies/wrist_compression.yaml"]],
    ids=lambda words: " ".join(words[:2]),
)
def test_commands_that_read_a_study_take_settings_and_name_their_place(tvimdesign, command, tmp_path):
    out = [] if command[0] == "check" else ["--out", tmp_path / "out"]
    done = tvimdesign(*command, "studies/wrist_joint.yaml", *WRONG, *out)
    assert done.returncode == 2
    assert "--set pcl_thickness=1,2 mm: module.pcl_thickness: '1,2 mm': a decimal comma" in done.stderr
    assert "--set require.holding_torque=15 N.m: require.holding_torque: " in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.gate
def test_a_setting_changes_the_run_and_the_study_that_is_kept(tvimdesign, tmp_path):
    study, out = "studies/paper_reconstructed.yaml", tmp_path / "out"
    done = tvimdesign("run", study, "--set", "wire_diameter=2 mm", "--no-cad", "--no-plots", "--json", "--out", out)
    assert done.returncode == 0, done.stderr
    wire = json.loads(done.stdout)["values"]["wire_diameter"]
    assert (wire["value"], wire["unit"]) == (2.0, "mm")
    study_file = tmp_path / "out/study.yaml"
    assert "# --set wire_diameter=2 mm" in study_file.read_text()
    assert read_study(study_file).module["wire_diameter"] == pytest.approx(2e-3)


@pytest.mark.gate
def test_a_study_that_is_not_changed_is_kept_as_it_was_written(tvimdesign, tmp_path):
    source = study_path("paper_reconstructed")
    assert tvimdesign("run", source, "--no-cad", "--no-plots", "--out", tmp_path / "out").returncode == 0
    assert (tmp_path / "out/study.yaml").read_bytes() == source.read_bytes()


@pytest.mark.slow
def test_a_setting_changes_what_is_tested(tvimdesign, tmp_path):
    def tested(name, *settings):
        done = tvimdesign("simulate", "studies/paper_reconstructed.yaml", "--test", "step", *settings, "--json",
                          "--out", tmp_path / name)  # fmt: skip
        assert done.returncode == 0, done.stderr
        return [finding["value"] for finding in json.loads(done.stdout)["findings"] if "value" in finding]

    assert tested("as it is") != tested("thicker", "--set", "pcl_thickness=2 mm")
    assert "# --set pcl_thickness=2 mm" in (tmp_path / "thicker/tested.yaml").read_text()


def test_a_design_takes_no_settings(tvimdesign, tmp_path):
    design = write_design(shipped_design("paper_reconstructed"), tmp_path / "design.json")
    done = tvimdesign("simulate", design, "--test", "creep", "--set", "current=1 A", "--out", tmp_path / "out")
    assert done.returncode == 2
    assert f"--set current=1 A: {design} is a design, which is finished" in done.stderr


@pytest.mark.slow
def test_settings_reach_every_study_of_a_comparison(tvimdesign, tmp_path):
    pair = ("studies/wrist_joint.yaml", "studies/wrist_compression.yaml")
    settings = ("--set", "moving_inertia=50 kg.mm^2", "--set", "solver.starts=1")
    done = tvimdesign("compare", *pair, "--points", "0", "--no-plots", *settings, "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    for mode in ("shear", "compression"):
        design = json.loads((tmp_path / f"out/{mode}/drawn.json").read_text())
        assert design["values"]["moving_inertia"] == pytest.approx(50e-6)
        assert read_study(tmp_path / f"out/{mode}/study.yaml").module["moving_inertia"] == pytest.approx(50e-6)


# --- shipped studies ---


def test_shipped_studies_are_listed_and_copied_once(tvimdesign, tmp_path):
    lines = tvimdesign("new", "--list").stdout.splitlines()
    assert lines[::2] == [study.stem for study in STUDIES]
    assert all(line.startswith("    ") and len(line.split()) > 5 for line in lines[1::2])
    assert tvimdesign("new", "--example", "wrist_joint", cwd=tmp_path).returncode == 0
    # But for where an editor finds the schema: beside the copy.
    shipped = study_path("wrist_joint").read_bytes().replace(b"=../study.schema.json", b"=study.schema.json")
    assert (tmp_path / "wrist_joint.yaml").read_bytes() == shipped
    assert tvimdesign("new", "mine.yaml", "--example", "finger", cwd=tmp_path).returncode == 0
    assert read_study(tmp_path / "mine.yaml").mode == "shear"
    assert "exists already" in tvimdesign("new", "--example", "wrist_joint", cwd=tmp_path).stderr
    assert "did you mean 'wrist_joint'" in tvimdesign("new", "--example", "wrist_joit", cwd=tmp_path).stderr


# --- completion ---


OFFERED = yaml.safe_load((ROOT / "tests/cases/completions.yaml").read_text(encoding="utf-8"))
"""What a shell offers, among others, for the last of some words."""
COMPLETES = """
import contextlib, io, json, os, sys
from tvimdesign.cli.main import main

sys.argv[0] = "tvimdesign"
offered = {}
for words in json.loads(sys.stdin.read()):
    for shell, asks in {"bash": {"COMP_WORDS": words, "COMP_CWORD": str(len(words.split(" ")) - 1)},
                        "zsh": {"_TYPER_COMPLETE_ARGS": words}}.items():
        os.environ.update(asks, _TVIMDESIGN_COMPLETE=f"complete_{shell}")
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.suppress(SystemExit):
            main()
        offered.setdefault(words, []).append(out.getvalue())
print(json.dumps(offered))
"""


def test_tab_completes():
    done = subprocess.run([sys.executable, "-c", COMPLETES], input=json.dumps([*OFFERED]), cwd=ROOT, check=False,
                          capture_output=True, text=True)  # fmt: skip
    assert done.returncode == 0, done.stderr
    for words, (bash, zsh) in json.loads(done.stdout).items():
        assert OFFERED[words] in bash.split("\n"), words
        assert OFFERED[words] in zsh, words


def test_help_names_the_completion_options(tvimdesign):
    shown = tvimdesign("--help").stdout
    assert "--install-completion" in shown
    assert "--show-completion" in shown


def test_files_are_those_a_command_reads(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("a.yaml", "b.yml", "c.txt", "d.json", ".hidden.yaml"):
        (tmp_path / name).touch()
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder/e.yaml").touch()
    assert options.study_files("") == ["a.yaml", "b.yml", "folder/"]
    assert options.designs_and_studies("") == ["a.yaml", "b.yml", "d.json", "folder/"]
    assert options.study_files("folder/") == ["folder/e.yaml"]
    assert options.study_files("./a") == ["./a.yaml"]
    assert options.study_files("nowhere/x") == []
    assert options.settings("require.holding_t") == ["require.holding_torque="]
    assert options.examples("") == list(examples())


NASTY = "name: '[/bold] [red] N·m 名 :key:'\nmode: shear\n"


def run(*words: object, **more: str) -> subprocess.CompletedProcess[bytes]:
    """Run the command in a process of its own, with more in its environment."""
    command = [sys.executable, "-m", "tvimdesign", *map(str, words)]
    return run_process(command, env={**environment(), **more})


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_a_terminal_that_lacks_letters_gets_plain_ones(encoding):
    done = run("rows", "stiff_threshold", PYTHONIOENCODING=encoding)
    assert done.returncode == 0, done.stderr
    assert ("N.m/rad" if encoding == "ascii" else "N·m/rad") in done.stdout.decode(encoding)


@pytest.mark.slow
def test_a_study_whose_name_looks_like_markup_runs_on_any_terminal(tmp_path):
    (tmp_path / "nasty.yaml").write_text(NASTY, encoding="utf-8")
    words = ["--no-cad", "--no-plots", "--out", tmp_path / "[/bold]"]
    done = run("run", tmp_path / "nasty.yaml", *words, PYTHONIOENCODING="ascii", TVIMDESIGN_SPREAD="")
    assert done.returncode == 0, done.stderr
    assert b"[/bold] [red] N.m ? :key: (shear)" in done.stdout
    summary = (tmp_path / "[/bold]/summary.txt").read_text(encoding="utf-8")
    assert "Manufacturing: " in summary  # the child read those letters


@pytest.mark.parametrize(("words", "unbuffered"), [(["rows"], ""), (["--help"], "1")])
def test_output_that_cannot_be_written_is_one_line(words, unbuffered):
    around = {**environment(), "PYTHONUNBUFFERED": unbuffered}
    with Path("/dev/full").open("wb") as full:
        command = [sys.executable, "-m", "tvimdesign", *words]
        done = run_process(command, stdout=full, env=around)
    assert done.returncode == 4
    assert b"No space left on device" in done.stderr
    assert done.stderr.count(b"\n") == 1


@pytest.mark.gate
def test_a_file_that_cannot_be_written_is_named_and_the_others_are_kept(tmp_path):
    out = tmp_path / "out"
    done = run_process(
        [sys.executable, "-m", "tvimdesign", "run", "studies/paper_reconstructed.yaml", "--no-cad", "--no-plots",
         "--out", str(out)],
        text=True, cwd=ROOT, env=environment(),
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000)),
    )  # fmt: skip
    assert done.returncode == 4
    assert done.stderr.splitlines()[-1].startswith(f"{out}/unfinished/results.json: cannot be written: File too large;")
    assert "Traceback" not in done.stderr
    assert json.loads((out / "study.resolved.json").read_text())["mode"] == "shear"
    assert json.loads((out / "manifest.json").read_text())["status"] == "failed"
    assert not list(out.rglob(".*"))
