"""World objects follow percepts, and go straight on without them."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from anchoring.world_objects import WorldObject
from dyknow.time import milliseconds
from tests.anchoring.drives import percepts

UNIT = WorldObject()


def _after(positions, period_ms=100, half_width=1.0):
    """Return the world object that exact percepts at *positions* lead to."""
    rng = np.random.default_rng(0)
    world = None
    for k, position in enumerate(positions):
        now = milliseconds(k * period_ms)
        seen = percepts([1], [position], now, half_width, rng)
        seen.columns["position"] = np.array([position], dtype=float)
        world = UNIT.create(seen.ids, seen, now) if k == 0 else UNIT.update(world, seen, now)
    return world


def test_the_velocity_is_found():
    """Percepts along a line give the velocity along it."""
    world = _after([(12.0 * 0.1 * k, -3.0 * 0.1 * k) for k in range(40)])

    np.testing.assert_allclose(world["velocity"], [[12.0, -3.0]], atol=0.05)
    assert world["observed"].all()


def test_a_percept_is_used_once():
    """A percept that was observed at the same instant as the last one changes nothing."""
    world = _after([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])
    again = percepts([1], [(50.0, 50.0)], milliseconds(200))

    later = UNIT.update(world, again, milliseconds(300))

    np.testing.assert_allclose(later["filter_mean"], world["filter_mean"])
    assert later["position"][0, 0] > world["position"][0, 0]


def test_a_percept_counts_when_it_was_observed():
    """A percept from 40 ms ago is carried on to the time of the table."""
    world = _after([(k * 1.0, 0.0) for k in range(30)])
    late = percepts([1], [(29.6, 0.0)], milliseconds(2960))

    found = UNIT.update(world, late, milliseconds(3000))

    np.testing.assert_allclose(found["position"], [[30.0, 0.0]], atol=0.05)
    np.testing.assert_allclose(found["measured_position"], [[29.6, 0.0]])
    assert found["observed_at"][0] == milliseconds(2960)


def test_without_percepts_it_goes_straight_on():
    """A predicted object keeps its velocity, is not observed, and has nothing measured."""
    world = _after([(k * 1.5, 0.0) for k in range(30)])

    predicted = UNIT.predict(world, milliseconds(4900))

    np.testing.assert_allclose(predicted["position"], [[73.5, 0.0]], atol=0.3)
    assert not predicted["observed"].any()
    assert np.isnan(predicted["measured_position"]).all()
    assert np.isnan(predicted["measured_covariance"]).all()
    assert predicted["observed_at"][0] == milliseconds(2900)


@settings(derandomize=True, deadline=None, max_examples=25)
@given(st.lists(st.integers(1, 900), min_size=1, max_size=6))
def test_predicting_in_steps_changes_nothing(steps):
    """Where an object is predicted to be does not depend on how often it was asked before."""
    world = _after([(k * 1.0, k * 0.5) for k in range(10)])
    times = np.cumsum(steps)

    stepwise = world
    for time in times:
        stepwise = UNIT.predict(stepwise, milliseconds(900 + int(time)))
    at_once = UNIT.predict(world, milliseconds(900 + int(times[-1])))

    np.testing.assert_allclose(stepwise["position"], at_once["position"])
    np.testing.assert_allclose(stepwise["covariance"], at_once["covariance"])


def test_after_a_gap_the_filter_starts_anew():
    """What is found again in another percept is where that is, with its own velocity."""
    world = _after([(k * 1.0, 0.0) for k in range(30)])
    elsewhere = percepts([2], [(60.0, 40.0)], milliseconds(4900))

    found = UNIT.update(world, elsewhere, milliseconds(4900))

    np.testing.assert_allclose(found["position"], [[60.0, 40.0]])
    np.testing.assert_allclose(found["velocity"], elsewhere["velocity"])


def test_seldom_is_no_gap():
    """Who is measured every second is believed to be between where it is and was expected."""
    straight = [(k * 10.0, 0.0) for k in range(10)]

    aside = _after([*straight, (100.0, 4.0)], period_ms=1000)

    assert 0 < aside["position"][0, 1] < 4


def test_unknown_attributes_wait_for_known_ones():
    """NaN in an attribute neither spoils its average nor stays once it is known."""
    first = percepts([1, 2], [(0, 0), (9, 9)], 0)
    first.columns["temperature"] = np.array([np.nan, 30.0], dtype=np.float32)
    second = percepts([1, 2], [(0, 0), (9, 9)], milliseconds(100))
    second.columns["temperature"] = np.array([20.0, np.nan], dtype=np.float32)

    found = UNIT.update(UNIT.create(first.ids, first, 0), second, milliseconds(100))

    np.testing.assert_allclose(found["temperature"], [20.0, 30.0])
    assert found["temperature"].dtype == np.float32


def test_no_objects_are_no_trouble():
    """A table without rows has the same columns as one with rows."""
    nobody = percepts(np.empty(0, dtype=np.int64), np.empty((0, 2)), 0)

    empty = UNIT.create(nobody.ids, nobody, 0)

    assert set(UNIT.update(empty, nobody, 100).columns) == set(_after([(0, 0)]).columns)
    assert len(UNIT.predict(empty, 200)) == 0
