"""Builds the package; all but the copy of the studies is said in pyproject.toml."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py


class BuildWithStudies(build_py):
    """Puts a copy of studies/ into what is installed, so that `tvimdesign new --example` has them there too."""

    def run(self) -> None:
        """Build, then copy; an editable installation reads studies/ itself."""
        super().run()
        if self.editable_mode:
            return
        examples = Path(self.build_lib) / "tvimdesign" / "study" / "examples"
        shutil.rmtree(examples, ignore_errors=True)
        examples.mkdir(parents=True)
        for study in sorted(Path("studies").glob("*.yaml")):
            shutil.copy(study, examples)


def pages() -> list[tuple[str, list[str]]]:
    """The documentation's pages, for share/doc/tvimdesign of the environment."""
    docs = Path("docs")
    folders = sorted({page.parent for page in docs.rglob("*.md")})
    installed = Path("share/doc/tvimdesign")
    return [(str(installed / at.relative_to(docs)), [str(page) for page in sorted(at.glob("*.md"))]) for at in folders]


setup(cmdclass={"build_py": BuildWithStudies}, data_files=pages())
