"""Streams as text: `"0:a 150:b@180"` is two samples, the second available at 180 ms."""

from collections.abc import Iterable, Iterator
from typing import Any

from dyknow.streams.process import ComputationalUnit
from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.time import MILLISECOND, TimePoint, duration_from_text, text_from_duration

__all__ = ["GivenSource", "ms", "run_unit", "stream", "text"]


def ms(amount: float) -> TimePoint:
    """Return the time-point *amount* milliseconds after the beginning."""
    return TimePoint(round(amount * MILLISECOND))


def stream(notation: str) -> list[Sample[Any]]:
    """Read a stream; times are milliseconds, values are words."""
    return [_sample(word) for word in notation.split()]


def text(samples: Iterable[Sample[Any]]) -> str:
    """Write a stream as `stream` reads it; nanoseconds above whole milliseconds show as `+n`."""
    return " ".join(_word(sample) for sample in samples)


class GivenSource:
    """A source that produces a given stream."""

    def __init__(self, samples: str | list[Sample[Any]]) -> None:
        self._samples = stream(samples) if isinstance(samples, str) else samples

    def samples(self) -> Iterator[Sample[Any]]:
        """Yield the samples."""
        yield from self._samples


def run_unit(
    unit: ComputationalUnit, *inputs: list[Sample[Any]], until: TimePoint, tick: int = 0
) -> list[Sample[Any]]:
    """Apply a unit to finished streams by the definition of the join, one instant after another.

    With *tick*, the unit is also told the time at every multiple of it.
    """
    arrivals = {sample.available_time for stream in inputs for sample in stream}
    ticks = {TimePoint(time) for time in range(0, until + 1, tick)} if tick else set()
    last = [NO_SAMPLE] * len(inputs)
    produced: list[Sample[Any]] = []
    pending = sorted(time for time in arrivals | ticks if time <= until)
    while True:
        due = unit.due()
        times = [*pending[:1], *([due] if due is not None and due <= until else [])]
        if not times:
            return produced
        now = min(times)
        if pending and pending[0] == now:
            pending.pop(0)
        if now in arrivals:
            arrivals.remove(now)
            new = [[s for s in given if s.available_time == now] for given in inputs]
            last = [found[0] if found else old for found, old in zip(new, last, strict=True)]
            produced.extend(unit.push(now, tuple(last)))
        produced.extend(unit.advance(now))


def _sample(word: str) -> Sample[Any]:
    times, _, rest = word.partition(":")
    value, _, available = rest.partition("@")
    valid = TimePoint(duration_from_text(times))
    return Sample(value, valid, TimePoint(duration_from_text(available or times)))


def _word(sample: Sample[Any]) -> str:
    valid = text_from_duration(sample.valid_time)
    word = f"{valid}:{sample.value}"
    if sample.delay == 0:
        return word
    whole, rest = divmod(sample.available_time, MILLISECOND)
    return f"{word}@{whole}+{rest}" if rest else f"{word}@{whole}"
