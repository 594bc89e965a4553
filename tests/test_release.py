"""A release."""

import re
import tomllib

import yaml
from packaging.requirements import Requirement
from support import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
RECIPE = yaml.safe_load((ROOT / "release/conda/recipe.yaml").read_text("utf-8"))
OF_CONDA = {"matplotlib": "matplotlib-base"}
"""Names of packages that conda-forge has under another: there matplotlib brings Qt, and the base does not."""


def _split(needed: str) -> tuple[str, str]:
    """Name and range of versions."""
    match = re.fullmatch(r"([A-Za-z0-9_.-]+?)\s*([<>=!~].*)?", needed)
    assert match, needed
    return match[1], (match[2] or "").replace(" ", "")


def test_the_recipe_needs_what_the_package_needs():
    project = PROJECT["project"]
    everywhere = [needed for needed in project["dependencies"] if ";" not in needed]  # conda builds for Macs itself
    wanted = {OF_CONDA.get(name, name): versions for name, versions in map(_split, everywhere)}
    run = dict(map(_split, RECIPE["requirements"]["run"]))
    assert run == {**wanted, "python": project["requires-python"]}
    host = dict(map(_split, RECIPE["requirements"]["host"]))
    built_with = dict(map(_split, PROJECT["build-system"]["requires"]))
    assert host == {**built_with, "python": project["requires-python"], "pip": ""}


def test_what_pip_takes_on_an_intel_mac_has_a_wheel_there():
    (needed,) = (Requirement(requirement) for requirement in PROJECT["project"]["dependencies"] if ";" in requirement)
    assert needed.name == "llvmlite"
    assert needed.specifier.contains("0.45.1")
    assert not needed.specifier.contains("0.46.0")
    macs = {machine: {"sys_platform": "darwin", "platform_machine": machine} for machine in ("x86_64", "arm64")}
    assert needed.marker
    assert {machine: needed.marker.evaluate(where) for machine, where in macs.items()} == {
        "x86_64": True,
        "arm64": False,
    }


def test_the_version_is_one():
    version = PROJECT["project"]["version"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    package = (ROOT / "tvimdesign/__init__.py").read_text("utf-8")
    assert RECIPE["context"]["version"] == version
    assert str(citation["version"]) == version
    assert f'__version__ = "{version}"' in package
    assert RECIPE["source"]["path"].startswith("../../dist/")
    assert RECIPE["about"]["license"] == PROJECT["project"]["license"]


def test_each_extra_in_the_docs_is_checked_from_the_wheel():
    extras = set(PROJECT["project"]["optional-dependencies"]) - {"dev", "docs", "bench"}
    page = (ROOT / "docs/install.md").read_text("utf-8")
    assert set(re.findall(r"^\| `pip install 'tvimdesign\[(\w+)\]'`", page, re.M)) == extras
    check = (ROOT / "release/check_wheel.py").read_text("utf-8")
    checked = re.search(r"^CHECKS.*?\{(.*?)\}", check, re.M | re.S)
    assert checked
    assert set(re.findall(r'"(\w+)":', checked[1])) == extras


def test_container_and_page_name_interpreters_and_extras_that_there_are():
    text = (ROOT / "Containerfile").read_text("utf-8")
    versions = {tag.rsplit(" ", 1)[1] for tag in PROJECT["project"]["classifiers"] if ":: Python ::" in tag}
    base = re.search(r"^FROM python:([\d.]+)-slim$", text, re.M)
    extras = re.search(r"\)\[([\w,]+)\]\"", text)
    assert base
    assert base[1] in versions
    assert extras
    assert set(extras[1].split(",")) <= set(PROJECT["project"]["optional-dependencies"])
    versions = [tag.rsplit(" ", 1)[1] for tag in PROJECT["project"]["classifiers"] if ":: Python ::" in tag]
    page = (ROOT / "docs/install.md").read_text("utf-8")
    range_of_tests = re.search(r"Python (3\.\d+) to (3\.\d+) are tested", page)
    assert range_of_tests
    assert [range_of_tests[1], range_of_tests[2]] == [versions[0], versions[-1]]
    assert all(f"on {version}" in page for version in versions)
