"""Which vehicle of the simulator a car symbol stands for, by where they are."""

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from dyknow.time import TimePoint

__all__ = ["Association"]

Ids = npt.NDArray[np.int64]
Points = npt.NDArray[np.float64]
Positions = npt.NDArray[np.intp]


class Association:
    """Remembers which vehicle each car stands for at each time, as Bernardin and Stiefelhagen.

    A car goes on standing for the vehicle that it stood for last, as long as it is within the
    gate; of several such cars, the nearest one does. All others are paired with the vehicles that
    are left within the gate so that the sum of distances is as small as it can be (CLEAR MOT,
    2008). So no two cars stand for one vehicle at a time, and two cars beside each other
    do not change places because one estimate is nearer to the other vehicle for a moment.

    This is a measuring instrument: nothing that reasons about cars may see it.

    Args:
        gate: A car further than this from a vehicle does not stand for it, metres.
    """

    def __init__(self, gate: float) -> None:
        self._gate = gate
        self._latest: dict[int, int] = {}
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
        apart = car_positions[:, None] - vehicle_positions[None]
        distances = np.hypot(apart[..., 0], apart[..., 1])
        rows, columns = self._kept(car_ids, vehicle_ids, distances)
        others = _nearest_pairs(distances, self._gate, rows, columns)
        rows, columns = np.append(rows, others[0]), np.append(columns, others[1])
        found_cars, found_vehicles = car_ids[rows], vehicle_ids[columns]
        self._latest.update(zip(found_cars.tolist(), found_vehicles.tolist(), strict=True))
        self._times.append(np.full(len(rows), time, dtype=np.int64))
        self._cars.append(found_cars)
        self._vehicles.append(found_vehicles)
        self._sorted = None

    def vehicle_of(self, car: int, begin: int, end: int) -> int | None:
        """Return what *car* stands for most of the time from *begin* to *end*, if for anything."""
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

    def _kept(
        self, cars: Ids, vehicles: Ids, distances: npt.NDArray[np.float64]
    ) -> tuple[Positions, Positions]:
        """Return the rows and columns of the pairs of before that are within the gate still."""
        column_by_vehicle = {int(vehicle): i for i, vehicle in enumerate(vehicles)}
        pairs = [
            (row, column)
            for row, car in enumerate(cars.tolist())
            if (column := column_by_vehicle.get(self._latest.get(car, -1))) is not None
            and distances[row, column] <= self._gate
        ]
        rows, columns = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
        nearest_first = np.argsort(distances[rows, columns], kind="stable")
        _, first = np.unique(columns[nearest_first], return_index=True)
        chosen = nearest_first[first]
        return rows[chosen], columns[chosen]

    def _index(self) -> tuple[Ids, Ids, Ids]:
        if self._sorted is None:
            none = np.empty(0, dtype=np.int64)
            cars = np.concatenate([none, *self._cars])
            times = np.concatenate([none, *self._times])
            vehicles = np.concatenate([none, *self._vehicles])
            order = np.lexsort((times, cars))
            self._sorted = cars[order], times[order], vehicles[order]
        return self._sorted


def _nearest_pairs(
    distances: npt.NDArray[np.float64], gate: float, rows: Positions, columns: Positions
) -> tuple[Positions, Positions]:
    """Return the pairs, none of them in *rows* or *columns*, whose distances add up to least.

    As many as possible are made within the gate.
    """
    free_rows = np.setdiff1d(np.arange(distances.shape[0]), rows)
    free_columns = np.setdiff1d(np.arange(distances.shape[1]), columns)
    costs = distances[np.ix_(free_rows, free_columns)]
    far = costs > gate
    reached = ~far.all(axis=1)
    free_rows, costs, far = free_rows[reached], costs[reached], far[reached]
    forbidden = gate * (costs.shape[0] + 1)
    left, right = linear_sum_assignment(np.where(far, forbidden, costs))
    near = ~far[left, right]
    return free_rows[left[near]], free_columns[right[near]]
