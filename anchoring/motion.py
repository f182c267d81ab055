"""How vehicles move: Kalman filters over columns, for all objects at once.

Two models. In the plane, an object keeps its velocity up to white noise in its acceleration. Along
one axis (along a road, or across it), it is in one of several *modes* of motion and goes from one
to another at known rates; this is the interacting multiple model filter of Blom and Bar-Shalom
(1988), 'The interacting multiple model algorithm for systems with Markovian switching
coefficients'. It is smooth while a vehicle cruises and quick when it brakes or changes lanes,
which no single constant-velocity filter is under noise of several metres.

Arrays have one row per object. Units are metres and seconds.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from filterpy.common import Q_continuous_white_noise

__all__ = [
    "ACROSS_A_ROAD",
    "ALONG_A_ROAD",
    "AxisState",
    "Floats",
    "MotionMode",
    "MotionModes",
    "predict_in_plane",
    "update_in_plane",
]

Floats = npt.NDArray[np.float64]

_UNIT_NOISE: Floats = Q_continuous_white_noise(dim=2, dt=1.0, spectral_density=1.0)
"""Covariance that white acceleration noise of density 1 m²/s³ adds to (position, velocity) in 1 s;
in t seconds the entries grow with t³, t² and t."""

_LONGEST_SWITCH = 1.0
"""Seconds up to which the probability of changing the mode is linear in time."""

_LEAST = 1e-12
"""No mode ever becomes impossible."""


def predict_in_plane(
    mean: Floats, covariance: Floats, elapsed: Floats, density: float
) -> tuple[Floats, Floats]:
    """Carry states (x, y, vx, vy) forward at constant velocity.

    Args:
        mean: shape (n, 4).
        covariance: shape (n, 4, 4).
        elapsed: shape (n,), seconds.
        density: Spectral density of the acceleration noise of either axis, m²/s³.
    """
    t = elapsed[:, None]
    predicted = mean.copy()
    predicted[:, :2] += mean[:, 2:] * t
    t = elapsed[:, None, None]
    position, cross, velocity = _blocks(covariance)
    noise = density * np.eye(2)
    grown = np.empty_like(covariance)
    grown[:, :2, :2] = (
        position
        + t * (cross + cross.transpose(0, 2, 1))
        + t**2 * velocity
        + t**3 * _UNIT_NOISE[0, 0] * noise
    )
    grown[:, :2, 2:] = cross + t * velocity + t**2 * _UNIT_NOISE[0, 1] * noise
    grown[:, 2:, :2] = grown[:, :2, 2:].transpose(0, 2, 1)
    grown[:, 2:, 2:] = velocity + t * _UNIT_NOISE[1, 1] * noise
    return predicted, grown


def update_in_plane(
    mean: Floats, covariance: Floats, position: Floats, noise: Floats
) -> tuple[Floats, Floats]:
    """Correct states (x, y, vx, vy) by measured positions.

    Args:
        mean: shape (n, 4).
        covariance: shape (n, 4, 4).
        position: shape (n, 2), what was measured.
        noise: shape (n, 2, 2), covariance of the measurement.
    """
    inverse = np.linalg.inv(covariance[:, :2, :2] + noise)
    gain = covariance[:, :, :2] @ inverse
    innovation = (position - mean[:, :2])[:, :, None]
    corrected = covariance - gain @ covariance[:, :2, :]
    corrected = (corrected + corrected.transpose(0, 2, 1)) / 2
    return mean + (gain @ innovation)[:, :, 0], corrected


def _blocks(covariance: Floats) -> tuple[Floats, Floats, Floats]:
    return covariance[:, :2, :2], covariance[:, :2, 2:], covariance[:, 2:, 2:]


@dataclass(frozen=True, slots=True)
class MotionMode:
    """One way of moving along an axis.

    Attributes:
        density: Spectral density of the acceleration noise, m²/s³.
        acceleration: Mean acceleration, m/s²; a negative one does not reverse the movement.
        damping: Rate at which the velocity returns to `drift`, 1/s; 0 for never.
        drift: The velocity that a damped movement tends to, m/s.
    """

    density: float
    acceleration: float = 0.0
    damping: float = 0.0
    drift: float = 0.0


@dataclass(frozen=True, slots=True)
class AxisState:
    """What is believed about positions and velocities along one axis, for each mode.

    Attributes:
        mean: shape (n, m, 2), position and velocity under each of m modes.
        covariance: shape (n, m, 3), variance of position, covariance, variance of velocity.
        weight: shape (n, m), probability of each mode.
    """

    mean: Floats
    covariance: Floats
    weight: Floats

    def expected(self) -> Floats:
        """Return position and velocity over all modes, shape (n, 2)."""
        expected: Floats = (self.weight[:, None, :] @ self.mean)[:, 0, :]
        return expected

    def estimate(self) -> tuple[Floats, Floats]:
        """Return mean (n, 2) and covariance (n, 3) over all modes."""
        mean = self.expected()
        moments = self.covariance + _products(self.mean - mean[:, None, :])
        return mean, (self.weight[:, None, :] @ moments)[:, 0, :]


@dataclass(frozen=True)
class MotionModes:
    """The ways of moving along an axis, and how often one turns into another.

    Attributes:
        kinds: The modes; the first is the usual one.
        rates: `rates[i][j]` is how often per second mode i turns into j; the diagonal is
            ignored.
    """

    kinds: tuple[MotionMode, ...]
    rates: tuple[tuple[float, ...], ...]

    def start(self, mean: Floats, covariance: Floats) -> AxisState:
        """Return states that begin with *mean* (n, 2) and *covariance* (n, 3)."""
        shape = (len(mean), len(self.kinds))
        return AxisState(
            np.repeat(mean[:, None, :], shape[1], axis=1),
            np.repeat(covariance[:, None, :], shape[1], axis=1),
            np.broadcast_to(self._usual_weight, shape).copy(),
        )

    def predict(self, state: AxisState, elapsed: Floats) -> AxisState:
        """Carry *state* forward by *elapsed* seconds, shape (n,)."""
        mixed = self._mix(state, elapsed)
        t = elapsed[:, None]
        damping, density = self._damping, self._density
        kept = np.exp(-damping * t)
        reach = np.where(damping > 0, (1 - kept) / np.where(damping > 0, damping, 1), t)
        position, velocity = mixed.mean[..., 0], mixed.mean[..., 1]
        drift = self._drift
        # Braking ends at a standstill.
        stop = -np.maximum(velocity, 0.0) / np.maximum(t, 1e-9)
        acceleration = np.where(
            self._acceleration < 0, np.maximum(self._acceleration, stop), self._acceleration
        )
        mean = np.stack(
            (
                position + drift * t + reach * (velocity - drift) + acceleration * t**2 / 2,
                drift + kept * (velocity - drift) + acceleration * t,
            ),
            axis=-1,
        )
        pp, pv, vv = (mixed.covariance[..., i] for i in range(3))
        covariance = np.stack(
            (
                pp + 2 * reach * pv + reach**2 * vv + density * t**3 * _UNIT_NOISE[0, 0],
                kept * (pv + reach * vv) + density * t**2 * _UNIT_NOISE[0, 1],
                kept**2 * vv + density * t * _UNIT_NOISE[1, 1],
            ),
            axis=-1,
        )
        return AxisState(mean, covariance, mixed.weight)

    def update(
        self, state: AxisState, position: Floats, variance: Floats
    ) -> tuple[AxisState, Floats]:
        """Correct *state* by measured positions (n,) with their variances (n,).

        Returns:
            The state, and the logarithm of the likelihood of each measurement, shape (n,).
        """
        pp, pv, vv = (state.covariance[..., i] for i in range(3))
        spread = pp + variance[:, None]
        innovation = position[:, None] - state.mean[..., 0]
        gain = state.covariance[..., :2] / spread[..., None]
        mean = state.mean + gain * innovation[..., None]
        covariance = np.stack(
            (pp - gain[..., 0] * pp, pv - gain[..., 0] * pv, vv - gain[..., 1] * pv), axis=-1
        )
        log_likelihood = -0.5 * (innovation**2 / spread + np.log(2 * np.pi * spread))
        best = log_likelihood.max(axis=1)
        weight = state.weight * np.exp(log_likelihood - best[:, None])
        total = weight.sum(axis=1)
        return AxisState(
            mean, covariance, np.maximum(weight / total[:, None], _LEAST)
        ), best + np.log(total)

    def _mix(self, state: AxisState, elapsed: Floats) -> AxisState:
        """Let each mode take over from the others, each with its share."""
        step = np.minimum(elapsed, _LONGEST_SWITCH)[:, None, None]
        share = state.weight[:, :, None] * (self._identity + step * self._generator)
        weight = share.sum(axis=1)
        share = share.transpose(0, 2, 1) / weight[:, :, None]
        centre = state.mean[:, :1, :]
        apart = state.mean - centre
        moments = np.concatenate((apart, state.covariance + _products(apart)), axis=-1)
        mixed = share @ moments
        mean = mixed[..., :2]
        return AxisState(mean + centre, mixed[..., 2:] - _products(mean), weight)

    @cached_property
    def _generator(self) -> Floats:
        rates = np.array(self.rates, dtype=np.float64)
        np.fill_diagonal(rates, 0.0)
        return rates - np.diag(rates.sum(axis=1))

    @cached_property
    def _identity(self) -> Floats:
        return np.eye(len(self.kinds))

    @cached_property
    def _usual_weight(self) -> Floats:
        """Where the probabilities settle without measurements."""
        m = len(self.kinds)
        equations = np.vstack((self._generator.T, np.ones(m)))
        weight: Floats = np.linalg.lstsq(equations, np.append(np.zeros(m), 1.0), rcond=None)[0]
        return weight

    @cached_property
    def _density(self) -> Floats:
        return np.array([kind.density for kind in self.kinds])

    @cached_property
    def _acceleration(self) -> Floats:
        return np.array([kind.acceleration for kind in self.kinds])

    @cached_property
    def _damping(self) -> Floats:
        return np.array([kind.damping for kind in self.kinds])

    @cached_property
    def _drift(self) -> Floats:
        return np.array([kind.drift for kind in self.kinds])


def _products(pairs: Floats) -> Floats:
    """Return (a², ab, b²) of pairs (a, b) along the last axis."""
    a, b = pairs[..., 0], pairs[..., 1]
    return np.stack((a * a, a * b, b * b), axis=-1)


ALONG_A_ROAD = MotionModes(
    kinds=(
        MotionMode(density=0.02),
        MotionMode(density=0.3, acceleration=2.0),
        MotionMode(density=1.0, acceleration=-3.5),
        MotionMode(density=0.005, damping=3.0),
    ),
    rates=(
        (0.0, 0.03, 0.03, 0.0),
        (0.3, 0.0, 0.03, 0.0),
        (0.3, 0.0, 0.0, 0.3),
        (0.0, 0.2, 0.0, 0.0),
    ),
)
"""Cruising, accelerating, braking, and standing."""

ACROSS_A_ROAD = MotionModes(
    kinds=(
        MotionMode(density=0.0005, damping=5.0),
        MotionMode(density=0.3, damping=3.3, drift=1.28),
        MotionMode(density=0.3, damping=3.3, drift=-1.28),
    ),
    rates=((0.0, 0.05, 0.05), (0.3, 0.0, 0.0), (0.3, 0.0, 0.0)),
)
"""Keeping the lane, and moving to the left or right by a lane of 3.2 m in 2.5 s."""
