"""Whether what could not be kept was published, and nothing else.

What must stand on the violation streams is what the adapters and units publish when they are given
the recorded streams. Reasons are for people and do not count.
"""

from collections.abc import Iterable, Iterator

from dyknow.judging.judgement import Breach, Definition
from dyknow.runtime.generators import Label
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.policy import Violation
from dyknow.time import text_from_duration

__all__ = ["PublishedViolations", "ViolatedStream"]

ViolatedStream = tuple[Label, Label, int]
"""Provider, receiver and number of the input, by which violations know their stream."""


class PublishedViolations:
    """The violations of an execution, to be compared with those that there should be.

    Args:
        violations: As they were published.
    """

    def __init__(self, violations: Iterable[StreamViolation]) -> None:
        self._published: dict[ViolatedStream, list[Violation]] = {}
        self._expected: dict[ViolatedStream, list[Violation]] = {}
        self._unknown: set[ViolatedStream] = set()
        for each in violations:
            stream = each.provider, each.receiver, each.number
            self._published.setdefault(stream, []).append(each.violation)

    def of(self, stream: ViolatedStream) -> list[Violation]:
        """Return what was published of a stream."""
        return self._published.get(stream, [])

    def expect(self, stream: ViolatedStream, violations: Iterable[Violation]) -> None:
        """Take in what should have been published of a stream, or of one of several alike."""
        self._expected.setdefault(stream, []).extend(violations)

    def leave_open(self, stream: ViolatedStream) -> None:
        """Note that nobody can tell what should have been published of a stream."""
        self._unknown.add(stream)

    def leave_rest_open(self) -> None:
        """Note that nobody can tell about streams of which nothing has been said yet."""
        self._unknown.update(self._published.keys() - self._expected.keys())

    def breaches(self) -> Iterator[Breach]:
        """Yield what is missing and what is too much, stream by stream."""
        for stream in dict.fromkeys([*self._expected, *self._published]):
            if stream not in self._unknown:
                yield from self._breaches_of(stream)

    def _breaches_of(self, stream: ViolatedStream) -> Iterator[Breach]:
        expected = {_key(each): each for each in self._expected.get(stream, [])}
        published = {_key(each): each for each in self._published.get(stream, [])}
        for key in sorted(expected.keys() | published.keys(), key=lambda key: (key[2], key[1])):
            if key not in published:
                yield _breach(
                    stream, expected[key], f"the violation: {_text(expected[key])}", "none"
                )
            elif key not in expected:
                yield _breach(stream, published[key], "no violation", _text(published[key]))


def _key(violation: Violation) -> tuple[str, int, int]:
    return violation.constraint.value, violation.valid_time, violation.noticed_at


def _text(violation: Violation) -> str:
    noticed_at = text_from_duration(violation.noticed_at)
    return f"{violation.constraint.value}, {violation.reason}, noticed at {noticed_at}"


def _breach(stream: ViolatedStream, violation: Violation, expected: str, found: str) -> Breach:
    provider, receiver, _ = stream
    where = f"violations of '{provider}'"
    if receiver != provider:
        where += f" to '{receiver}'"
    return Breach(
        where, Definition.POLICY, expected, found, violation.valid_time, violation.noticed_at
    )
