"""From text to formulas."""

from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import FormulaSyntaxError, SpecificationErrors
from dyknow.mtl import syntax
from dyknow.mtl.check import check
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.quantifiers import expand
from dyknow.mtl.syntax import ALWAYS_HENCEFORTH, Feature, Interval, Name, Number, Verdict
from dyknow.time import MILLISECOND, Duration, TimePoint


def test_a_link_condition_is_read_as_it_is_written():
    """Operators, intervals in milliseconds, and features with their arguments."""
    formula = parse_formula("always eventually [0, 200] xydist(from, to) < 3")

    distance = Feature("xydist", (Name("from"), Name("to")))
    close = syntax.Comparison(distance, "<", Number(3.0))
    within = Interval(Duration(0), Duration(200 * MILLISECOND))
    assert formula == syntax.Always(ALWAYS_HENCEFORTH, syntax.Eventually(within, close))


def test_brackets_and_parentheses_around_arguments_mean_the_same():
    """`speed[x]` is `speed(x)`."""
    assert parse_formula("speed[x] < 2") == parse_formula("speed(x) < 2")


def test_every_node_knows_its_place():
    """The span of a node covers its text."""
    formula = parse_formula("p and (q -> eventually [0, 5] r)", "conditions.txt")

    assert isinstance(formula, syntax.Conjunction)
    span = formula.bodies[1].span
    assert span.source.text[span.start : span.end] == "q -> eventually [0, 5] r"
    assert span.place == "conditions.txt:1:8"


def test_until_binds_tighter_than_and_and_to_the_right():
    """`a and b until c until d` is `a and (b until (c until d))`."""
    assert parse_formula("a and b until c until d") == parse_formula("a and (b until (c until d))")


def test_comments_and_line_ends_do_not_matter():
    """A formula may stretch over lines, with comments after `#`."""
    text = "always # at all times\n  p"
    assert parse_formula(text) == parse_formula("always p")


def test_a_conjunction_of_ten_thousand_formulas_is_one_operator():
    """Length is no limit."""
    formula = parse_formula(" and ".join(["p"] * 10_000))

    assert isinstance(formula, syntax.Conjunction)
    assert len(formula.bodies) == 10_000


@pytest.mark.parametrize("text", ["not " * 1000 + "p", " -> ".join(["p"] * 1000)])
def test_nesting_has_a_limit(text):
    """Operators nested deeper than the limit are a fault, not a crash."""
    with pytest.raises(FormulaSyntaxError, match="at most 200 operators inside one another"):
        parse_formula(text)


def test_a_thousand_parentheses_are_no_nesting():
    """Parentheses leave no trace."""
    assert parse_formula("(" * 1000 + "p" + ")" * 1000) == Feature("p")


def test_a_syntax_error_shows_the_place():
    """The report has the line and carets under what was found."""
    with pytest.raises(FormulaSyntaxError) as caught:
        parse_formula("always\n  p q", "file.txt")

    assert caught.value.report() == (
        "file.txt:2:5: expected an operator or the end, found 'q'\n  p q\n    ^"
    )


_PIECES = st.sampled_from(
    ["p", "q(", ")", "[", "0", ",", "oo", "]", "always", "until", "and", "->", "<", "-", "(", "$",
     "forall", "x", "in", "1.5 s", '"a', '"', "not", "true", "1e400", "\\"]
)  # fmt: skip


@settings(derandomize=True, deadline=None, max_examples=300)
@given(st.lists(_PIECES, max_size=12).map(" ".join) | st.text(max_size=20))
def test_any_text_is_a_formula_or_a_syntax_error(text):
    """No text makes the parser fail in another way."""
    with suppress(FormulaSyntaxError):
        parse_formula(text)


D = 198
DEEP = [
    "not " * D + "p",
    "always [0, 1] eventually [0, 2] " * (D // 2) + "p",
    " -> ".join(["p", "q"] * (D // 2)),
    " until ".join(["p", "q"] * (D // 2)),
    " <-> ".join(["p", "q"] * (D // 2)),
    "-" * (D - 3) + "x < 1",
    " + ".join(["x"] * (D - 2)) + " < 1",
    "(p and (q or " * (D // 2) + "p" + "))" * (D // 2),
    "".join(f"forall x{i} in C " for i in range(D - 2)) + "p(x3)",
]


@pytest.mark.parametrize("text", DEEP, ids=[text[:12] for text in DEEP])
def test_what_is_nested_almost_too_deep_goes_all_the_way(text):
    """A formula at the limit is checked, printed and monitored, and what is left is printed."""
    formula = parse_formula(text)
    check(formula)
    assert parse_formula(text_from_formula(formula)) == formula
    monitor = Monitor(expand(formula, {"C": ("c1",)}))
    for time in (1, 5):
        monitor.step(TimePoint(time), {"p": True, "q": False, "x": 0.5, "p(c1)": True})
    assert text_from_formula(monitor.residual)


def test_too_deep_a_formula_made_in_python_is_a_fault():
    """The limit holds wherever a formula comes from."""
    formula = Feature("p")
    for _ in range(5000):
        formula = syntax.Negation(formula)

    with pytest.raises(SpecificationErrors) as caught:
        Monitor(formula)
    assert "at most 200 operators" in caught.value.exceptions[0].message


def test_ten_thousand_operators_are_monitored():
    """A formula of ten thousand operators that are not nested is like any other."""
    rules = " and ".join(f"(p -> eventually [0, {i}] x < {i})" for i in range(1, 2501))
    monitor = Monitor(parse_formula(rules))

    assert monitor.step(TimePoint(0), {"p": True, "x": 2400}) is Verdict.UNDECIDED
    assert monitor.step(TimePoint(MILLISECOND), {"p": False, "x": 2600}) is Verdict.FALSE
