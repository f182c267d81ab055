"""Sightings and tracks written by hand."""

import numpy as np

from perception.locating import Sightings
from perception.tracking import Tracks


def sightings(*rows):
    """Return sightings from rows (x, y, angle, length, width)."""
    table = np.array(rows, dtype=float).reshape(-1, 5)
    count = len(table)
    return Sightings(
        table[:, :2].copy(),
        np.tile(0.01 * np.eye(2), (count, 1, 1)),
        table[:, 3].copy(),
        table[:, 4].copy(),
        table[:, 2].copy(),
        table[:, 3] * table[:, 4],
        np.arange(count),
    )


def tracks(*rows, hits=20):
    """Return tracks from rows (id, x, y, heading, length, width), at rest."""
    table = np.array(rows, dtype=float).reshape(-1, 6)
    count = len(table)
    return Tracks(
        table[:, 0].astype(np.int64),
        np.column_stack([table[:, 1:3], np.zeros((count, 2))]),
        np.tile(np.diag([0.01, 0.01, 1.0, 1.0]), (count, 1, 1)),
        table[:, 3].copy(),
        table[:, 4].copy(),
        table[:, 5].copy(),
        np.full(count, hits),
        np.zeros(count, dtype=np.int64),
    )
