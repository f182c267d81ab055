"""Static faults of specifications, beyond those in tests/languages/kpl."""

import pytest

from dyknow.errors import SpecificationErrors
from dyknow.kpl.check import check, faults
from dyknow.kpl.parser import parse_specification, parse_value
from dyknow.time import Duration

BASE = """
source a sa
source b sb
compunit a One(a)
compunit a Both(state(a, b))
compunit any Any(any)
strmgen a = sa
strmgen b = sb
"""


def _messages(text, **arguments):
    return [fault.message for fault in faults(parse_specification(BASE + text), **arguments)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("strmgen x = One(a)", []),
        ("strmgen x = One(b)", ["argument 1 of 'One' must be of sort 'a', found 'b'"]),
        ("strmgen x = Both(sync(a, b))", []),
        (
            "strmgen x = Both(sync(b, a))",
            ["argument 1 of 'Both' must be of sort 'state(a, b)', found 'state(b, a)'"],
        ),
        ("strmgen s = sync(a, b) strmgen x = Both(s)", []),
        ("strmgen x = Any(b) strmgen y = One(x)", []),
        ("strmgen x = link(a, One, true, true, true)", []),
        (
            "strmgen x = link(b, One, true, true, true)",
            ["argument 1 of 'One' must be of sort 'a', found 'b'"],
        ),
        ("strmgen x = One", ["'One' takes 1 argument(s), found 0"]),
        (
            "strmgen x = One(y) strmgen y = One(x) strmgen z = One(z)",
            ["circular definition: x -> y -> x", "circular definition: z -> z"],
        ),
        (
            "strmgen x = Both(sync(a, x))",
            [
                "circular definition: x -> x",
                "argument 1 of 'Both' must be of sort 'state(a, b)', found 'state(a, a)'",
            ],
        ),
        ("strmgen c[o] = One(c)", ["'c' takes 1 argument(s), found 0"]),
        (
            "compunit b sa(a)",
            ["computational unit 'sa' is already declared at <specification>:2:10"],
        ),
        ("stream a = a parameter a = 3", []),
    ],
)
def test_names_sorts_arities_and_cycles(text, expected):
    """Each fault is found once; labels, streams and parameters may share names."""
    assert _messages(text) == expected


def _make_one(
    *, gain: float, name: str = "", wait: Duration | None = None, n: int = 1, extra=None
):
    """Stand for a computational unit with settings."""


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ("gain = 3", []),
        ('gain = 3, name = x, wait = 500, extra = [1, "a"]', []),
        ("gain = 3, wait = 5 s", []),
        ("", ["'One' needs the setting 'gain'"]),
        (
            "gian = 3",
            [
                "'One' needs the setting 'gain'",
                "no setting of 'One' called 'gian'; did you mean 'gain'?",
            ],
        ),
        ("gain = wide", ["the setting 'gain' must be of sort 'number', found 'name'"]),
        ("gain = 1, wait = [1]", ["the setting 'wait' must be of sort 'time', found 'list'"]),
        (
            "gain = 1, name = true",
            ["the setting 'name' must be of sort 'name', found 'truth value'"],
        ),
        ("gain = 1, n = 2", []),
        (
            "gain = 1, n = 2.5",
            ["the setting 'n' must be of sort 'whole number', found 'number'"],
        ),
    ],
)
def test_settings_are_checked_where_the_signature_is_known(settings, expected):
    """Unknown, missing and unfit settings are found before anything is made."""
    text = f"strmgen x = One(a{', ' if settings else ''}{settings})"

    assert _messages(text, units={"One": _make_one}) == expected
    assert _messages(text) == []


def test_a_unit_may_take_any_setting():
    """A factory with `**settings` knows what it does."""

    def make(**settings):
        """Take all."""

    assert _messages("strmgen x = One(a, whatever = 3)", units={"One": make}) == []


def test_values_of_parameters_decide_what_is_checked():
    """With another value of a parameter there may be other faults."""
    text = "parameter p = a strmgen f[a] = One(a) strmgen x = One(f[p])"

    assert _messages(text) == []
    assert _messages(text, values={"p": parse_value("b")}) == [
        "no stream generator called 'f[b]'; did you mean 'f[a]'?"
    ]
    assert _messages(text, values={"p": parse_value("3")})[0] == (
        "the parameter 'p' must be of sort 'an object', found 'number'"
    )


def test_check_raises_all_faults_at_once():
    """The faults come as one group, in reading order."""
    specification = parse_specification(BASE + "strmgen x = One(b)\nstrmgen y = sc")

    with pytest.raises(SpecificationErrors) as caught:
        check(specification)

    lines = [fault.span.place.split(":")[1] for fault in caught.value.exceptions]
    assert lines == ["9", "10"]


def test_check_returns_the_specification_without_parameters_in_use():
    """What comes out has every use of a parameter replaced."""
    text = BASE + "parameter p = 20 stream x = a with sample every p"

    checked = check(parse_specification(text))

    written = parse_specification(BASE + "parameter p = 20 stream x = a with sample every 20")
    assert checked == written
