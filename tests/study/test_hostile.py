"""Hostile files and random texts give a clear error within a second, or a study that survives JSON."""

import errno
import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml
from hypothesis import given as given_that
from hypothesis import settings
from hypothesis import strategies as st

from tvimdesign.base.errors import InputError
from tvimdesign.study import Study, StudyError, read_study, read_study_text, read_tree
from tvimdesign.study.text import mistakes, yaml_text
from tvimdesign.study.tree import tree_of_file

LIMIT = 1.0
"""Seconds; the slowest of these takes a tenth."""

TEXTS = {
    "empty": ("", "the study is empty"),
    "alias bomb": ("a: &a [x,x]\n" + "".join(f"b{i}: &b{i} [*a,*a,*a]\n" for i in range(2500)), "the alias '*a'"),
    "deep lists": ("mode: " + "[" * 100_000, "nested deeper than 20 levels"),
    "deep blocks": ("\n".join(" " * i + "a:" for i in range(1000)), "nested deeper than 20 levels"),
    "deep dashes": ("- " * 400_000, "nested deeper than 20 levels"),
    "many values": ("mode: shear\nvary:\n" + "- a\n" * 240_000, "more than 10000 values"),
    "many keys": ("mode: shear\nmodule:\n" + "".join(f"  wire_diamete{i}: 1\n" for i in range(4000)), "and 3950 more"),
    "many bad units": (
        "mode: shear\nvary:\n  wire_diameter: {choose: [" + ", ".join(f"1 x{i}" for i in range(200)) + "]}\n",
        "and 151 more",
    ),
    "long list": ("mode: shear\nvary: {coil_count: {choose: [" + "1," * 201 + "]}}", "the list has 201 values"),
    "long text": ("mode: shear\nname: " + "x" * 900_000, "900000 characters, the limit is 200"),
    "long value": (
        "mode: shear\nmodule: {coil_count: " + "9" * 900_000 + "}",
        "has 900000 characters, the limit is 200",
    ),
    "long key": (f"mode: shear\n'{'x' * 1000}': 1", "no such section"),
    "quotes": ('"' * 900_000, "not valid YAML"),
    "escape character": ("mode: shear\nname: \x1b[31mred", "x.yaml:2:7: control character U+001B"),
    "lone surrogate": ("mode: \ud800", "control character U+D800"),
    "too long": ("#" * 1_000_001, "a study at most 1 MB"),
}


def test_hints_are_sought_for_as_many_names_as_are_shown(monkeypatch):
    sought: list[str] = []
    monkeypatch.setattr(mistakes, "get_close_matches", lambda word, *_, **__: sought.append(word) or [])
    with pytest.raises(StudyError):
        read_study_text(TEXTS["many keys"][0])
    assert 0 < len(set(sought)) <= mistakes.MOST_SHOWN


@pytest.mark.parametrize("case", TEXTS)
def test_hostile_text_is_refused_in_time(problems, case):
    text, message = TEXTS[case]
    start = time.process_time()
    lines = problems(text)
    assert time.process_time() - start < LIMIT
    assert message in "\n".join(lines)
    assert len(lines) <= 51
    assert all(line.isprintable() and len(line) < 1000 for line in lines)


@pytest.mark.parametrize("case", ["deep lists", "alias bomb"])
def test_the_parser_in_python_says_the_same(problems, monkeypatch, case):
    monkeypatch.setattr(yaml_text, "LOADER", yaml.SafeLoader)
    text, message = TEXTS[case]
    assert message in "\n".join(problems(text))


FILES: dict[str, tuple[bytes, str]] = {
    "binary": (b"\x7fELF\x02\x01\x01\x00\xff\xfe\x80", "the file is not UTF-8 text (byte 0xff is no text)"),
    "picture": (b"\x89PNG\r\n\x1a\n\x00", "x.yaml:1:1: the file is not UTF-8 text"),
    "latin 1": ("mode: shear\nname: Gelände".encode("latin-1"), "x.yaml:2:10: the file is not UTF-8 text"),
    "UTF-16": ("mode: shear".encode("utf-16"), "(UTF-16 text); expected a study in YAML; save it as UTF-8"),
    "one byte too many": (b"#" * 1_000_001, "the file has 1 MB, a study at most 1 MB"),
    "empty": (b"", "the study is empty; `tvimdesign new` writes a commented one"),
}


@pytest.mark.parametrize("case", FILES)
def test_hostile_files(tmp_path, case):
    raw, message = FILES[case]
    (tmp_path / "x.yaml").write_bytes(raw)
    with pytest.raises(StudyError) as caught:
        read_study(tmp_path / "x.yaml")
    assert message in str(caught.value)


def test_marked_files_are_read_and_unreadable_ones_named(tmp_path, monkeypatch, table_of):
    path = tmp_path / "large.yaml"
    with path.open("wb") as file:
        file.truncate(50_000_000)
    start = time.process_time()
    with pytest.raises(StudyError, match=r"large\.yaml: the file has 50 MB, a study at most 1 MB"):
        read_study(path)
    assert time.process_time() - start < 0.1
    path = tmp_path / "x.yaml"
    path.write_bytes(b"\xef\xbb\xbfmode: shear\r\n")
    assert isinstance(read_tree(tree_of_file(path), table_of), Study)
    # Root may read everything, so the system's refusal is brought about by hand.

    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(InputError, match="cannot be read: Permission denied"):
        read_study(path)


def test_what_is_no_ordinary_file_is_refused_in_words(tmp_path):
    (tmp_path / "paper_shear.yaml").touch()
    with pytest.raises(InputError, match=r"no such file; did you mean 'paper_shear\.yaml'\?"):
        read_study(tmp_path / "paper_sheer.yaml")
    with pytest.raises(InputError, match="no such file; `tvimdesign new`"):
        read_study(tmp_path / "nowhere" / "x.yaml")
    with pytest.raises(InputError, match="is a folder; give the path of a study file"):
        read_study(tmp_path)
    with pytest.raises(InputError, match="cannot be read"):
        read_study(Path("a\0b"))
    with pytest.raises(InputError, match="cannot be read"):
        read_study(tmp_path / ("x" * 5000))
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="is no ordinary file"):
        read_study(tmp_path / "pipe")
    with pytest.raises(InputError) as caught:
        read_study(tmp_path / "x\x1b[31m\n.yaml")
    assert str(caught.value).isprintable()


Read = Callable[..., Study]

WORDS = st.sampled_from(
    """mode shear module vary require minimize operating_points solver write catalog name tvimdesign from to start
    choose wire_diameter coil_count arc_count peltier qc_17 rate_model smi metric module_mass joint_stiffness@hot hot
    warm temperature frequency response_time starts seed plots true no 1 3 010 1e400 .nan ~ '' 2\xa0mm 3\xa0degC
    '>=5\xa0g' '<=5\xa0N.m/rad' !!str !!python/name:os &a *a << - ? : , [ ] { } | > # % @ ` " '""".replace(
        "\n", " "
    ).split(" ")
).map(lambda word: word.replace("\xa0", " "))
GLUE = st.sampled_from([" ", ": ", "\n", "\n  ", "\n    ", ", ", "", "\t", "\n- ", "{", "}", "[", "]"])
YAML_LIKE = st.lists(st.tuples(WORDS, GLUE), max_size=40).map(lambda parts: "".join(a + b for a, b in parts))
SCALARS = st.one_of(st.text(max_size=20), st.integers(), st.floats(), st.booleans(), st.none())
TREES = st.recursive(SCALARS, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(WORDS, inner, max_size=4))


def _reads_or_refuses(read: Read, text: str) -> None:
    try:
        study = read(text)
    except StudyError as error:
        lines = str(error).splitlines()
    else:
        assert Study.model_validate_json(study.model_dump_json()) == study
        return
    assert lines
    assert all(line.startswith(("x.yaml", "... and")) for line in lines)


@given_that(st.text(max_size=200))
def test_any_text(read, text):
    _reads_or_refuses(read, text)


@settings(max_examples=300)
@given_that(YAML_LIKE)
def test_anything_like_yaml(read, text):
    _reads_or_refuses(read, "mode: shear\n" + text)


@settings(max_examples=200)
@given_that(st.dictionaries(WORDS, TREES, max_size=5))
def test_any_tree(read, tree):
    import yaml

    _reads_or_refuses(read, yaml.safe_dump({"mode": "shear"} | tree, allow_unicode=True))


@given_that(st.binary(max_size=200))
def test_any_bytes(tmp_path_factory, raw):
    path = tmp_path_factory.getbasetemp() / "any.yaml"
    path.write_bytes(raw)
    with pytest.raises(InputError):
        read_study(path)


@given_that(st.floats(0.5, 5.0), st.floats(0.5, 5.0))
def test_a_range_is_read_or_refused_by_its_order(read, lower, upper):
    text = f"mode: shear\nminimize: module_mass\nvary: {{wire_diameter: [{lower!r} mm, {upper!r} mm]}}"
    if upper > lower * (1 + 1e-6):
        result = read(text).vary["wire_diameter"].model_dump()
        assert result["lower"] == pytest.approx(lower / 1000)
        assert result["upper"] == pytest.approx(upper / 1000)
    elif upper < lower:
        with pytest.raises(StudyError, match=r"upside down|ends where it begins"):
            read(text)


@given_that(st.text(st.characters(codec="utf-8"), min_size=1, max_size=30))
def test_no_file_name_gives_a_traceback(tmp_path_factory, name):
    with pytest.raises(InputError) as caught:
        read_study(Path(tmp_path_factory.getbasetemp() / "nowhere" / name.replace("/", "_")))
    assert str(caught.value).isprintable()
