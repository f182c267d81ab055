"""Every error that dyknow raises on purpose.

What the world does (a late sample, a missing value, an undecided formula) is not an error but a
value in a stream; see `dyknow.streams`.
"""

from collections.abc import Collection, Sequence

from dyknow.source_text import Span, did_you_mean
from dyknow.time import TimePoint, text_from_duration

__all__ = [
    "ArityError",
    "CircularDefinitionError",
    "DuplicateNameError",
    "DyKnowError",
    "FeatureError",
    "FormulaSyntaxError",
    "KPLSyntaxError",
    "LabelAlreadyExistsError",
    "LabelInUseError",
    "NoSuchLabelError",
    "NoSuchPrototypeError",
    "PolicyError",
    "PolicyNotSupportedError",
    "ProcessError",
    "PrototypeAlreadyExistsError",
    "ServiceError",
    "SortMismatchError",
    "SpecificationError",
    "SpecificationErrors",
    "StateOrderError",
    "UnknownNameError",
    "ValueNotAvailableError",
    "WrongNumberOfInputsError",
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
        hint = did_you_mean(nearest)
        super().__init__(f"no {kind} called '{name}'{hint}", span)
        self.name = name


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
    """A knowledge process failed; the cause is attached.

    Attributes:
        label: The label of its stream generator.
        time: The instant at which it failed.
        inputs: The label of each input stream and the sample it was called with.
    """

    def __init__(
        self,
        label: str,
        time: TimePoint,
        reason: str = "",
        inputs: Sequence[tuple[str, object]] = (),
    ) -> None:
        because = f": {reason}" if reason else ""
        super().__init__(f"process '{label}' failed at {text_from_duration(time)} ms{because}")
        self.label = label
        self.time = time
        self.inputs = tuple(inputs)


class ServiceError(DyKnowError, ValueError):
    """A request to a running network cannot be met; most are errors of Heintz (2009), 5.3-5.4."""


class LabelAlreadyExistsError(ServiceError):
    """There is a stream generator of this label already."""

    def __init__(self, label: str) -> None:
        super().__init__(f"there is a stream generator called '{label}' already")
        self.label = label


class NoSuchLabelError(ServiceError):
    """There is no stream generator of this label."""

    def __init__(self, label: str, nearest: str | None = None) -> None:
        hint = did_you_mean(nearest)
        super().__init__(f"no stream generator called '{label}'{hint}")
        self.label = label


class LabelInUseError(ServiceError):
    """A process cannot be removed while others receive its streams."""

    def __init__(self, label: str, receivers: Collection[str]) -> None:
        names = ", ".join(f"'{receiver}'" for receiver in receivers)
        super().__init__(f"'{label}' is in use by {names}")
        self.label = label
        self.receivers = tuple(receivers)


class PrototypeAlreadyExistsError(ServiceError):
    """There is a knowledge process prototype of this name already."""

    def __init__(self, name: str) -> None:
        super().__init__(f"there is a prototype called '{name}' already")
        self.name = name


class NoSuchPrototypeError(ServiceError):
    """There is no knowledge process prototype of this name."""

    def __init__(self, name: str, nearest: str | None = None) -> None:
        hint = did_you_mean(nearest)
        super().__init__(f"no prototype called '{name}'{hint}")
        self.name = name


class WrongNumberOfInputsError(ServiceError):
    """A prototype takes another number of input streams than it was given."""

    def __init__(self, name: str, expected: int, found: int) -> None:
        super().__init__(f"prototype '{name}' takes {expected} input stream(s), found {found}")
        self.name = name
        self.expected = expected
        self.found = found


class PolicyNotSupportedError(ServiceError):
    """A stream generator, or its process, cannot keep the policy that it is asked for."""

    def __init__(self, label: str, reason: str) -> None:
        super().__init__(f"'{label}' does not support the policy: {reason}")
        self.label = label
        self.reason = reason


class ValueNotAvailableError(ServiceError):
    """A query asks for a sample that the stream generator does not hold."""

    def __init__(self, label: str, wanted: str) -> None:
        super().__init__(f"'{label}' holds no {wanted}")
        self.label = label


class FeatureError(DyKnowError):
    """A state lacks a feature that a formula speaks of, or has an unfit value for it."""

    def __init__(self, feature: str, expected: str, found: str) -> None:
        super().__init__(f"feature '{feature}': expected {expected}, found {found}")
        self.feature = feature
        self.expected = expected
        self.found = found


class StateOrderError(DyKnowError, ValueError):
    """A state is not later than the one before.

    Attributes:
        time: The time of the state.
        last: The time of the state before.
    """

    def __init__(self, time: TimePoint, last: TimePoint) -> None:
        super().__init__(f"states must be in order of time: {time} ns after {last} ns")
        self.time = time
        self.last = last


class SpecificationErrors(ExceptionGroup[SpecificationError]):
    """Every fault of one text, in reading order."""
