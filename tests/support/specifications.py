"""Strategies for the syntax trees of KPL specifications."""

from hypothesis import strategies as st

from dyknow.kpl import syntax
from dyknow.kpl.syntax import Label, Name, Setting, Sort, StreamTerm, Synchronisation, Time
from dyknow.mtl.parser import parse_formula
from dyknow.time import Duration

__all__ = ["specifications"]

_KEYWORDS = {"any", "from", "link", "max", "no", "oo", "order", "state", "sync", "to", "use"}
_WORDS = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,6}", fullmatch=True).filter(
    lambda word: word not in _KEYWORDS
) | st.sampled_from(["sources", "linked", "to_", "any1", "establish", "ms", "s"])
_NAMES = _WORDS.map(Name)
_TIMES = st.integers(0, 10**12).map(lambda ns: Time(Duration(ns)))
_MOMENTS = _TIMES | _NAMES
_LIMITS = _MOMENTS | st.just(syntax.Endless())
_FORMULAS = st.sampled_from(
    [
        "true",
        "eventually [200, oo] true",
        "eventually [0, 200] xydist(from, to) < 3",
        "always (on_road(from) -> eventually [0, 10 s] (speed[from] > 2 and f(from, to) = 1))",
        "(a or not b) until [5, 10] c",
        'forall x in Car (colour[x] = "red, (dark]")',
    ]
).map(parse_formula)

_VALUES = st.recursive(
    st.integers(-(10**6), 10**6).map(syntax.Number)
    | st.floats(allow_nan=False, allow_infinity=False).map(syntax.Number)
    | _TIMES
    | st.text(st.characters(exclude_categories=["Cs"]), max_size=8).map(syntax.Text)
    | st.booleans().map(syntax.Truth)
    | _NAMES,
    lambda values: st.lists(values, min_size=1, max_size=3).map(
        lambda found: syntax.Values(tuple(found))
    ),
    max_leaves=4,
)
_SETTINGS = st.lists(
    st.builds(Setting, _WORDS | st.sampled_from(["from", "max", "link"]), _VALUES), max_size=2
).map(tuple)

_SORTS = st.recursive(
    _WORDS.map(Sort) | st.just(Sort("any")),
    lambda sorts: st.lists(sorts, min_size=1, max_size=2).map(
        lambda parts: Sort("state", tuple(parts))
    ),
    max_leaves=3,
)
_LABELS = st.builds(Label, _NAMES, st.lists(_NAMES, max_size=2).map(tuple))
_CONSTRAINTS = st.one_of(
    st.sampled_from(
        [
            syntax.NoApproximation(),
            syntax.UseMostRecent(),
            syntax.AnyUpdate(),
            syntax.AnyChange(),
            syntax.AnyOrder(),
            syntax.MonotoneOrder(),
            syntax.StrictOrder(),
        ]
    ),
    st.builds(syntax.SampleEvery, _MOMENTS),
    st.builds(syntax.MaxDelay, _LIMITS),
    st.builds(syntax.FromTo, _MOMENTS, st.none() | _LIMITS),
    st.builds(syntax.To, _LIMITS),
)
_POLICIES = st.lists(_CONSTRAINTS, max_size=3).map(tuple)
_PROVIDERS = st.recursive(
    _LABELS,
    lambda providers: st.lists(
        st.builds(StreamTerm, providers, _POLICIES), min_size=1, max_size=2
    ).map(lambda streams: Synchronisation(tuple(streams))),
    max_leaves=3,
)
_TERMS = st.builds(StreamTerm, _PROVIDERS, _POLICIES)
_STREAMS = st.lists(_TERMS, min_size=1, max_size=3).map(tuple)
_PROCESSES = st.one_of(
    st.builds(syntax.SourceInstance, _NAMES),
    st.builds(syntax.UnitInstance, _NAMES, _STREAMS, _SETTINGS),
    st.builds(syntax.Link, _TERMS, _NAMES, _FORMULAS, _FORMULAS, _FORMULAS, _SETTINGS),
    st.builds(Synchronisation, _STREAMS),
)
_DECLARATIONS = st.one_of(
    st.builds(syntax.SourceDeclaration, _SORTS, _NAMES),
    st.builds(
        syntax.UnitDeclaration,
        _SORTS,
        _NAMES,
        st.lists(_SORTS, min_size=1, max_size=3).map(tuple),
        st.booleans(),
    ),
    st.builds(syntax.GeneratorDeclaration, _LABELS, _PROCESSES),
    st.builds(syntax.StreamDeclaration, _NAMES, _TERMS),
    st.builds(syntax.ParameterDeclaration, _NAMES, _VALUES),
)

specifications = st.lists(_DECLARATIONS, max_size=4).map(
    lambda declarations: syntax.Specification(tuple(declarations))
)
"""Specifications as the grammar has them; most are full of static faults."""
