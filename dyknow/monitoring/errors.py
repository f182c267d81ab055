"""What can be wrong with a formula over streams."""

from collections.abc import Sequence

from dyknow.errors import DyKnowError, ServiceError, SpecificationError
from dyknow.source_text import Span, did_you_mean, nearest_are
from dyknow.streams.policy import Violation
from dyknow.time import text_from_duration

__all__ = [
    "EvaluationAlreadyExistsError",
    "EvaluationEndedError",
    "NoFeaturesError",
    "NoSuchEvaluationError",
    "UngroundedFeatureError",
]


class UngroundedFeatureError(SpecificationError):
    """No stream gives the values of a feature."""

    def __init__(self, feature: str, expected: str, nearest: Sequence[str], span: Span) -> None:
        message = f"no stream for the feature '{feature}': expected {expected}"
        super().__init__(message + nearest_are(nearest), span)
        self.feature = feature
        self.nearest = tuple(nearest)


class NoFeaturesError(DyKnowError):
    """A formula speaks of no feature, so that no stream says when it is to be evaluated.

    Attributes:
        left: What is left of the formulas, once all is decided that constants decide.
    """

    def __init__(self, name: str, left: Sequence[str]) -> None:
        comes_to = " and ".join(f"'{text}'" for text in left)
        super().__init__(
            f"'{name}' comes to {comes_to}: expected a feature, whose stream says when there are "
            f"states"
        )
        self.left = tuple(left)


class EvaluationAlreadyExistsError(ServiceError):
    """Something is being evaluated under this name already."""

    def __init__(self, name: str) -> None:
        super().__init__(f"'{name}' is being evaluated already")


class NoSuchEvaluationError(ServiceError):
    """Nothing is being evaluated under this name."""

    def __init__(self, name: str, nearest: str | None) -> None:
        hint = did_you_mean(nearest)
        super().__init__(f"nothing called '{name}' is being evaluated{hint}")


class EvaluationEndedError(DyKnowError):
    """A formula cannot be evaluated any further, since states are missing.

    Attributes:
        violation: What was violated.
    """

    def __init__(self, name: str, violation: Violation) -> None:
        at = text_from_duration(violation.valid_time)
        super().__init__(f"the evaluation of '{name}' ended at {at} ms: {violation.reason}")
        self.violation = violation
