"""Every error that the chronicle package raises on purpose.

All of them are faults of a text that a person wrote. What the world does (a late event, a partial
instance that dies) is not an error; see `chronicles.recognition`.
"""

from collections.abc import Sequence

from dyknow.errors import SpecificationError
from dyknow.source_text import Span, did_you_mean, nearest_are, nearest_name

__all__ = [
    "ChronicleError",
    "ChronicleSyntaxError",
    "InconsistentConstraintsError",
    "RecursionInChroniclesError",
    "UnboundInstantError",
    "UnboundVariableError",
    "UngroundedAttributeError",
    "UnknownParameterError",
    "ValueOutsideDomainError",
]


class ChronicleError(SpecificationError):
    """The root of the faults that only chronicles can have."""


class ChronicleSyntaxError(ChronicleError):
    """A chronicle file does not follow the grammar."""


class InconsistentConstraintsError(ChronicleError):
    """The temporal constraints of a chronicle contradict each other."""

    def __init__(self, chronicle: str, contradictory: Sequence[str], span: Span) -> None:
        listed = "; ".join(contradictory)
        super().__init__(f"chronicle '{chronicle}' can never be recognised: {listed}", span)
        self.contradictory = tuple(contradictory)


class RecursionInChroniclesError(ChronicleError):
    """A chronicle is made of itself, or a named constraint is."""

    def __init__(self, names: Sequence[str], span: Span) -> None:
        super().__init__(f"'{names[0]}' is made of itself: {' -> '.join(names)}", span)


class UnboundInstantError(ChronicleError):
    """An instant is used that is the time of no event of its chronicle."""

    def __init__(self, instant: str, span: Span, nearest: str | None = None) -> None:
        hint = did_you_mean(nearest)
        super().__init__(f"instant '{instant}' is the time of no event{hint}", span)


class UnboundVariableError(ChronicleError):
    """A variable is used that no event of its chronicle binds."""

    def __init__(self, variable: str, span: Span, nearest: str | None = None) -> None:
        hint = did_you_mean(nearest)
        super().__init__(f"variable '{variable}' is bound by no event{hint}", span)


class UngroundedAttributeError(ChronicleError):
    """No stream gives the values of an attribute."""

    def __init__(self, attribute: str, expected: str, nearest: Sequence[str], span: Span) -> None:
        message = f"no stream for the attribute '{attribute}': expected {expected}"
        super().__init__(message + nearest_are(nearest), span)
        self.attribute = attribute
        self.nearest = tuple(nearest)


class UnknownParameterError(ChronicleError):
    """A value is given to a parameter that the file does not have."""

    def __init__(self, name: str, file: str, known: Sequence[str], span: Span) -> None:
        hint = did_you_mean(nearest_name(name, known))
        there = f"it has {', '.join(known)}" if known else "it has none"
        super().__init__(f"'{file}' has no parameter '{name}'{hint} ({there})", span)
        self.name = name


class ValueOutsideDomainError(ChronicleError):
    """A value is used where its domain does not allow it."""

    def __init__(self, value: str, place: str, span: Span, nearest: str | None = None) -> None:
        hint = did_you_mean(nearest)
        super().__init__(f"'{value}' is not in the domain of {place}{hint}", span)
