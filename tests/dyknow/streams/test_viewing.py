"""The states of one object out of tables."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.streams.viewing import View
from tests.support.laws import assert_unit_laws
from tests.support.streams import ms


def _view(symbol, table):
    return View(symbol).push(ms(5), (Sample(table, ms(3), ms(5)),))


@settings(derandomize=True, deadline=None, max_examples=60)
@given(ids=st.lists(st.integers(0, 12), unique=True), wanted=st.integers(0, 12))
def test_a_view_has_the_row_of_its_object(ids, wanted):
    """With both times of the table; nothing if the table does not hold the object."""
    table = Table("car", np.array(ids, int), {"v": np.array([10 * each for each in ids])})

    found = _view(f"car{wanted}", table)

    if wanted in ids:
        assert [(each.value, each.valid_time) for each in found] == [({"v": 10 * wanted}, ms(3))]
    else:
        assert found == ()


@pytest.mark.parametrize("symbol", ["car", "car03", "bus3", "car3a", "acar3", "car٣"])
def test_a_symbol_that_is_none_of_the_tables_has_no_states(symbol):
    """A symbol is the sort and the id, written in the one way."""
    assert _view(symbol, Table("car", np.array([3]), {})) == ()


def test_what_is_no_table_is_an_error_and_no_value_is_nothing():
    """Only tables hold objects."""
    assert _view("car3", NO_VALUE) == ()
    with pytest.raises(TypeError, match="expected a table to look for 'car3' in, found int"):
        _view("car3", 3)


def test_a_view_keeps_the_laws():
    """A view is a unit like any other."""
    tables = [Table("car", np.array(ids), {}) for ids in ([3], [4], [3, 4])]
    given_stream = [Sample(each, ms(10 * at), ms(10 * at)) for at, each in enumerate(tables)]

    assert_unit_laws(lambda: View("car3"), given_stream, until=ms(50), tick=ms(7))
