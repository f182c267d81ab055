"""Cars: on-road objects that look and move like cars, with the areas that they are in."""

import numpy as np

from anchoring.links import DISTANCE
from anchoring.motion import Floats
from anchoring.rows import Rows
from dyknow.streams.table import Column, Ids, Table
from dyknow.time import SECOND, TimePoint
from networks.roads import RoadMap

__all__ = ["Car"]


class Car:
    """Computes cars from on-road objects: the same states, and where they are on the map.

    Added are the areas in which a car is, `lane`, `link` and `crossing` (indices into the map,
    -1 for none), and, of the road it travels on, whether in its areas or beside them, the
    `link_of_road` (-1 in crossings), the `direction_in_link` (1 along the link, -1 against it)
    and the `position_along_link` in metres.

    Args:
        roads: The road network.
    """

    sort = "car"
    trusts_predictions = True

    def __init__(self, roads: RoadMap) -> None:
        self._roads = roads

    def create(self, ids: Ids, lower: Table, now: TimePoint) -> Table:
        """Return the on-road objects *lower* as cars."""
        return self._located(Table(self.sort, ids, lower.columns), now)

    def predict(self, upper: Table, now: TimePoint) -> Table:
        """Return *upper* straight on, for as long as no on-road object says better."""
        elapsed = (now - upper["computed_at"]) / SECOND
        step = upper["velocity"] * elapsed[:, None]
        moved = upper.with_columns(
            position=upper["position"] + step,
            s=upper["s"] + upper["speed"] * elapsed,
            observed=np.zeros(len(upper), dtype=np.bool_),
        )
        return self._located(moved, now)

    def update(self, upper: Table, lower: Table, now: TimePoint) -> Table:
        """Return the on-road objects *lower* as the cars they are linked to."""
        return self._located(Table(self.sort, upper.ids, lower.columns), now)

    def feature(
        self, name: str, arguments: tuple[str, ...], lower: Table, upper: Table
    ) -> Column | None:
        """Return `xydist(from, to)`: metres between on-road object and car."""
        if (name, arguments) != (DISTANCE, ("from", "to")):
            return None
        distance: Floats = np.linalg.norm(lower["position"] - upper["position"], axis=1)
        return distance

    def places(self, upper: Table) -> tuple[Floats, Rows]:
        """Return the one position of each car."""
        return upper["position"], np.arange(len(upper))

    def published(self, upper: Table) -> Table:
        """Return *upper* as it is."""
        return upper

    def _located(self, upper: Table, now: TimePoint) -> Table:
        roads = self._roads
        areas = roads.locate(upper["position"])
        road = upper["road"]
        direction = roads.direction_in_link[road]
        return upper.with_columns(
            lane=areas.lane,
            link=areas.link,
            crossing=areas.crossing,
            link_of_road=roads.link_of_road[road],
            direction_in_link=direction,
            position_along_link=roads.offset_in_link[road] + direction * upper["s"],
            computed_at=np.full(len(upper), now, dtype=np.int64),
        )
