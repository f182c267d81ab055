"""Every error that perception raises on purpose.

What an image lacks (a car that no camera sees, a blob that cannot be followed) is not an error;
it is absent from the percepts.
"""

__all__ = ["CalibrationError", "PerceptionError"]


class PerceptionError(Exception):
    """The root of all errors of perception."""


class CalibrationError(PerceptionError):
    """A camera is described by figures that no overhead camera can have."""

    def __init__(self, quantity: str, expected: str, found: object) -> None:
        super().__init__(f"{quantity} must be {expected}, found {found}")
        self.quantity = quantity
