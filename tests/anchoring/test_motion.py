"""The column filters agree with filterpy, one object at a time."""

import numpy as np
import pytest
from filterpy.common import Q_continuous_white_noise
from filterpy.kalman import IMMEstimator, KalmanFilter
from hypothesis import given, settings
from hypothesis import strategies as st

from anchoring.motion import (
    ACROSS_A_ROAD,
    ALONG_A_ROAD,
    AxisState,
    MotionMode,
    MotionModes,
    predict_in_plane,
    update_in_plane,
)


def _plane_oracle(elapsed, density):
    """Return filterpy's filter over (x, y, vx, vy) for one step."""
    oracle = KalmanFilter(dim_x=4, dim_z=2)
    oracle.F = np.eye(4)
    oracle.F[0, 2] = oracle.F[1, 3] = elapsed
    noise = Q_continuous_white_noise(dim=2, dt=elapsed, spectral_density=density)
    oracle.Q = np.kron(noise, np.eye(2))
    oracle.H = np.eye(2, 4)
    return oracle


@settings(derandomize=True, deadline=None, max_examples=30)
@given(
    st.lists(
        st.tuples(
            st.floats(0.01, 3.0), st.floats(-50, 50), st.floats(-50, 50), st.floats(0.01, 9.0)
        ),
        min_size=1,
        max_size=8,
    )
)
def test_the_plane_filter_does_what_filterpy_does(steps):
    """Predicting and updating columns equals predicting and updating each row with filterpy."""
    mean = np.array([[0.0, 1.0, 2.0, -3.0]])
    covariance = np.diag([1.0, 2.0, 9.0, 16.0])[None]
    oracle = _plane_oracle(1.0, 0.7)
    oracle.x, oracle.P = mean[0][:, None].copy(), covariance[0].copy()

    for elapsed, x, y, variance in steps:
        noise = variance * np.array([[1.0, 0.3], [0.3, 2.0]])
        step = _plane_oracle(elapsed, 0.7)
        oracle.F, oracle.Q, oracle.H, oracle.R = step.F, step.Q, step.H, noise
        oracle.predict()
        oracle.update(np.array([x, y]))
        mean, covariance = predict_in_plane(mean, covariance, np.array([elapsed]), 0.7)
        mean, covariance = update_in_plane(mean, covariance, np.array([[x, y]]), noise[None])

        np.testing.assert_allclose(mean[0], oracle.x[:, 0], rtol=1e-8, atol=1e-8)
        np.testing.assert_allclose(covariance[0], oracle.P, rtol=1e-7, atol=1e-8)


_TWO = MotionModes(
    kinds=(MotionMode(density=0.05), MotionMode(density=4.0)), rates=((0.0, 0.4), (1.5, 0.0))
)


def _imm_oracle(elapsed, mean, covariance, weight):
    """Return filterpy's estimator for the two modes of `_TWO`."""
    filters = []
    for kind in _TWO.kinds:
        one = KalmanFilter(dim_x=2, dim_z=1)
        one.F = np.array([[1.0, elapsed], [0.0, 1.0]])
        one.H = np.array([[1.0, 0.0]])
        one.Q = Q_continuous_white_noise(dim=2, dt=elapsed, spectral_density=kind.density)
        one.x, one.P = mean[:, None].copy(), covariance.copy()
        filters.append(one)
    change = np.array([[1 - 0.4 * elapsed, 0.4 * elapsed], [1.5 * elapsed, 1 - 1.5 * elapsed]])
    return IMMEstimator(filters, weight, change)


@settings(derandomize=True, deadline=None, max_examples=30)
@given(st.lists(st.tuples(st.floats(-5.0, 5.0), st.floats(0.05, 6.0)), min_size=1, max_size=12))
def test_the_axis_filter_does_what_filterpy_does(measurements):
    """Mixing, predicting and weighing modes equals filterpy's interacting filters."""
    mean, covariance = np.array([0.5, -1.0]), np.array([[2.0, 0.3], [0.3, 1.0]])
    state = _TWO.start(mean[None], np.array([[2.0, 0.3, 1.0]]))
    oracle = _imm_oracle(0.1, mean, covariance, state.weight[0])

    for position, variance in measurements:
        for one in oracle.filters:
            one.R = np.array([[variance]])
        oracle.predict()
        oracle.update(np.array([[position]]))
        state = _TWO.predict(state, np.array([0.1]))
        state, _ = _TWO.update(state, np.array([position]), np.array([variance]))

    expected, spread = state.estimate()
    np.testing.assert_allclose(state.weight[0], oracle.mu, rtol=1e-6)
    np.testing.assert_allclose(expected[0], oracle.x[:, 0], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(spread[0], oracle.P[[0, 0, 1], [0, 1, 1]], rtol=1e-6, atol=1e-9)


@settings(derandomize=True, deadline=None, max_examples=20)
@given(st.integers(0, 2**32 - 1), st.integers(1, 6))
def test_rows_do_not_influence_each_other(seed, n):
    """Filtering many objects at once gives each what it gets alone."""
    rng = np.random.default_rng(seed)
    state = ALONG_A_ROAD.start(rng.normal(size=(n, 2)), np.tile([1.0, 0.0, 2.0], (n, 1)))
    elapsed, position = rng.uniform(0.04, 0.2, n), rng.normal(size=n)
    variance = rng.uniform(0.1, 5.0, n)

    together, likelihood = ALONG_A_ROAD.update(
        ALONG_A_ROAD.predict(state, elapsed), position, variance
    )

    for i in range(n):
        row = slice(i, i + 1)
        alone = AxisState(state.mean[row], state.covariance[row], state.weight[row])
        alone = ALONG_A_ROAD.predict(alone, elapsed[row])
        alone, one = ALONG_A_ROAD.update(alone, position[row], variance[row])
        np.testing.assert_allclose(together.mean[row], alone.mean, rtol=1e-12)
        np.testing.assert_allclose(together.weight[row], alone.weight, rtol=1e-12)
        np.testing.assert_allclose(likelihood[row], one, rtol=1e-12)


def _followed(modes, positions, deviation, rng, copies=60):
    """Return estimates (t, copies, 2) of a movement measured every 100 ms."""
    state = modes.start(
        np.tile([positions[0], 0.0], (copies, 1)), np.tile([4.0, 0.0, 100.0], (copies, 1))
    )
    half = deviation * np.sqrt(3.0)
    estimates = []
    for position in positions[1:]:
        measured = position + rng.uniform(-half, half, copies)
        state = modes.predict(state, np.full(copies, 0.1))
        state, _ = modes.update(state, measured, np.full(copies, deviation**2 + 0.01))
        estimates.append(state.expected())
    return np.array(estimates)


@pytest.mark.parametrize(("half_width", "tolerance"), [(0.1, 0.05), (1.0, 0.25), (4.0, 0.75)])
def test_cruising_is_smooth(half_width, tolerance):
    """At steady speed the error along the road is a small part of the measurement's."""
    truth = 15.0 * np.arange(0.0, 20.0, 0.1)

    found = _followed(ALONG_A_ROAD, truth, half_width / np.sqrt(3.0), np.random.default_rng(1))

    error = found[60:, :, 0] - truth[61:, None]
    assert np.sqrt((error**2).mean()) < tolerance


def test_braking_and_accelerating_are_followed():
    """Under errors up to 4 m, braking at 4.5 and accelerating at 2.6 m/s² lag by under 2.2 m."""
    time = np.arange(0.0, 30.0, 0.1)
    speed = np.interp(time, [0, 10, 10 + 14 / 4.5, 18, 18 + 14 / 2.6, 30], [14, 14, 0, 0, 14, 14])
    truth = np.concatenate(([0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * 0.1)))

    found = _followed(ALONG_A_ROAD, truth, 4 / np.sqrt(3.0), np.random.default_rng(2))

    lag = np.abs((found[60:, :, 0] - truth[61:, None]).mean(axis=1))
    assert lag.max() < 2.2
    standing = (time[61:] > 16) & (time[61:] < 18)
    assert np.abs(found[60:, :, 1][standing]).mean() < 0.6


def test_a_change_of_lanes_is_followed():
    """A lane change in 2.5 s is noticed within 1.2 s of its middle under errors up to 4 m."""
    time = np.arange(0.0, 20.0, 0.1)
    truth = np.interp(time, [0, 10, 12.5, 20], [0, 0, 3.2, 3.2])

    found = _followed(ACROSS_A_ROAD, truth, 4 / np.sqrt(3.0), np.random.default_rng(3))

    across = found[:, :, 0]
    assert np.sqrt((across[30:95] ** 2).mean()) < 0.5
    crossed = 1 + np.argmax(across[100:] > 1.6, axis=0)
    assert np.median(crossed) * 0.1 - 1.25 < 1.2
    assert np.abs(across[-20:] - 3.2).mean() < 0.5
