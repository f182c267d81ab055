"""When the instants of a chronicle can be: which of them are known from which others.

Instants at which an event is expected get their times from events. Any other instant must be at
a fixed distance from one of these, or from the beginning or the end of the chronicle, which are
the earliest and the latest of its instants. If the constraints leave open which instant that is,
it is known when all of them are.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from chronicles.constraints import UNBOUNDED, ZERO, Bound, TemporalNetwork, bounds_of
from chronicles.expansion import Expansion, Extreme, instants_of
from chronicles.syntax import TemporalConstraint

__all__ = ["Place", "Timing", "bounds_in", "timing_of"]


@dataclass(frozen=True, slots=True)
class Place:
    """Where an instant is.

    Attributes:
        anchor: The name of the instant of an event, or of an extreme that is still open.
        offset: Nanoseconds from there.
    """

    anchor: str
    offset: int


@dataclass(frozen=True)
class Timing:
    """What the temporal constraints of a chronicle amount to.

    Attributes:
        network: The minimal network.
        places: Where each instant is that is known from events.
        open_extremes: The extremes that are known only when all events have come, by name.
        tests: The bounds that must be looked at then, because they concern an open extreme.
    """

    network: TemporalNetwork
    places: Mapping[str, Place]
    open_extremes: Mapping[str, Extreme]
    tests: tuple[Bound, ...]

    def window(self, instant: str) -> tuple[int, int]:
        """Return between which times since time zero *instant* can be."""
        if ZERO not in self.network.instants:
            return -UNBOUNDED, UNBOUNDED
        return -self.network.limit(instant, ZERO), self.network.limit(ZERO, instant)


def bounds_in(expansion: Expansion) -> list[Bound]:
    """Return the bounds of the temporal constraints, leaving out those that are none."""
    found: list[Bound] = []
    for statement in expansion.statements:
        if isinstance(statement, TemporalConstraint):
            try:
                found.extend(bounds_of(statement))
            except ValueError:
                continue
    return found


def timing_of(expansion: Expansion) -> Timing:
    """Return what the temporal constraints of a chronicle amount to."""
    anchors = tuple(dict.fromkeys(event.instant for event in expansion.events))
    bounds = bounds_in(expansion)
    used = {name for statement in expansion.statements for name in instants_of(statement)}
    used |= {name for bound in bounds for name in (bound.later, bound.earlier)}
    extremes = {name: e for name, e in expansion.extremes.items() if name in used}
    names = tuple(dict.fromkeys([*anchors, *extremes, *sorted(used)]))
    network, determined = _network(names, extremes, bounds)
    if not network.consistent:
        return Timing(network, {name: Place(name, 0) for name in names}, {}, ())
    places = {name: Place(name, 0) for name in anchors}
    for name in extremes:
        places[name] = Place(determined.get(name, name), 0)
    for name in names:
        if name not in places and name != ZERO:
            place = _place(name, [*anchors, *extremes], places, network)
            if place is not None:
                places[name] = place
    open_extremes = {n: e for n, e in extremes.items() if places[n].anchor == n}
    tests = tuple(bound for bound in bounds if _concerns(bound, places, open_extremes))
    return Timing(network, places, open_extremes, tests)


def _network(
    names: tuple[str, ...], extremes: Mapping[str, Extreme], bounds: Iterable[Bound]
) -> tuple[TemporalNetwork, dict[str, str]]:
    """Return the minimal network, and which instants are an extreme whatever happens."""
    found = [*bounds, *_bounds_of_extremes(extremes)]
    determined: dict[str, str] = {}
    while True:
        network = TemporalNetwork(names, found)
        if not network.consistent:
            return network, determined
        new = {
            name: member
            for name, extreme in extremes.items()
            if name not in determined and (member := _determined(extreme, network)) is not None
        }
        if not new:
            return network, determined
        determined.update(new)
        for name, member in new.items():
            found += [Bound(name, member, 0, None), Bound(member, name, 0, None)]


def _bounds_of_extremes(extremes: Mapping[str, Extreme]) -> Iterator[Bound]:
    for name, extreme in extremes.items():
        for member in extreme.members:
            pair = (member, name) if extreme.is_end else (name, member)
            yield Bound(*pair, 0, None)


def _determined(extreme: Extreme, network: TemporalNetwork) -> str | None:
    """Return the instant that is an extreme whatever happens, if there is one."""
    for member in extreme.members:
        pairs = [(other, member) for other in extreme.members]
        if extreme.is_end:
            pairs = [(member, other) for other in extreme.members]
        if all(network.limit(*pair) <= 0 for pair in pairs):
            return member
    return None


def _place(
    name: str, anchors: Iterable[str], places: Mapping[str, Place], network: TemporalNetwork
) -> Place | None:
    for anchor in anchors:
        distance = network.limit(anchor, name)
        if distance < UNBOUNDED and distance == -network.limit(name, anchor):
            place = places[anchor]
            return Place(place.anchor, place.offset + distance)
    return None


def _concerns(
    bound: Bound, places: Mapping[str, Place], open_extremes: Mapping[str, Extreme]
) -> bool:
    ends = [places[name].anchor for name in (bound.later, bound.earlier) if name in places]
    return any(name in open_extremes for name in ends)
