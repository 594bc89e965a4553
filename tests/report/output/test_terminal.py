"""A user's text on the console is text, whatever brackets it has."""

import io

import pytest
from rich.markup import escape
from rich.table import Table

from tvimdesign.report.output.terminal import OwnMarkupConsole

TEXTS = ["[/bold]", "a [/] b", "[link=http://x]u[/link]", "x[1, 2]", "[[", "]", "[bold", "[/red] [/bold]", ":key:"]


def shown(what: object) -> str:
    stream = io.StringIO()
    OwnMarkupConsole(file=stream, width=80, color_system=None, highlight=False).print(what)
    return stream.getvalue()


@pytest.mark.parametrize("text", TEXTS)
def test_what_a_user_wrote_is_shown_as_it_stands(text: str) -> None:
    assert text in shown(f"Results are in [bold]{escape(text)}[/bold]")
    assert text in shown(f"Results are in {text}")
    table = Table()
    table.add_column(text)
    table.add_row(text, text)
    assert shown(table).count(text) == 3


def test_our_own_markup_is_obeyed() -> None:
    assert shown("[bold]a[/bold] [dim]b[/dim] [red]c[/]") == "a b c\n"
