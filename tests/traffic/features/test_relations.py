"""Relations between two cars on the road."""

import numpy as np
import pytest

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.features.relations import RELATIONS, CarRelations


def pairs(ahead: float, left: float = 0.0) -> Table:
    """One pair of five-metre cars in both orders."""
    columns = {
        "first": np.array([1, 2]),
        "second": np.array([2, 1]),
        "ahead": np.array([ahead, -ahead]),
        "left": np.array([left, -left]),
        "clearance": np.array([5.0, 5.0]),
    }
    return Table("car_pair", [12, 21], columns)


def relations_after(*tables: Table) -> tuple[set[str], set[str]]:
    """Push the tables one after the other; return what holds of (1, 2) and of (2, 1)."""
    unit = CarRelations(gap=1.5, offset=1.2, near=10.0)
    for i, table in enumerate(tables):
        (out,) = unit.push(TimePoint(i), (Sample(table, TimePoint(i), TimePoint(i)),))
    held = [{name for name in RELATIONS if out.value[name][row]} for row in (0, 1)]
    return held[0], held[1]


@pytest.mark.parametrize(
    ("ahead", "left", "first", "second"),
    [
        (20.0, 0.0, {"behind"}, {"in_front"}),
        (8.0, 0.0, {"behind", "close"}, {"in_front", "close"}),
        (0.0, 3.0, {"left", "beside", "close"}, {"right", "beside", "close"}),
        (-20.0, -3.0, {"in_front", "right"}, {"behind", "left"}),
    ],
)
def test_relations_of_a_new_pair(ahead, left, first, second):
    """Where two cars are to each other names their relations, seen from either."""
    assert relations_after(pairs(ahead, left)) == (first, second)


def test_behind_holds_until_the_cars_are_level():
    """A gap that shrinks below what makes a car be behind does not end it."""
    assert "behind" in relations_after(pairs(20.0), pairs(5.5))[0]
    assert "behind" not in relations_after(pairs(20.0), pairs(4.9))[0]


def test_being_level_once_needs_the_full_gap_to_be_behind_again():
    """After the cars were level a small gap is not enough."""
    assert "behind" not in relations_after(pairs(20.0), pairs(0.0), pairs(5.5))[0]
    assert "behind" in relations_after(pairs(20.0), pairs(0.0), pairs(6.6))[0]


def test_the_two_orders_of_a_pair_mirror_each_other():
    """Whatever the first is to the second, the second is the opposite to the first."""
    opposite = {"behind": "in_front", "in_front": "behind", "left": "right", "right": "left"}
    for ahead in np.linspace(-30, 30, 13):
        for left in (-3.0, 0.0, 3.0):
            first, second = relations_after(pairs(float(ahead), left))
            assert {opposite.get(name, name) for name in first} == second
