"""What happens when a process fails, and what is told about it."""

from dataclasses import dataclass
from enum import Enum
from typing import Any

from dyknow.runtime.names import Label
from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.time import TimePoint, text_from_duration

__all__ = ["Failure", "OnFailure"]


class OnFailure(Enum):
    """What a network does when a process of it fails."""

    STOP = "stop"
    """The run ends with a `ProcessError`."""

    END = "end"
    """The process ends, and the rest of the network goes on."""


@dataclass(frozen=True, slots=True)
class Failure:
    """A process raised an error.

    Attributes:
        label: The label of its stream generator.
        time: The instant at which it failed.
        inputs: The label of each input stream and the sample it was called with, which is
            `NO_SAMPLE` for a stream that had none; empty for a source.
        error: What it raised, with its own traceback.
    """

    label: Label
    time: TimePoint
    inputs: tuple[tuple[Label, Sample[Any]], ...]
    error: Exception

    @property
    def text(self) -> str:
        """The error and the samples that led to it, in one line."""
        error = f"{type(self.error).__name__}: {self.error}".removesuffix(": ")
        if not self.inputs:
            return error
        return f"{error}, given {', '.join(map(_input_text, self.inputs))}"


def _input_text(given: tuple[Label, Sample[Any]]) -> str:
    label, sample = given
    if sample is NO_SAMPLE:
        return f"no sample of '{label}'"
    valid, available = (text_from_duration(t) for t in (sample.valid_time, sample.available_time))
    return f"'{label}' valid at {valid}, available at {available}"
