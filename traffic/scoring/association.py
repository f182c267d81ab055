"""Which vehicle of the simulator a car symbol stands for, by where they are."""

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from dyknow.time import TimePoint

__all__ = ["Association"]

Ids = npt.NDArray[np.int64]
Points = npt.NDArray[np.float64]


class Association:
    """Remembers the vehicle that is nearest to each car at each time.

    This is a measuring instrument: nothing that reasons about cars may see it.

    Args:
        gate: A car further than this from every vehicle stands for none, metres.
    """

    def __init__(self, gate: float = 4.0) -> None:
        self._gate = gate
        self._times: list[npt.NDArray[np.int64]] = []
        self._cars: list[Ids] = []
        self._vehicles: list[Ids] = []
        self._sorted: tuple[Ids, Ids, Ids] | None = None

    def observe(
        self, time: TimePoint, cars: tuple[Ids, Points], vehicles: tuple[Ids, Points]
    ) -> None:
        """Take in where cars are believed to be and where vehicles are, both at *time*.

        Args:
            time: When.
            cars: Ids, shape (n,), and positions, shape (n, 2), metres in the world frame.
            vehicles: The same of the simulator's vehicles.
        """
        car_ids, car_positions = cars
        vehicle_ids, vehicle_positions = vehicles
        if not len(car_ids) or not len(vehicle_ids):
            return
        found = cKDTree(vehicle_positions).query(car_positions)
        distance, nearest = np.asarray(found[0]), np.asarray(found[1])
        near = distance <= self._gate
        self._times.append(np.full(int(near.sum()), time, dtype=np.int64))
        self._cars.append(car_ids[near])
        self._vehicles.append(vehicle_ids[nearest[near]])
        self._sorted = None

    def vehicle_of(self, car: int, begin: int, end: int) -> int | None:
        """Return the vehicle nearest to *car* most of the time from *begin* to *end*, if any."""
        cars, times, vehicles = self._index()
        first, last = np.searchsorted(cars, [car, car + 1])
        within = slice(
            first + np.searchsorted(times[first:last], begin),
            first + np.searchsorted(times[first:last], end, side="right"),
        )
        candidates, counts = np.unique(vehicles[within], return_counts=True)
        if not len(candidates):
            return None
        return int(candidates[np.argmax(counts)])

    def _index(self) -> tuple[Ids, Ids, Ids]:
        if self._sorted is None:
            none = np.empty(0, dtype=np.int64)
            cars = np.concatenate([none, *self._cars])
            times = np.concatenate([none, *self._times])
            vehicles = np.concatenate([none, *self._vehicles])
            order = np.lexsort((times, cars))
            self._sorted = cars[order], times[order], vehicles[order]
        return self._sorted
