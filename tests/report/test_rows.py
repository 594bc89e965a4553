"""`rows` is found by group, by name and by the words engineers use; names are whole at any width."""

import io
from typing import Any

import pytest
from rich.console import Console
from support import cases_of

from tvimdesign.base.errors import InputError
from tvimdesign.device import MODES
from tvimdesign.report import rows
from tvimdesign.study.text.mistakes import synonyms


@pytest.fixture
def printed(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return what `rows` prints on a terminal of a width."""

    def call(word: str, width: int, mode: str = "shear") -> str:
        stream = io.StringIO()
        monkeypatch.setattr(rows, "wide_console", lambda: Console(file=stream, width=width, highlight=False))
        rows.print_rows(mode, word, as_json=False)
        return stream.getvalue()

    return call


@pytest.mark.parametrize("mode", MODES)
def test_every_word_and_every_term_finds_rows(mode):
    every = rows.named_rows(mode)
    for word, terms in synonyms().items():
        assert rows.matching(every, word) or (mode == "lock" and word in {"coils", "fatigue"}), word
        for term in terms:
            others = (rows.named_rows(other) for other in MODES)
            every_mode = (row for named in others for row in named)
            assert any(term in f"{row.name} {row.description}".lower() for row in every_mode), f"{word}: {term}"


@cases_of("rows", "looked_for")
def test_what_an_engineer_looks_for_is_found(word, name):
    assert name in {row.name for row in rows.matching(rows.named_rows("shear"), word)}


def test_the_groups_come_first_with_their_counts(printed):
    text = printed("", 80)
    every = rows.named_rows("shear")
    groups = {row.group for row in every}
    for group in groups:
        (line,) = (line for line in text.splitlines() if line.startswith(f"{group}  "))
        assert str(sum(row.group == group for row in every)) in line.split()
    assert len(text.splitlines()) < 40
    assert max(map(len, text.splitlines())) <= 80


@pytest.mark.parametrize("mode", MODES)
def test_names_are_never_broken(printed, mode):
    groups = {row.group for row in rows.named_rows(mode)}
    words = set(printed("", 80, mode).replace(",", " ").split())
    for group in groups:
        words |= set(printed(group, 80, mode).split())
        own = [row for row in rows.named_rows(mode) if row.group == group]
        assert {rows._plain(row)["name"] for row in own} <= words
        assert set(rows._important(own)) <= words


def test_an_input_of_records_has_its_value_by_each(printed):
    text = " ".join(printed("minimum_wall", 110).split())
    assert "print_pc_bambu 1.2 (0.8 to 1.6), print_peek 1.2" in text


def test_a_choice_says_what_its_records_are(printed):
    text = " ".join(printed("heater_fuse", 160).split())
    assert "sefuse_sm_b Thermal cut-out SEFUSE" in text
    assert "functioning temperature 92 to 146 °C; holding temperature 62 to 116 °C" in text


def test_a_word_that_matches_nothing_is_reported_with_the_nearest():
    with pytest.raises(InputError, match="did you mean 'weight'"):
        rows.print_rows("shear", "wieght", as_json=False)
    with pytest.raises(InputError, match="lists the groups"):
        rows.print_rows("shear", "qqqq", as_json=False)
