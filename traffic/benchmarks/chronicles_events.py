"""The overtake pattern: its chronicle, changes that fit to it now and then, and what is in them.

About a hundred changes a second toggle five attributes of so many pairs of cars, two in five of
them at the instant of the change before. What is to be found in them is told a second time here,
by loops over each pair that know nothing of chronicles.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, islice

from chronicles.events import Event
from dyknow.time import MILLISECOND, TimePoint

__all__ = [
    "ATTRIBUTES",
    "OVERTAKE",
    "OVERTAKE_WITH_REPEATS",
    "Instants",
    "changes",
    "endless_changes",
    "overtakes",
    "together",
]

_WITHIN = 60_000
"""Milliseconds from t1 to t3 at most."""

OVERTAKE_WITH_REPEATS = f"""
chronicle overtake[?a, ?b] {{
    event(behind[?a, ?b]:(?, true), t1)
    event(behind[?a, ?b]:(true, false), t2)
    event(in_front[?a, ?b]:(false, true), t3)
    t1 < t2 <= t3
    t3 - t1 <= {_WITHIN}
}}
"""
"""The pattern without its `noevent`, which makes a match of every choice of three events."""

OVERTAKE = OVERTAKE_WITH_REPEATS.rstrip().removesuffix("}") + (
    "    noevent(behind[?a, ?b]:(?, true), (t1 + 1, t3))\n}\n"
)

ATTRIBUTES = ("behind", "in_front", "beside", "close", "same_road")

_STEPS = (0, 0, 10, 20, 20)
"""Milliseconds from one change to the next, each as often as the others."""

_FACTOR, _SHIFT, _MASK = 6_364_136_223_846_793_005, 33, (1 << 64) - 1


@dataclass(frozen=True, order=True, slots=True)
class Instants:
    """An overtake: which pair, and when, in milliseconds."""

    pair: str
    t1: int
    t2: int
    t3: int


def changes(n_pairs: int, n: int) -> list[Event]:
    """Return the first *n* changes of *n_pairs* pairs of cars."""
    return list(islice(endless_changes(n_pairs), n))


def endless_changes(n_pairs: int) -> Iterator[Event]:
    """Yield changes of *n_pairs* pairs of cars without end, always the same ones."""
    draws = _draws()
    cars = [(f"car{2 * pair}", f"car{2 * pair + 1}") for pair in range(n_pairs)]
    values: dict[tuple[str, int], str] = {}
    time = 0
    while True:
        time += _STEPS[next(draws) % len(_STEPS)] * MILLISECOND
        pair = next(draws) % n_pairs
        attribute = ATTRIBUTES[next(draws) % len(ATTRIBUTES)]
        before = values.get((attribute, pair), "false")
        after = values[attribute, pair] = "true" if before == "false" else "false"
        yield Event(attribute, cars[pair], before, after, TimePoint(time))


def together(events: Iterable[Event]) -> Iterator[tuple[TimePoint, list[Event]]]:
    """Yield the events of each instant."""
    for time, group in groupby(events, key=lambda event: event.time):
        yield time, list(group)


def overtakes(events: Sequence[Event], *, repeats: bool = False) -> set[Instants]:
    """Return the overtakes in *events*; with *repeats*, those that the `noevent` rules out too."""
    by_pair: dict[tuple[str, ...], list[Event]] = {}
    for event in events:
        by_pair.setdefault(event.arguments, []).append(event)
    return {
        Instants("+".join(pair), *times)
        for pair, found in by_pair.items()
        for times in _overtakes_of_pair(found, repeats=repeats)
    }


def _overtakes_of_pair(events: Sequence[Event], *, repeats: bool) -> Iterator[tuple[int, ...]]:
    rises, falls, passes = _moments(events)
    for at, t1 in enumerate(rises):
        following = [t for t in rises[at + 1 :] if t > t1][:1]
        last = min([t1 + _WITHIN, *([] if repeats else following)])
        for t3 in passes:
            if t1 < t3 <= last:
                for t2 in falls:
                    if t1 < t2 <= t3:
                        yield t1, t2, t3


def _moments(events: Sequence[Event]) -> tuple[list[int], list[int], list[int]]:
    """Return when behind rises, when it falls, and when in_front rises, each time once."""
    kinds = [("behind", "true"), ("behind", "false"), ("in_front", "true")]
    rises, falls, passes = (
        sorted(
            {
                event.time // MILLISECOND
                for event in events
                if (event.attribute, event.to_value) == kind
            }
        )
        for kind in kinds
    )
    return rises, falls, passes


def _draws() -> Iterator[int]:
    """Yield numbers without end that look as if they had been drawn, always the same ones."""
    state = 1
    while True:
        state = (state * _FACTOR + 1) & _MASK
        yield state >> _SHIFT
