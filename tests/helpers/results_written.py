"""Results folders for tests: finished, and of a run that was killed."""

import signal
import subprocess
import sys
from pathlib import Path

from tvimdesign.base.manifest import MANIFEST
from tvimdesign.base.results_folder import ResultsFolder

FILES = {"results.csv": "a,b\n", "plots/heat.png": "png", "cad/step/rotor.step": "step"}


def finished(out: Path, files: dict[str, str] = FILES, *, overwrite: bool = False) -> None:
    """Write a folder of results."""
    with ResultsFolder(out, overwrite) as folder:
        for name, text in files.items():
            folder.write(name, text)
        folder.finish("optimal", {}, {})


def killed(out: Path, *words: str) -> None:
    """Let a process write into a folder and end it by SIGKILL: half a file, one file, and a front's progress."""
    code = (
        "import os, signal, sys; from pathlib import Path\n"
        "from tvimdesign.base.results_folder import ResultsFolder\n"
        "from tvimdesign.base.atomic_files import whole_file\n"
        "folder = ResultsFolder(Path(sys.argv[1]), overwrite='overwrite' in sys.argv)\n"
        "folder.write('results.csv', 'of the killed run')\n"
        "folder.write('front/progress/0001.json', '{}')\n"
        "with whole_file(folder.path / 'summary.txt') as beside:\n"
        "    beside.write_text('half')\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    assert subprocess.run([sys.executable, "-c", code, str(out), *words], check=False).returncode == -signal.SIGKILL


def texts(folder: Path) -> dict[str, str]:
    """Return the files of a folder but manifests."""
    every = (path for path in folder.rglob("*") if path.is_file() and path.name != MANIFEST)
    return {path.relative_to(folder).as_posix(): path.read_text("utf-8-sig") for path in every}
