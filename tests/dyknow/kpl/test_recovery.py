"""Several faults in one text, and any text at all."""

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import KPLSyntaxError, SpecificationErrors
from dyknow.kpl.check import faults_of_text
from dyknow.kpl.parser import parse_policy, parse_specification, parse_value, read_specification
from dyknow.kpl.printer import text_from
from dyknow.kpl.recovery import MAX_DEPTH
from dyknow.kpl.unused import warnings

TWELVE = Path(__file__).with_name("twelve_faults.kpl")
REFERENCE = Path("docs/kpl.md").read_text(encoding="utf-8")
MONITORING = Path("data/specifications/monitoring.kpl").read_text(encoding="utf-8")


def test_twelve_different_faults_are_reported_in_one_go():
    """Syntax and meaning alike: each once, in reading order, with its place and its words."""
    found = faults_of_text(TWELVE.read_text(), "t.kpl")

    assert [f"{fault.span.place}: {fault.message}" for fault in found] == [
        "t.kpl:3:12: source 'car1_tracker' is already declared at t.kpl:2:12",
        "t.kpl:8:21: no source called 'car1_traker'; did you mean 'car1_tracker'?",
        "t.kpl:9:18: expected ',' or ']', found '='",
        "t.kpl:11:23: 'SpeedEst' takes 1 argument(s), found 2",
        "t.kpl:12:28: argument 1 of 'Mean' must be of sort 'speed', found 'pos'",
        "t.kpl:13:9: circular definition: mean[all] -> mean[all]",
        (
            "t.kpl:15:13: 'distance[uav]' would be declared again for each 'car'; "
            "expected 'car' among its objects"
        ),
        (
            "t.kpl:17:15: 'pos[car3]' cannot keep this policy: the process gives a sample every "
            "100, a sample every 150 cannot be picked out of it"
        ),
        (
            "t.kpl:18:17: 'use most recent' needs 'from' a time 'to' a time or 'oo' and a finite "
            "'max delay'"
        ),
        "t.kpl:19:33: stream 2 of 'merge' must be of sort 'pos', found 'speed'",
        "t.kpl:20:43: expected 'every', found 'evry'",
        "t.kpl:21:18: no stream generator called 'sped[car1]'; did you mean 'speed[car1]'?",
    ]
    for fault in found:
        *_, line, carets = fault.report().split("\n")
        assert line in TWELVE.read_text().split("\n")
        assert len(carets) <= len(line) + 1


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("strmgen a = = s\nstrmgen b = s)\nstream", ["1:13", "2:14", "3:7"]),
        ("source a\nstrmgen b =\nsource n s strmgen c = s", ["2:1", "3:1"]),
        (
            "for each m in {\n strmgen a[m] = s\n strmgen b = = }\nstrmgen = c",
            ["1:15", "3:14", "4:9"],
        ),
        ("for each m in a {\n strmgen b[m] = U(\n stream = b }\n}", ["3:2", "3:9", "4:1"]),
        ("for each m in a { strmgen b[m] = s", ["1:35"]),
        ("} stream a = b", ["1:1"]),
        ('strmgen a = U(b, c = "\\q", d = "\\q")', ["1:22", "1:32"]),
        ("strmgen a = link(s, U, p and, q or, true)", ["1:29", "1:35"]),
    ],
)
def test_behind_a_fault_reading_goes_on_with_the_next_declaration(text, expected):
    """Each declaration that does not follow the grammar is told once."""
    faults = read_specification(text).faults

    assert [fault.span.place.partition(":")[2] for fault in faults] == expected


def test_what_could_not_be_read_is_not_missed_elsewhere():
    """A name that a broken declaration seems to declare is no unknown name."""
    text = """
    source pos s
    compunit speed Speed(pos
    strmgen a[x = s
    strmgen b = Speed(a[x])
    strmgen c = Spede(d)
    """

    messages = [fault.message for fault in faults_of_text(text)]

    assert messages == [
        "expected ')', ', ...' or ',', found 'strmgen'",
        "expected ',' or ']', found '='",
        "no computational unit called 'Spede'",
        "no stream generator called 'd'",
    ]


def test_brackets_may_be_nested_to_a_limit():
    """Deeper texts are refused at once, whatever they are made of."""
    for start, end in (("[", "]"), ("sync(", ")"), ("f(", ")")):
        text = f"strmgen a = U(b, c = {start * 5000}1{end * 5000})"
        (fault,) = faults_of_text(text)
        assert (
            fault.message
            == f"expected at most {MAX_DEPTH} brackets inside one another, found more"
        )
    depth = MAX_DEPTH - 1
    nested = f"strmgen a = U(b, c = {'[' * depth}1{']' * depth})"
    assert parse_specification(text_from(parse_specification(nested)))
    assert parse_value("[" * 9999) is not None


def test_a_long_chain_of_generators_is_no_problem():
    """Checks do not recurse along the streams."""
    lines = [f"strmgen a{n} = merge(a{n - 1}, a{n - 1})" for n in range(1, 1200)]
    text = "compunit s U(s) source s s strmgen a0 = s\n" + "\n".join(lines)

    assert faults_of_text(text + " strmgen b = U(a1199)") == []
    (fault,) = faults_of_text(text.replace("a0 = s", "a0 = U(a1199)"))
    assert fault.message.startswith("circular definition: a0 -> a1199 -> a1198")


PIECES = st.sampled_from(
    [
        *("strmgen ", "stream ", "source ", "compunit ", "for each ", "in ", "parameter "),
        *("select ", "from ", "where ", "as ", "and ", "merge", "sync", "state", "link", "with "),
        *("sample every ", "up to ", " under load", "deviation ", "on failure end", "oo", "any "),
        *("a", "a[b]", "%a%", "1 s", "99999999999999999999 h", "1e999", "-3", '"', '"x"', "true"),
        *(
            "=",
            ",",
            "(",
            ")",
            "[",
            "]",
            "{",
            "}",
            ".",
            "*",
            "#",
            "\n",
            "\t",
            "\0",
            "é",
            "...",
            " ",
        ),
    ]
)


def _check(text):
    """Check what holds of every text."""
    reading = read_specification(text, "t")
    found = faults_of_text(text, "t")
    assert all(fault.report().startswith("t:") for fault in found)
    starts = [fault.span.start for fault in found]
    assert starts == sorted(starts)
    assert len(found) >= len(reading.faults)
    if reading.faults:
        with pytest.raises(SpecificationErrors):
            parse_specification(text)
    else:
        assert parse_specification(text_from(reading.specification)) == reading.specification
        warnings(reading.specification)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(st.lists(PIECES, max_size=25).map("".join) | st.text(max_size=40))
def test_any_text_is_read_or_refused(text):
    """Nothing but faults with places comes of it."""
    _check(text)
    parse_value(text)
    with suppress(KPLSyntaxError):
        parse_policy(text)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(data=st.data(), text=st.sampled_from([MONITORING[:4000], REFERENCE, TWELVE.read_text()]))
def test_a_damaged_specification_is_read_or_refused(data, text):
    """Whatever is lost, doubled or written into it."""
    start = data.draw(st.integers(0, max(0, len(text) - 600)))
    text = text[start : start + 600]
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(text)))
        end = min(len(text), at + data.draw(st.integers(0, 30)))
        text = text[:at] + data.draw(PIECES | st.just(text[at:end] * 2)) + text[end:]
    _check(text)
