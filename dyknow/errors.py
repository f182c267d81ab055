"""Every error that dyknow raises on purpose.

What the world does (a late sample, a missing value, an undecided formula) is not an error but a
value in a stream; see `dyknow.streams`.
"""

from collections.abc import Sequence

from dyknow.source_text import Span
from dyknow.time import TimePoint, text_from_duration

__all__ = [
    "ArityError",
    "CircularDefinitionError",
    "DuplicateNameError",
    "DyKnowError",
    "FeatureError",
    "FormulaSyntaxError",
    "KPLSyntaxError",
    "PolicyError",
    "ProcessError",
    "SortMismatchError",
    "SpecificationError",
    "SpecificationErrors",
    "UnknownNameError",
]


class DyKnowError(Exception):
    """The root of all errors of dyknow."""


class SpecificationError(DyKnowError):
    """A text that a person wrote is wrong at a known place."""

    def __init__(self, message: str, span: Span) -> None:
        super().__init__(message)
        self.message = message
        self.span = span

    def report(self) -> str:
        """Return the place, the message, and the line in question with carets under it."""
        return f"{self.span.place}: {self.message}\n{self.span.excerpt()}"


class KPLSyntaxError(SpecificationError):
    """A KPL specification does not follow the grammar."""


class FormulaSyntaxError(SpecificationError):
    """A formula does not follow the grammar."""


class UnknownNameError(SpecificationError):
    """A name is used that nothing declares."""

    def __init__(self, kind: str, name: str, span: Span, nearest: str | None = None) -> None:
        hint = f"; did you mean '{nearest}'?" if nearest else ""
        super().__init__(f"no {kind} called '{name}'{hint}", span)


class DuplicateNameError(SpecificationError):
    """A name is declared more than once."""

    def __init__(self, kind: str, name: str, span: Span, first: Span) -> None:
        super().__init__(f"{kind} '{name}' is already declared at {first.place}", span)


class SortMismatchError(SpecificationError):
    """A value of one sort stands where another is expected."""

    def __init__(self, what: str, expected: str, found: str, span: Span) -> None:
        super().__init__(f"{what} must be of sort '{expected}', found '{found}'", span)


class ArityError(SpecificationError):
    """Too few or too many arguments."""

    def __init__(self, name: str, expected: int, found: int, span: Span) -> None:
        super().__init__(f"'{name}' takes {expected} argument(s), found {found}", span)


class CircularDefinitionError(SpecificationError):
    """A stream generator depends on itself."""

    def __init__(self, labels: Sequence[str], span: Span) -> None:
        super().__init__(f"circular definition: {' -> '.join(labels)}", span)


class PolicyError(SpecificationError):
    """No stream can satisfy the policy."""


class ProcessError(DyKnowError):
    """A knowledge process failed; the cause is attached."""

    def __init__(self, label: str, time: TimePoint) -> None:
        super().__init__(f"process '{label}' failed at {text_from_duration(time)} ms")
        self.label = label
        self.time = time


class FeatureError(DyKnowError):
    """A state lacks a feature that a formula speaks of, or has an unfit value for it."""

    def __init__(self, feature: str, expected: str, found: str) -> None:
        super().__init__(f"feature '{feature}': expected {expected}, found {found}")
        self.feature = feature


class SpecificationErrors(ExceptionGroup[SpecificationError]):
    """Every fault of one text, in reading order."""
