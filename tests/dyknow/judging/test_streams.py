"""The recorded streams as a judge uses them."""

from collections.abc import Iterator

import pytest

from dyknow.errors import DyKnowError
from dyknow.judging.execution import Interpretation
from dyknow.judging.streams import KnownStreams
from dyknow.streams.process import Element
from dyknow.streams.sample import Heartbeat
from tests.support.streams import ms, stream, text


def known(*elements: Element) -> KnownStreams:
    """Return the streams of an execution with one stream."""
    return KnownStreams(Interpretation(ms(1000), {"speed": elements}))


def test_streams_are_put_in_order() -> None:
    """A stream that is out of order is put in order; of one available time the first counts."""
    streams = known(*stream("0:a 200:c 100:b 200:d@200"))

    assert text(streams["speed"]) == "0:a 100:b 200:c"
    assert text(streams.as_recorded("speed")) == "0:a 200:c 100:b 200:d"


def test_heartbeats_promise_no_more_than_is_kept() -> None:
    """What a heartbeat promises in vain is not promised to those who are computed again."""
    streams = known(*stream("0:a 50:b@200"), Heartbeat(ms(100), ms(100)))

    elements = list(streams.elements("speed"))

    assert [type(each).__name__ for each in elements] == ["Sample", "Heartbeat", "Sample"]
    heartbeat = elements[1]
    assert isinstance(heartbeat, Heartbeat)
    assert heartbeat.until == ms(50) - 1


def test_a_stream_that_cannot_be_read_is_not_known() -> None:
    """Why it cannot be read is told once; from then on it counts as not recorded."""

    class Damaged(Interpretation):
        def contents(self, topic: str) -> Iterator[Element]:  # type: ignore[override]
            raise DyKnowError(f"'{topic}' is damaged")

    streams = KnownStreams(Damaged(ms(1000), {"speed": ()}))

    assert "speed" in streams
    assert streams.fault("speed") == "'speed' is damaged"
    assert "speed" not in streams


@pytest.mark.parametrize(
    ("existing", "expected"), [(None, True), ({"other"}, False), ({"other", "height"}, True)]
)
def test_what_was_not_there_is_told_from_what_was_not_recorded(
    existing: set[str] | None, expected: bool
) -> None:
    """If it is known what streams there were, another one cannot have been."""
    streams = KnownStreams(Interpretation(ms(1000), {"speed": ()}, existing=existing))

    assert streams.may_have_been("speed")
    assert streams.may_have_been("height") is expected
