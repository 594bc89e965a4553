"""The module as a CadQuery script: what draws its parts, recorded step by step, with the numbers by name at the top.

A kernel that records takes the place of CadQuery's: it writes each body that is drawn, cut or joined as a line. The
dimensions it is given are floats that know their names, so that most arguments are written as expressions of them.
"""

from __future__ import annotations

import inspect
import sys
import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import cadquery as cq

from tvimdesign.cad.assembly.assembly import MODULES
from tvimdesign.cad.geometry import exact_kernel
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.exact_kernel import ExactKernel
from tvimdesign.cad.geometry.solids import drawn_by
from tvimdesign.device import table_for
from tvimdesign.study import Design

_WIDTH = 116
_LONG = 80
_OPERATORS = {"__add__": "+", "__sub__": "-", "__mul__": "*", "__truediv__": "/", "__pow__": "**"}
_TRIVIAL = 1e-12  # Size that is zero but for rounding


class Named(float):
    """A float that knows by what expression of named numbers it came about."""

    expression: str

    def __new__(cls, value: float, expression: str) -> Named:
        """`expression` is Python that has this value."""
        number = super().__new__(cls, value)
        number.expression = expression
        return number

    def __neg__(self) -> Named:
        return Named(-float(self), f"-{_operand(self)}")


def _operand(value: float) -> str:
    """Return a number as it stands beside an operator."""
    text = value.expression if isinstance(value, Named) else _literal(value)
    return text if text.isidentifier() or not isinstance(value, Named) else f"({text})"


def _literal(value: float) -> str:
    """Return a number with the digits that CAD needs."""
    return f"{0.0 if abs(value) < _TRIVIAL else float(value):.12g}"


def _operator(name: str, sign: str, *, reflected: bool) -> Callable[[Named, float], Any]:
    compute = getattr(float, name)

    def operate(self: Named, other: float) -> Any:
        first, second = (other, self) if reflected else (self, other)
        value = compute(float(first), float(second))
        if sign == "*" and 1.0 in (float(first), float(second)):
            return second if float(first) == 1.0 else first
        if abs(value) < _TRIVIAL:
            return 0.0
        return Named(value, f"{_operand(first)} {sign} {_operand(second)}") if isinstance(value, float) else value

    return operate


for _name, _sign in _OPERATORS.items():
    setattr(Named, _name, _operator(_name, _sign, reflected=False))
    setattr(Named, f"__r{_name[2:]}", _operator(_name, _sign, reflected=True))


class _NamedDimensions(Dimensions):
    """Dimensions whose values know their names, and which have been read."""

    def __init__(self, dims: Dimensions) -> None:
        super().__init__(dims.mode, dims.by_name)
        self._read: dict[str, float] = {}

    @property
    def read(self) -> Mapping[str, float]:
        """The dimensions that were read, in their order."""
        return self._read

    def __getattr__(self, name: str) -> float:
        value = super().__getattr__(name)
        plain = name.replace(".", "_")
        self._read[plain] = value
        return Named(value, plain)


class _Recorded:
    """A body of the script: the name of its variable, and where it has been moved to since."""

    def __init__(self, recorder: _Recorder, name: str, location: cq.Location | None = None) -> None:
        self.recorder, self.name, self.location = recorder, name, location

    @property
    def text(self) -> str:
        """The body as it is written where it is used."""
        return f"{self.name}.moved({_location(self.location)})" if self.location is not None else self.name

    def moved(self, location: cq.Location) -> _Recorded:
        """Return it at another place."""
        return _Recorded(self.recorder, self.name, location if self.location is None else location * self.location)

    def cut(self, *others: _Recorded) -> _Recorded:
        """Return it less others."""
        return self.recorder.line("cut", f"{self.text}.cut", others) if others else self

    def fuse(self, *others: _Recorded) -> _Recorded:
        """Return it with others."""
        return self.recorder.line("joined", f"{self.text}.fuse", others) if others else self

    def clean(self) -> _Recorded:
        """Return it without seams."""
        return self.recorder.line("clean", f"{self.text}.clean", ())


def _location(location: cq.Location) -> str:
    shift, turn = location.toTuple()
    numbers = [0.0 if abs(value) < _TRIVIAL else value for value in (*shift, *turn)]
    return f"cq.Location({', '.join(_text(value) for value in numbers)})"


def _text(value: Any) -> str:
    if isinstance(value, _Recorded):
        return value.text
    if isinstance(value, Named):
        return value.expression
    if isinstance(value, tuple | list):
        inside = ", ".join(map(_text, value))
        if isinstance(value, list):
            return f"[{inside}]" if len(inside) < _LONG else _rows(value)
        return f"({inside},)" if len(value) == 1 else f"({inside})"
    return _literal(value) if isinstance(value, float | int) else repr(value)


def _rows(values: Sequence[Any]) -> str:
    """Return a list with a line for each of its entries."""
    return "\n".join(["[", *(f"            {_text(value)}," for value in values), "        ]"])


class _Recorder:
    """Kernel that writes what it is asked to draw as lines of Python."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self._counts: dict[str, int] = {}
        self._drawn_by = ""
        self._known: dict[tuple[str, ...], str] = {}

    def __getattr__(self, name: str) -> Callable[..., _Recorded]:
        """Return what writes a line for a body that `ExactKernel` draws."""
        if not hasattr(ExactKernel, name):
            raise AttributeError(name)
        return lambda *arguments: self.line(name, f"draw.{name}", arguments)

    def line(self, what: str, call: str, arguments: Sequence[Any]) -> _Recorded:
        """Write a call, its result under a name of its own; a comment where another function begins to draw."""
        texts = [_text(argument) for argument in arguments]
        if known := self._known.get((call, *texts)):
            return _Recorded(self, known)
        self._comment()
        self._counts[what] = self._counts.get(what, 0) + 1
        name = self._known[(call, *texts)] = f"{what}_{self._counts[what]}"
        short = f"    {name} = {call}({', '.join(texts)})"
        if len(short) > _WIDTH:
            short = "\n".join([f"    {name} = {call}(", *(f"        {text}," for text in texts), "    )"])
        self.lines.append(short)
        return _Recorded(self, name)

    def _comment(self) -> None:
        frame = sys._getframe(2)
        while frame.f_globals["__name__"] in (__name__, "tvimdesign.cad.geometry.solids") and frame.f_back:
            frame = frame.f_back
        function = frame.f_globals.get(frame.f_code.co_name)
        if frame.f_code.co_name != self._drawn_by:
            self._drawn_by = frame.f_code.co_name
            about = " ".join((inspect.getdoc(function) or "").split("\n\n")[0].split())
            self.lines += [f"    # {line}" for line in textwrap.wrap(about, _WIDTH - len("    # "))]


def module_script(design: Design, dims: Dimensions) -> bytes:
    """Return the script of a module's parts, which draws their solids with CadQuery alone."""
    named, parts = _NamedDimensions(dims), MODULES[dims.mode]
    functions, drawn = [], {}
    for kind, draw in parts.drawn(dims).items():
        recorder: Any = _Recorder()  # it answers for the kernel
        with drawn_by(recorder):
            solid: Any = draw(named)
        functions.append(_function(kind, recorder.lines, solid.text))
        drawn[kind] = _Recorded(recorder, kind)
    placed: Mapping[str, Any] = parts.stand(named, drawn)
    places = [
        f'    "{name}": ("{body.name}", {_location(body.location) if body.location is not None else "cq.Location()"}),'
        for name, body in placed.items()
    ]
    listed = [f'    "{kind}": {kind},' for kind in drawn]
    head = _template("head").format(title=design.name.replace('"', "'")) + "\n".join(_numbers(design.mode, named.read))
    parts_listed = ["PARTS = {", *listed, "}", '"""Functions that draw a part, by kind."""']
    places_listed = ["PLACES = {", *places, "}", '"""Kind and place of each part of the module, but of springs."""']
    lines = [head, "", "", _kernel_source(), *functions, "", *parts_listed, "", *places_listed]
    return "\n".join(lines).encode() + _template("tail").encode()


def _template(end: str) -> str:
    """Return how a script begins, or ends."""
    return Path(__file__).with_name(f"module_script_{end}.txt").read_text(encoding="utf-8")


def _numbers(mode: str, read: Mapping[str, float]) -> list[str]:
    """Return a line for each number, with its description where the table has one."""
    table = table_for(mode)
    about = {row.name: f"  # {row.description}" for row in table.inputs}
    about |= {row.name: f"  # {row.description}" for row in table.outputs}
    return [f"{name} = {_literal(value)}{about.get(name, '')}" for name, value in read.items()]


def _function(kind: str, lines: Sequence[str], result: str) -> str:
    about = f'    """Draw the part {kind.replace("_", " ")}."""'
    return "\n".join(["", "", f"def {kind}() -> cq.Shape:", about, *lines, f"    return solid_of({result})"])


def _kernel_source() -> str:
    """Return the source of CadQuery's kernel, by which the parts are drawn."""
    constants = [f"{name} = {getattr(exact_kernel, name)!r}" for name in ("_UPRIGHT", "_LINE")]
    pieces = [inspect.getsource(piece) for piece in (ExactKernel, exact_kernel._wire, exact_kernel._edge)]
    helper = '''def solid_of(shape: cq.Shape) -> cq.Solid:
    """Return the one solid of a shape."""
    return shape.Solids()[0]
'''
    return "\n".join([
        "# --- how bodies are drawn ---", "", "_UP = cq.Vector(0, 0, 1)", *constants, "", "",
        "\n\n".join([*pieces, helper]), "", "draw = ExactKernel()", "", "# --- parts ---",
    ])  # fmt: skip
