"""Where a recorded stream differs from the stream that should have been recorded.

Two streams are compared in one pass, so that only what differs is kept in memory. Samples with the
same two times belong together. What is left over is paired by likeness, so that a missing sample,
one too many, an altered value, a changed valid time and a changed available time are told
apart, and one that is missing does not make all later ones look wrong.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from dyknow.judging.judgement import Breach, Definition, Tally
from dyknow.judging.wording import deviation, short, times
from dyknow.streams.sample import Sample
from dyknow.streams.values import are_equal

__all__ = ["Comparison"]

_WINDOW = 128
"""How many samples without a counterpart are kept before they are paired by likeness."""

Likeness = Callable[[Sample[Any], Sample[Any]], bool]


class Comparison:
    """Compares a recorded stream with what is expected, sample by sample.

    Args:
        stream: The topic of the stream, for the breaches.
        definition: What a difference breaks.
        recorded: The samples of the stream in order of available time.
        tally: Takes the breaches.
    """

    def __init__(
        self, stream: str, definition: Definition, recorded: Iterable[Sample[Any]], tally: Tally
    ) -> None:
        self._stream = stream
        self._definition = definition
        self._recorded = iter(recorded)
        self._head = next(self._recorded, None)
        self._before: Sample[Any] | None = None
        self._missing: list[Sample[Any]] = []
        self._extra: list[Sample[Any]] = []
        self._repeated: set[int] = set()
        self._tally = tally

    def expect(self, sample: Sample[Any]) -> None:
        """Take in the next sample that should have been recorded."""
        while self._head is not None and self._head.available_time < sample.available_time:
            self._keep_extra(self._take())
        head = self._head
        if head is None or head.available_time > sample.available_time:
            self._missing.append(sample)
        elif head.valid_time != sample.valid_time:
            self._missing.append(sample)
            self._keep_extra(self._take())
        else:
            self._tally.add(self._between(sample, self._take()))
        if len(self._missing) > _WINDOW:
            self._settle(_WINDOW // 2)

    def finish(self) -> None:
        """Say that nothing more is expected."""
        while self._head is not None:
            self._keep_extra(self._take())
        self._settle(0)

    def _take(self) -> Sample[Any]:
        head = self._head
        assert head is not None  # whoever takes has looked
        self._head = next(self._recorded, None)
        before, self._before = self._before, head
        if before is not None and _has_same_content(before, head):
            self._repeated.add(head.available_time)
        return head

    def _keep_extra(self, sample: Sample[Any]) -> None:
        self._extra.append(sample)
        if len(self._extra) > _WINDOW:
            self._settle(_WINDOW // 2)

    def _settle(self, keep: int) -> None:
        """Pair what has no counterpart; report the pairs, and all that is left but the newest."""
        found: list[Breach] = []
        for is_like in (_is_same, _has_same_content, _has_same_reading, _has_same_valid_time):
            found.extend(self._pair(is_like))
        while len(self._missing) > keep:
            found.append(self._absent(self._missing.pop(0)))
        while len(self._extra) > keep:
            found.append(self._surplus(self._extra.pop(0)))
        found.sort(key=lambda breach: breach.available_time or 0)
        self._tally.add(found)

    def _pair(self, is_like: Likeness) -> Iterator[Breach]:
        lonely: list[Sample[Any]] = []
        for expected in self._missing:
            for at, found in enumerate(self._extra):
                if is_like(expected, found):
                    del self._extra[at]
                    yield from self._between(expected, found)
                    break
            else:
                lonely.append(expected)
        self._missing = lonely

    def _between(self, expected: Sample[Any], found: Sample[Any]) -> Iterator[Breach]:
        """Yield a breach if two samples that belong together differ."""
        wanted, instead = deviation(expected, found)
        if wanted:
            yield self._breach(found, wanted, instead)

    def _absent(self, expected: Sample[Any]) -> Breach:
        wanted = f"a sample {times(expected)}: {short(expected.value)}"
        return self._breach(expected, wanted, "none")

    def _surplus(self, found: Sample[Any]) -> Breach:
        again = ", the same as the one before it" if self._is_repeated(found) else ""
        return self._breach(found, "no such sample", f"{short(found.value)}{again}")

    def _is_repeated(self, found: Sample[Any]) -> bool:
        return found.available_time in self._repeated

    def _breach(self, sample: Sample[Any], expected: str, found: str) -> Breach:
        return Breach.at(self._stream, self._definition, sample, expected, found)


def _is_same(expected: Sample[Any], found: Sample[Any]) -> bool:
    return expected.available_time == found.available_time and _has_same_content(expected, found)


def _has_same_content(expected: Sample[Any], found: Sample[Any]) -> bool:
    return expected.valid_time == found.valid_time and are_equal(expected.value, found.value)


def _has_same_reading(expected: Sample[Any], found: Sample[Any]) -> bool:
    return expected.available_time == found.available_time and are_equal(
        expected.value, found.value
    )


def _has_same_valid_time(expected: Sample[Any], found: Sample[Any]) -> bool:
    return expected.valid_time == found.valid_time
