"""Every error that traffic raises on purpose; each message is for the person who must act."""

from collections.abc import Sequence
from pathlib import Path

__all__ = [
    "ExperimentError",
    "ExplanationError",
    "LineError",
    "NetworkBuildError",
    "RecordingError",
    "RegressionError",
    "ReplayError",
    "RequestError",
    "ResultError",
    "ScenarioError",
    "SimulatorError",
    "TrafficError",
]


class TrafficError(Exception):
    """The root of all errors of traffic."""


class ScenarioError(TrafficError):
    """A scenario is wrong, or there is none of that name.

    Attributes:
        faults: Everything that is wrong, in reading order; each text begins with the place if
            there is one, as `file:line:column`, and ends with the line in question.
    """

    def __init__(self, *faults: str) -> None:
        super().__init__("\n".join(faults))
        self.faults: tuple[str, ...] = faults


class SimulatorError(TrafficError):
    """The simulator cannot start, or gave up while it ran.

    Attributes:
        what: What could not be done.
        detail: What the simulator itself said, line by line.
    """

    def __init__(self, what: str, detail: Sequence[str] = ()) -> None:
        super().__init__("\n  ".join([what, *detail]))
        self.what = what
        self.detail = tuple(detail)


class NetworkBuildError(TrafficError):
    """A network cannot be built from plain XML.

    Attributes:
        what: What could not be done.
        detail: What netconvert itself said, line by line.
    """

    def __init__(self, what: str, detail: Sequence[str] = ()) -> None:
        super().__init__("\n  ".join([what, *detail]))
        self.what = what
        self.detail = tuple(detail)


class RecordingError(TrafficError):
    """Recorded poses are missing, incomplete, or out of order."""

    def __init__(self, path: Path, fault: str) -> None:
        super().__init__(f"{path}: {fault}")
        self.path = path
        self.fault = fault


class ReplayError(TrafficError):
    """A recording of a run cannot be replayed, or not as it was asked for."""

    def __init__(self, path: Path, fault: str) -> None:
        super().__init__(f"{path}: {fault}")
        self.path = path
        self.fault = fault


class ResultError(TrafficError):
    """A folder of results cannot be written or read."""


class ExplanationError(TrafficError):
    """What was recognised cannot be explained."""


class LineError(TrafficError):
    """Something that was recorded line by line cannot be read, or is not as it should be.

    Attributes:
        place: Where, as `file:line:column`, as far as that is known.
    """

    def __init__(self, place: str, expected: str, found: str) -> None:
        super().__init__(f"{place}: expected {expected}, found {found}")
        self.place = place


class ExperimentError(TrafficError):
    """An experiment is wrong, cannot be conducted, or its folder cannot be written or read.

    Attributes:
        faults: Everything that is wrong, a text for each; it begins with the place if there is
            one.
    """

    def __init__(self, *faults: str) -> None:
        super().__init__("\n".join(faults))
        self.faults: tuple[str, ...] = faults


class RegressionError(TrafficError):
    """What a regression suite says of its recordings is wrong.

    Attributes:
        faults: Everything that is wrong, a text for each, which begins with the place.
    """

    def __init__(self, *faults: str) -> None:
        super().__init__("\n".join(faults))
        self.faults: tuple[str, ...] = faults


class RequestError(TrafficError):
    """What was asked for on the command line is impossible."""

    def __init__(self, option: str, expected: str, found: object) -> None:
        super().__init__(f"{option}: expected {expected}, found {str(found)!r}")
        self.option = option
