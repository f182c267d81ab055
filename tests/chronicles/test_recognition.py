"""The promises of the recogniser, one by one."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event
from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from chronicles.recognition import Recogniser
from dyknow.time import MILLISECOND, TimePoint

MS = int(MILLISECOND)


def recogniser_of(text: str) -> Recogniser:
    """Return a recogniser of the chronicles in a text."""
    return Recogniser(models_from_chronicles(parse_chronicles(text)))


def message(name: str, time: int, *arguments: str) -> Event:
    """Return a message at a time in milliseconds."""
    return Event(name, arguments, None, None, TimePoint(time * MS))


def told(recogniser: Recogniser, *events: Event) -> list[tuple[int, ...]]:
    """Push events and return the times of what is recognised, in milliseconds."""
    found = []
    for event in events:
        found += recogniser.push(event.time, [event])
    return [tuple(time // MS for time in one.instants.values()) for one in found]


def test_noevent_is_recognised_when_its_interval_ends_without_another_event():
    """A clock update alone recognises, and the time of recognition is the end of the interval."""
    recogniser = recogniser_of("chronicle c { event(a, t1) noevent(b, (t1 + 1, t1 + 100)) }")

    assert told(recogniser, message("a", 5)) == []
    assert recogniser.next_deadline() == 105 * MS
    assert recogniser.advance(TimePoint(104 * MS)) == []
    (found,) = recogniser.advance(TimePoint(500 * MS))
    assert (found.end, found.recognised_at) == (5 * MS, 105 * MS)


def test_an_interval_ends_before_its_second_instant():
    """A forbidden event at the very end of its interval does not matter; one before it does."""
    text = "chronicle c { event(a, t1) event(d, t2) noevent(b, (t1, t2)) t1 <= t2 }"

    assert told(recogniser_of(text), *(message(n, t) for n, t in [("a", 1), ("b", 3), ("d", 3)]))
    assert not told(
        recogniser_of(text), *(message(n, t) for n, t in [("a", 1), ("b", 2), ("d", 3)])
    )
    assert not told(
        recogniser_of(text), *(message(n, t) for n, t in [("b", 1), ("a", 1), ("d", 3)])
    )


def test_enough_events_are_settled_with_the_last_of_them():
    """`occurs(n, oo)` waits for the n-th event and not for the end of its interval."""
    recogniser = recogniser_of("chronicle c { event(a, t1) occurs(2, oo, b, (t1, t1 + 100)) }")

    assert told(recogniser, message("a", 0), message("b", 10)) == []
    assert told(recogniser, message("b", 10)) == []
    assert told(recogniser, message("b", 20)) == [(0,)]


def test_equal_events_of_one_instant_are_one():
    """An event that is told twice counts once and makes one match."""
    recogniser = recogniser_of("chronicle c { event(a, t1) occurs(1, 1, a, (t1, t1 + 1)) }")

    assert told(recogniser, message("a", 0), message("a", 0)) == []
    assert len(recogniser.advance(TimePoint(MS))) == 1


def test_finer_times_are_rounded_down_to_instants():
    """Events within one millisecond are at one instant; the event keeps its own time."""
    recogniser = recogniser_of("chronicle c { event(a, t1) event(b, t2) t1 = t2 }")

    recogniser.push(TimePoint(7 * MS + 900_000), [message("a", 7)])
    late = Event("b", (), None, None, TimePoint(7 * MS + 100_000))
    (found,) = recogniser.push(late.time, [late])

    assert found.instants == {"t1": 7 * MS, "t2": 7 * MS}
    assert found.events[1].time == 7 * MS + 100_000


def test_late_events_are_counted_and_left_out():
    """An event before the clock changes nothing but the count."""
    recogniser = recogniser_of("chronicle c { event(a, t1) }")

    recogniser.advance(TimePoint(10 * MS))

    assert told(recogniser, message("a", 9), message("a", 10)) == [(10,)]
    assert recogniser.n_late == 1


def test_a_variable_does_not_take_an_unknown_value():
    """`?` matches a change from unknown; `?x` does not."""
    text = "chronicle c[?x] {{ event(p[?x]:({}, v), t1) }}"
    first = Event("p", ("x",), None, "v", TimePoint(0))

    assert told(recogniser_of(text.format("?")), first) == [(0,)]
    assert told(recogniser_of(text.format("?x")), first) == []


def test_partial_instances_are_listed_with_what_they_wait_for():
    """The worked example of the thesis (section 8.4): A, B, and C at most 5 later than B."""
    recogniser = recogniser_of(
        "chronicle c { event(A, a) event(B, b) event(C, c) c - b in [0, 5] }"
    )

    def listed() -> list[dict[str, int]]:
        return [
            {name: time // MS for name, time in one.instants.items()}
            for one in recogniser.partial_instances()
        ]

    told(recogniser, message("A", 4), message("B", 5), message("B", 8))
    assert sorted(map(str, listed())) == sorted(
        map(str, [{"a": 4}, {"b": 5}, {"b": 8}, {"a": 4, "b": 5}, {"a": 4, "b": 8}])
    )

    recogniser.advance(TimePoint(11 * MS))
    assert sorted(map(str, listed())) == sorted(map(str, [{"a": 4}, {"b": 8}, {"a": 4, "b": 8}]))

    assert told(recogniser, message("C", 12)) == [(4, 8, 12)]


def test_what_is_awaited_carries_values_and_limits():
    """A partial instance tells the events to come with the values and times known so far."""
    recogniser = recogniser_of(
        "chronicle c[?x] { event(a[?x], t1) event(b[?x]:(?, v), t2) t2 - t1 in [10, 100]"
        " noevent(d[?x], (t1 + 1, t2 + 50)) }"
    )

    told(recogniser, message("a", 5, "x7"))
    (partial,) = recogniser.partial_instances()
    (awaited,) = partial.awaited
    assert (partial.values, awaited.predicate) == ({"x": "x7"}, "event(b[x7]:(?, v), t2)")
    assert (awaited.earliest, awaited.latest) == (15 * MS, 105 * MS)

    told(recogniser, Event("b", ("x7",), None, "v", TimePoint(20 * MS)))
    waiting = [one for one in recogniser.partial_instances() if len(one.instants) == 2]
    (awaited,) = waiting[0].awaited
    assert awaited.predicate == "noevent(d[x7], (t1 + 1, t2 + 50))"
    assert (awaited.earliest, awaited.latest) == (6 * MS, 70 * MS)


def test_events_without_a_common_variable_do_not_multiply():
    """Only what a later event joins is put together."""
    recogniser = recogniser_of(
        "chronicle c[?x, ?y] { event(a[?x], t1) event(a[?y], t2) event(b[?x, ?y], t3)"
        " t1 <= t3 t2 <= t3 t3 - t1 <= 1000 t3 - t2 <= 1000 }"
    )

    told(recogniser, *(message("a", i, f"v{i}") for i in range(50)))
    assert len(recogniser.partial_instances()) == 100

    assert told(recogniser, message("b", 60, "v3", "v9")) == [(3, 9, 60)]


@settings(derandomize=True, deadline=None, max_examples=30)
@given(st.lists(st.tuples(st.integers(1, 9), st.sampled_from("abd")), max_size=60))
def test_nothing_is_kept_longer_than_the_bounds_of_a_chronicle(
    steps: list[tuple[int, str]],
) -> None:
    """When all deadlines have passed no instance, deadline or index entry is left."""
    recogniser = recogniser_of(
        "chronicle c[?x] { event(a[?x], t1) event(b[?x], t2) noevent(d[?x], (t1 + 1, t2))"
        " t1 < t2 <= t1 + 20 }"
    )
    time = 0
    for step, name in steps:
        time += step
        told(recogniser, message(name, time, f"v{step % 3}"))

    recogniser.advance(TimePoint((time + 100) * MS))

    assert recogniser.size() == 0


def test_memory_stays_flat_over_a_long_stream():
    """Instances, counted events and reports are forgotten as the stream goes on."""
    recogniser = recogniser_of(
        "chronicle c[?x] { report non_overlapping (t1, t2)"
        " event(a[?x], t1) event(b[?x], t2) occurs(0, 1, a[?x], (t1 - 5, t2))"
        " t1 < t2 <= t1 + 20 }"
    )
    n_found = 0
    for time in range(20_000):
        n_found += len(told(recogniser, message("ab"[time % 2], time, f"v{time // 2}")))
    sizes = recogniser.size()

    assert n_found == 10_000
    assert sizes < 10_000


def test_an_included_chronicle_says_what_it_would_say_in_place():
    """Inclusion binds instants by place and by name; everything else is the included one's own."""
    text = (
        "chronicle pair[?x](u) {{ event(a[?x], u) event(b[?x], v) u < v <= u + 50 }} "
        "chronicle c[?x] {{ event(d[?x], t) {} t <= e }}"
    )
    events = [message("a", 1, "x"), message("d", 2, "x"), message("b", 9, "x")]

    for included in (
        "chronicle pair[?x] (s, v = e)",
        "chronicle pair[?x] (start = s, end = e)",
        "event(a[?x], s) event(b[?x], e) s < e <= s + 50",
    ):
        recogniser = recogniser_of(text.format(included))
        found = [one for event in events for one in recogniser.push(event.time, [event])]
        (one,) = [one for one in found if one.chronicle == "c"]
        times = {name: one.instants[name] // MS for name in ("t", "s", "e")}
        assert times == {"t": 2, "s": 1, "e": 9}


def test_recognitions_are_events_of_other_chronicles():
    """A chronicle can ask for recognitions, with beginning and end as values."""
    recogniser = recogniser_of(
        "chronicle pair[?x] { event(a[?x], t1) event(b[?x], t2) t1 < t2 <= t1 + 9 }"
        " chronicle two[?x, ?s, ?e] { event(pair[?x]:(?s, ?e), t1) event(pair[?x], t2) t1 < t2 }"
    )
    found = []
    for name, time in [("a", 1), ("b", 3), ("a", 5), ("b", 6)]:
        event = message(name, time, "x")
        found += recogniser.push(event.time, [event])

    # The pair (5, 6) and the pair (1, 6) are both recognised at 6: in `two`, t1 is at 3.
    assert [one.arguments for one in found if one.chronicle == "two"] == [
        {"x": "x", "s": "1", "e": "3"}
    ]


def test_chronicles_are_registered_and_withdrawn_while_running():
    """A new chronicle sees what comes later; one that is withdrawn leaves nothing behind."""
    quiet = models_from_chronicles(
        parse_chronicles("chronicle q { event(a, t1) noevent(b, (t1, t1 + 10)) }")
    )
    recogniser = Recogniser()
    recogniser.push(TimePoint(0), [message("a", 0)])
    recogniser.register(quiet)
    with pytest.raises(ValueError, match="'q' is recognised already"):
        recogniser.register(quiet)
    assert recogniser.push(TimePoint(5 * MS), [message("a", 5)]) == []

    recogniser.withdraw("q")

    assert recogniser.partial_instances() == []
    assert recogniser.advance(TimePoint(100 * MS)) == []
    assert recogniser.size() == 0
    with pytest.raises(ValueError, match="no chronicle called 'r'"):
        recogniser.withdraw("r")


def test_the_oldest_instances_are_given_up_beyond_the_limit(caplog):
    """The number of partial instances is limited, and who was given up is told."""
    ended = []
    text = "chronicle c[?x] { event(a[?x], t1) event(b[?x], t2) t1 < t2 }"
    models = models_from_chronicles(parse_chronicles(text))
    recogniser = Recogniser(models, limit=4, on_end=ended.append)

    told(recogniser, *(message("a", i, f"v{i}") for i in range(6)))

    assert [one.values["x"] for one in recogniser.partial_instances()] == ["v2", "v3", "v4", "v5"]
    assert [(one.instance.values["x"], one.reason) for one in ended] == [
        ("v0", "limit"),
        ("v1", "limit"),
    ]
    assert recogniser.n_given_up == {"c": 2}
    assert "chronicle 'c' has more than 4 partial instances" in caplog.text


@pytest.mark.parametrize(
    ("tail", "events", "reason"),
    [
        ("event(b, t2) t1 < t2 <= t1 + 5", [], "deadline"),
        ("noevent(b, (t1, t1 + 9))", [("b", 3)], "forbidden event"),
        ("occurs(0, 1, b, (t1, t1 + 9))", [("b", 3), ("b", 4)], "too many events"),
        ("occurs(2, 3, b, (t1, t1 + 9))", [("b", 3)], "too few events"),
    ],
)
def test_an_instance_that_dies_says_why(tail, events, reason):
    """The reason is the predicate that can no longer hold."""
    ended = []
    text = f"chronicle c {{ event(a, t1) {tail} }}"
    recogniser = Recogniser(models_from_chronicles(parse_chronicles(text)), on_end=ended.append)

    told(recogniser, message("a", 0), *(message(name, time) for name, time in events))
    recogniser.advance(TimePoint(100 * MS))

    assert [one.reason for one in ended] == [reason]
