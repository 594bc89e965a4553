"""Installs a wheel in empty environments and does with it what a newcomer does: light, and with each extra alone.

`python release/check_wheel.py dist/tvimdesign-*.whl --extras none cad` makes an environment for each, answers the study
of the README's first command outside the repository, and does what the extra is for. Ends with the first that fails.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

STUDY = "elbow_printed"
"""Of the README's first command."""
FE_STUDY = "paper_reconstructed"
"""Evaluated only: solving its parts takes the time."""
SWEEP = "\nsweep:\n  task: evaluate\n  over:\n    current: {from: 1.5 A, to: 2 A, count: 4}\n"
LIGHT, VALIDATION = "none", "validation"
"""Environments without an extra: what a newcomer does first, and the cases of the validation."""
ROOT = Path(__file__).resolve().parents[1]


class Environment:
    """A virtual environment that has the wheel, and an empty folder to work in."""

    def __init__(self, place: Path, wheel: Path, extra: str, python: str, constraints: Path | None) -> None:
        """Make and fill it, with the versions that the file of `constraints` names."""
        self.folder, self.bin = place / "work", place / "venv" / ("Scripts" if os.name == "nt" else "bin")
        self.folder.mkdir(parents=True)
        subprocess.run([python, "-m", "venv", str(place / "venv")], check=True)
        requirement = str(wheel.resolve()) + ("" if extra in (LIGHT, VALIDATION) else f"[{extra}]")
        pip = [str(self.bin / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        held = ["-c", str(constraints.resolve())] if constraints else []
        subprocess.run([*pip, *held, requirement], check=True)

    def run(self, program: str, *words: str, fails: bool = False) -> str:
        """Output of one of its programs, standard error included; an end that is not expected ends all."""
        environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
        done = subprocess.run(
            [str(self.bin / program), *words], cwd=self.folder, capture_output=True, text=True, check=False,
            env={**environment, "COLUMNS": "200"},
        )  # fmt: skip
        if (done.returncode != 0) != fails:
            sys.exit(f"{program} {' '.join(words)}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def tell(self, text: str, expected: str) -> None:
        """End all where a text does not have what is expected of it."""
        if expected not in text:
            sys.exit(f"expected {expected!r} in:\n{text}")

    def has(self, *names: str) -> None:
        """End all where a file is not there."""
        missing = [name for name in names if not (self.folder / name).exists()]
        if missing:
            sys.exit(f"not written: {', '.join(missing)}")

    def megabytes(self) -> float:
        """Size of all that is installed."""
        files = (self.bin.parent / "lib").rglob("*")
        return sum(file.stat().st_size for file in files if file.is_file() and not file.is_symlink()) / 1e6


def light(env: Environment) -> None:
    """Run the first command without CAD: it says so in a line, and does all else."""
    env.tell(env.run("tvimdesign", "new", "--example", STUDY), "written; next")
    result = env.run("tvimdesign", "run", f"{STUDY}.yaml")
    env.tell(result, "No parts: cadquery is not installed: pip install 'tvimdesign[cad]'")
    env.has(f"results/{STUDY}/report.html", f"results/{STUDY}/plots", f"results/{STUDY}/design.json")
    refused = env.run("tvimdesign", "cad", f"results/{STUDY}/design.json", fails=True)
    env.tell(refused, "pip install 'tvimdesign[cad]'")


def cad(env: Environment) -> None:
    """Run the first command whole, parts included."""
    env.run("tvimdesign", "new", "--example", STUDY)
    env.run("tvimdesign", "run", f"{STUDY}.yaml")
    env.has(f"results/{STUDY}/cad/step/housing.step", f"results/{STUDY}/cad/preview.png")


def robot(env: Environment) -> None:
    """Load the joint for simulators in MuJoCo."""
    env.run("tvimdesign", "new", "--example", STUDY)
    env.run("tvimdesign", "run", f"{STUDY}.yaml", "--no-cad", "--no-plots")
    env.run("tvimdesign", "robot", f"results/{STUDY}")
    env.has(f"results/{STUDY}-robot/joint.fmu")
    env.run("python", "-c", f"import mujoco; mujoco.MjModel.from_xml_path('results/{STUDY}-robot/joint_cold.xml')")


def fe(env: Environment) -> None:
    """Finite elements on the exported parts."""
    env.run("tvimdesign", "new", "--example", FE_STUDY)
    env.run("tvimdesign", "run", f"{FE_STUDY}.yaml", "--no-plots")
    env.run("tvimdesign", "verify", f"results/{FE_STUDY}")
    env.has(f"results/{FE_STUDY}-verified/report.html")


def validation(env: Environment) -> None:
    """Run the validation's cases, as the repository has them, by the wheel's package without an extra."""
    for name in ("validation", "studies", "tests/studies"):
        shutil.copytree(ROOT / name, env.folder / name)
    result = env.run("python", "validation/run.py", "--docs", "compared", "--known", str(ROOT / "docs/validation.md"))
    env.tell(result, " inside")
    env.has("compared/validation.md")


def _write_sweep(env: Environment) -> None:
    env.run("tvimdesign", "new", "--example", STUDY)
    study = env.folder / f"{STUDY}.yaml"
    text = study.read_text(encoding="utf-8")
    study.write_text(text + SWEEP, encoding="utf-8")


CHECKS: dict[str, Callable[[Environment], None]] = {
    LIGHT: light, VALIDATION: validation, "cad": cad, "robot": robot, "fe": fe,
}  # fmt: skip


def main() -> None:
    """Check a wheel."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wheel", type=Path)
    parser.add_argument("--extras", nargs="+", choices=CHECKS, default=list(CHECKS))
    parser.add_argument("--constraints", type=Path, help="versions to install, as pip's -c takes them")
    parser.add_argument("--python", default=sys.executable, help="interpreter that the environments are made with")
    options = parser.parse_args()
    for extra in options.extras:
        place = Path(tempfile.mkdtemp(prefix=f"tvimdesign-{extra}-"))
        began = time.monotonic()
        try:
            env = Environment(place, options.wheel, extra, options.python, options.constraints)
            installed = time.monotonic() - began
            CHECKS[extra](env)
            used = time.monotonic() - began - installed
            size = env.megabytes()
            print(f"{extra}: installed in {installed:.0f} s, {size:.0f} MB; passed in {used:.0f} s", flush=True)
        finally:
            shutil.rmtree(place, ignore_errors=True)


if __name__ == "__main__":
    main()
