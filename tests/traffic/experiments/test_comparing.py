"""Comparing: the same measures, cell by cell."""

import pytest

from traffic.errors import ExperimentError
from traffic.experiments.comparing import compare
from traffic.experiments.findings import Findings
from traffic.experiments.measures import Share
from traffic.experiments.tables import CellMeasures

SPEEDS = {"fast": 25, "slow": 15}


def side(name: str, measure: str, **successes: int) -> Findings:
    """Return findings with a hundred trials for each cell."""
    cells = tuple(
        CellMeasures({"speed": SPEEDS[key]}, 100, 0, {measure: Share(each, 100)})
        for key, each in successes.items()
    )
    return Findings(name, "", ("speed",), {}, (measure,), cells)


def test_a_difference_that_chance_does_not_make_is_clear() -> None:
    """99 of 100 against 80 is clear, against 97 it is not; what only one has is told."""
    found = compare(
        side("a", "overtake.recall", fast=80, slow=97), side("b", "overtake.recall", fast=99)
    )
    slow = compare(side("a", "overtake.recall", slow=97), side("b", "overtake.recall", slow=99))

    (fast,) = found.differences
    assert fast.is_clear
    assert fast.interval.low > 0
    assert found.only == (("a", {"speed": 15}),)
    assert not slow.differences[0].is_clear


def test_different_measures_are_not_compared() -> None:
    """Recall against precision says nothing."""
    with pytest.raises(ExperimentError, match="the same measures"):
        compare(side("a", "overtake.recall", fast=1), side("b", "overtake.precision", fast=1))


def test_there_must_be_a_cell_in_common() -> None:
    """Experiments about different cells cannot be compared."""
    with pytest.raises(ExperimentError, match="no cell in common"):
        compare(side("a", "overtake.recall", fast=1), side("b", "overtake.recall", slow=1))


def test_what_varies_in_ways_unknown_to_each_other_is_not_compared() -> None:
    """Two experiments whose factors have nothing to do with each other have no cell in common."""
    one = side("a", "overtake.recall", fast=1, slow=2)
    cells = (CellMeasures({"noise": 1}, 100, 0, {"overtake.recall": Share(1, 100)}),) * 2
    other = Findings("b", "", ("noise",), {}, ("overtake.recall",), cells)

    with pytest.raises(ExperimentError, match="no cell in common"):
        compare(one, other)
