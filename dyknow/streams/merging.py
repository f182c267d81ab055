"""Several streams into one that has every sample of each.

`merge` is an operation of the stream specification language of Heintz, *Semantically Grounded
Stream Reasoning Integrated with ROS*, section III. There the order of samples that become
available at exactly the same time is left open; here it is that of the inputs.
"""

from typing import Any

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = ["Merge"]


class Merge(Reactive):
    """Emits every sample of every input as soon as it is available.

    Values and valid times stay as they are. Samples that become available at one instant follow
    each other in the order of the inputs and keep available times of their own, a nanosecond
    apart. What the merged stream must look like (order, delay, duration, change) is up to the
    policy under which it is received.
    """

    def __init__(self, n_inputs: int) -> None:
        if n_inputs < 1:
            raise ValueError(f"a merge needs at least one input, found {n_inputs}")
        self._last = TimePoint(-1)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[Any]]:
        """Emit the new samples among *inputs*."""
        return [self._at(now, sample) for sample in inputs if sample.available_time == now]

    def _at(self, now: TimePoint, sample: Sample[Any]) -> Sample[Any]:
        """Return *sample* with an available time after all others."""
        if self._last < now:
            self._last = now
            return sample
        self._last = TimePoint(self._last + 1)
        return Sample(sample.value, sample.valid_time, self._last)
