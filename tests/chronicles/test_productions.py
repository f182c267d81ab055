"""The grammar of C.R.S., production by production (Heintz 2009, sections 8.3.1 to 8.3.5)."""

import pytest

from chronicles.check import faults
from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from chronicles.printer import print_chronicles, text_of
from dyknow.errors import SpecificationErrors

CONTEXT = """
domain Car = {car1, car2}
parameter long = 9 parameter count = 3
attribute p[?x] message m[?x] message q
constraint two(a, b) { a <= b }
constraint three(a, b, c) { a <= b <= c }
constraint none() { }
constraint unlike[?x, ?y] { ?x != ?y }
chronicle sub[?x](u, v) { event(m[?x], u) event(q, v) u <= v }
"""


def statements(text: str) -> str:
    """Return a file with a chronicle that says something."""
    events = "event(p[?x]:(?, ?y), t1) event(m[?x], t2) event(q, t3)"
    return f"{CONTEXT} chronicle c[?x] {{ {events}; {text} }}"


DECLARATIONS = {
    "ChronicleFile": ["", "domain A = {a} attribute p message m chronicle c { event(m, t) }"],
    "Parameter declaration (ours)": [
        "parameter a = 5", "parameter a = 1.5 s", "parameter a = -1 min", "parameter a = +3",
        "parameter a = −3 parameter b = 0", "parameter parameter = 3",
        "domain A = {a} parameter b = 5", "domain A = {a} domain B = ~A parameter b = 5",
    ],
    "DomainDefinition": ["domain A = {}"],
    "Domain": [
        "domain A = {a} | {b} \\ {c} | {d}", "domain A = {a} + {b} - {c}", "domain A = {a} − {b}",
    ],
    "IntersectedDomain": ["domain A = {a} & {b} & {c}", "domain A = {a} | {b} & {c}"],
    "BasicDomain": [
        "domain A = ({a})", "domain A = ~{a}", "domain A = ∼ {}", "domain A = ~~{car1}",
        "domain A = {a} domain B = A", 'domain A = {"a b", 7}',
    ],
    "ConstraintModel": [
        "constraint k[?a, ?b] { ?a != ?b }", "constraint k[?a] { ?a == x; ?a in {x} }",
        "constraint k { }",
    ],
    "TimeConstraintGraph": [
        "time constraint k(a, b) { a <= b }", "constraint k(a, b) { a <= b; b <= a + 5 }",
        "time constraint k { }", "time constraint k() { }", "domain A = {a} time constraint k { }",
        "constraint k[?a, ?b](a, b) { ?a != ?b; a <= b }",
    ],
    "Attribute": ["attribute a", "attribute a[?x]", "attribute a[?x] { ?value in {v} ?x != b }"],
    "Message": ["message a", "message a[?x, ?y] { }", "message a[?x] { ?x in {a} or ?x == b }"],
    "Chronicle": [
        "chronicle c { event(q, t) }", "chronicle c[?x](t) { event(q[?x], t) }",
        "chronicle c[]() { event(q, t) }",
    ],
}  # fmt: skip
STATEMENTS = {
    "Constraint": [
        "?x == a => ?y == b", "?x == a <=> ?y == b", "if ?x == a then ?y == b",
        "if ?x == a then ?y == b else ?y != b", "if ?x == a or ?x == b then ?y == b and ?x == a",
    ],
    "ConstraintDisjunct": ["?x == a or ?x == b or ?x == c"],
    "ConstraintConjunct": ["?x != a and ?x != b or ?y == d"],
    "AtomicConstraint": [
        "?x in Car", "?x not in Car", "?x == ?y", "?x != ?y", "?x == car1", "?x != \"a b\"",
        "?x ≠ ?y", "not ?x == ?y", "not not ?x in Car", "(?x == a or ?x == b)",
        "not (?x == a => ?y == b)",
    ],
    "Parameter": [
        "event(m[?z], t4)", "event(m[?], t4)", "event(m[*], t4)", "event(m[*z], t4)",
        "event(m[car1], t4)", "event(m[7], t4)", 'event(m["a b"], t4)',
        "event(p[?]:(*, *z), t4)",
    ],
    "TimeConstraint": [
        "t1 < t2", "t1 in [0, 9]", "t1 - t2 in [0, 9]", "t1 < 9", "t1 - t2 >= -9", "t1 > +9",
        "two(t1, t2)", "three(t1, t1 + 5, t2 - 5)", "none()", "two(start, end)",
        "two(t1, t2 + [5, 5])", "unlike[?x, ?y]", "unlike[?x, car1]",
    ],
    "SymbolicInstantSeq": [
        "t1 = t2 = t3", "t1 < t2 = t3 <= t1 + 9", "t3 > t2 >= t1", "t1 <= t2 < t3",
        "t3 >= t2 = t1",
        "t1 ≤ t2; t3 ≥ t2", "t1 < t2 + 5 <= t3", "9 <= t2 - t1 <= 30",
    ],
    "TimeValue": [
        "t2 - t1 < +5", "t2 - t1 > -5", "t2 − t1 < 5", "t2 - t1 in [-5, +5]",
        "t2 - t1 <= long", "t2 - long <= t1", "-long + 5 <= t2 - t1", "t1 < long + 5",
    ],
    "TimePoint": [
        "event(q, t1 + 5)", "event(q, t1 - 5)", "t1 - [0, 5] + [1, 2] - 3 < t2",
        "event(q, t1 - long + 2)", "event(q, t1 + [0, 5])", "event(q, t1 - [0, 5])",
        "t1 < t2 + [0, 5]", "t1 - 5 < t2", "noevent(q, (t1 + [2, 2], t2 - [2, 2] + 1))",
    ],
    "TimeInterval": [
        "t2 - t1 in [0, 5] + [1, 2] - [3, 4]", "t2 - t1 in [-12, 100] + 22",
        "t2 - t1 in [1300, oo[ & [0, 10000]", "t2 - t1 in [10, 122] | [50, 100]",
        "t2 - t1 in [0, 5] + long - [3, 4]",
    ],
    "AtomicTimeInterval": [
        "t2 - t1 in [0, 5]", "t2 - t1 in ]-oo, 5]", "t2 - t1 in [0, oo[", "t2 - t1 in ]-oo, oo[",
        "t2 - t1 in -[-5, 0]", "t2 - t1 in ]0, 5[", "t2 - t1 in [-long, long[",
    ],
    "ChronicleStatement": [
        "chronicle sub[?x]", "chronicle sub[?x]()", "chronicle sub[?](t1)",
        "chronicle sub[*](t1, t2)", "chronicle sub[car1](t1, v = t2)", "chronicle sub[?x](v = t2)",
        "chronicle sub[?x](start = t1, end = t2 + 1)",
        "event(sub[?x]:(?, ?), t4)", "variable ?y, *z event(m[*z], t4)", "variable ?y in Car",
        "instant t1, t2",
    ],
    "Predicate": [
        "event(q, t4)", "noevent(m[?x], (t1, t2 + 1))", "occurs(0, 3, m[*z], (t1, t2))",
        "occurs(3, oo, m[?x], (start, end))", "occurs(count, oo, m[?x], (t1, t1 + long))",
        "occurs(0, count, m[?x], (t1 + [2, 2] - long, t2))",
        "event(q, end)", "event(q, t1) ; event(m[?x], t1)",
    ],
    "Type": ["event(p[?x]:(?, true), t4)", "event(p[?x]:(?y, ?z), t4)", "event(q, t4)"],
}  # fmt: skip
FILES = [(name, text) for name, texts in DECLARATIONS.items() for text in texts]
FILES += [(name, statements(text)) for name, texts in STATEMENTS.items() for text in texts]


@pytest.mark.parametrize(("production", "text"), FILES)
def test_each_production_is_read_printed_and_checked(production: str, text: str) -> None:
    """It has no fault, and printing and parsing it changes nothing."""
    file = parse_chronicles(text)

    assert faults(file) == []
    assert parse_chronicles(print_chronicles(file)) == file
    assert len(models_from_chronicles(file)) == len(file.chronicles)


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("t1 ≤ t2", "t1 <= t2"),
        ("t1 ≥ t2", "t1 >= t2"),
        ("?x ≠ car1", "?x != car1"),
        ("t2 − t1 < 5", "t2 - t1 < 5"),
        ("t2 - t1 in [−5, +5]", "t2 - t1 in [-5, 5]"),
        ("t2 - t1 in [-12, 100] + 22", "t2 - t1 in [10, 122]"),
        ("t2 - t1 in [1300, oo[ & [0, 10000]", "t2 - t1 in [1300, 10000]"),
        ("t2 - t1 in [10, 122] | [50, 100]", "t2 - t1 in [10, 122]"),
        ("t2 - t1 in ]0, 5[", "t2 - t1 in [1, 4]"),
        ("t2 - t1 in -[1, 2]", "t2 - t1 in [-2, -1]"),
        ("t2 - t1 in [0, 5] - [1, 2]", "t2 - t1 in [-2, 4]"),
        ("t1 < t2 - [1, 2] + 5", "t1 < t2 + [3, 4]"),
        ("noevent(q, (t1 + [2, 2], t2))", "noevent(q, (t1 + 2, t2))"),
        ("noevent(q, (t1 - [2, 2], t2))", "noevent(q, (t1 - 2, t2))"),
        ("chronicle sub[?x]()", "chronicle sub[?x]"),
        ("?x in {a} | {b} \\ {a}", "?x in ({a} | {b}) \\ {a}"),
        ("?x in {a} | {b} & {c}", "?x in {a} | ({b} & {c})"),
        ("?x in {a} − {b}", "?x in {a} \\ {b}"),
        ("?x == a and ?x == b or ?x == c", "(?x == a and ?x == b) or ?x == c"),
        ("not ?x == a and ?y == b", "(not ?x == a) and ?y == b"),
        ("?x == a or ?y == b => ?x == b", "(?x == a or ?y == b) => ?x == b"),
        ("?x not in Car", "not ?x in Car"),
        ("event(q, t1 + [5, 5])", "event(q, t1 + 5)"),
        ("time_constraint(t1)", "time_constraint (t1)"),
    ],
)
def test_different_ways_to_write_one_thing(text: str, same: str) -> None:
    """Signs, sums, and what binds more tightly."""
    (one,), (other,) = (
        parse_chronicles(f"chronicle c {{ {each} }}").chronicles[0].statements
        for each in (text, same)
    )

    assert one == other
    assert text_of(one) == text_of(other)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("noevent(q, (t1 + [0, 5], t2))", "an instant at a fixed distance from another, such as"),
        ("occurs(1, 2, q, (t1, t2 + [0, oo[))", "found 't2 + [0, oo['"),
        ("two(t1 - [0, 5], t2)", "found 't1 - [0, 5]'"),
        ("chronicle sub[?x](t1 + ]-oo, 5])", "found 't1 + ]-oo, 5]'"),
        ("?x == ?", "expected a star variable, a value or a variable, found '?'"),
        ("?x == a => ?x == b => ?x == c", "found '=>'"),
        ("t2 - t1 in [0, 1] | [5, 9]", "these intervals leave a gap"),
        ("t2 - t1 in [0, 1] & [5, 9]", "these intervals share nothing"),
        ("event(q, é)", "expected a name, found 'é'"),
        ("event(init, t1)", "found the reserved word 'init'"),
        ("?x inCar", "found 'inCar'"),
    ],
)
def test_what_the_grammar_leaves_open_is_decided(text: str, message: str) -> None:
    """What could not be meant is a fault with a place."""
    with pytest.raises(SpecificationErrors) as raised:
        parse_chronicles(statements(text))

    assert message in str(raised.value.exceptions[0])


@pytest.mark.parametrize("text", ["attribute a[?]", "message m[x]", "chronicle c[*x] { }"])
def test_declared_parameters_are_variables(text: str) -> None:
    """A value or a star in the place of a parameter could stand for nothing."""
    with pytest.raises(SpecificationErrors) as raised:
        parse_chronicles(text)

    assert "expected ']' or a variable" in str(raised.value.exceptions[0])


def test_words_that_are_no_keywords_are_names() -> None:
    """Words with a meaning in one place only may be names elsewhere."""
    text = "chronicle all { event(time[?non_overlapping]:(all, non_overlapping), time) }"

    assert print_chronicles(parse_chronicles(text)).split() == text.split()
