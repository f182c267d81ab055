"""Changes of columns are found for many tables at once."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from traffic.explaining.changing import ABSENT, changes_of

NAMES = ("link", "moving")

rows = st.dictionaries(st.integers(1, 6), st.tuples(st.integers(-2, 2), st.booleans()), max_size=5)


def table(values) -> Table:
    """Return a table of objects with a link and whether they move."""
    ids = list(values)
    return Table(
        "car",
        ids,
        {
            "link": np.array([values[one][0] for one in ids], dtype=np.int32),
            "moving": np.array([values[one][1] for one in ids], dtype=bool),
        },
    )


def naive(previous, frames, column):
    """Yield which object changed in which table, from what to what."""
    last = previous
    for number, values in enumerate(frames):
        for one in sorted(set(last) | set(values)):
            before = int(last[one][column]) if one in last else ABSENT
            after = int(values[one][column]) if one in values else ABSENT
            if before != after:
                yield number, one, before, after
        last = values


@given(rows, st.lists(rows, max_size=6))
@settings(derandomize=True, deadline=None, max_examples=300)
def test_changes_are_those_from_table_to_table(previous, frames):
    """An object that comes, goes, or has another value has changed, and nothing else has."""
    tables = [table(values) for values in frames]
    ids = np.concatenate([each.ids for each in [table(previous), *tables]])

    found = changes_of(NAMES, tables, table(previous))

    for column, changes in enumerate(found):
        told = zip(
            changes.table.tolist(),
            ids[changes.row].tolist(),
            changes.before.tolist(),
            changes.after.tolist(),
            strict=True,
        )
        assert sorted(told) == sorted(naive(previous, frames, column))


@given(st.lists(rows, min_size=2, max_size=8), st.integers(1, 7))
@settings(derandomize=True, deadline=None, max_examples=100)
def test_it_does_not_matter_how_tables_are_taken_together(frames, cut):
    """Of two parts one after the other come the same changes as of the whole."""
    tables, cut = [table(values) for values in frames], min(cut, len(frames) - 1)
    nothing = Table("none", (), {})

    def told(changes, first):
        when = (changes.table + first).tolist()
        return sorted(zip(when, changes.before.tolist(), changes.after.tolist(), strict=True))

    (whole,) = changes_of(["link"], tables, nothing)
    (first,) = changes_of(["link"], tables[:cut], nothing)
    (second,) = changes_of(["link"], tables[cut:], tables[cut - 1])

    assert told(whole, 0) == sorted([*told(first, 0), *told(second, cut)])
