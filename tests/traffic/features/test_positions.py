"""Percepts made of the simulator's positions."""

import numpy as np
import pytest

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.features.positions import NoisyPositions

N = 4000


def percepts(error: float, seed: int = 1) -> Table:
    """The percepts of many vehicles that stand at the origin."""
    columns = {
        "position": np.zeros((N, 2)),
        "heading": np.zeros(N),
        "length": np.full(N, 5.0),
        "width": np.full(N, 1.8),
        "colour": np.zeros((N, 3), dtype=np.uint8),
    }
    vehicles = Sample(Table("vehicle", np.arange(N), columns), TimePoint(5), TimePoint(5))
    unit = NoisyPositions(np.random.default_rng(seed), error=error)
    (out,) = unit.push(TimePoint(5), (vehicles,))
    return out.value


def test_without_error_positions_are_exact():
    """An error of zero changes nothing."""
    assert (percepts(0.0)["position"] == 0).all()


def test_errors_fill_the_square_and_match_the_stated_covariance():
    """Errors reach almost ±4 m, never more, and spread as the covariance says."""
    position = percepts(4.0)["position"]

    assert 3.9 < np.abs(position).max() <= 4.0
    assert np.allclose(position.var(axis=0), percepts(4.0)["covariance"][0].diagonal(), rtol=0.1)


def test_the_same_generator_gives_the_same_percepts():
    """Equal seeds give equal errors, others do not."""
    assert np.array_equal(percepts(2.0, 3)["position"], percepts(2.0, 3)["position"])
    assert not np.array_equal(percepts(2.0, 3)["position"], percepts(2.0, 4)["position"])


def test_a_negative_error_is_refused():
    """An error below zero has no meaning."""
    with pytest.raises(ValueError, match="at least 0"):
        NoisyPositions(np.random.default_rng(1), error=-1.0)
