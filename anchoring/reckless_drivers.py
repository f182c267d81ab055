"""Reckless drivers: cars that have been observed doing something reckless (Heintz 2009, 10.5)."""

import numpy as np

from anchoring.motion import Floats
from anchoring.rows import Rows
from dyknow.streams.table import Column, Ids, Table
from dyknow.time import TimePoint

__all__ = ["RecklessDriver"]


class RecklessDriver:
    """Computes reckless drivers from cars with what was recognised about them.

    The columns of a reckless driver are the id of its `car`, whether that is `present`, its last
    known `position`, `since` when it has been one, how many reckless acts of its car are known,
    `n_acts`, and `last_act_at`, when the last of them was recognised; times in nanoseconds.

    The cars stay linked while nobody sees them: what was done is not undone by driving away.
    """

    sort = "reckless_driver"
    trusts_predictions = True

    def create(self, ids: Ids, lower: Table, now: TimePoint) -> Table:
        """Return the cars *lower* as reckless drivers from *now* on."""
        since = np.full(len(lower), now, dtype=np.int64)
        return Table(self.sort, ids, {"since": since, **_of_car(lower)})

    def predict(self, upper: Table, now: TimePoint) -> Table:  # noqa: ARG002, the protocol's
        """Return *upper* as it was: nothing is expected to change."""
        return upper

    def update(self, upper: Table, lower: Table, now: TimePoint) -> Table:  # noqa: ARG002, the protocol's
        """Return *upper* with what is known of the cars *lower*."""
        return upper.with_columns(**_of_car(lower))

    def feature(
        self,
        name: str,  # noqa: ARG002, the protocol's
        arguments: tuple[str, ...],  # noqa: ARG002, the protocol's
        lower: Table,  # noqa: ARG002, the protocol's
        upper: Table,  # noqa: ARG002, the protocol's
    ) -> Column | None:
        """Return None: there are no features but the columns."""
        return None

    def places(self, upper: Table) -> tuple[Floats, Rows]:
        """Return the one last known position of each."""
        return upper["position"], np.arange(len(upper))

    def published(self, upper: Table) -> Table:
        """Return *upper* as it is."""
        return upper


def _of_car(lower: Table) -> dict[str, Column]:
    return {
        "car": lower.ids,
        "present": lower["present"],
        "position": lower["position"],
        "n_acts": lower["n_recognised"],
        "last_act_at": lower["recognised_at"],
    }
