"""Events put in order of time."""

from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event
from dyknow.time import MILLISECOND, Duration, TimePoint
from traffic.recognising.ordering import Ordering

times = st.integers(-20, 60)


@settings(derandomize=True, deadline=None, max_examples=300)
@given(st.lists(times, max_size=20), st.integers(0, 12))
def test_events_come_in_order_if_they_are_not_too_late(amounts: list[int], delay: int) -> None:
    """An event is late if one came before that is later by more than the delay; others are sorted.

    Times are half milliseconds, of which two are one instant.
    """
    half = MILLISECOND // 2
    events = [Event("p", (str(i),), None, "v", TimePoint(t * half)) for i, t in enumerate(amounts)]
    ordering = Ordering(Duration(delay * half))
    came, late = [], []

    for event in events:
        if ordering.clock is not None and event.time < ordering.clock:
            late.append(event)
        else:
            came.extend(each for each, _ in ordering.put(event, "here"))
    came.extend(each for each, _ in ordering.rest())

    fit = []
    latest = -(10**9)
    for event in events:
        latest_instant = (latest - delay * half) // MILLISECOND
        if event.time // MILLISECOND >= latest_instant:
            fit.append(event)
            latest = max(latest, event.time)
    assert [e.time // MILLISECOND for e in came] == sorted(e.time // MILLISECOND for e in came)
    assert sorted(e.arguments for e in came) == sorted(e.arguments for e in fit)
    assert len(late) + len(came) == len(events)


def test_events_wait_no_longer_than_needed() -> None:
    """An event is let through as soon as one has come that is later by the delay."""
    ordering = Ordering(Duration(5 * MILLISECOND))
    at = [Event("p", (), None, "v", TimePoint(t * MILLISECOND)) for t in (0, 4, 5, 11)]

    let_through = [[e.time // MILLISECOND for e, _ in ordering.put(event, "")] for event in at]

    assert let_through == [[], [], [0], [4, 5]]
