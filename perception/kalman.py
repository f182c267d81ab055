"""A Kalman filter with constant velocity for many objects at once.

States are (x, y, vx, vy). The model matrices come from filterpy; the recursion is that of its
`KalmanFilter`, applied to arrays of shape (n, 4) and (n, 4, 4), because a loop over objects would
take most of the time of a frame.
"""

from functools import lru_cache

import numpy as np
import numpy.typing as npt
from filterpy.common import Q_discrete_white_noise

__all__ = ["Covariances", "States", "mahalanobis_squared", "predict", "update"]

States = npt.NDArray[np.float64]
"""Shape (n, 4): x, y, vx, vy."""

Covariances = npt.NDArray[np.float64]
"""Shape (n, k, k)."""


def predict(
    states: States, covariances: Covariances, elapsed: float, acceleration: float
) -> tuple[States, Covariances]:
    """Return states and covariances *elapsed* seconds later.

    Args:
        states: shape (n, 4).
        covariances: shape (n, 4, 4).
        elapsed: seconds.
        acceleration: deviation of the acceleration along each axis, m/s².
    """
    transition, noise = _model(elapsed, acceleration)
    return states @ transition.T, transition @ covariances @ transition.T + noise


def update(
    states: States, covariances: Covariances, measured: States, noise: Covariances
) -> tuple[States, Covariances]:
    """Return states and covariances after positions (n, 2) were measured with *noise*."""
    gain = covariances[:, :, :2] @ _inverse(covariances[:, :2, :2] + noise)
    innovation = measured - states[:, :2]
    corrected = states + np.einsum("nij,nj->ni", gain, innovation)
    keep = np.eye(4) - np.concatenate([gain, np.zeros_like(gain)], axis=2)
    # Joseph's form, as in filterpy: stays symmetric and positive for any gain.
    spread = keep @ covariances @ keep.transpose(0, 2, 1)
    return corrected, spread + gain @ noise @ gain.transpose(0, 2, 1)


def mahalanobis_squared(
    states: States, covariances: Covariances, measured: States, noise: Covariances
) -> npt.NDArray[np.float64]:
    """Return the squared distance of every state from every measured position: shape (n, m)."""
    innovation = measured[None, :, :] - states[:, None, :2]
    inverse = _inverse(covariances[:, None, :2, :2] + noise[None, :, :, :])
    return np.asarray(np.einsum("nmi,nmij,nmj->nm", innovation, inverse, innovation))


@lru_cache(maxsize=64)
def _model(
    elapsed: float, acceleration: float
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return transition and process noise for both axes."""
    axis = np.array([[1.0, elapsed], [0.0, 1.0]])
    noise = Q_discrete_white_noise(dim=2, dt=elapsed, var=acceleration**2)
    return np.kron(axis, np.eye(2)), np.kron(noise, np.eye(2))


def _inverse(matrices: Covariances) -> Covariances:
    """Return the inverses of matrices (..., 2, 2)."""
    a, b = matrices[..., 0, 0], matrices[..., 0, 1]
    c, d = matrices[..., 1, 0], matrices[..., 1, 1]
    inverse = np.empty_like(matrices)
    inverse[..., 0, 0], inverse[..., 0, 1] = d, -b
    inverse[..., 1, 0], inverse[..., 1, 1] = -c, a
    return np.asarray(inverse / (a * d - b * c)[..., None, None])
