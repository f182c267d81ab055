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
