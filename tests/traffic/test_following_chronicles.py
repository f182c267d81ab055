"""What the chronicles of following recognise, against their definitions read literally."""

from collections.abc import Iterable
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event, Recognition
from chronicles.models import models_from_chronicles
from chronicles.parser import read_chronicles
from chronicles.recognition import Recogniser
from dyknow.time import SECOND, TimePoint
from traffic.bundled import data_folder

MODELS = models_from_chronicles(
    read_chronicles(data_folder() / "chronicles" / "following.chronicle")
)
Spans = list[tuple[int, int]]


def at(seconds: float) -> TimePoint:
    """Return a time."""
    return TimePoint(round(seconds * SECOND))


def holds(relation: str, pair: tuple[str, str], spans: Spans) -> list[Event]:
    """Return the changes of a relation that holds from one second to another."""
    name = f"car_following.{relation}"
    events = [Event(name, pair, None, "false", at(0))]
    for begin, end in spans:
        events.append(Event(name, pair, "false", "true", at(begin)))
        events.append(Event(name, pair, "true", "false", at(end)))
    return events


def recognised(events: Iterable[Event], until: float = 1000) -> list[Recognition]:
    """Return what is recognised of events by the end."""
    recogniser = Recogniser(MODELS)
    found: list[Recognition] = []
    in_order = sorted(events, key=lambda event: event.time)
    for time in sorted({event.time for event in in_order}):
        found += recogniser.push(time, [event for event in in_order if event.time == time])
    return found + recogniser.advance(at(until))


def test_tailgating_is_certain_after_four_seconds() -> None:
    """Who tailgates that long is recognised then, once, and who does not is not."""
    (found,) = recognised(holds("tailgates", ("car1", "car2"), [(10, 30), (40, 43)]))

    assert found.chronicle == "tailgating"
    assert found.arguments == {"c1": "car1", "c2": "car2"}
    assert (found.begin, found.recognised_at) == (at(10), at(14))


def test_a_convoy_of_five_is_three() -> None:
    """Each three in a row are one."""
    pairs = [(f"car{i + 1}", f"car{i}") for i in range(1, 5)]

    found = recognised(e for pair in pairs for e in holds("follows", pair, [(5, 40)]))

    assert [tuple(each.arguments.values()) for each in found] == [
        ("car1", "car2", "car3"),
        ("car2", "car3", "car4"),
        ("car3", "car4", "car5"),
    ]


@st.composite
def spans(draw: st.DrawFn) -> Spans:
    """Return when a relation holds: spans of whole seconds that do not touch."""
    lengths = draw(st.lists(st.integers(1, 35), min_size=2, max_size=8))
    found, time = [], 1
    for hold, pause in zip(lengths[::2], lengths[1::2], strict=False):
        found.append((time, time + hold))
        time += hold + pause
    return found


@given(spans(), spans())
@settings(derandomize=True, deadline=None, max_examples=150)
def test_convoys_are_the_times_in_which_both_follow(front: Spans, rear: Spans) -> None:
    """Twenty seconds or more in which the one and the other follow make one convoy."""
    events = [
        *holds("follows", ("car2", "car1"), front),
        *holds("follows", ("car3", "car2"), rear),
    ]
    common = [(max(a, c), min(b, d)) for a, b in front for c, d in rear]

    found = recognised(events)

    assert sorted((each.begin, each.recognised_at) for each in found) == sorted(
        (at(begin), at(begin + 20)) for begin, end in common if end - begin >= 20
    )


TURNS = {
    ("a", "x", "b"): "left",
    ("b", "y", "c"): "right",
    ("b", "y", "d"): "straight",
    ("b", "y", "e"): "left",
}
MAP = [Event("links.turn", place, None, turn, at(0)) for place, turn in TURNS.items()]


def journey(car: str, links: str, begin: float, step: float = 10.0) -> list[Event]:
    """Return the changes of the link of a car that needs two seconds for each crossing."""
    found = [Event("cars.link", (car,), None, links[0], at(1))]
    for i, (one, other) in enumerate(pairwise(links)):
        leaves = begin + i * step
        found.append(Event("cars.link", (car,), one, "no_link", at(leaves)))
        found.append(Event("cars.link", (car,), "no_link", other, at(leaves + 2)))
    return found


@pytest.mark.parametrize(
    ("links", "lag", "follows"),
    [
        ("abc", 4, True),
        ("abe", 4, False),  # another second turn
        ("abd", 4, False),
        ("abc", 15, True),
        ("abc", 16, False),  # much later
        ("abc", -4, False),  # ahead
        ("ab", 4, False),  # only one turn
    ],
)
def test_who_turns_twice_alike_follows(links: str, lag: float, *, follows: bool) -> None:
    """The same two turns, at most fifteen seconds behind each time."""
    found = recognised([*MAP, *journey("car1", "abc", 30), *journey("car2", links, 30 + lag)])

    expected = [{"c1": "car1", "c2": "car2", "x1": "x", "x2": "y"}] if follows else []
    swapped = [{"c1": "car2", "c2": "car1", "x1": "x", "x2": "y"}] if lag < 0 else []
    assert [each.arguments for each in found] == expected + swapped


def test_going_straight_on_together_is_no_following() -> None:
    """Both must turn left or right, both times."""
    assert recognised([*MAP, *journey("car1", "abd", 30), *journey("car2", "abd", 34)]) == []


def test_who_falls_back_on_the_way_does_not_follow() -> None:
    """Each of the two turns must be soon after the other's."""
    late = journey("car2", "abc", 34, step=25.0)

    assert recognised([*MAP, *journey("car1", "abc", 30), *late]) == []
