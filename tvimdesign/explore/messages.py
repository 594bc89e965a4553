"""Messages from a page to the server, each checked before it is used."""

from typing import Annotated, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from tvimdesign.base.errors import InputError

MOST_BYTES = 100_000  # Of one message; the longest that a page sends are some hundred
_Name = Annotated[str, Field(min_length=1, max_length=120)]
_Text = Annotated[str, Field(max_length=500)]
Way: TypeAlias = Literal["evaluate", "optimize"]


class _Message(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class _Change(_Message):
    name: _Name
    final: bool = True
    """Whether the control was let go; what it passes through while it is dragged cannot be undone one by one."""


class SetValue(_Change):
    """An input, a choice, or a value of an operating point, as text with its unit."""

    kind: Literal["set"]
    text: _Text


class SetLimits(_Change):
    """All limits of one required output."""

    kind: Literal["require"]
    texts: Annotated[tuple[_Text, ...], Field(max_length=10, strict=False)]


class SetRange(_Change):
    """The ends of a variable's range."""

    kind: Literal["range"]
    low: _Text
    high: _Text


class SetWeight(_Change):
    """The weight of a minimised output."""

    kind: Literal["weight"]
    text: _Text


class SetWay(_Message):
    """Evaluate the module under the hand, or optimise."""

    kind: Literal["way"]
    way: Way


class Step(_Message):
    """Back or forth in what was done, or all the way back."""

    kind: Literal["undo", "redo", "reset"]


class Pin(_Message):
    """Keep the design that is shown, under a name."""

    kind: Literal["pin"]
    name: Annotated[str, Field(min_length=1, max_length=60)]


class OfPin(_Message):
    """Let a kept design go, or go back to it."""

    kind: Literal["unpin", "recall"]
    number: Annotated[int, Field(ge=0, le=1000)]


class Point(_Message):
    """See a point of the result's front, or a cell of the sweep."""

    kind: Literal["point"]
    number: Annotated[int, Field(ge=0, le=1_000_000_000)]


class Save(_Message):
    """Write the study as a file in the folder of results."""

    kind: Literal["save"]
    file: Annotated[str, Field(min_length=1, max_length=100)]


class Confirm(_Message):
    """Search as `run` does: every start, every listed choice."""

    kind: Literal["confirm"]


class Size(_Message):
    """Size a joint from five numbers, as `tvimdesign size` does."""

    kind: Literal["size"]
    torque: _Text
    stiffness: _Text
    diameter: _Text
    time: _Text
    supply: _Text
    stroke: _Text = ""
    stiff_time: _Text = ""
    process: _Text = ""


class MakeParts(_Message):
    """Make the exact CAD of the design that is shown."""

    kind: Literal["cad"]


Change = SetValue | SetLimits | SetRange | SetWeight
Message = Annotated[
    Change | SetWay | Step | Pin | OfPin | Point | Save | Confirm | Size | MakeParts, Field(discriminator="kind")
]
_MESSAGES: TypeAdapter[Message] = TypeAdapter(Message)


def read_message(text: str) -> Message:
    """Read one message. Raises InputError, naming what is wrong with it."""
    if len(text.encode()) > MOST_BYTES:
        raise InputError(f"message: more than {MOST_BYTES} bytes")
    try:
        return _MESSAGES.validate_json(text)
    except ValidationError as error:
        faults = (f"{'.'.join(map(str, fault['loc'])) or 'message'}: {fault['msg']}" for fault in error.errors()[:5])
        raise InputError(f"message: {'; '.join(faults)}") from None
