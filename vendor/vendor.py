"""Makes the page's libraries, tvimdesign/page/static/vendor/*.js, from pinned packages: `make vendor` (needs npm)."""

from __future__ import annotations

import base64
import hashlib
import shutil
import subprocess
import tarfile
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

HERE = Path(__file__).resolve().parent
OUT = HERE.parent / "tvimdesign/page/static/vendor"
_TEXTS = ("LICENSE", "LICENSE.txt", "NOTICE")


def main() -> None:
    """Pack, check, unpack and bundle. Raises ValueError where a package is not the pinned one."""
    pinned: dict[str, Any] = yaml.safe_load((HERE / "packages.yaml").read_text(encoding="utf-8"))
    OUT.mkdir(parents=True, exist_ok=True)
    made: dict[str, str] = {}
    with tempfile.TemporaryDirectory() as scratch:
        modules = Path(scratch) / "node_modules"
        for name, package in pinned["packages"].items():
            unpack(name, package, modules)
        tool = unpack(pinned["tool"]["name"], pinned["tool"], modules) / "bin/esbuild"
        for bundle, names in pinned["bundles"].items():
            shutil.copy(HERE / "entries" / f"{bundle}.js", scratch)
            licences = licence_texts(names, pinned["packages"], modules)
            (OUT / f"{bundle}.LICENSE.txt").write_text(licences, encoding="utf-8")
            code = bundled(tool, Path(scratch) / f"{bundle}.js")
            (OUT / f"{bundle}.js").write_text(f"/*!\n{licences.replace('*/', '* /')}*/\n{code}", encoding="utf-8")
            made[bundle] = hashlib.sha256((OUT / f"{bundle}.js").read_bytes()).hexdigest()
            print(f"{bundle}.js: {len(code)} bytes")
    note_hashes(made)


def unpack(name: str, package: Mapping[str, str], modules: Path) -> Path:
    """Fetch one package, hold it against its pinned hash and lay it where the bundler looks for it."""
    place = modules / name
    place.mkdir(parents=True)
    asked = f"{name}@{package['version']}"
    packed = subprocess.run(
        ["npm", "pack", asked, "--silent"], cwd=place, check=True, capture_output=True, text=True
    ).stdout.strip()
    archive = place / packed
    found = "sha512-" + base64.b64encode(hashlib.sha512(archive.read_bytes()).digest()).decode()
    if found != package["integrity"]:
        raise ValueError(f"{asked}: its hash is {found}, pinned is {package['integrity']}")
    with tarfile.open(archive) as held:
        held.extractall(place, filter="data")
    for entry in (place / "package").iterdir():
        entry.rename(place / entry.name)
    return place


def licence_texts(names: Sequence[str], packages: Mapping[str, Mapping[str, str]], modules: Path) -> str:
    """The licences of what goes into a bundle, as their packages have them."""
    texts = []
    for name in names:
        texts.append(f"{name} {packages[name]['version']}, {packages[name]['licence']}\n")
        texts += [(modules / name / file).read_text("utf-8") for file in _TEXTS if (modules / name / file).exists()]
    return "\n".join(text.strip() + "\n" for text in texts)


def bundled(tool: Path, entry: Path) -> str:
    """What the entry imports, as one module, minified."""
    arguments = ["--bundle", "--minify", "--format=esm", "--target=es2022", "--legal-comments=none"]
    return subprocess.run([tool, entry, *arguments], check=True, capture_output=True, text=True).stdout


def note_hashes(made: Mapping[str, str]) -> None:
    """Write the hashes of what was made into the list of packages, which a test holds the files against."""
    path = HERE / "packages.yaml"
    kept = path.read_text(encoding="utf-8").partition("made:")[0]
    lines = [f"  {bundle}: {digest}" for bundle, digest in made.items()]
    path.write_text(
        "\n".join([f"{kept}made:                     # SHA-256 of each file", *lines, ""]), encoding="utf-8"
    )


if __name__ == "__main__":
    main()
