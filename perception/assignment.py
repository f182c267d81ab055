"""Which of two groups belong together: as many pairs as the gate allows, at least cost."""

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

__all__ = ["assign"]


def assign(
    cost: npt.NDArray[np.float64], gate: float
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Return the rows and columns that are paired.

    Only pairs whose cost is at most *gate* are made. Among all ways to pair, one with the most
    pairs is chosen, and among these one of least total cost.

    Args:
        cost: shape (n, m), not negative.
        gate: The highest cost of a pair.
    """
    allowed = cost <= gate
    if not allowed.any():
        nothing = np.zeros(0, dtype=np.intp)
        return nothing, nothing
    # Worse than any number of allowed pairs, so that one more pair always pays.
    forbidden = gate * (min(cost.shape) + 1.0) + 1.0
    rows, columns = linear_sum_assignment(np.where(allowed, cost, forbidden))
    kept = allowed[rows, columns]
    return np.asarray(rows[kept]), np.asarray(columns[kept])
