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


MORE = """
source ids ids
source cars tracker
compunit a OfCar(object(cars))
strmgen ids = ids
strmgen cars = tracker
strmgen p[x] = sa
strmgen p[y] = sa
strmgen q[x] = sb
"""


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        # Sorts through every construct
        ("strmgen x = One(merge(a, p[x]))", []),
        ("strmgen x = One(merge(b))", ["argument 1 of 'One' must be of sort 'a', found 'b'"]),
        ("strmgen x = merge(a, b)", ["stream 2 of 'merge' must be of sort 'a', found 'b'"]),
        ("strmgen x = One(select k from a)", []),
        (
            "strmgen x = One(select k from merge(b) where k = 2)",
            ["argument 1 of 'One' must be of sort 'a', found 'b'"],
        ),
        ("strmgen x = One(merge(p[i] for each i in ids))", []),
        (
            "strmgen x = One(merge(q[i] for each i in ids))",
            ["argument 1 of 'One' must be of sort 'a', found 'b'"],
        ),
        ("strmgen x = Any(merge(w for each w in ids))", []),
        ("strmgen x = OfCar(cars[car3])", []),
        (
            "strmgen x = OfCar(cars)",
            ["argument 1 of 'OfCar' must be of sort 'object(cars)', found 'cars'"],
        ),
        (
            "strmgen x = One(cars[car3])",
            ["argument 1 of 'One' must be of sort 'a', found 'object(cars)'"],
        ),
        ("for each i in cars { strmgen x[i] = OfCar(cars[i]) }", []),
        (
            "for each i in ids { strmgen x[i] = One(q[i]) }",
            ["argument 1 of 'One' must be of sort 'a', found 'b'"],
        ),
        ("strmgen x = Both(state(p[x], q[x]) with use latest)", []),
        # Names in blocks and mediations
        (
            "for each i in ids { strmgen x[i] = One(p[j]) }",
            ["no stream generator called 'p[j]'; did you mean 'p[y]'?"],
        ),
        (
            "for each i in ids { strmgen x[i] = One(a) } strmgen y = One(x[k])",
            [
                (
                    "'x[k]' is not known here: it exists for each 'i' in 'ids' alone; expected a"
                    " label that always exists, or 'merge(... for each ...)'"
                ),
            ],
        ),
        (
            "for each i in ids { strmgen x[i] = One(a) } stream y = merge(x[k] for each k in ids)",
            [],
        ),
        (
            "for each i in ids { strmgen x[i] = One(a) for each k in ids {stream y[k, i] = x[i]}}",
            [],
        ),
        (
            "for each i in ids { for each k in ids { strmgen x[i] = One(a) stream y[k] = a } }",
            [
                "'x[i]' would be declared again for each 'k'; expected 'k' among its objects",
                "'y[k]' would be declared again for each 'i'; expected 'i' among its objects",
            ],
        ),
        (
            "for each i in ids { for each i in ids { stream y[i] = a } }",
            ["member 'i' is already declared at <specification>:18:10"],
        ),
        (
            "parameter i = x stream y = merge(p[i] for each i in ids)",
            ["parameter 'i' is already declared at <specification>:18:11"],
        ),
        (
            "for each i in ids { strmgen x[i] = One(a) strmgen x[i] = One(a) }",
            ["stream generator 'x[i]' is already declared at <specification>:18:29"],
        ),
        (
            "for each i in ids { stream y[i] = a } for each k in ids { stream y[k] = a }",
            ["stream 'y[k]' is already declared at <specification>:18:28"],
        ),
        ("for each i in idz { }", ["no stream generator called 'idz'; did you mean 'ids'?"]),
        (
            "stream y = merge(p[i] for each i in merge(w for each w in idz))",
            ["no stream generator called 'idz'; did you mean 'ids'?"],
        ),
        ("stream y = merge(c[i] for each i in ids)", ["no stream generator called 'c[i]'"]),
        ("strmgen x = One(p[x, y])", ["'p' takes 1 argument(s), found 2"]),
        (
            "stream y = select k, m as k from a",
            ["two fields are called 'k'; expected a name for each, with 'as'"],
        ),
        # Cycles through configuration and mediation
        (
            "strmgen p[z] = merge(p[i] for each i in ids)",
            ["circular definition: p[z] -> p[z]"],
        ),
        (
            "strmgen s = Any(merge(x[i] for each i in ids)) for each k in s {strmgen x[k]=One(a)}",
            ["circular definition: s -> x[k] -> s"],
        ),
        ("strmgen x = Any(y[x]) strmgen y = Any(x)", ["circular definition: x -> y -> x"]),
        ("strmgen x = select k from x", ["circular definition: x -> x"]),
        # What generators promise
        (
            "strmgen x = One(a) with max delay 5 stream y = x with max delay 3",
            [
                (
                    "'x' cannot keep this policy: the process needs a delay of up to 5, "
                    "the policy allows at most 3"
                ),
            ],
        ),
        (
            (
                "strmgen x = sync(a, b) with sample every 100, use most recent, from 0 to oo "
                "stream y = x with sample every 250"
            ),
            [
                (
                    "'x' cannot keep this policy: the process gives a sample every 100, a sample "
                    "every 250 cannot be picked out of it"
                ),
            ],
        ),
        (
            (
                "for each i in ids { strmgen x[i] = One(a) with from 10 to 20 } "
                "stream y = merge(x[k] with from 30 for each k in ids)"
            ),
            [
                (
                    "'x[i]' cannot keep this policy: the process gives nothing after 20, "
                    "the policy begins at 30"
                ),
            ],
        ),
        (
            "strmgen x = sa with max delay 3, max delay 4",
            ["there are two delay constraints, 'max delay 3' and 'max delay 4'"],
        ),
    ],
)
def test_what_is_wrong_is_found_through_every_construct(text, expected):
    """Sorts, names, cycles and policies, through views, merging, selection, blocks, mediation."""
    found = _messages(MORE + text)

    assert found == expected


def test_members_of_blocks_stand_for_objects_and_values():
    """They may be used in labels, settings and conditions; as times they are no parameters."""
    text = """
    for each i in ids {
        strmgen x[i] = One(p[i], gain = 2, name = i)
        stream y[i] = select * from a where k = i
    }
    """
    assert _messages(MORE + text, units={"One": _make_one}) == []
    assert _messages(MORE + "for each i in ids { stream y[i] = a with sample every i }") == [
        "no parameter called 'i'"
    ]
