"""Keep blobs apart from frame to frame, on the ground.

A track is followed by a Kalman filter of constant velocity and takes the sighting that the
assignment gives it. It counts after a few sightings and ends when none has come for a short
while: a track lasts as long as its blob can be followed and no longer. To take up an object
again after it was hidden is anchoring's task.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from perception.assignment import assign
from perception.camera import Points
from perception.columns import concatenate, select
from perception.fusion import lies_in
from perception.kalman import Covariances, States, mahalanobis_squared, predict, update
from perception.locating import Sightings, no_sightings

__all__ = ["Tracker", "TrackingSettings", "Tracks", "as_sightings"]

_SECOND = 1_000_000_000


@dataclass(frozen=True, slots=True)
class TrackingSettings:
    """How blobs are followed.

    Attributes:
        acceleration: Deviation of the acceleration of vehicles along each axis, m/s².
        gate: Greatest squared Mahalanobis distance between a track and its sighting; wide, since
            vehicles keep off one another and none may be lost when it jerks.
        hits_to_count: Sightings after which a track counts.
        longest_gap: Nanoseconds without a sighting after which a track ends.
        longest_first_gap: The same for a track that does not count yet.
        first_speed: Deviation of the velocity of what is seen for the first time, m/s.
        memory: Weight of a new length or width in the mean of a track.
    """

    acceleration: float = 4.0
    gate: float = 50.0
    hits_to_count: int = 3
    longest_gap: int = 300_000_000
    longest_first_gap: int = 60_000_000
    first_speed: float = 8.0
    memory: float = 0.08


@dataclass(frozen=True, slots=True, eq=False)
class Tracks:
    """Everything that is followed, as columns.

    Attributes:
        ids: shape (n,); never used again.
        states: shape (n, 4): x, y, vx, vy.
        covariances: shape (n, 4, 4).
        heading: shape (n,), of the velocity, or of the long axis of what has not moved.
        length: shape (n,), running mean.
        width: shape (n,), running mean.
        hits: shape (n,), number of sightings.
        last_seen: shape (n,), nanoseconds.
    """

    ids: npt.NDArray[np.int64]
    states: States
    covariances: Covariances
    heading: npt.NDArray[np.float64]
    length: npt.NDArray[np.float64]
    width: npt.NDArray[np.float64]
    hits: npt.NDArray[np.int64]
    last_seen: npt.NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.ids)


class Tracker:
    """Follows sightings from frame to frame."""

    def __init__(self, settings: TrackingSettings | None = None) -> None:
        self._settings = settings or TrackingSettings()
        self._time = 0
        self._next_id = 1
        self._tracks = self._begin(no_sightings(), 0)

    def predict(self, time: int) -> Tracks:
        """Carry all tracks to *time*, nanoseconds, and return them."""
        if time > self._time and len(self._tracks):
            elapsed = (time - self._time) / _SECOND
            states, covariances = predict(
                self._tracks.states,
                self._tracks.covariances,
                elapsed,
                self._settings.acceleration,
            )
            self._tracks.states[:] = states
            self._tracks.covariances[:] = covariances
        self._time = time
        return self._tracks

    def update(
        self, sightings: Sightings, is_part: npt.NDArray[np.bool_]
    ) -> tuple[Tracks, npt.NDArray[np.intp]]:
        """Take in the sightings of the time to which the tracks were carried.

        Args:
            sightings: Where vehicles are seen.
            is_part: shape (n,); which ones were cut out of a larger blob, so that their size
                tells nothing.

        Returns:
            The tracks that count and are seen now, and the row of the sighting of each.
        """
        time = self._time
        distance = mahalanobis_squared(
            self._tracks.states,
            self._tracks.covariances,
            sightings.position,
            sightings.covariance,
        )
        rows, seen = assign(distance, self._settings.gate)
        self._correct(rows, select(sightings, seen), is_part[seen])
        is_new = np.ones(len(sightings), dtype=bool)
        is_new[seen] = False
        is_new &= ~self._covered(sightings.position, rows)
        begun = self._begin(select(sightings, is_new), time)
        sighting = np.full(len(self._tracks), -1, dtype=np.intp)
        sighting[rows] = seen
        kept = self._is_kept(time)
        self._tracks = concatenate([select(self._tracks, kept), begun])
        sighting = np.concatenate([sighting[kept], np.flatnonzero(is_new)])
        counts = (sighting >= 0) & (self._tracks.hits >= self._settings.hits_to_count)
        return select(self._tracks, counts), sighting[counts]

    def _correct(
        self,
        rows: npt.NDArray[np.intp],
        sightings: Sightings,
        is_part: npt.NDArray[np.bool_],
    ) -> None:
        """Correct the tracks *rows* by one sighting each."""
        tracks = self._tracks
        states, covariances = update(
            tracks.states[rows], tracks.covariances[rows], sightings.position, sightings.covariance
        )
        tracks.states[rows] = states
        tracks.covariances[rows] = covariances
        tracks.hits[rows] += 1
        tracks.last_seen[rows] = self._time
        weight = np.maximum(self._settings.memory, 1.0 / tracks.hits[rows])
        weight = np.where(is_part, 0.0, weight)
        tracks.length[rows] += weight * (sightings.length - tracks.length[rows])
        tracks.width[rows] += weight * (sightings.width - tracks.width[rows])
        speed = np.hypot(states[:, 2], states[:, 3])
        course = np.arctan2(states[:, 3], states[:, 2])
        tracks.heading[rows] = np.where(speed > _MOVING, course, tracks.heading[rows])

    def _covered(self, points: Points, rows: npt.NDArray[np.intp]) -> npt.NDArray[np.bool_]:
        """Return which points lie on vehicles that are seen anyway: they are pieces of these."""
        counts = rows[self._tracks.hits[rows] > self._settings.hits_to_count]
        if not len(counts) or not len(points):
            return np.zeros(len(points), dtype=bool)
        return np.asarray(lies_in(points, as_sightings(select(self._tracks, counts))).any(axis=1))

    def _is_kept(self, time: int) -> npt.NDArray[np.bool_]:
        settings = self._settings
        counts = self._tracks.hits >= settings.hits_to_count
        longest = np.where(counts, settings.longest_gap, settings.longest_first_gap)
        return np.asarray(time - self._tracks.last_seen <= longest)

    def _begin(self, sightings: Sightings, time: int) -> Tracks:
        """Return new tracks, one for each sighting."""
        count = len(sightings)
        ids = np.arange(self._next_id, self._next_id + count, dtype=np.int64)
        self._next_id += count
        covariances = np.zeros((count, 4, 4))
        covariances[:, :2, :2] = sightings.covariance
        covariances[:, 2:, 2:] = self._settings.first_speed**2 * np.eye(2)
        return Tracks(
            ids,
            np.concatenate([sightings.position, np.zeros((count, 2))], axis=1),
            covariances,
            sightings.angle.copy(),
            sightings.length.copy(),
            sightings.width.copy(),
            np.ones(count, dtype=np.int64),
            np.full(count, time, dtype=np.int64),
        )


_MOVING = 1.5


def as_sightings(tracks: Tracks) -> Sightings:
    """Return where the tracks are predicted to be seen."""
    return Sightings(
        tracks.states[:, :2].copy(),
        tracks.covariances[:, :2, :2],
        tracks.length,
        tracks.width,
        tracks.heading,
        tracks.length * tracks.width,
        np.full(len(tracks), -1, dtype=np.intp),
    )
