"""Faults of event types: unknown, of the wrong kind, with too many arguments or wrong values."""

from collections.abc import Iterator

from chronicles.declared import Declared, Signal
from chronicles.errors import ChronicleError, ValueOutsideDomainError
from chronicles.syntax import (
    VALUE_VARIABLE,
    AttributeDeclaration,
    Chronicle,
    EventAt,
    EventType,
    MessageDeclaration,
    NoEvent,
    Occurs,
    Parameter,
    Value,
)
from dyknow.errors import ArityError, SpecificationError, UnknownNameError
from dyknow.source_text import Span, nearest_name

__all__ = ["event_type_of", "faults_of_event_type"]


def faults_of_event_type(
    event_type: EventType, declared: Declared
) -> Iterator[SpecificationError]:
    """Yield what is wrong with an event type, given what is *declared*."""
    signal: Signal | None = declared.signals.get(event_type.name)
    signal = signal or declared.chronicles.get(event_type.name)
    if signal is None and not declared.signals:
        return
    if signal is None:
        nearest = nearest_name(event_type.name, [*declared.signals, *declared.chronicles])
        span = event_type.span
        span = Span(span.source, span.start, span.start + len(event_type.name))
        yield UnknownNameError("attribute or message", event_type.name, span, nearest)
        return
    n_expected, n_found = len(signal.parameters), len(event_type.arguments)
    if n_expected != n_found:
        yield ArityError(event_type.name, n_expected, n_found, event_type.span)
    yield from _faults_of_kind(signal, event_type)
    names = [parameter.name for parameter in signal.parameters]
    for parameter, name in zip(event_type.arguments, names, strict=False):
        yield from _faults_of_value(parameter, name, signal, declared)
    if event_type.change and not isinstance(signal, Chronicle):
        for value in (event_type.change.before, event_type.change.after):
            yield from _faults_of_value(value, VALUE_VARIABLE, signal, declared)


def _faults_of_kind(signal: Signal, event_type: EventType) -> Iterator[SpecificationError]:
    if isinstance(signal, AttributeDeclaration) and event_type.change is None:
        message = f"expected ':(from, to)' behind the attribute '{signal.name}'"
        yield ChronicleError(message, event_type.span)
    if isinstance(signal, MessageDeclaration) and event_type.change is not None:
        message = f"'{signal.name}' is a message and has no values ':(from, to)'"
        yield ChronicleError(message, event_type.change.span)


def _faults_of_value(
    parameter: Parameter, name: str, signal: Signal, declared: Declared
) -> Iterator[SpecificationError]:
    if isinstance(parameter, Value) and not declared.allowed(signal, name)(parameter.text):
        nearest = nearest_name(parameter.text, declared.listed(signal, name))
        place = f"'{name}' of '{signal.name}'"
        yield ValueOutsideDomainError(parameter.text, place, parameter.span, nearest)


def event_type_of(statement: object) -> EventType | None:
    """Return the event type of a predicate; None of another statement."""
    return statement.event_type if isinstance(statement, EventAt | NoEvent | Occurs) else None
