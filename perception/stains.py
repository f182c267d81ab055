"""Tell marks on the road from vehicles that only the colour camera sees.

The first image does not show what is under the vehicles that stand in it, nor in their shadows.
When they have gone, a marking that the background lacks looks like a blob. What is never warmer
or colder than the road and has never moved is such a stain.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from perception.camera import Points

__all__ = ["Stains"]

_SECOND = 1_000_000_000


@dataclass(slots=True)
class _Record:
    """What is known of one track."""

    first_time: int
    last_time: int
    place: npt.NDArray[np.float64]
    is_believed: bool = False


class Stains:
    """Remembers which tracks have proved to be vehicles.

    Args:
        patience: Nanoseconds after which a doubtful track that has not moved is a stain.
        movement: Metres that prove a vehicle.
    """

    def __init__(self, *, patience: int = _SECOND, movement: float = 1.5) -> None:
        self._patience = patience
        self._movement = movement
        self._records: dict[int, _Record] = {}

    def judge(
        self,
        time: int,
        ids: npt.NDArray[np.int64],
        position: Points,
        is_doubtful: npt.NDArray[np.bool_],
    ) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
        """Return which tracks are believed to be vehicles, and which ones are stains.

        Args:
            time: Now, nanoseconds.
            ids: shape (n,), of the tracks that are seen.
            position: shape (n, 2).
            is_doubtful: shape (n,), whether the colour camera alone sees the track.
        """
        self._forget(time)
        believed = np.zeros(len(ids), dtype=bool)
        stains = np.zeros(len(ids), dtype=bool)
        for row, track in enumerate(ids.tolist()):
            record = self._records.setdefault(track, _Record(time, time, position[row]))
            record.last_time = time
            moved = float(np.hypot(*(position[row] - record.place)))
            record.is_believed |= not is_doubtful[row] or moved > self._movement
            believed[row] = record.is_believed
            stains[row] = not believed[row] and time - record.first_time >= self._patience
        return believed, stains

    def _forget(self, time: int) -> None:
        """Forget the tracks that have not been seen for a second."""
        ended = [i for i, record in self._records.items() if time - record.last_time > _SECOND]
        for track in ended:
            del self._records[track]
