"""What vehicles did, and what finds it in the frames of a simulation."""

from dataclasses import dataclass
from typing import Protocol

from dyknow.time import TimePoint
from traffic.sumo.simulation import Frame
from traffic.truth.places import TruePlaces

__all__ = ["TrueManoeuvre", "Watcher"]


@dataclass(frozen=True, slots=True)
class TrueManoeuvre:
    """Certain vehicles did something for a while.

    Attributes:
        kind: What they did, such as `overtake`; the keys of `traffic.truth.watchers.WATCHERS`.
        vehicles: Their ids, in the order in which chronicles of this kind name them.
        place: Where, by names of the road map, if that is a part of what a recognition claims;
            else empty.
        begin: The first frame that belongs to it.
        end: The last one.
        in_view: Whether all vehicles were in view all the while.
    """

    kind: str
    vehicles: tuple[int, ...]
    place: tuple[str, ...]
    begin: TimePoint
    end: TimePoint
    in_view: bool = True


class Watcher(Protocol):
    """Finds the manoeuvres of some kinds, by a definition that it documents."""

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in the next frame; return the manoeuvres that became certain with it.

        Args:
            frame: Of the simulation; all frames of it, in order.
            places: Where its vehicles are, row by row.
        """

    def finish(self) -> list[TrueManoeuvre]:
        """Return the manoeuvres that still go on in the last frame; they end there."""
