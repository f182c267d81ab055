"""Which vehicle a car symbol stands for."""

from itertools import combinations

import numpy as np
import numpy.typing as npt
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.time import TimePoint
from traffic.scoring.association import Association


def observed(*frames: tuple[int, dict[int, float], dict[int, float]]) -> Association:
    """Observe frames of (time, x by car, x by vehicle) along one line."""
    association = Association(gate=4.0)
    for time, cars, vehicles in frames:
        association.observe(TimePoint(time), columns(cars), columns(vehicles))
    return association


def columns(places: dict[int, float]) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float64]]:
    """Return ids and positions of places along a line."""
    positions = np.array([[x, 0.0] for x in places.values()]).reshape(-1, 2)
    return np.array(list(places), dtype=np.int64), positions


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


def test_two_cars_beside_each_other_do_not_change_places():
    """Each goes on standing for its vehicle when it seems nearer to the other for a while."""
    before = (0, {7: 0.0, 8: 5.0}, {1: 0.0, 2: 5.0})
    beside = [(t, {7: 2.0, 8: 1.0}, {1: 1.0, 2: 2.0}) for t in range(1, 9)]
    association = observed(before, *beside)

    assert association.vehicle_of(7, 1, 8) == 1
    assert association.vehicle_of(8, 1, 8) == 2


def test_no_two_cars_stand_for_one_vehicle():
    """The second symbol of one vehicle stands for nothing, or for another one that is near."""
    association = observed((0, {7: 0.0, 8: 0.5}, {1: 0.0}))

    assert association.vehicle_of(7, 0, 0) == 1
    assert association.vehicle_of(8, 0, 0) is None


Row = dict[int, float]


def row(step: float) -> st.SearchStrategy[Row]:
    """Return rows of places along a line, no two of which are equally far apart."""
    drawn = st.dictionaries(st.integers(0, 3), st.integers(0, 12), max_size=3)
    return drawn.map(lambda places: {i: x + i * step for i, x in places.items()})


def kept_pairs(latest: dict[int, int], apart: dict[tuple[int, int], float]) -> dict[int, int]:
    """Return the pairs of before that are within the gate still, the nearest ones first."""
    kept: dict[int, int] = {}
    for distance, (car, vehicle) in sorted((d, pair) for pair, d in apart.items()):
        if latest.get(car) == vehicle and vehicle not in kept.values() and distance <= 4:
            kept[car] = vehicle
    return kept


def best_pairs(apart: dict[tuple[int, int], float], kept: dict[int, int]) -> tuple[int, float]:
    """Return how many further pairs there can be, and the least sum of their distances."""
    free = [
        pair
        for pair, distance in apart.items()
        if distance <= 4 and pair[0] not in kept and pair[1] not in kept.values()
    ]
    for n in range(len(free), 0, -1):
        sums = [
            sum(apart[pair] for pair in chosen)
            for chosen in combinations(free, n)
            if len({car for car, _ in chosen}) == len({v for _, v in chosen}) == n
        ]
        if sums:
            return n, min(sums)
    return 0, 0.0


@settings(derandomize=True, deadline=None, max_examples=300)
@given(st.lists(st.tuples(row(0.1), row(0.013)), min_size=1, max_size=4))
def test_pairs_are_those_of_trying_them_all(frames: list[tuple[Row, Row]]) -> None:
    """What was paired stays so within the gate; the others are as near as they can be."""
    association, latest = Association(gate=4.0), dict[int, int]()
    for time, (cars, vehicles) in enumerate(frames):
        association.observe(TimePoint(time), columns(cars), columns(vehicles))
        found = {
            car: vehicle
            for car in cars
            if (vehicle := association.vehicle_of(car, time, time)) is not None
        }
        apart = {(car, v): abs(cars[car] - vehicles[v]) for car in cars for v in vehicles}
        kept = kept_pairs(latest, apart)
        others = {car: vehicle for car, vehicle in found.items() if car not in kept}

        assert kept.items() <= found.items()
        n, least = best_pairs(apart, kept)
        assert len(others) == n
        assert abs(sum(apart[pair] for pair in others.items()) - least) < 1e-9
        latest.update(found)
