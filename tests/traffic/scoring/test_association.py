"""Which vehicle a car symbol stands for."""

import numpy as np

from dyknow.time import TimePoint
from traffic.scoring.association import Association


def observed(*frames: tuple[int, dict[int, float], dict[int, float]]) -> Association:
    """Observe frames of (time, x by car, x by vehicle) along one line."""
    association = Association(gate=4.0)
    for time, cars, vehicles in frames:
        columns = [
            (np.array(list(row)), np.array([[x, 0.0] for x in row.values()]))
            for row in (cars, vehicles)
        ]
        association.observe(TimePoint(time), columns[0], columns[1])
    return association


def test_a_car_stands_for_the_vehicle_that_is_nearest_most_of_the_time():
    """One frame nearer to another vehicle changes nothing."""
    frames = [(t, {7: 0.0}, {1: 1.0, 2: 3.0}) for t in range(5)]
    association = observed(*frames, (5, {7: 0.0}, {1: 3.0, 2: 1.0}))

    assert association.vehicle_of(7, 0, 5) == 1


def test_only_the_asked_time_counts():
    """A symbol that has moved to another vehicle stands for the new one since then."""
    association = observed((0, {7: 0.0}, {1: 0.0}), (10, {7: 0.0}, {2: 0.0}))

    assert association.vehicle_of(7, 10, 20) == 2


def test_a_car_far_from_every_vehicle_stands_for_none():
    """Beyond the gate there is no association, nor for a car never seen."""
    association = observed((0, {7: 0.0}, {1: 5.0}))

    assert association.vehicle_of(7, 0, 10) is None
    assert association.vehicle_of(8, 0, 10) is None
