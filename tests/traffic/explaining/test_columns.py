"""Tables of a run become columns of files."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from traffic.explaining.columns import changes_kept, digest_of, states_kept

NOBODY = Table("none", (), {})

frames = st.lists(
    st.dictionaries(st.integers(1, 5), st.booleans(), max_size=4), min_size=1, max_size=6
)


def cars(ids, **columns) -> Table:
    """Return a table of cars."""
    return Table("car", ids, {name: np.asarray(column) for name, column in columns.items()})


def test_states_keep_where_objects_were():
    """Positions become two columns; what a table does not have is left empty."""
    samples = [
        Sample(cars([3, 7], position=np.array([[1.0, 2.0], [3.0, 4.0]])), 100, 100),
        Sample(cars([], position=np.empty((0, 2))), 200, 200),
        Sample(cars([7], position=np.array([[5.0, 6.0]])), 300, 300),
    ]

    kept = states_kept(samples, ["x", "y", "speed"])

    assert kept["valid_time"].tolist() == [100, 100, 300]
    assert kept["id"].tolist() == [3, 7, 7]
    assert kept["x"].tolist() == [1.0, 3.0, 5.0]
    assert kept["y"].tolist() == [2.0, 4.0, 6.0]
    assert kept["speed"] is None


@given(frames)
@settings(derandomize=True, deadline=None, max_examples=150)
def test_quantities_are_kept_when_a_quality_changes(tables):
    """For each object that has changed and is there, each number of that moment is kept once."""
    samples = [
        Sample(
            cars(
                list(values),
                moving=np.array(list(values.values()), dtype=bool),
                speed=np.array([10.0 * one + at for one in values]),
            ),
            at,
            at,
        )
        for at, values in enumerate(tables)
    ]
    beside = [
        Sample(cars(list(values), gap=np.array([float(one) for one in values])), at, at)
        for at, values in enumerate(tables)
    ]

    changes, quantities = changes_kept(samples, NOBODY, ["moving"], beside)

    changed = {
        (time, one)
        for time, one, after in zip(
            changes["valid_time"].tolist(),
            changes["id"].tolist(),
            changes["after"].tolist(),
            strict=True,
        )
        if after >= 0
    }
    told = list(
        zip(
            quantities["column"],
            [int(each) for each in quantities["valid_time"]],
            [int(each) for each in quantities["id"]],
            [float(each) for each in quantities["value"]],
            strict=True,
        )
    )
    assert sorted(told) == sorted(
        [("speed", time, one, 10.0 * one + time) for time, one in changed]
        + [("gap", time, one, float(one)) for time, one in changed]
    )


@given(st.integers(0, 3), st.floats(0.5, 2.0))
@settings(derandomize=True, deadline=None, max_examples=30)
def test_a_digest_tells_when_anything_has_moved(row, by):
    """The least change of any object changes it; the same tables have the same one."""
    heading = np.arange(4.0)
    moved = heading.copy()
    moved[row] += by

    one = cars([1, 2, 3, 4], heading=heading)

    assert digest_of([one, None]) == digest_of([cars([1, 2, 3, 4], heading=heading.copy())])
    assert digest_of([one]) != digest_of([cars([1, 2, 3, 4], heading=moved)])
    assert digest_of([one]) != digest_of([cars([1, 2, 4, 3], heading=heading)])
    assert digest_of([one, one]) != digest_of([one])
