"""The recogniser on streams."""

import logging

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event
from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from chronicles.processes import ChronicleRecogniser
from dyknow.streams.sample import END_OF_TIME, NO_SAMPLE, Heartbeat, Sample
from dyknow.time import Duration, TimePoint

MS = 1_000_000
TEXT = """
chronicle pair[?x] { event(a[?x], t1) event(b[?x], t2) noevent(d[?x], (t1 + 1, t2)) t1 < t2 }
chronicle quiet[?x] { event(a[?x], t1) noevent(d[?x], (t1 + 1, t1 + 100)) }
"""


def unit(max_delay: int | None = None) -> ChronicleRecogniser:
    """Return a unit for the chronicles of this file."""
    delay = None if max_delay is None else Duration(max_delay * MS)
    return ChronicleRecogniser(models_from_chronicles(parse_chronicles(TEXT)), max_delay=delay)


def sample(valid: int, available: int, *names: str) -> Sample[tuple[Event, ...]]:
    """Return a sample of messages about x, times in milliseconds."""
    time = TimePoint(valid * MS)
    events = tuple(Event(name, ("x",), None, None, time) for name in names)
    return Sample(events, time, TimePoint(available * MS))


def told(samples) -> list[tuple[int, list[str]]]:
    """Return what samples say, with their valid times in milliseconds."""
    found = [one for one in samples if isinstance(one, Sample)]
    return [(one.valid_time // MS, [r.chronicle for r in one.value]) for one in found]


def pushed(recogniser: ChronicleRecogniser, *inputs) -> list[tuple[int, list[str]]]:
    """Push joined inputs, of which the last one tells the time."""
    now = max(one.available_time for one in inputs)
    return told(recogniser.push(now, inputs))


def test_recognitions_come_with_the_time_at_which_they_were_certain():
    """There is one sample for each time at which anything was recognised."""
    recogniser = unit()

    assert pushed(recogniser, sample(0, 0, "a")) == []
    assert pushed(recogniser, sample(50, 60, "b")) == [(50, ["pair"])]
    assert pushed(recogniser, sample(300, 300)) == [(100, ["quiet"])]


def test_streams_are_merged_and_only_new_samples_count():
    """A sample that was joined before, and a stream without samples, are left alone."""
    recogniser = unit()
    first = sample(0, 0, "a")

    assert pushed(recogniser, first, NO_SAMPLE) == []
    assert pushed(recogniser, first, sample(10, 20, "b")) == [(10, ["pair"])]


def test_late_events_are_counted_and_logged(caplog: pytest.LogCaptureFixture):
    """Without a promise about delays, what comes after something newer is left out."""
    recogniser = unit()
    pushed(recogniser, sample(100, 100, "a"))

    with caplog.at_level(logging.WARNING):
        pushed(recogniser, sample(50, 110, "d", "b"))

    assert recogniser.n_late == 2
    assert "2 late events" in caplog.text


def test_samples_wait_for_slower_streams():
    """With a largest delay, samples are taken in by valid time, and time alone recognises."""
    recogniser = unit(max_delay=100)

    assert pushed(recogniser, sample(50, 60, "b")) == []
    assert pushed(recogniser, sample(0, 90, "a")) == []
    assert recogniser.due() == 100 * MS
    assert told(recogniser.advance(TimePoint(150 * MS))) == [(50, ["pair"])]
    assert recogniser.due() == 200 * MS
    assert told(recogniser.advance(TimePoint(200 * MS))) == [(100, ["quiet"])]
    assert recogniser.n_late == 0


def heartbeat(until: float, available: float) -> Heartbeat:
    """Return a heartbeat, times in milliseconds."""
    return Heartbeat(TimePoint(round(until * MS)), TimePoint(round(available * MS)))


def test_samples_wait_for_streams_that_give_heartbeats():
    """A stream that says how far it is complete is awaited, and no longer than it says."""
    recogniser = unit()
    recogniser.push(TimePoint(0), (sample(0, 0, "a"), NO_SAMPLE))
    recogniser.beat(TimePoint(0), 1, heartbeat(10, 0))

    assert pushed(recogniser, sample(30, 30, "b"), NO_SAMPLE) == []
    assert pushed(recogniser, sample(30, 30, "b"), sample(20, 35, "d")) == []
    assert told(recogniser.beat(TimePoint(40 * MS), 1, heartbeat(30, 40))) == []
    assert recogniser.n_late == 0


def test_heartbeats_shorten_the_wait():
    """With a largest delay too, nobody waits for a stream that is known to be complete."""
    recogniser = unit(max_delay=100)
    pushed(recogniser, sample(0, 0, "a"))
    assert pushed(recogniser, sample(50, 50, "b")) == []

    assert told(recogniser.beat(TimePoint(51 * MS), 0, heartbeat(50, 51))) == [(50, ["pair"])]


def test_recognitions_are_complete_up_to_the_clock():
    """A heartbeat says up to where nothing more is recognised; the clock's own instant is open."""
    recogniser = unit(max_delay=100)
    made = recogniser.push(TimePoint(0), (sample(0, 0, "a"),))
    made += recogniser.advance(TimePoint(200 * MS))

    *_, recognition, last = made
    assert told([recognition]) == [(100, ["quiet"])]
    assert last == Heartbeat(TimePoint(100 * MS - 1), TimePoint(200 * MS))


def test_no_time_is_known_before_it_has_come():
    """When all streams have ended, what time alone recognises still waits for its time."""
    recogniser = unit()
    pushed(recogniser, sample(0, 0, "a"))
    ended = Heartbeat(END_OF_TIME, TimePoint(10 * MS))

    assert told(recogniser.beat(TimePoint(10 * MS), 0, ended)) == []
    assert recogniser.due() == 100 * MS
    assert told(recogniser.advance(TimePoint(100 * MS))) == [(100, ["quiet"])]


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    st.lists(
        st.tuples(
            st.integers(0, 2), st.integers(0, 200), st.integers(0, 40), st.sampled_from("abd")
        ),
        max_size=12,
    )
)
def test_heartbeats_alone_put_streams_in_order(drawn: list[tuple[int, int, int, str]]) -> None:
    """Streams that say how far they are complete need no largest delay, whatever their delays."""
    orderly = unit()
    expected = []
    for _, valid, _, name in sorted(drawn, key=lambda one: one[1]):
        expected += pushed(orderly, sample(valid, valid, name))
    expected += pushed(orderly, sample(1000, 1000))

    waiting = unit()
    joined = [NO_SAMPLE, NO_SAMPLE, NO_SAMPLE]
    waiting.push(TimePoint(-1), tuple(joined))
    for at in range(3):
        waiting.beat(TimePoint(0), at, heartbeat(-1, 0))
    found = []
    for number, (at, valid, delay, name) in enumerate(sorted(drawn, key=lambda d: d[1] + d[2])):
        now = TimePoint((valid + delay) * MS + number)
        new = sample(valid, 0, name)
        joined[at] = Sample(new.value, new.valid_time, now)
        found += told(waiting.push(now, tuple(joined)))
        for other in range(3):
            complete = TimePoint(now - 41 * MS)
            found += told(waiting.beat(now, other, Heartbeat(complete, now)))
    for at in range(3):
        ended = Heartbeat(END_OF_TIME, TimePoint(1000 * MS))
        found += told(waiting.beat(TimePoint(1000 * MS), at, ended))

    assert waiting.n_late == 0
    assert sorted_by_time(found) == sorted_by_time(expected)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(
    st.lists(
        st.tuples(st.integers(0, 200), st.integers(0, 40), st.sampled_from("abd")), max_size=12
    ),
    st.lists(st.integers(0, 300), max_size=5),
)
def test_delays_and_clock_updates_change_nothing(
    drawn: list[tuple[int, int, str]], ticks: list[int]
) -> None:
    """What is recognised depends on valid times alone, as long as delays keep their promise."""
    orderly = unit()
    expected = []
    for valid, _, name in sorted(drawn):
        expected += pushed(orderly, sample(valid, valid, name))
    expected += pushed(orderly, sample(1000, 1000))

    delayed = unit(max_delay=40)
    found = []
    arrivals = [(valid + delay, 1, valid, name) for valid, delay, name in drawn]
    for now, is_sample, valid, name in sorted([*arrivals, *((t, 0, 0, "") for t in ticks)]):
        if is_sample:
            found += pushed(delayed, sample(valid, now, name))
        else:
            found += told(delayed.advance(TimePoint(now * MS)))
    found += told(delayed.advance(TimePoint(1040 * MS)))

    assert sorted_by_time(found) == sorted_by_time(expected)


def sorted_by_time(found: list[tuple[int, list[str]]]) -> list[tuple[int, str]]:
    """Return single recognitions, in order."""
    return sorted((time, name) for time, names in found for name in names)
