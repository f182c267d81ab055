"""Which way vehicle bodies point, when only the path of the front bumper can be relied on.

SUMO turns a body to the chord of the lanes below it. In junctions, where lanes of different
curves meet, a bus of 12 m then jumps sideways by metres between two frames, and a body lags the
motion of its front by up to 25 degrees. Real bodies are dragged: the rear axle moves towards the
front, wherever that goes (the curve is called tractrix).
"""

import numpy as np
import numpy.typing as npt

__all__ = ["Bodies"]

Floats = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.int64]

_REAR_AXLE = 0.8
"""Where the rear axle is, in lengths behind the front bumper."""

_LONGEST_STEP = 10.0
"""Metres; a front that moves further between two frames was put somewhere else."""


class Bodies:
    """Remembers the rear axle of each vehicle from frame to frame."""

    def __init__(self) -> None:
        self._frame = 1
        self._seen = np.zeros(64, dtype=np.int64)
        self._front = np.zeros((64, 2))
        self._rear = np.zeros((64, 2))

    def headings(self, numbers: Numbers, front: Floats, angle: Floats, length: Floats) -> Floats:
        """Return the headings of the bodies in the next frame, radians.

        A vehicle that is new, or was put somewhere else, begins with the simulator's *angle*.

        Args:
            numbers: shape (n,), which vehicles.
            front: shape (n, 2), middle of the front bumper, metres.
            angle: shape (n,), the simulator's headings, radians.
            length: shape (n,), of the bodies, metres.
        """
        self._frame += 1
        self._make_room(numbers)
        step = np.linalg.norm(front - self._front[numbers], axis=1)
        known = (self._seen[numbers] == self._frame - 1) & (step <= _LONGEST_STEP)
        pull = front - self._rear[numbers]
        dragged = np.arctan2(pull[:, 1], pull[:, 0])
        heading: Floats = np.where(known, dragged, angle)
        forward = np.column_stack([np.cos(heading), np.sin(heading)])
        self._rear[numbers] = front - _REAR_AXLE * length[:, None] * forward
        self._front[numbers] = front
        self._seen[numbers] = self._frame
        return heading

    def _make_room(self, numbers: Numbers) -> None:
        missing = int(numbers.max(initial=-1)) + 1 - len(self._seen)
        if missing > 0:
            self._seen = np.append(self._seen, np.zeros(missing + 64, dtype=np.int64))
            self._front = np.append(self._front, np.zeros((missing + 64, 2)), axis=0)
            self._rear = np.append(self._rear, np.zeros((missing + 64, 2)), axis=0)
