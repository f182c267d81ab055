"""On-road objects: world objects that move along roads, filtered in road coordinates.

A place on a road is its index, s metres along its centre line and d metres to the left of it.
Without observations an object goes on along its road at retained speed, in several branches after
a crossing (see `anchoring.branches`); its distance to a world object is that of the nearest one.
"""

import numpy as np
import numpy.typing as npt

from anchoring.branches import Branches, BranchSettings, RoadFollower, grown_unseen
from anchoring.motion import Floats
from anchoring.rows import Rows, take, with_rows
from dyknow.streams.table import Column, Ids, Table
from dyknow.time import SECOND, TimePoint
from networks.roads import RoadMap

__all__ = ["OnRoadObject"]

_FILTER_COLUMNS = frozenset({"branches", "places", "headings", "misfit", "filtered_at"})
_LOWER_COLUMNS = frozenset(
    {"position", "velocity", "covariance", "measured_position", "measured_covariance"}
)
_UNCARRIED_COLUMNS = _LOWER_COLUMNS | _FILTER_COLUMNS
_SMOOTHING = 0.2
"""Share of a new measurement in the running misfit."""

_ANYWHERE = 1e5
"""Metres within which there is some road."""

_LEAST_DEVIATION = 0.5
"""Metres of misfit that are never held against a road."""


class OnRoadObject:
    """Computes on-road objects from world objects with filters along the roads.

    Args:
        roads: The road network.
        branches: How roads are followed.
        road_margin: Up to how many metres beside a road a world object still is on it, beyond
            twice the standard deviation of its position.
        misfit_limit: Mean squared deviation, in variances, at which another road is looked for.
        stray_limit: Metres beside its road at which another road is looked for.
        steering_speed: Speed from which the direction of travel can be told, m/s.
    """

    sort = "on_road_object"
    trusts_predictions = False

    def __init__(
        self,
        roads: RoadMap,
        *,
        branches: BranchSettings | None = None,
        road_margin: float = 1.0,
        misfit_limit: float = 4.0,
        stray_limit: float = 4.0,
        steering_speed: float = 1.5,
    ) -> None:
        self._roads = roads
        self._settings = branches if branches is not None else BranchSettings()
        self._follower = RoadFollower(roads, self._settings)
        self._half_widths: Floats = np.asarray(roads.road_width, dtype=np.float64) / 2
        self._road_margin = road_margin
        self._misfit_limit = misfit_limit
        self._stray_limit = stray_limit
        self._steering_speed = steering_speed

    def create(self, ids: Ids, lower: Table, now: TimePoint) -> Table:
        """Return on-road objects on the roads that fit the world objects *lower* best."""
        n = len(lower)
        road = self._road_of(lower)
        mean = np.concatenate((lower["position"], lower["velocity"]), axis=1)
        begun = self._follower.start(np.arange(n), road, mean, lower["covariance"])
        columns = _carried(lower) | {
            "branches": self._follower.tabulate(begun, n),
            "filtered_at": np.full(n, now, dtype=np.int64),
            "misfit": np.ones(n),
        }
        return self._placed(Table(self.sort, ids, columns), lower["position"], now, observed=True)

    def predict(self, upper: Table, now: TimePoint) -> Table:
        """Return *upper* carried along the roads to *now*, one branch for each way they may go."""
        return self._placed(self._advanced(upper, now), upper["world_position"], now)

    def update(self, upper: Table, lower: Table, now: TimePoint) -> Table:
        """Return *upper* corrected by what was measured of the world objects *lower*."""
        upper = self._advanced(upper, now).with_columns(**_carried(lower))
        fresh = np.flatnonzero(lower["observed_at"] > upper["filtered_at"])
        upper = with_rows(upper, fresh, self._corrected(take(upper, fresh), take(lower, fresh)))
        lost = self._lost(upper, lower)
        upper = with_rows(upper, lost, self._matched(upper.select(lost), lower.select(lost), now))
        return self._placed(upper, lower["position"], now, observed=True)

    def feature(
        self, name: str, arguments: tuple[str, ...], lower: Table, upper: Table
    ) -> Column | None:
        """Return a feature of world objects, alone or with on-road objects.

        - `on_road(from)`: whether the world object is on a road;
        - `xydist(from, to)`: metres from the world object to the nearest branch;
        - `deviation(from, to)`: how far position and velocity are from those of the branch that
          fits best, in standard deviations of both.
        """
        match name, arguments:
            case "on_road", ("from",):
                variance = lower["covariance"][:, (0, 1), (0, 1)].mean(axis=1)
                margin = self._road_margin + 2 * np.sqrt(variance)
                on_road: Column = self._roads.distance_to_road(lower["position"]) <= margin
                return on_road
            case "xydist", ("from", "to"):
                apart = upper["places"] - lower["position"][:, None, :]
                distance: Column = np.nanmin(np.linalg.norm(apart, axis=2), axis=1)
                return distance
            case "deviation", ("from", "to"):
                return _deviation(lower, upper)
            case _:
                return None

    def places(self, upper: Table) -> tuple[Floats, Rows]:
        """Return the position of every branch of every object."""
        rows, ranks = np.nonzero(upper["branches"]["road"] >= 0)
        return upper["places"][rows, ranks], rows

    def published(self, upper: Table) -> Table:
        """Return *upper* without the branches and other states of the filter."""
        columns = {n: c for n, c in upper.columns.items() if n not in _FILTER_COLUMNS}
        return Table(upper.sort, upper.ids, columns)

    def _road_of(self, lower: Table) -> npt.NDArray[np.int32]:
        """Return the road that fits each world object best, however far away it is."""
        position, velocity = lower["position"], lower["velocity"]
        road = self._roads.match(position, velocity, self._settings.match_distance)
        far = np.flatnonzero(road < 0)
        if len(far):
            road[far] = self._roads.match(position[far], velocity[far], _ANYWHERE)
        return road

    def _advanced(self, upper: Table, now: TimePoint) -> Table:
        """Return *upper* with branches on the roads on which they are at *now*."""
        branches = Branches.of(upper["branches"])
        ahead = self._follower.advance(branches, _elapsed(upper, now)[branches.owner])
        if ahead is branches:
            return upper
        return upper.with_columns(branches=self._follower.tabulate(ahead, len(upper)))

    def _corrected(self, upper: Table, lower: Table) -> Table:
        """Return *upper* with filters that have taken in the measurements of *lower*."""
        branches = Branches.of(upper["branches"])
        owner = branches.owner
        elapsed = (lower["observed_at"] - upper["filtered_at"]) / SECOND
        position, noise = lower["measured_position"], lower["measured_covariance"]
        corrected = self._follower.correct(branches, elapsed[owner], position[owner], noise[owner])
        table = self._follower.tabulate(corrected, len(upper))
        best = table[:, 0]
        s, d = self._follower.position(Branches.of(table[:, :1]), np.zeros(len(upper)))
        apart = position - self._roads.point_at(best["road"], s, d)
        deviation = np.trace(noise, axis1=1, axis2=2) / 2 + _LEAST_DEVIATION**2
        misfit = (apart**2).sum(axis=1) / 2 / deviation
        return upper.with_columns(
            branches=table,
            filtered_at=lower["observed_at"],
            misfit=upper["misfit"] + _SMOOTHING * (misfit - upper["misfit"]),
        )

    def _lost(self, upper: Table, lower: Table) -> Rows:
        """Return the rows of objects that seem to be on another road than on their branches."""
        best = Branches.of(upper["branches"][:, :1])
        along, across = best.along.expected(), best.across.expected()
        beside = np.abs(across[:, 0]) - self._half_widths[best.state["road"]]
        strange = (
            (upper["misfit"] > self._misfit_limit)
            | (beside > self._stray_limit)
            | (along[:, 1] < -2 * self._steering_speed)
        )
        moving = np.linalg.norm(lower["velocity"], axis=1) > self._steering_speed
        return np.flatnonzero(strange & moving)

    def _matched(self, upper: Table, lower: Table, now: TimePoint) -> Table:
        """Return *upper* with a branch more, on the road that fits *lower* best."""
        road = self._roads.match(
            lower["position"], lower["velocity"], self._settings.match_distance
        )
        known = (upper["branches"]["road"] == road[:, None]).any(axis=1)
        new = np.flatnonzero((road >= 0) & ~known)
        mean = np.concatenate((lower["position"], lower["velocity"]), axis=1)[new]
        started = self._follower.start(new, road[new], mean, lower["covariance"][new])
        branches = Branches.of(upper["branches"])
        # The state is that of the world object at *now*, the filters are behind by this much.
        behind = _elapsed(upper, now)[new]
        speed = started.state["along_mean"][:, :, 1]
        started.state["along_mean"][:, :, 0] -= np.maximum(speed, 0.0) * behind[:, None]
        table = self._follower.tabulate(branches.joined(started), len(upper))
        return upper.with_columns(branches=table, misfit=np.ones(len(upper)))

    def _placed(
        self, upper: Table, world_position: Floats, now: TimePoint, *, observed: bool = False
    ) -> Table:
        """Return *upper* with the columns that follow from its branches at *now*."""
        n = len(upper)
        table = upper["branches"]
        branches = Branches.of(table)
        elapsed = _elapsed(upper, now)
        s, d = self._follower.position(branches, elapsed[branches.owner])
        points = self._roads.point_at(branches.state["road"], s, d)
        alive = table["road"] >= 0
        places = np.full((*table.shape, 2), np.nan)
        places[alive] = points
        headings = np.full(table.shape, np.nan)
        headings[alive] = self._roads.heading_at(branches.state["road"], s)
        best = Branches.of(table[:, :1])
        first = np.searchsorted(branches.owner, np.arange(n))
        road, s, d = best.state["road"], s[first], d[first]
        along, along_variance = best.along.estimate()
        across, across_variance = best.across.estimate()
        along_variance, across_variance = grown_unseen(along_variance, across_variance, elapsed)
        heading = headings[:, 0]
        ahead = np.stack((np.cos(heading), np.sin(heading)), axis=1)
        left = np.stack((-ahead[:, 1], ahead[:, 0]), axis=1)
        backwards = along[:, 1] < -self._steering_speed
        return upper.with_columns(
            places=places,
            headings=headings,
            position=places[:, 0],
            velocity=along[:, 1:] * ahead + across[:, 1:] * left,
            speed=np.abs(along[:, 1]),
            road=road.astype(np.int32),
            s=s,
            d=d,
            s_variance=along_variance[:, 0],
            d_variance=across_variance[:, 0],
            speed_variance=along_variance[:, 2],
            drift_variance=across_variance[:, 2],
            heading=heading + np.pi * backwards,
            world_position=world_position,
            observed=np.full(n, observed),
        )


def _carried(lower: Table) -> dict[str, Column]:
    """Return the columns that an on-road object has from its world object unchanged."""
    return {
        name: column for name, column in lower.columns.items() if name not in _UNCARRIED_COLUMNS
    }


def _elapsed(upper: Table, now: TimePoint) -> Floats:
    """Return the seconds since the last measurement of each object."""
    elapsed: Floats = np.maximum(now - upper["filtered_at"], 0) / SECOND
    return elapsed


def _deviation(lower: Table, upper: Table) -> Floats:
    """Return the least Mahalanobis distance of each world object from a branch, along and across.

    How the errors of position and velocity, and of along and across, depend on one another is
    left out of account.
    """
    headings = upper["headings"]
    ahead = np.stack((np.cos(headings), np.sin(headings)), axis=2)
    left = np.stack((-ahead[:, :, 1], ahead[:, :, 0]), axis=2)
    position = lower["position"][:, None, :] - upper["places"]
    velocity = lower["velocity"][:, None, :] - upper["speed"][:, None, None] * ahead
    squared = np.zeros(headings.shape)
    for apart, at, variances in (
        (position, slice(0, 2), ("s_variance", "d_variance")),
        (velocity, slice(2, 4), ("speed_variance", "drift_variance")),
    ):
        spread = lower["covariance"][:, None, at, at]
        for way, variance in zip((ahead, left), variances, strict=True):
            known = (way[:, :, None, :] @ spread @ way[:, :, :, None])[:, :, 0, 0]
            squared += (apart * way).sum(axis=2) ** 2 / (known + upper[variance][:, None])
    deviation: Floats = np.sqrt(np.nanmin(squared, axis=1))
    return deviation
