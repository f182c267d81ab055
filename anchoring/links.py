"""Links between objects of two levels: what declares them, and what one is.

A link declaration is that of Heintz (2009), definition 8.5.3: `strmgen b = link(a, cu, e, r, m)`.
The objects in stream *a* are called *lower*, those in stream *b* *upper*; in a formula `from` is
the lower object and `to` the upper one. The unit *cu* has the form of `LinkUnit`.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

from anchoring.motion import Floats
from anchoring.rows import Rows
from dyknow.mtl.syntax import Formula
from dyknow.streams.table import Column, Ids, Table
from dyknow.time import Duration, TimePoint

__all__ = ["DEVIATION", "DISTANCE", "Link", "LinkEnd", "LinkSettings", "LinkUnit"]

DISTANCE = "xydist"
"""The feature that is the distance from a lower to an upper object in the plane, in metres."""

DEVIATION = "deviation"
"""The feature that tells how far two objects are apart for what is known about them: their
Mahalanobis distance, in standard deviations. A unit may have none."""


@dataclass(frozen=True, slots=True)
class LinkSettings:
    """The conditions of a link declaration.

    Attributes:
        establish: When a lower object is linked to a new upper one; may mention `from`.
        reestablish: When it is linked to a known upper one; may mention `from` and `to`.
        maintain: What must go on holding for the link to stay; may mention `from` and `to`.
        remove_after: For how long an upper object may be unanchored before it is given up.
        least_states: In how many states at least it is looked for before that, however seldom
            there are any.
    """

    establish: Formula
    reestablish: Formula
    maintain: Formula
    remove_after: Duration
    least_states: int = 1


class LinkEnd(StrEnum):
    """Why a link was removed."""

    VANISHED = "vanished"
    """The lower object was gone, or no longer observed."""

    VIOLATED = "violated"
    """The maintain condition had become false."""

    GIVEN_UP = "given up"
    """The upper object had been without observations for too long."""


@dataclass(frozen=True, slots=True)
class Link:
    """The hypothesis that two objects are the same physical object, over a stretch of time.

    Attributes:
        upper: Symbol of the more specific object, such as `car3`.
        lower: Symbol of the object its state is computed from, such as `on_road_object7`.
        begin: When the link was made.
        end: When it was removed, or None while it stands.
        ended_by: Why it was removed, if that was told.
    """

    upper: str
    lower: str
    begin: TimePoint
    end: TimePoint | None = None
    ended_by: LinkEnd | None = None

    def holds_at(self, time: TimePoint) -> bool:
        """Return whether the link stands at *time*."""
        return self.begin <= time and (self.end is None or time < self.end)


class LinkUnit(Protocol):
    """Computes the states of upper objects, from lower ones or by prediction.

    All states of the upper objects are in a table that the link process keeps; a unit has no
    state of its own. Rows of the tables given together belong together.

    Attributes:
        sort: The sort of the upper objects.
        trusts_predictions: Whether a link outlives the observation of its lower object. Say no
            where the upper object predicts better than the lower one.
    """

    sort: str
    trusts_predictions: bool

    def create(self, ids: Ids, lower: Table, now: TimePoint) -> Table:
        """Return first states at *now* of new upper objects, one for each row of *lower*."""

    def predict(self, upper: Table, now: TimePoint) -> Table:
        """Return what *upper* is expected to be at *now*, without observations."""

    def update(self, upper: Table, lower: Table, now: TimePoint) -> Table:
        """Return the states of *upper* at *now*, given the lower objects they are linked to."""

    def feature(
        self, name: str, arguments: tuple[str, ...], lower: Table, upper: Table
    ) -> Column | None:
        """Return feature *name* of each row, or None if the unit has none of that name.

        *arguments* are `from` and `to`; *upper* is empty for features of `from` alone.
        Columns of the tables need not be offered, the link process finds them itself.
        """

    def places(self, upper: Table) -> tuple[Floats, Rows]:
        """Return where the objects may be: points, shape (k, 2), and the row of each."""

    def published(self, upper: Table) -> Table:
        """Return the columns of *upper* that are of interest to others."""
