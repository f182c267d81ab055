"""What the map says about turning, as events that a chronicle can refer to."""

from collections.abc import Iterator

from chronicles.events import Event
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from networks.roads import RoadMap

__all__ = ["LinkTurns"]


class LinkTurns:
    """A source of one sample at time 0: the relations of links, as changes from unknown to true.

    `links.left[?l1, ?x, ?l2]` is true if who comes from the link ?l1 through the crossing ?x and
    goes on on the link ?l2 has turned left; likewise `right`, `straight` and `uturn`
    (Heintz 2009, section 8.7.4). `links.turn[?l1, ?x, ?l2]` has the name of the turn as its value.
    """

    def __init__(self, road_map: RoadMap) -> None:
        self._map = road_map

    def samples(self) -> Iterator[Sample[tuple[Event, ...]]]:
        """Yield the sample."""
        zero = TimePoint(0)
        turns = self._map.turn_names.items()
        events = (
            *(Event(f"links.{turn.value}", place, None, "true", zero) for place, turn in turns),
            *(Event("links.turn", place, None, turn.value, zero) for place, turn in turns),
        )
        yield Sample(events, zero, zero)
