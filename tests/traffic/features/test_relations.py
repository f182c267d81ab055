"""Relations between two cars on the road."""

from types import SimpleNamespace

import numpy as np
import pytest

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, Duration, TimePoint
from traffic.features.relations import RELATIONS, CarRelations
from traffic.features.stability import UNKNOWN

PERIOD = 100 * MILLISECOND


def pairs(ahead: float, left: float = 0.0, deviation: float = 0.0) -> Table:
    """One pair of five-metre cars in both orders."""
    columns = {
        "first": np.array([1, 2]),
        "second": np.array([2, 1]),
        "ahead": np.array([ahead, -ahead]),
        "left": np.array([left, -left]),
        "clearance": np.array([5.0, 5.0]),
        "ahead_deviation": np.full(2, deviation),
        "left_deviation": np.full(2, deviation),
    }
    return Table("car_pair", [12, 21], columns)


def relations(*tables: Table, within: int = 0, left_hand: bool = False) -> list[Table]:
    """Push the tables one after the other, one every 100 ms; return what comes out."""
    unit = CarRelations(
        SimpleNamespace(left_hand=left_hand),
        gap=1.5,
        offset=1.2,
        near=10.0,
        certainty=2.0,
        within=Duration(within * PERIOD),
    )
    found = []
    for i, table in enumerate(tables):
        at = TimePoint(i * PERIOD)
        found += [out.value for out in unit.push(at, (Sample(table, at, at),))]
    return found


def held(table: Table, row: int = 0) -> set[str]:
    """Return the relations of a pair that are known to hold."""
    return {name for name in RELATIONS if table[name][row] == 1}


@pytest.mark.parametrize(
    ("ahead", "left", "first", "second"),
    [
        (20.0, 0.0, {"behind", "in_line"}, {"in_front", "in_line"}),
        (8.0, 0.0, {"behind", "close", "in_line"}, {"in_front", "close", "in_line"}),
        (
            0.0,
            3.0,
            {"left", "beside", "beside_left", "close"},
            {"right", "beside", "beside_right", "beside_wrong", "close"},
        ),
        (-20.0, -3.0, {"in_front", "right"}, {"behind", "left"}),
        (0.0, 0.0, {"in_line", "close"}, {"in_line", "close"}),
    ],
)
def test_relations_of_a_new_pair(ahead, left, first, second):
    """Where two cars are to each other names their relations, seen from either."""
    (found,) = relations(pairs(ahead, left))

    assert (held(found), held(found, 1)) == (first, second)


def test_where_one_drives_on_the_left_the_wrong_side_is_the_left_one():
    """Which side is wrong is a matter of the map."""
    (found,) = relations(pairs(0.0, 3.0), left_hand=True)

    assert "beside_wrong" in held(found)
    assert "beside_wrong" not in held(found, 1)


def test_what_is_uncertain_changes_nothing():
    """A gap that is smaller than it is certain makes nobody be behind, nor stop being so."""
    found = relations(pairs(20.0), pairs(5.5, deviation=4.0), pairs(4.0, deviation=4.0))

    assert all({"behind", "in_line"} <= held(table) for table in found)
    (unknown,) = relations(pairs(8.0, deviation=4.0))
    assert all(unknown[name][0] == UNKNOWN for name in ("behind", "left", "right"))


def test_relations_are_dated_back():
    """The table in which one is behind no more is that in which the estimate began to say so."""
    gaps = [20.0, 6.0, 5.5, 5.0, 4.0, 2.0, 1.0]
    found = relations(*(pairs(gap, 3.0, deviation=1.0) for gap in gaps), within=4)

    assert ["behind" in held(table) for table in found] == [True, False, False]


def test_uncertain_neighbours_are_beside_each_other():
    """Who is level is beside, unless it is known to be in line, as if two symbols were mixed."""
    certain, uncertain = relations(pairs(0.0, 0.2)) + relations(pairs(0.0, 0.2, deviation=1.0))

    assert "beside" not in held(certain)
    assert "beside" in held(uncertain)


def test_the_two_orders_of_a_pair_mirror_each_other():
    """Whatever the first is to the second, the second is the opposite to the first."""
    opposite = {"behind": "in_front", "left": "right", "beside_left": "beside_right"}
    opposite |= {back: there for there, back in opposite.items()}
    for ahead in np.linspace(-30, 30, 13):
        for left in (-3.0, 0.0, 3.0):
            (found,) = relations(pairs(float(ahead), left))
            first, second = (held(found, row) - {"beside_wrong"} for row in (0, 1))
            assert {opposite.get(name, name) for name in first} == second
