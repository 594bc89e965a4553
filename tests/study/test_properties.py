"""Properties: no text whatever gives anything but a study or a StudyError, and what is read survives JSON."""

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given as given_that
from hypothesis import settings
from hypothesis import strategies as st

from tvimdesign.base.errors import InputError
from tvimdesign.study import Study, StudyError, read_study

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
def test_any_text(read: Read, text: str) -> None:
    _reads_or_refuses(read, text)


@settings(max_examples=300)
@given_that(YAML_LIKE)
def test_anything_like_yaml(read: Read, text: str) -> None:
    _reads_or_refuses(read, "mode: shear\n" + text)


@settings(max_examples=200)
@given_that(st.dictionaries(WORDS, TREES, max_size=5))
def test_any_tree(read: Read, tree: dict[str, object]) -> None:
    import yaml

    _reads_or_refuses(read, yaml.safe_dump({"mode": "shear"} | tree, allow_unicode=True))


@given_that(st.binary(max_size=200))
def test_any_bytes(tmp_path_factory: pytest.TempPathFactory, raw: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "any.yaml"
    path.write_bytes(raw)
    with pytest.raises(InputError):
        read_study(path)


@given_that(st.floats(0.5, 5.0), st.floats(0.5, 5.0))
def test_a_range_is_read_or_refused_by_its_order(read: Read, lower: float, upper: float) -> None:
    text = f"mode: shear\nminimize: module_mass\nvary: {{wire_diameter: [{lower!r} mm, {upper!r} mm]}}"
    if upper > lower * (1 + 1e-6):
        result = read(text).vary["wire_diameter"].model_dump()
        assert result["lower"] == pytest.approx(lower / 1000)
        assert result["upper"] == pytest.approx(upper / 1000)
    elif upper < lower:
        with pytest.raises(StudyError, match=r"upside down|ends where it begins"):
            read(text)


@given_that(st.text(st.characters(codec="utf-8"), min_size=1, max_size=30))
def test_no_file_name_gives_a_traceback(tmp_path_factory: pytest.TempPathFactory, name: str) -> None:
    with pytest.raises(InputError) as caught:
        read_study(Path(tmp_path_factory.getbasetemp() / "nowhere" / name.replace("/", "_")))
    assert str(caught.value).isprintable()
