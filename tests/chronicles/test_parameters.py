"""Parameters of chronicle files: what they stand for, and what is said of wrong ones."""

import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from chronicles.check import faults
from chronicles.comments import remark_on
from chronicles.models import models_from_chronicles
from chronicles.parameters import Given, amount_from, parameters_behind
from chronicles.parser import parse_chronicles, with_values
from chronicles.printer import print_chronicles, text_of
from chronicles.recognition import Recogniser
from chronicles.syntax import EventAt, Length, Number, Parametric
from chronicles.unused import warnings
from dyknow.errors import SpecificationErrors
from dyknow.source_text import SourceText, Span
from dyknow.time import MILLISECOND
from tests.support.random_chronicles import chronicle_texts, streams

ALL = list(HealthCheck)
CONTEXT = """
parameter longest = 1 min   # from the first to the last
# How many.
parameter least = 3
parameter early = -5
attribute p[?x] message q
constraint near(a, b) { a <= b <= a + longest }
chronicle sub[?x](u) { event(p[?x]:(?, ?), u) noevent(q, (u, u + longest)) }
"""
BEGINNING = "event(p[?x]:(?, ?), t1); event(q, t2); "
STATEMENTS = [
    ("t2 <= t1 + longest", "t2 <= t1 + 60000"),
    ("t2 - longest - 5 <= t1", "t2 - 60005 <= t1"),
    ("t2 - t1 < longest", "t2 - t1 < 60000"),
    ("t2 - t1 <= longest - 1 s + early", "t2 - t1 <= 58995"),
    ("-longest < t2 - t1 - early", "-60000 < t2 - t1 + 5"),
    ("5 + longest >= t2 - t1", "60005 >= t2 - t1"),
    ("longest - least > t2 - t1", "59997 > t2 - t1"),
    ("t2 < longest", "t2 < 60000"),
    ("t2 - longest in [0, early + 9]", None),
    ("t2 - longest in [early, 9]", "t2 - 60000 in [-5, 9]"),
    ("t2 - t1 in [early, longest]", "t2 - t1 in [-5, 60000]"),
    ("t2 - t1 in ]early, longest[", "t2 - t1 in [-4, 59999]"),
    ("t2 - t1 in [-longest, +longest]", "t2 - t1 in [-60000, 60000]"),
    ("t2 - t1 in [0, least] + longest | [0, longest]", "t2 - t1 in [0, 60003]"),
    ("t2 - t1 in -[early, oo[ & ]-oo, longest]", "t2 - t1 in ]-oo, 5]"),
    ("t1 < t2 + [early, longest] - longest", "t1 < t2 + [-60005, 0]"),
    ("event(q, t1 + longest)", "event(q, t1 + 60000)"),
    ("event(q, t1 - [0, longest])", "event(q, t1 + [-60000, 0])"),
    ("noevent(q, (t1 - longest, t2 + early))", "noevent(q, (t1 - 60000, t2 - 5))"),
    ("occurs(least, oo, q, (t1, t2 + 1))", "occurs(3, oo, q, (t1, t2 + 1))"),
    ("occurs(0, least, p[?x]:(?, ?), (t1, t2))", "occurs(0, 3, p[?x]:(?, ?), (t1, t2))"),
    ("near(t1 - early, t2)", "near(t1 + 5, t2)"),
    ("chronicle sub[?x](t1 + least)", "chronicle sub[?x] (t1 + 3)"),
]


def file_with(statement: str) -> str:
    """Return a file with parameters, and a chronicle that makes a statement."""
    return f"{CONTEXT} chronicle c[?x] {{ {BEGINNING} {statement} }}"


@pytest.mark.parametrize(("written", "meant"), STATEMENTS)
def test_a_parameter_stands_wherever_a_constant_can(written: str, meant: str | None) -> None:
    """It means its value there; printing and parsing changes nothing."""
    if meant is None:
        with pytest.raises(SpecificationErrors):
            parse_chronicles(file_with(written))
        return
    file = parse_chronicles(file_with(written))
    (said,) = file.chronicle_by_name["c"].statements[2:]

    assert isinstance(said, Parametric)
    assert text_of(said) == written.replace("1 s", "1000")
    assert text_of(said.statement) == meant
    assert faults(file) == []
    assert parse_chronicles(print_chronicles(file)) == file
    assert len(models_from_chronicles(file)) == 2


@settings(derandomize=True, deadline=None, max_examples=100)
@given(
    st.sampled_from([written for written, meant in STATEMENTS if meant]),
    st.integers(0, 9),
    st.sampled_from([" ", "\n", " # longest\n", "\t// +\n"]),
    st.fixed_dictionaries(
        {}, optional={"longest": st.integers(20, 99), "early": st.integers(-9, 0)}
    ),
)
def test_layout_is_not_part_of_what_is_written(
    written: str, at: int, blank: str, values: dict[str, Given]
) -> None:
    """Blanks, comments and other signs make no difference; what is printed is read as the same."""
    places = [match.end() for match in re.finditer(r"[,(] ?| (?:<=|<|\+) ", written)] or [0]
    place = places[at % len(places)]
    other = written[:place] + blank + written[place:]
    file = parse_chronicles(file_with(written), values=values)
    again = parse_chronicles(file_with(other.replace("<=", "≤").replace("-", "−")), values=values)

    assert again == file
    assert parse_chronicles(print_chronicles(file)) == file
    assert print_chronicles(again) == print_chronicles(file)


_NUMBER = re.compile(r"(?<![\w?*])\d+(?!\w)")


@settings(derandomize=True, deadline=None, max_examples=100, suppress_health_check=ALL)
@given(st.data())
def test_values_mean_what_constants_in_their_places_mean(data: st.DataObject) -> None:
    """A chronicle with parameters for its numbers recognises what it recognises without."""
    text = data.draw(chronicle_texts())
    before, begin, body = text.rpartition("chronicle c")
    declared: dict[str, int] = {}
    given_values: dict[str, Given] = {}

    def named(number: re.Match[str]) -> str:
        if not data.draw(st.booleans()):
            return number[0]
        name = f"k{len(declared)}"
        declared[name] = int(number[0])
        if data.draw(st.booleans()):
            given_values[name], declared[name] = int(number[0]), 9
        return name

    written = f"{begin}{_NUMBER.sub(named, body)}"
    parameters = "\n".join(f"parameter {name} = {value}" for name, value in declared.items())
    plain = parse_chronicles(text)
    file = parse_chronicles(f"{parameters}\n{before}{written}", values=given_values)

    assert [chronicle.plain for chronicle in file.chronicles] == [
        chronicle.plain for chronicle in plain.chronicles
    ]
    assert [str(fault) for fault in faults(file)] == [str(fault) for fault in faults(plain)]
    if faults(plain):
        return
    asked = [s.event_type for s in plain.chronicles[-1].plain if isinstance(s, EventAt)]
    events = data.draw(streams(asked))
    found = []
    for each in (plain, file):
        recogniser = Recogniser(models_from_chronicles(each))
        told = [
            recognition
            for event in events
            for recognition in recogniser.push(event.time, (event,))
        ]
        found.append(told)
    assert found[0] == found[1]


@pytest.mark.parametrize(
    ("given_value", "expected"),
    [
        (3, Number),
        ("+3", Number),
        (" -3 ", Number),
        (3.0, Number),
        ("30 s", Length),
        ("-1 s", Length),
        ("1.5 s", Length),
        ("1000000 ns", Length),
    ],
)
def test_values_are_numbers_or_lengths(given_value: Given, expected: type) -> None:
    """A number has no unit; what has one is a length of time."""
    assert isinstance(amount_from(given_value), expected)


def test_values_from_outside_replace_those_of_the_file() -> None:
    """In the statements, and in what the file declares; the others stay as they are."""
    file = parse_chronicles(file_with("t2 <= t1 + longest"))
    other = with_values(file, {"longest": "30 s", "least": 1})
    third = with_values(other, {"least": 2})

    assert text_of(other.chronicles[1].plain[2]) == "t2 <= t1 + 30000"
    assert [text_of(each) for each in third.parameters] == [
        "parameter longest = 30000 ms", "parameter least = 2", "parameter early = -5"
    ]  # fmt: skip
    assert parse_chronicles(print_chronicles(third)) == third
    assert file.parameters[0].value == Length(file.span, 60_000 * MILLISECOND)


def test_a_value_may_have_a_place() -> None:
    """Faults of it are told there."""
    place = Span(SourceText("x.kpl", "least = 1 s"), 0, 11)
    with pytest.raises(SpecificationErrors) as raised:
        parse_chronicles(
            file_with("occurs(least, oo, q, (t1, t2))"),
            values={"least": amount_from("1 s", place)},
        )

    (fault,) = raised.value.exceptions
    assert fault.report() == (
        "x.kpl:1:1: the parameter 'least' must be of sort 'number', found 'time'\n"
        "least = 1 s\n^^^^^^^^^^^"
    )


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"longst": 3}, "has no parameter 'longst'; did you mean 'longest'? (it has longest, "),
        ({"xyz": 3}, "has no parameter 'xyz' (it has longest, least, early)"),
        ({"longest": "x"}, "expected a duration such as"),
        ({"longest": ""}, "expected a duration such as"),
        ({"longest": "3 weeks"}, "expected one of the units"),
        ({"longest": True}, "found 'True'"),
        ({"longest": 1.5}, "'1.5' is finer than a millisecond"),
        ({"longest": float("nan")}, "found 'nan'"),
        ({"longest": float("inf")}, "found 'inf'"),
        ({"longest": 1e30}, "is longer than nine years"),
        ({"longest": 10**17}, "the parameter 'longest' is longer than nine years"),
        ({"early": 10**17}, "the parameter 'early' is longer than nine years"),
        ({"longest": "999999 h"}, "is longer than nine years"),
        ({"longest": "-999999 h"}, "is longer than nine years"),
        ({"longest": "1 us"}, "is finer than a millisecond"),
        ({"least": -1}, "expected a number of events, found the parameter 'least', which is -1"),
        ({"least": "3 s"}, "must be of sort 'number', found 'time'"),
    ],
)
def test_unfit_values_are_told(values: dict[str, Given], message: str) -> None:
    """What was expected, what was found, and the nearest name."""
    with pytest.raises(SpecificationErrors) as raised:
        parse_chronicles(
            file_with("t2 <= t1 + longest occurs(least, oo, q, (t1, t2)) early < t1"), "f", values
        )

    assert message in str(raised.value.exceptions[0])


def test_a_file_without_parameters_has_none() -> None:
    """The message says so."""
    with pytest.raises(SpecificationErrors) as raised:
        parse_chronicles("message m", "f.chronicle", {"x": 1})

    assert "'f.chronicle' has no parameter 'x' (it has none)" in str(raised.value.exceptions[0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("chronicle c { event(q, t) t < t + longst }", "no parameter called 'longst'; did you me"),
        ("chronicle c { event(q, t) t < longst }", "of no event; did you mean 'longest'?"),
        ("chronicle c { event(q, t) noevent(q, (t, longest)) }", "'longest' is a parameter of th"),
        ("chronicle c { event(q, longest) }", "'longest' is a parameter of the file; expected an"),
        ("chronicle c(longest) { event(q, t) }", "'longest' is a parameter of the file; expected"),
        ("chronicle c { event(q, t) instant longest }", "'longest' is a parameter of the file; e"),
        ("chronicle c { event(q, t) longest - t < 5 }", "'longest' is a parameter of the file; e"),
        ("chronicle c { event(q, t) longest in [0, 5] }", "'longest' is a parameter of the file;"),
        (
            "chronicle c { event(q, t) report non_overlapping (t, longest) }",
            "'longest' is a param",
        ),
        ("constraint k(longest, b) { b <= 5 }", "'longest' is a parameter of the file; expected"),
        ("constraint k(b) { b <= longst }", "no instant called 'longst'; did you mean 'longest'"),
        ("parameter longest = 4", "parameter 'longest' is already declared at"),
        ("parameter a = longest", "expected '-' or a length of time, found 'longest'"),
        ("parameter a = 5 + 5", "found '+'"),
        ("parameter a = 1 us", "'1 us' is finer than a millisecond"),
        ("parameter a = oo", "found the reserved word 'oo'"),
        ("parameter end = 5", "found the reserved word 'end'"),
        ("parameter ?x = 5", "expected a name, found"),
        ("parameter a[?x] = 5", "expected '=', found '['"),
        ("parameter a 5", "expected '=', found '5'"),
        ("chronicle c { event(q, t) occurs(longest, oo, q, (t, t + 1)) }", "of sort 'number', fo"),
        ("chronicle c { event(q, t) occurs(0, early, q, (t, t + 1)) }", "which is -5"),
        ("chronicle c { event(q, t) occurs(least, 2, q, (t, t + 1)) }", "at least 3 as the large"),
    ],
)
def test_wrong_uses_are_told_with_their_place(text: str, said: str) -> None:
    """Names that are not there, or stand for something else."""
    try:
        found = [str(fault) for fault in faults(parse_chronicles(f"{CONTEXT}{text}"))]
    except SpecificationErrors as errors:
        found = [str(fault) for fault in errors.exceptions]

    assert any(said in each for each in found), found


def test_a_parameter_that_cannot_be_read_is_told_alone() -> None:
    """That others name it is not a second fault."""
    with pytest.raises(SpecificationErrors) as raised:
        parse_chronicles("parameter a = x\nmessage q\nchronicle c { event(q, t) t < t + a }")

    assert len(raised.value.exceptions) == 1


def test_parameters_that_nothing_uses_are_told() -> None:
    """Like other declarations, by a warning."""
    file = parse_chronicles(f"{CONTEXT} chronicle c {{ event(q, t) near(t, t + early) }}")

    assert [each.message for each in warnings(file)] == ["'least' is not used"]


def test_what_a_chronicle_depends_on_is_known() -> None:
    """Its own parameters, and those of what it includes, in the order of the file."""
    file = parse_chronicles(file_with("chronicle sub[?x](t1) occurs(least, oo, q, (t1, t2))"))

    found = parameters_behind(file.chronicle_by_name["c"], file)

    assert [each.name for each in found] == ["longest", "least"]
    assert [remark_on(each) for each in file.parameters] == [
        "from the first to the last", "How many.", ""
    ]  # fmt: skip


def test_parameter_is_no_reserved_word() -> None:
    """It is a name wherever a name can stand."""
    text = """message parameter domain D = {a} constraint time(a) { a in [0, 5] }
    chronicle parameter[?x] {
        event(parameter[?x], parameter) event(parameter[?x], u)
        variable ?x in D parameter in [0, 5] ?x in D time(parameter) ?x in D parameter < u
    }"""

    assert parse_chronicles(text).chronicles[0].name == "parameter"


def test_the_example_of_the_page_has_no_faults() -> None:
    """And uses all that it declares."""
    page = Path("docs/chronicles.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"^```chronicle\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    file = parse_chronicles(example)

    assert faults(file) == []
    assert warnings(file) == []
    assert [each.name for each in file.parameters] == ["longest", "early", "times"]
