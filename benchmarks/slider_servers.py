"""One slider that evaluates a module, as someone would write it with trame or Panel: `slider_servers.py trame STUDY`.

Both call what the explorer calls (`Engine.answer`), in their own process. The first line printed is the address.
"""

from __future__ import annotations

import socket
import sys
import threading
from collections.abc import Callable
from pathlib import Path

from tvimdesign.base.units import from_si
from tvimdesign.explore.engine import Engine
from tvimdesign.explore.source import open_source
from tvimdesign.explore.state import State
from tvimdesign.study import Range

VARIABLE = "pcl_thickness"
STEPS = 100
"""Of the slider, from one end of the variable's range to the other."""


class Module:
    """The study's module as a function of the slider."""

    def __init__(self, study: Path) -> None:
        """Evaluate once, and wait until the kernels are compiled."""
        self._source = open_source(study)
        self._engine = Engine(self._source.tree)
        vary, self.unit = self._source.study.vary[VARIABLE], self._source.study.table.unit(VARIABLE)
        assert isinstance(vary, Range)
        self.low, self.high = (from_si(end, self.unit) for end in (vary.lower, vary.upper))
        self.lock = threading.Lock()
        self.text(0.5 * (self.low + self.high))
        self._engine.wait()

    def text(self, value: float) -> str:
        """Return the text of an answer: violated limits and all values."""
        state = State(way="evaluate", at={**self._source.first.at, VARIABLE: f"{value:.7g} {self.unit}"})
        with self.lock:
            shown = self._engine.answer(state, "quick").shown
        violated = sum(check["stands"] == "violated" for check in shown["limits"])
        return f"{value:.7g}: {violated} violated; {shown['values']}"


def trame(module: Module, port: int) -> None:
    """Serve a range input bound to a state variable; a change computes the text."""
    from trame.app import get_server
    from trame.ui.html import DivLayout
    from trame.widgets import html

    server = get_server(client_type="vue3")
    middle = 0.5 * (module.low + module.high)
    server.state.x, server.state.answer = middle, module.text(middle)

    @server.state.change("x")
    def move(x: str, **_: object) -> None:
        server.state.answer = module.text(float(x))

    with DivLayout(server):
        html.Input(
            type="range", v_model=("x",), min=module.low, max=module.high, step=(module.high - module.low) / STEPS
        )
        html.Div("{{ answer }}", id="answer")
    server.start(port=port, open_browser=False, show_connection_info=False)


def panel(module: Module, port: int) -> None:
    """Serve a slider bound to a function whose text is shown."""
    import panel

    def page() -> object:
        middle, step = 0.5 * (module.low + module.high), (module.high - module.low) / STEPS
        slider = panel.widgets.FloatSlider(start=module.low, end=module.high, step=step, value=middle)
        shown = panel.bind(lambda x: f'<div id="answer">{module.text(x)}</div>', slider)
        return panel.Column(slider, panel.pane.HTML(shown))

    panel.serve(page, port=port, show=False, verbose=False)


def free_port() -> int:
    """Return a free port."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return int(listener.getsockname()[1])


SERVERS: dict[str, Callable[[Module, int], None]] = {"trame": trame, "panel": panel}

if __name__ == "__main__":
    library, study_file = sys.argv[1:]
    module_of_study, at_port = Module(Path(study_file)), free_port()
    print(f"http://127.0.0.1:{at_port}/", flush=True)
    SERVERS[library](module_of_study, at_port)
