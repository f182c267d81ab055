"""Printing and parsing are inverse, and no text makes the parser fail in another way."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles import syntax
from chronicles.errors import ChronicleSyntaxError
from chronicles.parser import parse_chronicles, read_chronicles
from chronicles.printer import print_chronicles
from chronicles.wording import RESERVED_WORDS
from dyknow.errors import SpecificationErrors
from dyknow.source_text import MADE_IN_PYTHON
from dyknow.time import MILLISECOND

AT = MADE_IN_PYTHON

words = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,3}", fullmatch=True)
names = words.filter(lambda word: word not in RESERVED_WORDS)
dotted_names = st.lists(names, min_size=1, max_size=2).map(".".join)
texts = st.one_of(words, st.from_regex(r'[^"\n\r]{0,4}', fullmatch=True))
durations = st.integers(-9, 99_999).map(lambda amount: amount * MILLISECOND)
variables = st.builds(syntax.Variable, st.just(AT), words.map("?{}".format))
values = st.builds(syntax.Value, st.just(AT), texts)
parameters = st.one_of(
    variables,
    values,
    st.builds(syntax.Star, st.just(AT), words.map("*{}".format)),
    st.builds(syntax.Anything, st.just(AT)),
)
signatures = st.lists(variables, max_size=3).map(tuple)
changes = st.builds(syntax.Change, st.just(AT), parameters, parameters)
event_types = st.builds(
    syntax.EventType,
    st.just(AT),
    dotted_names,
    st.lists(parameters, max_size=3).map(tuple),
    st.one_of(st.none(), changes),
)
moments = st.one_of(names, st.sampled_from(["start", "end"]))
instants = st.builds(syntax.Instant, st.just(AT), moments, durations)
differences = st.builds(syntax.Difference, st.just(AT), moments, moments, durations)
limits = st.one_of(st.none(), durations)
intervals = st.builds(syntax.Interval, st.just(AT), limits, limits)
displaced = st.builds(syntax.Displaced, st.just(AT), moments, intervals)
lengths = st.builds(syntax.Length, st.just(AT), durations)
operands = st.one_of(instants, displaced, differences, lengths)
value_sets = st.builds(syntax.ValueSet, st.just(AT), st.lists(texts, max_size=3).map(tuple))
domains = st.recursive(
    st.one_of(value_sets, st.builds(syntax.DomainReference, st.just(AT), names)),
    lambda inner: st.one_of(
        st.builds(syntax.DomainUnion, st.just(AT), inner, inner),
        st.builds(syntax.DomainIntersection, st.just(AT), inner, inner),
        st.builds(syntax.DomainDifference, st.just(AT), inner, inner),
        st.builds(syntax.DomainComplement, st.just(AT), inner),
    ),
    max_leaves=4,
)
stars = st.builds(syntax.Star, st.just(AT), words.map("*{}".format))
terms = st.one_of(variables, stars, values)
memberships = st.builds(syntax.Membership, st.just(AT), st.one_of(variables, stars), domains)
relations = st.builds(
    syntax.Relation,
    st.just(AT),
    st.one_of(variables, stars),
    st.sampled_from(["==", "!="]),
    terms,
)
conditions = st.recursive(
    st.one_of(memberships, relations),
    lambda inner: st.one_of(
        st.builds(syntax.Negation, st.just(AT), inner),
        st.builds(syntax.Conjunction, st.just(AT), inner, inner),
        st.builds(syntax.Disjunction, st.just(AT), inner, inner),
        st.builds(syntax.Implication, st.just(AT), inner, inner),
        st.builds(syntax.Equivalence, st.just(AT), inner, inner),
        st.builds(syntax.Conditional, st.just(AT), inner, inner, st.one_of(st.none(), inner)),
    ),
    max_leaves=4,
)


@st.composite
def comparisons(draw: st.DrawFn) -> syntax.Comparison:
    """Return a chain of comparisons."""
    chain = draw(st.lists(operands, min_size=2, max_size=4))
    orders = st.sampled_from(["<", "<=", "=", ">", ">="])
    signs = draw(st.lists(orders, min_size=len(chain) - 1, max_size=len(chain) - 1))
    return syntax.Comparison(AT, tuple(chain), tuple(signs))


displacements = intervals.filter(lambda i: not i.lower == i.upper == 0)
constraints = st.one_of(
    comparisons(),
    st.builds(syntax.Within, st.just(AT), st.one_of(differences, instants), intervals),
    conditions,
    st.builds(
        syntax.NamedConstraint,
        st.just(AT),
        names,
        st.lists(terms, max_size=2).map(tuple),
        st.lists(instants, max_size=2).map(tuple),
    ),
)
bindings = st.builds(syntax.InstantBinding, st.just(AT), st.one_of(st.none(), moments), instants)
statements = st.one_of(
    st.builds(
        syntax.EventAt,
        st.just(AT),
        event_types,
        moments,
        st.one_of(st.none(), displacements),
    ),
    st.builds(syntax.NoEvent, st.just(AT), event_types, instants, instants),
    st.builds(
        syntax.Occurs,
        st.just(AT),
        st.integers(0, 9),
        st.one_of(st.none(), st.integers(0, 9)),
        event_types,
        instants,
        instants,
    ),
    constraints,
    st.builds(
        syntax.VariableDeclaration,
        st.just(AT),
        st.lists(st.one_of(variables, stars), min_size=1, max_size=2).map(tuple),
        st.one_of(st.none(), domains),
    ),
    st.builds(
        syntax.InstantDeclaration, st.just(AT), st.lists(names, min_size=1, max_size=2).map(tuple)
    ),
    st.builds(
        syntax.Inclusion,
        st.just(AT),
        names,
        st.lists(parameters, max_size=2).map(tuple),
        st.lists(bindings, max_size=2).map(tuple),
    ),
    st.builds(syntax.ReportAll, st.just(AT)),
    st.builds(syntax.ReportNonOverlapping, st.just(AT), moments, moments),
)
blocks = st.lists(conditions, max_size=2).map(tuple)
some_instants = st.lists(names, max_size=2).map(tuple)
declarations = st.one_of(
    st.builds(syntax.DomainDeclaration, st.just(AT), names, domains),
    st.builds(
        syntax.ConstraintDeclaration,
        st.just(AT),
        names,
        signatures,
        some_instants,
        st.lists(constraints, max_size=3).map(tuple),
    ),
    st.builds(syntax.AttributeDeclaration, st.just(AT), dotted_names, signatures, blocks),
    st.builds(syntax.MessageDeclaration, st.just(AT), dotted_names, signatures, blocks),
    st.builds(
        syntax.Chronicle,
        st.just(AT),
        names,
        signatures,
        st.lists(statements, max_size=5).map(tuple),
        some_instants,
    ),
)
files = st.builds(syntax.ChronicleFile, st.just(AT), st.lists(declarations, max_size=4).map(tuple))


@settings(derandomize=True, deadline=None, max_examples=80)
@given(files)
def test_printing_then_parsing_changes_nothing(file: syntax.ChronicleFile) -> None:
    """The text of a tree parses to an equal tree, which prints to the same text."""
    text = print_chronicles(file)

    parsed = parse_chronicles(text)

    assert parsed == file
    assert print_chronicles(parsed) == text


PIECES = st.sampled_from(
    [*'{}[](),:;?*<=>+-$\n"', "chronicle", "event", "noevent", "t1", "?x", "12", "0.5 s", "oo"]
)


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.lists(PIECES, max_size=12).map(" ".join), st.booleans())
def test_whatever_is_written_is_parsed_or_refused_with_a_place(text: str, inside: bool) -> None:
    """Any text gives a tree or a syntax error whose place can be shown."""
    text = f"chronicle a {{ event(b, t1) {text} }}" if inside else text
    try:
        parse_chronicles(text)
        report = "<chronicles>:"
    except SpecificationErrors as errors:
        report = "".join(error.report() for error in errors.exceptions)

    assert report.startswith("<chronicles>:")


def test_spans_tell_where_a_thing_was_written():
    """Each node knows its place in the text."""
    file = parse_chronicles("chronicle a {\n  event(b[?x], t1)\n}", "a.chronicle")

    event = file.chronicles[0].statements[0]

    assert event.span.place == "a.chronicle:2:3"


def test_a_file_in_another_encoding_is_refused_with_the_byte(tmp_path):
    """Text that is not UTF-8 gives a syntax error that says so."""
    path = tmp_path / "latin.chronicle"
    path.write_bytes(b"# \xe5\n")

    with pytest.raises(SpecificationErrors) as raised:
        read_chronicles(path)
    (fault,) = raised.value.exceptions
    assert isinstance(fault, ChronicleSyntaxError)
    assert "UTF-8, found the byte 0xe5 at offset 2" in fault.message
