"""The Kalman filter for many objects at once."""

import numpy as np
from filterpy.kalman import KalmanFilter
from hypothesis import given, settings
from hypothesis import strategies as st

from perception.kalman import mahalanobis_squared, predict, update

SEEDS = st.integers(0, 2**32 - 1)


def random_beliefs(count, generator):
    """Return states (n, 4), covariances (n, 4, 4), measurements (n, 2) and noise (n, 2, 2)."""
    roots = generator.normal(size=(count, 4, 4))
    noise_roots = generator.normal(size=(count, 2, 2))
    return (
        generator.normal(scale=20.0, size=(count, 4)),
        roots @ roots.transpose(0, 2, 1) + 0.1 * np.eye(4),
        generator.normal(scale=20.0, size=(count, 2)),
        noise_roots @ noise_roots.transpose(0, 2, 1) + 0.1 * np.eye(2),
    )


def filterpy_step(state, covariance, measured, noise, elapsed, acceleration):
    """Predict and update one object with filterpy."""
    naive = KalmanFilter(dim_x=4, dim_z=2)
    naive.x, naive.P = state.copy(), covariance.copy()
    naive.F = np.eye(4) + elapsed * np.eye(4, k=2)
    push = np.array([[0.5 * elapsed**2, 0], [0, 0.5 * elapsed**2], [elapsed, 0], [0, elapsed]])
    naive.Q = acceleration**2 * push @ push.T
    naive.H = np.eye(2, 4)
    naive.predict()
    naive.update(measured, R=noise)
    return naive.x, naive.P


@settings(derandomize=True, deadline=None, max_examples=40)
@given(SEEDS, st.integers(1, 6), st.floats(0.001, 2.0), st.floats(0.1, 10.0))
def test_many_filters_at_once_agree_with_filterpy_one_by_one(seed, count, elapsed, acceleration):
    """Prediction and update give filterpy's states and covariances."""
    states, covariances, measured, noise = random_beliefs(count, np.random.default_rng(seed))

    predicted = predict(states, covariances, elapsed, acceleration)
    updated = update(*predicted, measured, noise)

    for row in range(count):
        state, covariance = filterpy_step(
            states[row], covariances[row], measured[row], noise[row], elapsed, acceleration
        )
        np.testing.assert_allclose(updated[0][row], state, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(updated[1][row], covariance, rtol=1e-6, atol=1e-6)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(SEEDS, st.integers(0, 4), st.integers(0, 4))
def test_distances_are_those_of_each_pair(seed, n_states, n_measured):
    """The matrix of squared Mahalanobis distances agrees with the definition, pair by pair."""
    generator = np.random.default_rng(seed)
    states, covariances, _, _ = random_beliefs(n_states, generator)
    _, _, measured, noise = random_beliefs(n_measured, generator)

    distances = mahalanobis_squared(states, covariances, measured, noise)

    assert distances.shape == (n_states, n_measured)
    for i in range(n_states):
        for j in range(n_measured):
            off = measured[j] - states[i, :2]
            spread = covariances[i, :2, :2] + noise[j]
            np.testing.assert_allclose(distances[i, j], off @ np.linalg.inv(spread) @ off)
