"""The kinds of values that scenario files hold, each with what is possible and how it is read."""

from typing import Annotated

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationInfo,
)

from dyknow.time import MILLISECOND, Duration, duration_from_text

__all__ = [
    "AnyDuration",
    "Distances",
    "DurationRange",
    "LongDuration",
    "Option",
    "Point",
    "Range",
    "Rate",
    "Roads",
    "Settings",
    "Speeds",
    "StepLength",
    "TypeWeights",
    "Weight",
    "ordered",
]

_Size = Annotated[float, Field(gt=0, le=100)]
_Distance = Annotated[float, Field(ge=0, le=100_000)]
_Speed = Annotated[float, Field(ge=0, le=100)]


class Settings(BaseModel):
    """A table of the file: unknown keys are faults, values never change."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def _duration(value: object, info: ValidationInfo) -> object:
    """Read a duration as people write it in files; in Python it is in nanoseconds already."""
    if info.context is None:
        return value
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise ValueError("expected a duration such as '60 s'")  # noqa: TRY004, pydantic wants it
    return duration_from_text(str(value))


def _duration_range(value: object) -> object:
    match value:
        case [_, _]:
            return value
        case str() | int() | float():
            return value, value
        case _:
            raise ValueError(f"expected a duration, or [shortest, longest], found {value!r}")


def _shorter_first(value: tuple[Duration, Duration]) -> tuple[Duration, Duration]:
    if value[0] > value[1]:
        raise ValueError("expected the shorter duration first")
    return value


def _range(value: object) -> object:
    if _is_number(value):
        return value, value
    return _pair(value, "a number, or [smallest, largest]")


def _point(value: object) -> object:
    return value if isinstance(value, str) else _pair(value, "the name of a junction, or [x, y]")


def _pair(value: object, expected: str) -> object:
    match value:
        case [x, y] if _is_number(x) and _is_number(y):
            return value
        case _:
            raise ValueError(f"expected {expected}, found {value!r}")


def _option(value: object) -> object:
    if isinstance(value, str | bool | int | float):
        return value
    raise ValueError(f"expected a text, a number, true or false, found {value!r}")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def ordered(value: tuple[float, float]) -> tuple[float, float]:
    """Return *value*; a range whose larger number stands first is a fault."""
    if value[0] > value[1]:
        raise ValueError(f"expected the smaller number first, in {list(value)}")
    return value


AnyDuration = Annotated[Duration, BeforeValidator(_duration), Field(ge=0)]
"""A text such as `"60 s"`, or milliseconds."""

LongDuration = Annotated[Duration, BeforeValidator(_duration), Field(gt=0)]
"""A duration that is not nothing."""

StepLength = Annotated[
    Duration, BeforeValidator(_duration), Field(ge=MILLISECOND, multiple_of=MILLISECOND)
]
"""A duration of whole milliseconds, which is what the simulator can do."""

DurationRange = Annotated[
    tuple[AnyDuration, AnyDuration],
    BeforeValidator(_duration_range),
    AfterValidator(_shorter_first),
]
"""A duration, or the shortest and the longest of durations drawn evenly."""

Range = Annotated[tuple[_Size, _Size], BeforeValidator(_range)]
"""A number, or the smallest and the largest of numbers drawn evenly; at most 100 of any unit."""

Distances = Annotated[
    tuple[_Distance, _Distance], BeforeValidator(_range), AfterValidator(ordered)
]
"""Metres: a number, or the smallest and the largest of numbers drawn evenly; 0 and more."""

Speeds = Annotated[tuple[_Speed, _Speed], BeforeValidator(_range), AfterValidator(ordered)]
"""m/s: a number, or the smallest and the largest of numbers drawn evenly; 0 to 100."""

Point = Annotated[str | tuple[float, float], BeforeValidator(_point)]
"""The name of a junction, or x and y in the world frame, metres."""

Rate = Annotated[float, Field(gt=0, le=100_000)]
"""Mean number in an hour."""

Weight = Annotated[float, Field(ge=0, le=1e6)]
"""A share, compared with other shares."""

TypeWeights = Annotated[dict[str, Annotated[float, Field(gt=0, le=1e6)]], Field(min_length=1)]
"""The weight of each vehicle type, by its name."""

Roads = Annotated[tuple[str, ...], Field(min_length=1)]
"""Roads from the first to the last; between two that do not touch, the fastest way."""

Option = Annotated[str | bool | int | float, BeforeValidator(_option)]
"""The value of an option of the simulator."""
