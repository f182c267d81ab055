"""Records of columns."""

from dataclasses import dataclass

import numpy as np
import pytest

from perception.columns import concatenate, select


@dataclass
class Pairs:
    """Two columns."""

    left: np.ndarray
    right: np.ndarray


def test_choosing_and_joining_keeps_rows_together():
    """Rows that are chosen apart and put one after another are the rows again."""
    pairs = Pairs(np.arange(4), np.arange(8).reshape(4, 2))
    is_odd = np.array([False, True, False, True])

    together = concatenate([select(pairs, ~is_odd), select(pairs, is_odd)])

    np.testing.assert_array_equal(together.left, [0, 2, 1, 3])
    np.testing.assert_array_equal(together.right[:, 0], [0, 4, 2, 6])


def test_only_records_have_columns():
    """Anything but a dataclass is a mistake of the caller."""
    with pytest.raises(TypeError, match="expected a dataclass of columns, found list"):
        select([1, 2], np.array([True, False]))
