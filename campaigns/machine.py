"""Runs a study where the machine lacks something: room, descriptors, memory, a home, letters; and looks how it ends.

    python campaigns/machine.py [--only WORD]

A run that can be done is done (0). Any other ends with one line on stderr that says what is wrong, with the exit code
of what it is, and every file that is there is whole. Read-only and full file systems are mounted in a namespace of
their own, which Linux lets a user do; elsewhere they are left out, and a line says so.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from kills import whole

ROOT = Path(__file__).resolve().parents[1]
STUDY = ROOT / "studies/paper_reconstructed.yaml"
MEGABYTE = 1 << 20
Limit = tuple[int, int]
"""A limit of the kernel's and its value."""


@dataclass(frozen=True)
class Lack:
    """A resource that lacks, and how a run of a study ends then."""

    name: str
    code: int
    says: str = ""
    """Words that the one line on stderr has; none where the run is done."""
    environment: Mapping[str, str | None] = field(default_factory=dict)
    """Variables set, or taken away (None)."""
    limits: tuple[Limit, ...] = ()
    mount: str = ""
    """Options of the file system on which the results are to stand; the usual one where it is empty."""
    stdout: str = ""
    """Where the standard output goes."""
    parts: bool = False
    """Whether the parts are made as well, by processes that have the same limits."""


PROGRESS = "... "
"""What lines of progress begin with where stderr is no terminal."""
PLAIN = {"LC_ALL": "C", "LANG": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
LACKS = (
    Lack("no HOME", 0, environment={"HOME": None}),
    Lack("a HOME that is not there", 0, environment={"HOME": "/nowhere/at/all"}),
    Lack("64 descriptors", 0, limits=((resource.RLIMIT_NOFILE, 64),)),
    Lack("3 GB of address space", 0, limits=((resource.RLIMIT_AS, 3000 * MEGABYTE),)),
    Lack("64 descriptors, with parts", 0, limits=((resource.RLIMIT_NOFILE, 64),), parts=True),
    Lack("3 GB of address space, with parts", 0, limits=((resource.RLIMIT_AS, 3000 * MEGABYTE),), parts=True),
    Lack("8 descriptors", 4, "Too many open files", limits=((resource.RLIMIT_NOFILE, 8),)),
    Lack("files of 20 kB at most", 4, "File too large", limits=((resource.RLIMIT_FSIZE, 20_000),)),
    Lack("a read-only file system", 2, "Read-only file system", mount="ro"),
    Lack("64 kB left on the disk", 4, "No space left on device", mount="size=64k"),
    Lack("an output that cannot be written", 4, "what was finished is kept", stdout="/dev/full"),
    Lack("PYTHONIOENCODING=ascii", 0, environment={"PYTHONIOENCODING": "ascii"}),
    Lack("a C locale without UTF-8", 0, environment=PLAIN),
)


def mounts() -> bool:
    """Return whether this user may mount a file system in a namespace of their own."""
    try:
        return subprocess.run(["unshare", "-rm", "true"], capture_output=True, check=False).returncode == 0
    except OSError:
        return False


def faults_of(lack: Lack, folder: Path) -> list[str]:
    """Run the study into an empty folder, and say what is not as it should be."""
    out = folder / "disk" / "out"
    out.parent.mkdir()
    words = [sys.executable, "-m", "tvimdesign", "run", str(STUDY), "--out", str(out)]
    words += [] if lack.parts else ["--no-cad"]
    if lack.mount:
        tmpfs = f"mount -t tmpfs -o {lack.mount} none {out.parent}"
        copy = f"cp -r {out.parent} {folder / 'kept'}"  # the mount is gone with the namespace
        words = ["unshare", "-rm", "sh", "-c", f'{tmpfs} && "$@"; code=$?; {copy}; exit $code', "sh", *words]
    uncached = {"TVIMDESIGN_CACHE": ""} if lack.parts else {}  # parts that are kept would not be made
    environment = {**os.environ, **uncached, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", **lack.environment}
    with Path(lack.stdout or folder / "told.txt").open("wb") as output:
        done = subprocess.run(
            words, stdout=output, stderr=subprocess.PIPE, check=False, cwd=folder, preexec_fn=_limited(lack.limits),
            env={name: value for name, value in environment.items() if value is not None},
        )  # fmt: skip
    errors = done.stderr.decode(errors="replace")
    lines = [line for line in errors.splitlines() if line.strip() and not line.startswith(PROGRESS)]
    faults = (
        [f"exit code {done.returncode}, not {lack.code}: {errors[-300:]!r}"] if done.returncode != lack.code else []
    )
    if "Traceback" in errors:
        faults.append("a traceback")
    if lack.says and (len(lines) != 1 or lack.says not in errors):
        faults.append(f"not one line about {lack.says!r}: {errors[-300:]!r}")
    if lack.parts and not lack.code and not list(out.rglob("*.step")):
        faults.append("no parts")
    results = folder / "kept" if lack.mount else out
    for path in sorted(path for path in results.rglob("*") if path.is_file()):
        if path.name.startswith(".") or not whole(path, path.read_bytes()):
            faults.append(f"{path.relative_to(results)} is broken")
    return faults


def _limited(limits: tuple[Limit, ...]) -> Callable[[], None]:
    def limit() -> None:
        for number, value in limits:
            resource.setrlimit(number, (value, value))

    return limit


def main() -> int:
    """Run all; 1 where one does not end as it should."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="those whose name has this word")
    options = parser.parse_args()
    failed, can_mount = 0, mounts()
    for lack in (candidate for candidate in LACKS if options.only in candidate.name):
        if lack.mount and not can_mount:
            print(f"{lack.name}: not tried, as this user may not mount")
            continue
        with tempfile.TemporaryDirectory(prefix="machine-") as folder:
            faults = faults_of(lack, Path(folder))
        failed += bool(faults)
        print(f"{lack.name}: {'; '.join(faults) or f'as it should, {lack.code}'}", flush=True)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
