"""Comparing: the same measures, cell by cell."""

import pytest

from traffic.errors import ExperimentError
from traffic.experiments.comparing import Side, compare
from traffic.experiments.measures import Share

FAST = (("speed", 25),)
SLOW = (("speed", 15),)


def side(name: str, measure: str, **successes: int) -> Side:
    """Return a side with a hundred trials for each cell."""
    cells = {"fast": FAST, "slow": SLOW}
    shares = {cells[key]: {measure: Share(each, 100)} for key, each in successes.items()}
    return Side(name, (measure,), shares)


def test_a_difference_that_chance_does_not_make_is_clear() -> None:
    """99 of 100 against 80 is clear, against 97 it is not; what only one has is told."""
    found = compare(
        side("a", "overtake.recall", fast=80, slow=97), side("b", "overtake.recall", fast=99)
    )
    slow = compare(side("a", "overtake.recall", slow=97), side("b", "overtake.recall", slow=99))

    (fast,) = found.differences
    assert fast.is_clear
    assert fast.interval.low > 0
    assert found.only == (("a", SLOW),)
    assert not slow.differences[0].is_clear


def test_different_measures_are_not_compared() -> None:
    """Recall against precision says nothing."""
    with pytest.raises(ExperimentError, match="the same measures"):
        compare(side("a", "overtake.recall", fast=1), side("b", "overtake.precision", fast=1))


def test_there_must_be_a_cell_in_common() -> None:
    """Experiments about different cells cannot be compared."""
    with pytest.raises(ExperimentError, match="no cell in common"):
        compare(side("a", "overtake.recall", fast=1), side("b", "overtake.recall", slow=1))
