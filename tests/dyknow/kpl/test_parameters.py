"""Values of parameters in their places."""

from dyknow.kpl.parameters import bind_parameters
from dyknow.kpl.parser import parse_specification, parse_value
from dyknow.kpl.printer import text_from

TEXT = """
parameter view = vision
parameter period = 100
parameter end = 2 s
parameter noise = 2.5
strmgen a[view] = U(
    sync(b[view, x] with sample every period, c with max delay period) with to end,
    noise = noise, other = [view, noise, word])
strmgen l = link(a[view], U, true, true, true, noise = noise)
strmgen s = sync(a[view])
stream out = a[view] with from period to end
"""


def _bound(**values):
    specification = parse_specification(TEXT)
    given = {name: parse_value(value) for name, value in values.items()}
    return bind_parameters(specification, given)


def test_a_parameter_may_stand_for_an_object_a_time_or_a_setting():
    """Every use is replaced by the value given, or else by the default."""
    bound, faults = _bound(view="truth", period="40", noise="7")

    assert faults == []
    assert text_from(bound) == (
        "parameter view = truth\n"
        "parameter period = 40\n"
        "parameter end = 2000 ms\n"
        "parameter noise = 7\n"
        "strmgen a[truth] = U(sync(b[truth, x] with sample every 40, c with max delay 40)"
        " with to 2000, noise = 7, other = [truth, 7, word])\n"
        "strmgen l = link(\n    a[truth],\n    U,\n    establish = true,\n"
        "    reestablish = true,\n    maintain = true,\n    noise = 7)\n"
        "strmgen s = sync(a[truth])\n"
        "stream out = a[truth] with from 40 to 2000\n"
    )


def test_a_value_stands_at_the_place_of_its_use():
    """Messages about a value point to where it is used, not to where it comes from."""
    bound, _ = _bound()

    setting = bound.declarations[4].process.settings[0]
    assert setting.value.span.place == "<specification>:8:13"


def test_a_value_that_does_not_fit_its_place_is_a_fault():
    """A word is no time, a list is no object, and an unknown name is no parameter."""
    _, faults = _bound(period="soon", view="[1, 2]")

    messages = {fault.message for fault in faults}
    assert messages == {
        "the parameter 'period' must be of sort 'time', found 'name'",
        "the parameter 'view' must be of sort 'an object', found 'list'",
    }
    _, (fault,) = bind_parameters(
        parse_specification("parameter p = 1 stream s = a with to q"), {}
    )
    assert fault.message == "no parameter called 'q'"
