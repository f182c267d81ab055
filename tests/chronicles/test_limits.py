"""Files that are very large, very deep, or damaged."""

import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.boundedness import warnings
from chronicles.check import faults
from chronicles.events import Event
from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from chronicles.printer import print_chronicles
from chronicles.recognition import Recogniser
from dyknow.errors import SpecificationError, SpecificationErrors
from dyknow.time import MILLISECOND, TimePoint

EVENT = "event(m[?x], t1)"
LIBRARY = Path(__file__).parents[2] / "data" / "chronicles"
FOLDER = Path(__file__).parents[1] / "languages" / "chronicles"


def messages(text: str) -> list[str]:
    """Return the faults of a text."""
    try:
        return [fault.message for fault in faults(parse_chronicles(text))]
    except SpecificationErrors as errors:
        return [e.message for e in errors.exceptions if isinstance(e, SpecificationError)]


def recognised_of_many(n_models: int) -> int:
    """Return how many of so many models, all alike, are recognised in three events."""
    head = "attribute p[?x] { ?value in {true, false} }\n"
    text = head + "".join(
        f"chronicle c{i}[?x] {{ event(p[?x]:(?, true), t1) event(p[?x]:(true, false), t2)"
        f" noevent(p[?x]:(?, ?), (t1 + 1, t2)) t1 < t2 <= t1 + {i % 100 + 1} }}\n"
        for i in range(n_models)
    )
    file = parse_chronicles(text)
    assert warnings(file) == []
    recogniser = Recogniser(models_from_chronicles(file))
    events = [
        Event("p", ("a",), None, "true", TimePoint(0)),
        Event("p", ("a",), "true", "false", TimePoint(50 * MILLISECOND)),
    ]
    return sum(len(recogniser.push(event.time, (event,))) for event in events)


def test_a_file_may_have_many_models() -> None:
    """Each of them is recognised."""
    assert recognised_of_many(100) == 51


@pytest.mark.exhaustive
def test_a_file_may_have_ten_thousand_models() -> None:
    """It takes a minute."""
    assert recognised_of_many(10_000) == 5_100


def test_a_model_may_have_two_hundred_events() -> None:
    """It is read, checked, and prepared; with more than five hundred it is refused."""

    def text(n_events: int) -> str:
        events = " ".join(f"event(p{i}, t{i})" for i in range(n_events))
        order = " ".join(f"t{i} < t{i + 1} <= t{i} + 50" for i in range(n_events - 1))
        return f"chronicle c {{ {events} {order} }}"

    (model,) = models_from_chronicles(parse_chronicles(text(200)))
    (message,) = messages(text(501))

    assert len(model.slots) == 200
    assert model.limits[0][199] == 199 * 50 * MILLISECOND
    assert message.startswith("expected chronicle 'c' to have at most 500 events")


@pytest.mark.parametrize(
    ("before", "piece", "between"),
    [
        ("", "?x == a", " or "),
        ("", "?x != a", " and "),
        ("", "not ?x == a", " and not "),
        ("?x in ", "{a}", " | "),
        ("?x in ", "~{a}", " & ~"),
        ("t1 in ", "[0, 1]", " + "),
    ],
)
def test_operators_may_be_so_deep_and_no_deeper(before: str, piece: str, between: str) -> None:
    """A chain of hundred is read and printed, one of thousand is refused."""
    short, long = (
        f"chronicle c[?x] {{ {EVENT}; {before}{between.join([piece] * n)} }}" for n in (100, 1000)
    )

    file = parse_chronicles(short)

    assert parse_chronicles(print_chronicles(file)) == file
    assert messages(long) == ["expected at most 200 operators inside one another, found more"]


@pytest.mark.parametrize("statement", ["(" * 60 + "?x == a" + ")" * 60, "?x in " + "(" * 60 + "D"])
def test_brackets_may_be_so_deep_and_no_deeper(statement: str) -> None:
    """Fifty are allowed."""
    text = f"domain D = {{}} chronicle c[?x] {{ {EVENT}; {statement} }}"

    assert messages(text) == ["expected at most 50 brackets inside one another, found more"]


def test_sums_of_lengths_may_be_long() -> None:
    """They are one length."""
    text = f"chronicle c[?x] {{ {EVENT} event(q, t2) t2 <= t1{' + 1' * 3000} t2 >= t1 }}"

    (model,) = models_from_chronicles(parse_chronicles(text))

    assert model.limits[0][1] == 3000 * MILLISECOND


def test_what_includes_too_much_is_refused() -> None:
    """Chronicles inside one another may be too deep or, doubled again and again, too many."""
    first = "chronicle c0[?x] { event(q[?x], t) }\n"
    chain = first + "".join(
        f"chronicle c{i}[?x] {{ chronicle c{i - 1}[?x] }}\n" for i in range(1, 103)
    )
    doubled = first + "".join(
        f"chronicle c{i}[?x] {{ chronicle c{i - 1}[?x] chronicle c{i - 1}[?x] }}\n"
        for i in range(1, 6)
    )
    many = " ".join("chronicle c5[?x]" for _ in range(16))
    doubled += f"chronicle top[?x] {{ {many} }}"

    assert [message.split(" to have")[0] for message in messages(chain)] == [
        "expected chronicle 'c101'", "expected chronicle 'c102'"
    ]  # fmt: skip
    assert [message.split(" to have")[0] for message in messages(doubled)] == [
        "expected chronicle 'top'"
    ]


TEXTS = [
    path.read_text(encoding="utf-8")
    for path in sorted([*LIBRARY.glob("*.chronicle"), *FOLDER.glob("*.ok"), *FOLDER.glob("*.bad")])
]
TOKEN = re.compile(r'"[^"\n]*"|[A-Za-z_]\w*|\d+|\s+|.')
WORDS = st.sampled_from(
    [*'{}[](),:;?*<>=+-&|~\\#"$.\n', "=>", "<=>", "<=", "==", "chronicle", "event", "noevent",
     "occurs", "constraint", "domain", "attribute", "message", "variable", "instant", "report",
     "if", "then", "else", "and", "or", "not", "in", "oo", "start", "end", "t1", "?x", "*x", "1",
     "?value", "5 s", "9" * 20, "time", "é", "\0", "\ufeff", "//"]
)  # fmt: skip


@st.composite
def damaged(draw: st.DrawFn) -> str:
    """Return a declaration of some file in which words were lost, doubled, changed or swapped."""
    text = draw(st.sampled_from(TEXTS))
    parts = re.split(r"\n(?=chronicle|attribute|domain|message|constraint)", text)
    words = TOKEN.findall(draw(st.sampled_from(parts)))
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(words)))
        end = min(len(words), start + draw(st.integers(0, 3)))
        others = st.lists(WORDS, max_size=2)
        words[start:end] = draw(st.one_of(st.just(words[start:end] * 2), others))
    return "".join(words)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(damaged())
def test_damaged_files_are_read_or_refused(text: str) -> None:
    """Whatever is read can be printed, checked and prepared; other texts have faults."""
    file, reports = None, []
    try:
        file = parse_chronicles(text)
    except SpecificationErrors as errors:
        reports = [fault.report() for fault in errors.exceptions]

    assert all(report.startswith("<chronicles>:") for report in reports)
    assert (file is None) == bool(reports)
    if file is not None:
        assert parse_chronicles(print_chronicles(file)) == file
        if not faults(file):
            assert len(models_from_chronicles(file)) == len(file.chronicles)


def test_nothing_is_listed_whose_time_is_over():
    """Neither an event that should have come before, nor an interval without length."""
    text = """
        chronicle early { event(a, t) event(n, t + 1) }
        chronicle empty {
            event(n, t) event(a, u) occurs(0, 1, n, (t, t + 9)) noevent(n, (u + 9, t))
        }
    """
    recogniser = Recogniser(models_from_chronicles(parse_chronicles(text)))
    recogniser.push(0, [Event("n", (), None, None, 0)])
    before = [each.chronicle for each in recogniser.partial_instances()]
    recogniser.push(1_000_000, [Event("a", (), None, None, 1_000_000)])

    assert "early" not in before
    assert all(
        awaited.latest is None or awaited.latest >= max(awaited.earliest, 0)
        for each in recogniser.partial_instances()
        for awaited in each.awaited
    )
