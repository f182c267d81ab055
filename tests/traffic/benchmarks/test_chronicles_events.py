"""What is to be found in the changes that chronicle recognition is measured with."""

import pytest

from chronicles.events import Event
from dyknow.time import MILLISECOND, TimePoint
from traffic.benchmarks.chronicles_events import Instants, changes, overtakes, together

CARS = ("car0", "car1")


def change(attribute: str, after: str, time: int) -> Event:
    """Return a change of one pair at a time in milliseconds."""
    before = "false" if after == "true" else "true"
    return Event(attribute, CARS, before, after, TimePoint(time * MILLISECOND))


@pytest.mark.parametrize(
    ("moments", "expected"),
    [
        ([("behind", "true", 1), ("behind", "false", 5), ("in_front", "true", 5)], [(1, 5, 5)]),
        (
            [("behind", "true", 1), ("behind", "false", 5), ("in_front", "true", 60_001)],
            [(1, 5, 60_001)],
        ),
        ([("behind", "true", 1), ("behind", "false", 5), ("in_front", "true", 60_002)], []),
        ([("behind", "true", 1), ("in_front", "true", 3), ("behind", "false", 5)], []),
        (
            [
                ("behind", "true", 1),
                ("behind", "false", 2),
                ("behind", "true", 4),
                ("in_front", "true", 4),
            ],
            [(1, 2, 4)],
        ),
        (
            [
                ("behind", "true", 1),
                ("behind", "false", 2),
                ("behind", "true", 3),
                ("in_front", "true", 4),
            ],
            [],
        ),
    ],
)
def test_an_overtake_is_what_the_pattern_says(moments, expected):
    """Behind falls after it rose, in_front rises no earlier, in a minute, with no rise between."""
    events = [change(*moment) for moment in moments]

    assert overtakes(events) == {Instants("car0+car1", *times) for times in expected}


def test_changes_are_always_the_same_and_change_something():
    """Each attribute of each pair is now true, now false; five instants in three changes each."""
    events = changes(3, 1_000)
    last: dict[tuple[str, tuple[str, ...]], str | None] = {}
    for event in events:
        assert event.from_value == last.get((event.attribute, event.arguments), "false")
        last[event.attribute, event.arguments] = event.to_value

    assert changes(3, 1_000) == events
    assert len(last) == 15
    assert [event for _, group in together(events) for event in group] == events
