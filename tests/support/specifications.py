"""Strategies for the syntax trees of KPL specifications."""

import re
from typing import Any

from hypothesis import strategies as st

from dyknow.kpl import syntax
from dyknow.kpl.syntax import Label, Name, Setting, Sort, StreamTerm, Synchronisation, Time
from dyknow.mtl.parser import parse_formula
from dyknow.runtime.failures import OnFailure
from dyknow.time import Duration

__all__ = ["specifications"]

_KEYWORDS = set(
    re.findall(
        r"\w+",
        "any change delay every from link max merge most no oo order recent state sync to use"
        " with",
    )
)
_WORDS_OF_THE_LANGUAGE = (
    "all and as at before capacity common deviation each end failure for in load object on period "
    "select stop under up updates where"
)
_WORDS = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,6}", fullmatch=True).filter(
    lambda word: word not in _KEYWORDS
) | st.sampled_from(["sources", "linked", "to_", "any1", "establish", "ms", "s"])
_WORDS |= st.sampled_from(_WORDS_OF_THE_LANGUAGE.split())
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
    (_WORDS | st.just("object")).map(Sort) | st.just(Sort("any")),
    lambda sorts: st.builds(
        Sort,
        st.sampled_from(["state", "object"]),
        st.lists(sorts, min_size=1, max_size=2).map(tuple),
    ),
    max_leaves=3,
)
_LABELS = st.builds(Label, _NAMES, st.lists(_NAMES, max_size=2).map(tuple))
_CONSTRAINTS = st.one_of(
    st.sampled_from(
        [
            syntax.NoApproximation(),
            syntax.UseMostRecent(),
            syntax.UseLinear(),
            syntax.UseLatest(),
            syntax.AnyUpdate(),
            syntax.AnyChange(),
            syntax.AllUpdates(),
            syntax.SampleEveryCommonPeriod(),
            syntax.AtMaxDelay(),
            syntax.AnyOrder(),
            syntax.MonotoneOrder(),
            syntax.StrictOrder(),
        ]
    ),
    st.builds(syntax.SampleEvery, _MOMENTS, st.none() | _MOMENTS, st.none() | _MOMENTS),
    st.builds(syntax.DelayBeforeApproximation, _MOMENTS),
    st.builds(syntax.Capacity, st.integers(0, 10**6)),
    st.builds(syntax.MaxDelay, _LIMITS),
    st.builds(syntax.FromTo, _MOMENTS, st.none() | _LIMITS),
    st.builds(syntax.To, _LIMITS),
)
_POLICIES = st.lists(_CONSTRAINTS, max_size=3).map(tuple)
_PATHS = st.lists(_WORDS | st.sampled_from(["from", "link"]), min_size=1, max_size=3).map(".".join)
_PATTERNS = st.lists(_WORDS | _PATHS.map(lambda path: f"%{path}%"), min_size=1, max_size=3).map(
    "".join
)
_FIELDS = st.lists(st.builds(syntax.SelectedField, _PATHS, st.none() | _PATTERNS), max_size=2).map(
    tuple
)
_WHERE = st.lists(st.builds(syntax.Condition, _PATHS, _VALUES), max_size=2).map(tuple)


def _operations(providers: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    terms = st.builds(StreamTerm, providers, _POLICIES)
    streams = st.lists(terms, min_size=1, max_size=2).map(tuple)
    return st.one_of(
        st.builds(Synchronisation, streams),
        st.builds(syntax.Merging, streams),
        st.builds(syntax.Mediation, terms, _NAMES, terms),
    )


_UNSELECTED = st.recursive(_LABELS, _operations, max_leaves=3)
_SELECTIONS = st.builds(syntax.Selection, _FIELDS, _UNSELECTED, _WHERE)
_TERMS = st.deferred(lambda: st.builds(StreamTerm, _UNSELECTED | _SELECTIONS, _POLICIES))
_STREAMS = st.lists(_TERMS, min_size=1, max_size=3).map(tuple)
_PROCESSES = st.deferred(lambda: _ALL_PROCESSES)
_ALL_PROCESSES = st.one_of(
    st.builds(syntax.SourceInstance, _NAMES),
    st.builds(syntax.UnitInstance, _NAMES, _STREAMS, _SETTINGS),
    st.builds(syntax.Link, _TERMS, _NAMES, _FORMULAS, _FORMULAS, _FORMULAS, _SETTINGS),
    st.builds(Synchronisation, _STREAMS),
    st.builds(syntax.Merging, _STREAMS),
    st.builds(syntax.Mediation, _TERMS, _NAMES, _TERMS),
    _SELECTIONS,
)
_MEMBER_DECLARATIONS = st.recursive(
    st.builds(
        syntax.GeneratorDeclaration, _LABELS, _PROCESSES, _POLICIES, st.sampled_from(OnFailure)
    )
    | st.builds(syntax.StreamDeclaration, _LABELS, _TERMS),
    lambda inner: st.builds(
        syntax.Configuration, _NAMES, _TERMS, st.lists(inner, max_size=3).map(tuple)
    ),
    max_leaves=4,
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
    st.builds(syntax.ParameterDeclaration, _NAMES, _VALUES),
    _MEMBER_DECLARATIONS,
)

specifications = st.lists(_DECLARATIONS, max_size=4).map(
    lambda declarations: syntax.Specification(tuple(declarations))
)
"""Specifications as the grammar has them; most are full of static faults."""
