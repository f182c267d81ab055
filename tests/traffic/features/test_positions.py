"""Percepts made of the simulator's positions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import Duration, TimePoint
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


def frames(n_frames: int, n: int = 200) -> list[Sample[Table]]:
    """Return frames 10 ns apart in which every vehicle stands at the number of the frame."""
    columns = {
        "heading": np.zeros(n),
        "length": np.full(n, 5.0),
        "width": np.full(n, 1.8),
        "colour": np.zeros((n, 3), dtype=np.uint8),
    }
    return [
        Sample(
            Table("vehicle", np.arange(n), {**columns, "position": np.full((n, 2), float(i))}),
            TimePoint(10 * i),
            TimePoint(10 * i),
        )
        for i in range(n_frames)
    ]


@settings(derandomize=True, deadline=None, max_examples=50)
@given(st.integers(0, 35), st.integers(1, 6))
def test_each_table_comes_out_once_after_the_delay(delay: int, n_frames: int):
    """Valid when the vehicles were, available so much later, in order; asked as often as due."""
    unit = NoisyPositions(np.random.default_rng(1), error=0.0, delay=Duration(delay))
    given_frames = frames(n_frames, 2)
    out = []
    for frame in given_frames:
        while (due := unit.due()) is not None and due < frame.available_time:
            out += unit.advance(due)
        out += unit.push(frame.available_time, (frame,))
    while (due := unit.due()) is not None:
        out += unit.advance(due)

    assert [(s.valid_time, s.available_time) for s in out] == [
        (frame.valid_time, frame.available_time + delay) for frame in given_frames
    ]
    assert [s.value["position"][0, 0] for s in out] == list(range(n_frames))
    assert [s.value["observed_at"][0] for s in out] == [f.valid_time for f in given_frames]


def test_so_many_percepts_are_missing_as_said():
    """A quarter of them, no matter which vehicle and when."""
    unit = NoisyPositions(np.random.default_rng(1), error=0.0, dropout=0.25)
    seen = [s.value.ids for frame in frames(50) for s in unit.push(frame.valid_time, (frame,))]
    times_seen = np.bincount(np.concatenate(seen), minlength=200)

    assert times_seen.mean() == pytest.approx(0.75 * 50, rel=0.03)
    assert times_seen.std() == pytest.approx(np.sqrt(50 * 0.25 * 0.75), rel=0.2)


@pytest.mark.parametrize("setting", [{"dropout": 1.0}, {"dropout": -0.1}, {"delay": Duration(-1)}])
def test_impossible_faults_are_refused(setting: dict):
    """A sensor that sees nothing, more than everything, or the future."""
    with pytest.raises(ValueError, match="expected"):
        NoisyPositions(np.random.default_rng(1), error=0.0, **setting)
