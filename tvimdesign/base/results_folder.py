"""The results folder: one run writes it, every file appears whole, and nobody else's files are touched."""

import json
import platform
import shutil
import subprocess
import sys
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from functools import cached_property
from importlib import metadata
from pathlib import Path, PurePosixPath
from types import TracebackType
from typing import Any, Self

from tvimdesign import __version__
from tvimdesign.base import atomic_files, manifest
from tvimdesign.base.claim import FORMAT, IN_PARTS, RUNNING, Claim, is_run
from tvimdesign.base.errors import FolderInUseError, InputError, OutputError
from tvimdesign.base.interrupts import raise_pending

PROGRESS = "front/progress"  # Folder of what a run can go on from where it was killed
_LIBRARIES = ("casadi", "numpy", "scipy", "pydantic", "pint", "matplotlib", "cadquery", "cadquery-ocp", "trimesh",
              "ezdxf")  # fmt: skip


class ResultsFolder:
    """A folder for the results of one run.

    The run writes into the folder `unfinished` within it. When it finishes, its files take the place of earlier
    results. A run that fails leaves earlier results as they are; where there are none, its files take their place with
    a manifest that says how it ended. Use it as a context manager.
    """

    def __init__(self, out: Path, overwrite: bool = False, resume: bool = False, progress: str = PROGRESS) -> None:
        """Claim the folder `out`, made where there is none. Raises InputError where it is in use, or not ours.

        With `resume` the run continues from the files in the folder `progress` of an unfinished or earlier one.
        """
        if overwrite and resume:
            raise InputError("--overwrite and --resume: choose one")
        self.out, self.path = out, out / atomic_files.UNFINISHED
        """Where the results will be, and where files are written until then."""
        self._progress = PurePosixPath(progress)
        self._run, self._started = uuid.uuid4().hex, datetime.now(UTC)
        self._results: manifest.Manifest | None = None
        try:
            prepare(out)
            self._claim = Claim(out)
            try:
                self._earlier = recovered(out, self._claim)
                self._begin(overwrite, resume)
                self._claim.write(RUNNING, self._run)
            except BaseException:
                self._claim.release()
                raise
        except OSError as error:
            raise InputError(f"{out}: cannot be used as a results folder: {error.strerror or error}") from error

    def _begin(self, overwrite: bool, resume: bool) -> None:
        """Clear the folder `unfinished`, but for what the run continues from. Raises InputError."""
        manifest.refuse_links(self.out, self._earlier.files)
        written, results = atomic_files.files_in(self.path), self._earlier.files
        if resume and any(map(self._is_continued, written)):
            manifest.discard_unfinished(self.path, self._is_continued)
            return
        if resume and (self._earlier.content or written) and not any(map(self._is_continued, results)):
            raise InputError(f"{self.out}: there is nothing to resume in it; --overwrite to do it again")
        if not (overwrite or resume) and written:
            raise InputError(
                f"{self.path}: holds what an unfinished run has written; --overwrite begins again, --resume goes on "
                "with a front or a sweep, or name another folder with --out"
            )
        if not (overwrite or resume) and results:
            raise InputError(
                f"{self.out}: holds results already; say --overwrite to replace them, or --out another folder; "
                "--resume goes on with a front or a sweep that was stopped"
            )
        manifest.discard_unfinished(self.path)
        if resume:
            manifest.seed(
                self.out, self.path, {name: results[name] for name in results if self._is_continued(name)}, say
            )

    def _is_continued(self, name: str) -> bool:
        """Return whether a run that is resumed continues from a file."""
        return PurePosixPath(name).parent == self._progress

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        """Say how a run ended that did not finish, and let go of the folder."""
        try:
            if self._results is not None:
                self._publish()  # an interrupt came between
            elif self.path != self.out:
                self._stop("interrupted" if kind and issubclass(kind, KeyboardInterrupt) else "failed")
        except OutputError:
            if value is None:
                raise
        finally:
            self._claim.release()

    def look_up_versions(self) -> None:
        """Do now what takes time of the manifest: good where a run waits for something else."""
        _ = self.made_by

    @cached_property
    def made_by(self) -> dict[str, Any]:
        """Versions and commit."""
        return {
            "tvimdesign": __version__,
            "commit": _commit(),
            "python": platform.python_version(),
            "platform": platform.platform(),
            "libraries": {name: _version(name) for name in _LIBRARIES},
        }

    @property
    def has_earlier(self) -> bool:
        """True if earlier results stand, which stay if the run fails."""
        return bool(self._earlier.files)

    def where_if_stopped(self, name: str) -> Path:
        """Return where a file will be if the run stops before it finishes."""
        return (self.path if self.has_earlier else self.out) / name

    def write(self, name: str, data: str | bytes) -> Path:
        """Write one file, whole; text of a table in the encoding that Excel reads. Raises OutputError.

        Raises KeyboardInterrupt where a library swallowed an interrupt: what it gave since is not to be kept.
        """
        if self._results is None:
            raise_pending()
        return self.write_at_the_end(name, data)

    def write_at_the_end(self, name: str, data: str | bytes) -> Path:
        """Write one file of a run that was interrupted. Raises OutputError."""
        path = self.path / name
        atomic_files.make_folder(path.parent)
        atomic_files.atomic_write(
            path,
            data.encode(atomic_files.TABLE_ENCODING if path.suffix == ".csv" else "utf-8")
            if isinstance(data, str)
            else data,
        )
        return path

    def write_json(self, name: str, data: Any) -> Path:
        """Write one JSON file, whole; infinities are not JSON and raise ValueError."""
        return self.write(name, json.dumps(data, indent=2, allow_nan=False) + "\n")

    def remove(self, folder: str) -> None:
        """Remove what this run has written into a folder within its own."""
        if not self.path.is_symlink() and not atomic_files.link_on_the_way(self.path, f"{folder}/any"):
            shutil.rmtree(self.path / folder, ignore_errors=True)

    def finish(
        self, status: str, inputs: dict[str, Path], study: dict[str, Any], timing: dict[str, float] | None = None
    ) -> None:
        """Write the manifest (versions, commit, seed, digests of inputs and files), and put the results in place.

        An interrupt that comes before the manifest is written has it say so.
        """
        raise_pending()
        self._write_manifest(status, inputs, study, timing or {})
        self._publish()

    def _stop(self, status: str) -> None:
        """End a run that did not finish: beside earlier results its files stay where they are."""
        if not self.has_earlier:
            self._write_manifest(status, {}, {}, {})
            self._publish()
        elif atomic_files.files_in(self.path):
            self._claim.write(status, self._run)
            say(f"{self.out}: the earlier results are as they were; {self.path} holds what this run has written")

    def _write_manifest(
        self, status: str, inputs: dict[str, Path], study: dict[str, Any], timing: dict[str, float]
    ) -> None:
        if self.path.is_symlink():
            raise OutputError(f"{self.path}: was moved while the run was writing it; what it wrote is there")
        content = {
            "format": FORMAT,
            "run": self._run,
            "status": status,
            **self.made_by,
            "started": self._started.isoformat(timespec="seconds"),
            "seconds": round((datetime.now(UTC) - self._started).total_seconds(), 3),
            "timing": timing,
            "seed": study.get("solver", {}).get("seed"),
            "inputs": {name: atomic_files.digest_of(path) for name, path in inputs.items()},
            "files": {
                name: atomic_files.digest_of(self.path / name)
                for name in atomic_files.files_in(self.path)
                if name != manifest.MANIFEST
            },
        }
        self.write_at_the_end(manifest.MANIFEST, manifest.manifest_text(content))
        self._results = manifest.read_manifest(self.path)

    def _publish(self) -> None:
        """Put the results in place, and let go of the folder. Raises OutputError where they stay in `unfinished`."""
        if self.path == self.out or self._results is None:
            return
        self._claim.write(str(self._results.content["status"]), self._run)
        publish(self.out, self.path, self._results, self._earlier)
        self.path = self.out
        self._claim.release()


def prepare(out: Path) -> None:
    """Make a folder of results, or refuse one that holds other files. Raises InputError before anything is changed."""
    if out.exists() and not out.is_dir():
        raise InputError(f"{out}: is a file; name a folder with --out")
    out.mkdir(parents=True, exist_ok=True)
    names = {path.name for path in out.iterdir()}
    if atomic_files.UNFINISHED in names and not is_run(out / atomic_files.UNFINISHED):
        raise InputError(f"{out / atomic_files.UNFINISHED}: is not the folder of a run; name another folder with --out")
    if names and not names & {manifest.MANIFEST, atomic_files.UNFINISHED}:
        raise InputError(f"{out}: not a folder of results (no {manifest.MANIFEST}); --overwrite would lose other files")
    manifest.read_manifest(out)


def recovered(out: Path, claim: Claim) -> manifest.Manifest:
    """Put results of a run in place that was killed at its very end, and return the manifest of those that stand."""
    earlier = manifest.read_manifest(out)
    if (claim.folder / manifest.MANIFEST).exists():
        publish(out, claim.folder, manifest.read_manifest(claim.folder), earlier)
        earlier = manifest.read_manifest(out)
    return earlier


def publish(out: Path, new: Path, results: manifest.Manifest, earlier: manifest.Manifest) -> None:
    """Put finished results in the place of earlier ones. Raises OutputError."""
    try:
        manifest.replace_results(out, new, results, earlier, say)
        manifest.discard_unfinished(new)
    except (OSError, InputError) as error:
        reason = error.strerror or error if isinstance(error, OSError) else error
        raise OutputError(
            f"{out}: {reason}. The new results are whole in {new}, and are put in place next time"
        ) from error


def say(text: str) -> None:
    """Print a word about files that somebody changed."""
    sys.stderr.write(f"{text}\n")


@contextmanager
def joined(out: Path, progress: str, *, overwrite: bool = False) -> Iterator[Path]:
    """Write into a folder together with other jobs; yields where. Raises InputError where it is not theirs.

    Earlier results in the folder `progress` are used again.
    """
    if overwrite:
        raise InputError("--overwrite and --shard: the parts share a folder; name another one with --out")
    try:
        prepare(out)
        with suppress(FolderInUseError):  # another job prepares it, or has
            _prepare_jobs(out, progress)
        claim = Claim(out, shared=True)
    except OSError as error:
        raise InputError(f"{out}: cannot be used as a results folder: {error.strerror or error}") from error
    try:
        yield claim.folder
    finally:
        claim.release(remove=False)


def _prepare_jobs(out: Path, progress: str) -> None:
    """Make the folder that jobs write into, with earlier results. Raises FolderInUseError, OSError."""
    claim = Claim(out)
    try:
        earlier = recovered(out, claim)
        if not atomic_files.files_in(claim.folder):
            own = {name: digest for name, digest in earlier.files.items() if PurePosixPath(name).parts[0] == progress}
            manifest.seed(out, claim.folder, own, say)
        claim.write(IN_PARTS, "")
    finally:
        claim.release(remove=False)


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _commit() -> str | None:
    """Return commit of the source tree this package runs from, or None when it runs from an installed wheel."""
    source = Path(__file__).resolve().parents[2]
    if not (source / ".git").exists():
        return None
    try:
        process = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=source, capture_output=True, text=True, timeout=60, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return process.stdout.strip() or None
