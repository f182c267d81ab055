"""Chronicles recognised in events as these are read."""

import gc
import tracemalloc
from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event, Recognition
from chronicles.parser import parse_chronicles
from chronicles.recognition import Recogniser
from chronicles.semantics import matches
from dyknow.time import MILLISECOND, Duration, TimePoint
from tests.support.event_files import asked, events_in, lines_from, reader_of, recognised
from traffic.errors import RequestError
from traffic.recognising.following import Settings, delay_from, recognise
from traffic.recognising.screening import RemarkKind

PASSING = """
attribute behind[?a, ?b] { ?value in {true, false} }
attribute in_front[?a, ?b] { ?value in {true, false} }
message horn[?a] { ?a in {x, y, z} }
chronicle passing[?a, ?b] {
    event(behind[?a, ?b]:(?, true), t1)
    event(in_front[?a, ?b]:(?, true), t2)
    noevent(in_front[?a, ?b]:(true, ?), (t2 + 1, t2 + 5))
    noevent(horn[?a], (t1, t2))
    t1 < t2 <= t1 + 20
}
"""
FILE = parse_chronicles(PASSING)
cars = st.sampled_from(["x", "y", "z"])
changes = st.builds(
    Event,
    st.sampled_from(["behind", "in_front"]),
    st.tuples(cars, cars),
    st.sampled_from([None, "true", "false"]),
    st.sampled_from(["true", "false"]),
    st.integers(0, 30).map(lambda t: TimePoint(t * MILLISECOND)),
)
messages = st.builds(
    Event,
    st.just("horn"),
    st.tuples(cars),
    st.none(),
    st.none(),
    st.integers(0, 30).map(lambda t: TimePoint(t * MILLISECOND)),
)
sequences = st.lists(st.one_of(changes, messages), max_size=12)


def facts(found: list[Recognition]) -> list[str]:
    """Return the recognitions in an order of their own."""
    return sorted(
        f"{r.recognised_at} {sorted(r.arguments.items())} {sorted(r.instants.items())}"
        for r in found
    )


@settings(derandomize=True, deadline=None, max_examples=150)
@given(sequences)
def test_what_is_recognised_in_a_file_is_what_the_recogniser_finds(events: list[Event]) -> None:
    """Sorted events give the recognitions of the recogniser; unchanged values are no events."""
    events.sort(key=lambda event: event.time)
    recogniser = Recogniser(asked(PASSING).models)
    expected = []
    for event in events:
        is_unchanged = event.from_value == event.to_value is not None
        expected += recogniser.push(event.time, () if is_unchanged else (event,))

    found, _, outcome = recognised(PASSING, lines_from(events))

    assert facts(found) == facts(expected)
    assert outcome.n_events == len(events)
    assert outcome.n_recognitions == len(found)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(sequences, st.randoms(use_true_random=False), st.integers(0, 15))
def test_order_does_not_matter_within_the_delay(events, random, delay) -> None:
    """Events that come late by less than the delay give what events in order give."""
    in_order = sorted(events, key=lambda event: event.time)
    lateness = {id(event): random.uniform(0, delay) * MILLISECOND for event in in_order}
    shuffled = sorted(in_order, key=lambda event: event.time + lateness[id(event)])

    expected, _, _ = recognised(PASSING, lines_from(in_order))
    found, remarks, _ = recognised(
        PASSING, lines_from(shuffled), Settings(max_delay=Duration(delay * MILLISECOND))
    )

    assert facts(found) == facts(expected)
    assert not [remark for remark in remarks if remark.kind is RemarkKind.LATE]


@settings(derandomize=True, deadline=None, max_examples=150)
@given(sequences)
def test_late_events_are_left_out_and_told(events: list[Event]) -> None:
    """What comes too late is as if it had not come."""
    in_time, late, clock = [], 0, -1
    for event in events:
        if event.time < clock:
            late += 1
        else:
            in_time.append(event)
            clock = event.time

    found, remarks, outcome = recognised(PASSING, lines_from(events))
    expected, _, _ = recognised(PASSING, lines_from(in_time))

    assert facts(found) == facts(expected)
    assert sum(remark.kind is RemarkKind.LATE for remark in remarks) == late
    assert outcome.remarks.get(RemarkKind.LATE, 0) == late


@settings(derandomize=True, deadline=None, max_examples=100)
@given(sequences)
def test_closing_decides_all_that_is_pending(events: list[Event]) -> None:
    """With `closes`, recognitions are the matches of the whole, and nothing is pending."""
    events = sorted(
        (e for e in events if e.from_value != e.to_value or e.to_value is None),
        key=lambda event: event.time,
    )

    found, _, outcome = recognised(PASSING, lines_from(events), Settings(closes=True))
    _, _, unclosed = recognised(PASSING, lines_from(events))

    expected = matches(FILE.chronicles[0], FILE, events, clock=TimePoint(1 << 60))
    assert len(found) == len(expected)
    assert outcome.pending == ()
    assert outcome.n_recognitions >= unclosed.n_recognitions
    assert outcome.n_recognitions <= unclosed.n_recognitions + len(unclosed.pending)


def test_a_recognition_does_not_wait_for_more_events() -> None:
    """It is told when the event that settles it has been read, and no further one has."""
    lines = lines_from(
        Event(name, ("x", "y"), None, "true", TimePoint(t * MILLISECOND))
        for name, t in (("behind", 0), ("in_front", 3), ("behind", 8), ("behind", 9))
    )
    read = reader_of(lines, size=1)
    n_read = 0

    class Counting:
        def __iter__(self) -> Iterator[Event]:
            nonlocal n_read
            for event in read:
                n_read += 1
                yield event

        def place(self) -> str:
            return read.place()

    told: list[int] = []
    recognise(asked(PASSING), Counting(), Settings(), lambda _: told.append(n_read), print)

    assert told == [3]


EVENT = (
    '{{"t": {t}, "attribute": "{name}", "arguments": ["x", "y"], "from": {old}, "to": "{new}"}}\n'
)


@pytest.mark.parametrize(
    ("lines", "kind", "message"),
    [
        ('{"t": 9, "message": "hron"}', RemarkKind.UNKNOWN, "no chronicle knows 'hron'; did you"),
        (
            '{"t": 9, "message": "horn"}',
            RemarkKind.ARITY,
            "1 argument of 'horn', found 0",
        ),
        (
            '{"t": 9, "message": "behind", "arguments": ["x", "y"]}',
            RemarkKind.KIND,
            "expected an attribute as 'behind', found the event of a message",
        ),
        (
            '{"t": 9, "attribute": "horn", "arguments": ["x"], "to": "v"}',
            RemarkKind.KIND,
            "expected a message as 'horn', found the event of an attribute",
        ),
        (
            '{"t": 9, "message": "horn", "arguments": ["w"]}',
            RemarkKind.DOMAIN,
            "expected ?a in {x, y, z} of 'horn', found horn[w]",
        ),
        (
            EVENT.format(t=9, name="behind", old='"maybe"', new="true"),
            RemarkKind.DOMAIN,
            "found behind[x, y]:(maybe, true)",
        ),
        (
            '{"t": 1, "message": "horn", "arguments": ["x"]}',
            RemarkKind.LATE,
            "expected events in order of time, after 5 ms, found one at 1 ms",
        ),
    ],
)
def test_what_does_not_fit_is_left_out_with_a_reason(lines, kind, message) -> None:
    """The remark has the line of the event, and counts."""
    good = EVENT.format(t=5, name="behind", old="null", new="true")

    _, remarks, outcome = recognised(PASSING, good + lines)

    (remark,) = remarks
    assert (remark.place, remark.kind, remark.is_left_out) == ("events:2", kind, True)
    assert message in remark.message
    assert outcome.remarks == {kind: 1}
    assert outcome.n_events == 2
    assert outcome.clock == max(5, 9 if kind is not RemarkKind.LATE else 5) * MILLISECOND


def test_a_contradiction_is_told_and_believed() -> None:
    """A change from another value than the last one is taken as it is written."""
    lines = EVENT.format(t=0, name="behind", old="null", new="false") + EVENT.format(
        t=1, name="behind", old='"true"', new="true"
    )
    lines += EVENT.format(t=2, name="behind", old='"true"', new="false")
    lines += EVENT.format(t=3, name="behind", old="null", new="true")

    _, remarks, outcome = recognised(PASSING, lines)

    (remark,) = remarks
    assert (remark.place, remark.kind) == ("events:3", RemarkKind.CONTRADICTION)
    assert (
        remark.message == "expected a change from 'false', the last value, found one from 'true'"
    )
    assert not remark.is_left_out
    assert outcome.remarks == {RemarkKind.UNCHANGED: 1, RemarkKind.CONTRADICTION: 1}
    assert [instance.instants for instance in outcome.partial] == [{"t1": 3 * MILLISECOND}]


def test_chronicles_of_several_files_are_recognised_together() -> None:
    """What one recognises is an event for those that declare it."""
    other = "attribute passing[?a, ?b] chronicle twice[?a] {"
    other += (
        " event(passing[?a, ?]:(?, ?), t1) event(passing[?a, ?]:(?, ?), t2) t1 < t2 <= t1 + 100 }"
    )
    events = [
        Event(name, ("x", car), None, "true", TimePoint(t * MILLISECOND))
        for name, car, t in (
            ("behind", "y", 0), ("in_front", "y", 1), ("behind", "z", 10), ("in_front", "z", 11),
            ("behind", "x", 40),
        )
    ]  # fmt: skip

    found, _, _ = recognised([PASSING, other], lines_from(events))

    assert [(r.chronicle, r.recognised_at // MILLISECOND) for r in found] == [
        ("passing", 6), ("passing", 16), ("twice", 16),
    ]  # fmt: skip


def test_the_limit_is_kept_and_told() -> None:
    """The oldest partial instances are given up."""
    lines = "".join(
        EVENT.format(t=t, name="behind", old="null", new="true").replace("x", f"x{t}")
        for t in range(10)
    )

    _, _, outcome = recognised(PASSING, lines, Settings(limit=4))

    assert len(outcome.partial) <= 4
    assert outcome.given_up == {"passing": 10 - len(outcome.partial)}


def test_long_files_need_no_more_memory_than_short_ones() -> None:
    """Fifty times as many events do not take more memory than once."""

    def peak(n_events: int) -> int:
        def pieces() -> Iterator[Event]:
            for i in range(n_events):
                new = "false" if i % 4 < 2 else "true"
                time = TimePoint(i * 3 * MILLISECOND)
                yield Event("behind" if i % 2 else "in_front", (f"c{i % 7}", "y"), None, new, time)

        class Reader:
            def __iter__(self) -> Iterator[Event]:
                return pieces()

            def place(self) -> str:
                return "here"

        question = asked(PASSING)
        gc.collect()
        tracemalloc.start()
        recognise(question, Reader(), Settings(), lambda _: None, lambda _: None)
        _, highest = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return highest

    assert peak(10_000) < 1.5 * peak(1_000) + 20_000


@pytest.mark.parametrize("text", ["", "x", "-1", "-2 s", "1 day"])
def test_a_delay_is_a_length_of_time(text: str) -> None:
    """Anything else is told."""
    with pytest.raises(RequestError, match="--max-delay: expected a length of time"):
        delay_from(text)


def test_delays_are_milliseconds_or_have_a_unit() -> None:
    """As everywhere."""
    assert delay_from("200") == 200 * MILLISECOND
    assert delay_from("1.5 s") == 1500 * MILLISECOND


def test_events_read_are_those_written() -> None:
    """The helper of these tests writes what it reads."""
    event = Event("p", ("a",), None, "v", TimePoint(0))

    assert events_in(lines_from([event])) == [event]
