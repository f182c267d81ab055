"""The promises of the recogniser, one by one."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event
from chronicles.models import Model, models_from_chronicles
from chronicles.parser import parse_chronicles
from chronicles.patterns import Pattern, pattern_from_event_type
from chronicles.prospects import EndedInstance, PartialInstance
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


def test_partial_instances_are_those_of_the_worked_example():
    """Heintz (2009), section 8.4, step by step: A, B, and C at most 5 later than B.

    The empty instance, which is always there, is not listed; a complete one is recognised.
    """
    ended: list[EndedInstance] = []
    text = "chronicle c { event(A, a) event(B, b) event(C, c) c - b in [0, 5] }"
    recogniser = Recogniser(models_from_chronicles(parse_chronicles(text)), on_end=ended.append)

    def listed() -> set[str]:
        return {seen_in(one) for one in recogniser.partial_instances()}

    told(recogniser, message("A", 4))
    assert listed() == {"A4"}

    told(recogniser, message("B", 5))
    assert listed() == {"A4", "B5", "A4 B5"}

    told(recogniser, message("B", 8))
    assert listed() == {"A4", "B5", "B8", "A4 B5", "A4 B8"}
    assert ended == []

    recogniser.advance(TimePoint(11 * MS))
    assert listed() == {"A4", "B8", "A4 B8"}
    assert {(seen_in(one.instance), one.reason) for one in ended} == {
        ("B5", "deadline"),
        ("A4 B5", "deadline"),
    }
    assert {one.time for one in ended} == {11 * MS}

    assert told(recogniser, message("C", 12)) == [(4, 8, 12)]
    assert listed() == {"A4", "B8", "C12", "A4 B8", "A4 C12", "B8 C12"}


def seen_in(instance: PartialInstance) -> str:
    """Return the events that a partial instance has seen, with their times in milliseconds."""
    return " ".join(f"{event.attribute}{event.time // MS}" for event in instance.events)


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


@pytest.mark.parametrize("begin", [-(10**12), 0, 1_700_000_000_000, 9 * 10**12])
def test_any_time_of_64_bits_will_do(begin):
    """Long before time zero and in our own days everything is as it is at the beginning."""
    recogniser = recogniser_of(
        "chronicle c[?x] { event(a[?x], t1) event(b[?x], t2) noevent(d, (t1 + 1, t2))"
        " t1 < t2 <= t1 + 100 }"
    )
    events = [("a", 0), ("b", 7), ("d", 9), ("b", 11), ("a", 200), ("b", 300), ("a", 400)]

    found = told(recogniser, *(message(n, begin + t, *"x" * (n != "d")) for n, t in events))

    assert found == [(begin, begin + 7), (begin + 200, begin + 300)]
    assert recogniser.next_deadline() == (begin + 501) * MS
    recogniser.advance(TimePoint((begin + 501) * MS))
    assert recogniser.size() == 0


@pytest.mark.parametrize("time", [1 << 64, -(1 << 64)])
def test_a_time_of_more_than_64_bits_is_refused(time):
    """Nothing has happened then: the clock stays where it is."""
    recogniser = recogniser_of("chronicle c { event(a, t1) }")

    with pytest.raises(ValueError, match="expected a time of 64 bits"):
        recogniser.push(TimePoint(time), [])

    assert recogniser.clock is None


def test_a_window_since_time_zero_has_no_other_end():
    """A chronicle that must begin before some time begins however long before."""
    recogniser = recogniser_of("chronicle c { event(a, t1) t1 <= 5 }")

    assert told(recogniser, *(message("a", t) for t in (-(10**12), 5, 6))) == [(-(10**12),), (5,)]


def test_what_an_event_says_is_believed():
    """The recogniser keeps no values: an event may contradict the one before."""
    recogniser = recogniser_of("chronicle c { event(p:(u, v), t1) event(p:(u, v), t2) t1 < t2 }")

    def change(time: int) -> Event:
        return Event("p", (), "u", "v", TimePoint(time * MS))

    assert told(recogniser, change(1), change(2)) == [(1, 2)]


def test_events_of_another_shape_are_none_of_the_chronicle():
    """Another name, more or fewer arguments, a message, a value that is lost: no match."""
    recogniser = recogniser_of("chronicle c[?x] { event(p[?x]:(?, v), t1) }")
    now = TimePoint(0)

    strangers = [
        Event("q", ("x",), None, "v", now),
        Event("p", ("x", "y"), None, "v", now),
        Event("p", (), None, "v", now),
        Event("p", ("x",), None, None, now),
        Event("p", ("x",), "v", None, now),
    ]

    assert told(recogniser, *strangers) == []
    assert recogniser.partial_instances() == []


def test_thousands_of_chronicles_are_registered_and_cost_only_those_concerned():
    """They come one by one; an event is given to the one that asks for its object."""
    text = (
        "chronicle c {{ event(p[{0}]:(?, true), t1) event(p[{0}]:(true, false), t2)"
        " t1 < t2 <= t1 + 50 noevent(p[{0}]:(?, true), (t1 + 1, t2)) }}"
    )
    (model,) = models_from_chronicles(parse_chronicles(text.format("car0")))
    recogniser = Recogniser()
    for i in range(2_000):
        recogniser.register([of_another_object(model, f"c{i}", f"car{i}")])

    found = []
    for time in range(100):
        value = ("true", "false")[time % 2]
        before = ("false", "true")[time % 2]
        event = Event("p", (f"car{time // 2 * 39}",), before, value, TimePoint(time * MS))
        found += recogniser.push(event.time, [event])

    assert [one.chronicle for one in found] == [f"c{i * 39}" for i in range(50)]


def of_another_object(model: Model, name: str, value: str) -> Model:
    """Return a model as that of a chronicle that asks for another object."""

    def moved(pattern: Pattern) -> Pattern:
        (argument,) = pattern.event_type.arguments
        other = replace(argument, text=value)
        return pattern_from_event_type(replace(pattern.event_type, arguments=(other,)))

    return replace(
        model,
        name=name,
        slots=tuple(replace(slot, pattern=moved(slot.pattern)) for slot in model.slots),
        counters=tuple(replace(each, pattern=moved(each.pattern)) for each in model.counters),
    )


def test_a_chronicle_of_two_hundred_events_is_recognised():
    """A chain of two hundred events is followed for several objects at once."""
    n = 200
    events = " ".join(f"event(e{i}[?x], t{i})" for i in range(n))
    order = " < ".join(f"t{i}" for i in range(n))
    recogniser = recogniser_of(f"chronicle c[?x] {{ {events} {order} t{n - 1} - t0 <= 10000 }}")

    found = told(recogniser, *(message(f"e{i}", i, x) for i in range(n) for x in ("u", "v")))

    assert found == [tuple(range(n))] * 2


def test_stages_that_nothing_is_at_are_forgotten():
    """A chronicle whose events come in any order goes through hundreds of stages, and on."""
    n = 9
    events = " ".join(f"event(e{i}[?x], t{i})" for i in range(n))
    recogniser = recogniser_of(f"chronicle c[?x] {{ {events} end - start <= 100 }}")
    found = []
    for turn in range(3):
        for i in range(n):
            at = (i * 7 + turn) % n
            found += told(recogniser, message(f"e{at}", turn * 1_000 + i, f"x{turn}"))

    assert len(found) == 3
    recogniser.advance(TimePoint(10_000 * MS))
    assert recogniser.size() == 0


def test_late_events_leave_no_trace():
    """A late event changes neither clock nor instances, whatever it says."""
    text = "chronicle c { event(a, t1) event(b, t2) t1 <= t2 <= t1 + 10 }"
    with_late, without = recogniser_of(text), recogniser_of(text)
    for recogniser in (with_late, without):
        told(recogniser, message("a", 5))
        recogniser.advance(TimePoint(9 * MS))

    assert told(with_late, message("b", 7), message("a", 8)) == []

    assert with_late.partial_instances() == without.partial_instances()
    assert (with_late.clock, with_late.n_late) == (9 * MS, 2)
