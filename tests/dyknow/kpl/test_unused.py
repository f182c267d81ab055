"""Declarations that nothing needs."""

from dyknow.kpl.parser import parse_specification
from dyknow.kpl.unused import warnings


def test_what_no_output_needs_is_remarked():
    """Sources, units, generators and parameters without a use are each named."""
    text = """
    parameter p = 3
    parameter q = x
    source a sa
    source a sb
    compunit a One(a)
    compunit a Two(a)
    strmgen a[x] = sa
    strmgen a[y] = One(a[x])
    strmgen b = One(a[q])
    strmgen c = One(b)
    strmgen d = One(c)
    stream out = sync(b with max delay 3, a[x])
    """

    remarks = [remark.message for remark in warnings(parse_specification(text))]

    assert remarks == [
        "'p' is not used",
        "'sb' is not used",
        "'Two' is not used",
        "'c' is not used",
        "'d' is not used",
    ]


def test_blocks_and_what_may_be_merged():
    """A block is used if an output in it, or what is merged elsewhere, needs it."""
    text = """
    source ids ids
    source a sa
    compunit a One(a)
    strmgen ids = ids
    strmgen tables = sa
    strmgen a[x] = sa
    strmgen b[x] = sa
    for each i in ids { strmgen c[i] = One(a[i]) strmgen d[i] = One(c[i]) }
    for each i in ids { strmgen e[i] = One(tables[i]) }
    stream out = merge(c[k] for each k in ids)
    for each k in ids { stream f[k] = tables[k] }
    """

    remarks = [remark.message for remark in warnings(parse_specification(text))]

    assert remarks == [
        "'b[x]' is not used",
        "'d[i]' is not used",
        "'for each i' is not used",
        "'e[i]' is not used",
    ]
