"""World objects: physical things in the plane, computed from percepts.

Without percepts they are taken to go straight on at their last velocity (Heintz, Kvarnström and
Doherty 2009, 'A stream-based hierarchical anchoring framework', section V).
"""

import numpy as np

from anchoring.links import DEVIATION, DISTANCE
from anchoring.motion import Floats, predict_in_plane, update_in_plane
from anchoring.rows import Mask, Rows, choose
from dyknow.streams.table import Column, Ids, Table
from dyknow.time import SECOND, Duration, TimePoint, milliseconds

__all__ = ["WorldObject"]

_OWN_COLUMNS = frozenset({"position", "velocity", "covariance", "observed_at"})
_FILTER_COLUMNS = frozenset({"filter_mean", "filter_covariance", "filtered_at", "percept"})


_RESTART_AFTER = milliseconds(300)


class WorldObject:
    """Computes world objects from percepts with a constant-velocity filter in the plane.

    A percept is used at the time it was observed, once, and the state is then carried forward to
    the time of the table. Sizes, colours and temperatures are averaged.

    Args:
        acceleration_density: How much objects accelerate: spectral density, m²/s³.
        velocity_deviation: How far the first velocity of a percept may be wrong, m/s.
        averaging: Share of a new percept in the averages.
        restart_after: After a gap as long as this an object that is linked to another percept
            starts anew, because it may in truth be another one with another velocity.
    """

    sort = "world_object"
    trusts_predictions = False

    def __init__(
        self,
        *,
        acceleration_density: float = 1.0,
        velocity_deviation: float = 10.0,
        averaging: float = 0.1,
        restart_after: Duration = _RESTART_AFTER,
    ) -> None:
        self._density = acceleration_density
        self._velocity_variance = velocity_deviation**2
        self._averaging = averaging
        self._restart_after = restart_after

    def create(self, ids: Ids, lower: Table, now: TimePoint) -> Table:
        """Return world objects that begin as the percepts *lower* are."""
        mean, covariance = self._begin(lower)
        columns = {name: lower[name] for name in lower.columns if name not in _OWN_COLUMNS}
        columns |= {
            "filter_mean": mean,
            "filter_covariance": covariance,
            "filtered_at": lower["observed_at"].astype(np.int64),
            "percept": lower.ids,
        }
        return self._observed(Table(self.sort, ids, columns), lower, now)

    def predict(self, upper: Table, now: TimePoint) -> Table:
        """Return *upper* carried straight on to *now*, with nothing measured."""
        n = len(upper)
        return self._carried(upper, now).with_columns(
            observed=np.zeros(n, dtype=np.bool_),
            measured_position=np.full((n, 2), np.nan),
            measured_covariance=np.full((n, 2, 2), np.nan),
        )

    def update(self, upper: Table, lower: Table, now: TimePoint) -> Table:
        """Return *upper* corrected by the percepts *lower* that were not used before."""
        observed_at = lower["observed_at"].astype(np.int64)
        elapsed = (observed_at - upper["filtered_at"]) / SECOND
        fresh = elapsed > 0
        mean, covariance = predict_in_plane(
            upper["filter_mean"],
            upper["filter_covariance"],
            np.maximum(elapsed, 0.0),
            self._density,
        )
        mean, covariance = update_in_plane(
            mean, covariance, lower["position"], lower["covariance"]
        )
        is_other = lower.ids != upper["percept"]
        anew = is_other & (elapsed * SECOND >= self._restart_after)
        first_mean, first_covariance = self._begin(lower)
        mean = choose(anew, first_mean, mean)
        covariance = choose(anew, first_covariance, covariance)
        corrected = upper.with_columns(
            filter_mean=choose(fresh, mean, upper["filter_mean"]),
            filter_covariance=choose(fresh, covariance, upper["filter_covariance"]),
            filtered_at=np.where(fresh, observed_at, upper["filtered_at"]),
            percept=lower.ids,
            **self._averages(upper, lower, fresh),
        )
        return self._observed(corrected, lower, now)

    def feature(
        self, name: str, arguments: tuple[str, ...], lower: Table, upper: Table
    ) -> Column | None:
        """Return a feature of percepts with predicted world objects.

        - `xydist(from, to)`: metres between them;
        - `deviation(from, to)`: the same in standard deviations of both.
        """
        if arguments != ("from", "to"):
            return None
        apart = lower["position"] - upper["position"]
        if name == DISTANCE:
            distance: Column = np.hypot(apart[:, 0], apart[:, 1])
            return distance
        if name == DEVIATION:
            spread = lower["covariance"] + upper["covariance"][:, :2, :2]
            scaled = np.linalg.solve(spread, apart[:, :, None])[:, :, 0]
            deviation: Column = np.sqrt((apart * scaled).sum(axis=1))
            return deviation
        return None

    def places(self, upper: Table) -> tuple[Floats, Rows]:
        """Return the one position of each world object."""
        return upper["position"], np.arange(len(upper))

    def published(self, upper: Table) -> Table:
        """Return *upper* without the state of the filter."""
        columns = {n: c for n, c in upper.columns.items() if n not in _FILTER_COLUMNS}
        return Table(upper.sort, upper.ids, columns)

    def _begin(self, lower: Table) -> tuple[Floats, Floats]:
        mean = np.concatenate((lower["position"], np.nan_to_num(lower["velocity"])), axis=1)
        covariance = np.zeros((len(lower), 4, 4))
        covariance[:, :2, :2] = lower["covariance"]
        covariance[:, 2:, 2:] = self._velocity_variance * np.eye(2)
        return mean, covariance

    def _carried(self, upper: Table, now: TimePoint) -> Table:
        elapsed = np.maximum(now - upper["filtered_at"], 0) / SECOND
        mean, covariance = predict_in_plane(
            upper["filter_mean"], upper["filter_covariance"], elapsed, self._density
        )
        return upper.with_columns(
            position=mean[:, :2],
            velocity=mean[:, 2:],
            covariance=covariance,
            observed_at=upper["filtered_at"],
        )

    def _observed(self, upper: Table, lower: Table, now: TimePoint) -> Table:
        return self._carried(upper, now).with_columns(
            observed=np.ones(len(upper), dtype=np.bool_),
            measured_position=lower["position"],
            measured_covariance=lower["covariance"],
        )

    def _averages(self, upper: Table, lower: Table, fresh: Mask) -> dict[str, Column]:
        averages = {}
        for name, column in lower.columns.items():
            if name in _OWN_COLUMNS or not np.issubdtype(column.dtype, np.floating):
                continue
            old = upper[name]
            averaged = np.where(np.isnan(old), column, old + self._averaging * (column - old))
            known = choose(fresh, ~np.isnan(column), np.zeros(column.shape, dtype=np.bool_))
            averages[name] = np.where(known, averaged, old).astype(column.dtype)
        return averages
