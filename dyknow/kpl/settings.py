"""From the settings of a computational unit, as written, to keyword arguments of its factory.

What a setting may be is read from the factory's signature: a parameter annotated `Duration`,
`float`, `int`, `str` or `bool` (or one of these or None) is checked; any other takes what comes.
A bare number is milliseconds where a `Duration` is wanted. Settings that the factory does not name
go into its `**others`; if these are annotated `Setting`, it gets them as they are written.
"""

import inspect
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, get_args

from dyknow.errors import (
    DuplicateNameError,
    SortMismatchError,
    SpecificationError,
    UnknownNameError,
)
from dyknow.kpl.parameters import kind_of
from dyknow.kpl.syntax import Name, Number, Setting, Text, Time, Truth, Value, Values
from dyknow.source_text import Span, nearest_name
from dyknow.time import Duration, TimePoint, milliseconds

__all__ = ["arguments_from", "plain_value", "repeated_settings", "setting_faults"]

_KINDS: dict[Any, tuple[str, tuple[type[Value], ...]]] = {
    Duration: ("time", (Time, Number)),
    TimePoint: ("time", (Time, Number)),
    float: ("number", (Number,)),
    int: ("whole number", (Number,)),
    str: ("name", (Name, Text)),
    bool: ("truth value", (Truth,)),
}


def plain_value(value: Value) -> Any:
    """Return a value as Python knows it: times in nanoseconds, lists as tuples."""
    match value:
        case Number(number):
            return number
        case Time(time):
            return time
        case Text(text) | Name(text):
            return text
        case Truth(truth):
            return truth
        case Values(values):
            return tuple(plain_value(each) for each in values)


def arguments_from(settings: Iterable[Setting], factory: Callable[..., Any]) -> dict[str, Any]:
    """Return the keyword arguments that *settings*, which have no faults, are for *factory*."""
    wanted = _parameters(factory)
    known = {name: each for name, each in wanted.items() if _is_setting(each)}
    as_written = any(_takes_as_written(each) for each in wanted.values())
    return {
        each.name: each
        if as_written and each.name not in known
        else _argument(each.value, known.get(each.name))
        for each in settings
    }


def repeated_settings(settings: Sequence[Setting]) -> Iterator[SpecificationError]:
    """Yield a fault for each setting that is given a second time."""
    first: dict[str, Span] = {}
    for setting in settings:
        if setting.name in first:
            name = setting.name
            yield DuplicateNameError("setting", name, setting.span, first[name])
        first.setdefault(setting.name, setting.span)


def setting_faults(
    unit: Name, settings: Sequence[Setting], factory: Callable[..., Any]
) -> Iterator[SpecificationError]:
    """Yield what is wrong with *settings*, given what makes the unit: unknown, unfit, missing."""
    wanted = _parameters(factory)
    takes_all = any(each.kind is each.VAR_KEYWORD for each in wanted.values())
    known = [name for name, each in wanted.items() if _is_setting(each)]
    for setting in settings:
        if setting.name in known:
            yield from _unfit(setting, wanted[setting.name])
        elif not takes_all:
            kind = f"setting of '{unit.text}'"
            yield UnknownNameError(
                kind, setting.name, setting.span, nearest_name(setting.name, known)
            )
    given = {setting.name for setting in settings}
    for name in known:
        if name not in given and wanted[name].default is inspect.Parameter.empty:
            message = f"'{unit.text}' needs the setting '{name}'"
            yield SpecificationError(message, unit.span)


def _parameters(factory: Callable[..., Any]) -> dict[str, inspect.Parameter]:
    return dict(inspect.signature(factory).parameters)


def _is_setting(parameter: inspect.Parameter) -> bool:
    return parameter.kind in (parameter.POSITIONAL_OR_KEYWORD, parameter.KEYWORD_ONLY)


def _takes_as_written(parameter: inspect.Parameter) -> bool:
    return parameter.kind is parameter.VAR_KEYWORD and parameter.annotation is Setting


def _annotations(parameter: inspect.Parameter | None) -> tuple[Any, ...]:
    if parameter is None:
        return ()
    alternatives = get_args(parameter.annotation) or (parameter.annotation,)
    return tuple(each for each in alternatives if each is not type(None))


def _unfit(setting: Setting, parameter: inspect.Parameter) -> Iterator[SpecificationError]:
    annotations = _annotations(parameter)
    if not annotations or not all(_is_known(each) for each in annotations):
        return
    allowed = {kind for each in annotations for kind in _KINDS[each][1]}
    must_be_whole = int in annotations and float not in annotations
    if type(setting.value) not in allowed or (must_be_whole and _is_fraction(setting.value)):
        expected = " or ".join(dict.fromkeys(_KINDS[each][0] for each in annotations))
        what = f"the setting '{setting.name}'"
        found = kind_of(setting.value)
        yield SortMismatchError(what, expected, found, setting.value.span)


def _argument(value: Value, parameter: inspect.Parameter | None) -> Any:
    annotations = _annotations(parameter)
    if isinstance(value, Number) and (Duration in annotations or TimePoint in annotations):
        return milliseconds(value.value)
    if isinstance(value, Number) and float in annotations:
        return float(value.value)
    return plain_value(value)


def _is_fraction(value: Value) -> bool:
    return isinstance(value, Number) and isinstance(value.value, float)


def _is_known(annotation: Any) -> bool:
    return any(annotation is known for known in _KINDS)
