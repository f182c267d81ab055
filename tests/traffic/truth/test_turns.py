"""The definition of a turn, on hand-made cases and against its naive reading."""

from collections.abc import Sequence

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import TimePoint
from networks.turns import Turn
from tests.support.true_places import true_places
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.turns import TurnWatcher

Place = tuple[int, int] | None
"""Link and crossing, one of them -1, or None for a vehicle that is not there."""

A, B, C = (0, -1), (1, -1), (2, -1)
X, Y = (-1, 0), (-1, 1)
OFF_ROAD = (-1, -1)
TURNS = {
    (0, 0, 1): Turn.LEFT,
    (0, 0, 0): Turn.UTURN,
    (1, 0, 0): Turn.RIGHT,
    (1, 1, 2): Turn.STRAIGHT,
    (2, 1, 1): Turn.STRAIGHT,
    (0, 1, 2): Turn.LEFT,
    (0, 0, 2): Turn.RIGHT,
}


LINKS, CROSSINGS = ("a", "b", "c"), ("x", "y")


def watch(*paths: Sequence[Place]) -> list[TrueManoeuvre]:
    """Return the turns of vehicles 0, 1, ... that are at these places in frames 0, 1, ..."""
    watcher, found = TurnWatcher(TURNS, LINKS, CROSSINGS), []
    for time, places in enumerate(zip(*paths, strict=True)):
        there = [(i, place) for i, place in enumerate(places) if place is not None]
        ids = np.array([i for i, _ in there], dtype=np.int64)
        at = np.array([place for _, place in there], dtype=np.int32).reshape(-1, 2)
        frame = Frame(TimePoint(time), Table("vehicle", ids, {}), Table("vehicle", ids, {}))
        places_now = true_places(len(ids), link=at[:, 0], crossing=at[:, 1])
        found += watcher.observe(frame, places_now)
    return found + watcher.finish()


def test_a_passage_from_link_to_link_is_a_turn() -> None:
    """It begins with the first frame in the crossing and ends with the first behind it."""
    assert watch([A, A, X, X, B, B]) == [
        TrueManoeuvre("turn_left", (0,), ("a", "x", "b"), TimePoint(2), TimePoint(4))
    ]


def test_back_to_the_same_link_is_a_u_turn() -> None:
    """The second link may be the first."""
    (found,) = watch([A, X, A])

    assert (found.kind, found.place) == ("turn_uturn", ("a", "x", "a"))


def test_turns_follow_one_another() -> None:
    """The second link of one turn is the first of the next."""
    found = watch([A, X, B, Y, Y, C])

    assert [(t.kind, t.begin, t.end) for t in found] == [
        ("turn_left", 1, 2),
        ("turn_straight", 3, 5),
    ]


def test_who_starts_in_a_crossing_has_not_turned() -> None:
    """Without a link before the crossing there is no turn."""
    assert watch([X, X, B]) == []


def test_a_break_ends_the_passage() -> None:
    """A vehicle that is missing, or nowhere, for a frame has to begin again."""
    assert watch([A, X, None, X, B]) == []
    assert watch([A, X, OFF_ROAD, X, B]) == []
    assert watch([A, X, OFF_ROAD, B]) == []


def test_a_crossing_may_be_skipped_by_a_long_step() -> None:
    """From link to link within a step counts where only one crossing lies between."""
    (found,) = watch([A, B])
    ambiguous = watch([A, C])

    assert (found.kind, found.place, found.begin, found.end) == (
        "turn_left",
        ("a", "x", "b"),
        1,
        1,
    )
    assert ambiguous == []


def test_ways_that_the_map_does_not_know_are_left_out() -> None:
    """A passage is a turn only if the road map has it."""
    assert watch([C, X, A]) == []


def naive(path: Sequence[Place]) -> list[tuple[tuple[str, ...], int, int]]:
    """Return place, begin and end of each turn by reading the definition."""
    found = []
    for begin in range(1, len(path)):
        for end in range(begin, len(path)):
            before, after, inside = path[begin - 1], path[end], set(path[begin:end])
            if before not in (A, B, C) or after not in (A, B, C):
                continue
            if len(inside) == 1 and inside <= {X, Y}:
                crossing = inside.pop()[1]
            elif not inside and before != after:
                between = [x for (a, x, b) in TURNS if (a, b) == (before[0], after[0])]
                crossing = between[0] if len(between) == 1 else -1
            else:
                continue
            if (before[0], crossing, after[0]) in TURNS:
                place = (LINKS[before[0]], CROSSINGS[crossing], LINKS[after[0]])
                found.append((place, begin, end))
    return found


@given(
    st.integers(1, 12).flatmap(
        lambda n: st.lists(
            st.lists(st.sampled_from([A, B, C, X, X, Y, OFF_ROAD, None]), min_size=n, max_size=n),
            min_size=1,
            max_size=3,
        )
    )
)
@settings(derandomize=True, deadline=None, max_examples=300)
def test_the_watcher_agrees_with_the_definition(paths: list[list[Place]]) -> None:
    """All vehicles at once, frame by frame, give what reading each path as a whole gives."""
    found = watch(*paths)

    for vehicle, path in enumerate(paths):
        mine = [t for t in found if t.vehicles == (vehicle,)]
        assert [(t.place, t.begin, t.end) for t in mine] == naive(path)
