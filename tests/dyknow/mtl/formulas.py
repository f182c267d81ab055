"""Random formulas and traces, shared by the tests of metric temporal logic."""

from hypothesis import strategies as st

from dyknow.mtl import syntax
from dyknow.mtl.syntax import Formula, Interval
from dyknow.time import Duration

__all__ = ["TWO_FEATURES", "any_formulas", "intervals", "small_formulas", "traces"]

TWO_FEATURES = st.sampled_from([syntax.Feature("p"), syntax.Feature("q")])


def intervals(longest: int = 6) -> st.SearchStrategy[Interval]:
    """Intervals of a few nanoseconds, some without end."""
    starts = st.integers(0, longest // 2)
    lengths = st.none() | st.integers(0, longest)
    return st.builds(
        lambda start, length: Interval(
            Duration(start), None if length is None else Duration(start + length)
        ),
        starts,
        lengths,
    )


def small_formulas(
    leaves: st.SearchStrategy[Formula] = TWO_FEATURES, longest: int = 6, size: int = 6
) -> st.SearchStrategy[Formula]:
    """Formulas over p and q with every operator, nested."""
    return st.recursive(leaves, lambda inner: _operators(inner, longest), max_leaves=size)


def any_formulas() -> st.SearchStrategy[Formula]:
    """Formulas with every piece of syntax."""
    return st.recursive(
        _truths() | _features() | _comparisons(),
        lambda inner: _operators(inner, 3_000_000_000) | _quantifiers(inner),
        max_leaves=8,
    )


@st.composite
def traces(draw, most=8, longest=7):
    """Traces of p and q at irregular times, some nanoseconds apart."""
    count = draw(st.integers(1, most))
    gaps = draw(st.lists(st.integers(1, longest), min_size=count, max_size=count))
    truths = draw(
        st.lists(st.tuples(st.booleans(), st.booleans()), min_size=count, max_size=count)
    )
    states = [{"p": p, "q": q} for p, q in truths]
    return [(sum(gaps[: i + 1]), state) for i, state in enumerate(states)]


def _operators(inner, longest):
    several = st.lists(inner, min_size=2, max_size=3).map(tuple)
    within = intervals(longest)
    return (
        st.builds(syntax.Negation, inner)
        | st.builds(syntax.Conjunction, several)
        | st.builds(syntax.Disjunction, several)
        | st.builds(syntax.Implication, inner, inner)
        | st.builds(syntax.Equivalence, inner, inner)
        | st.builds(syntax.Always, within, inner)
        | st.builds(syntax.Eventually, within, inner)
        | st.builds(syntax.Until, within, inner, inner)
    )


def _names():
    words = ["p", "on_road", "cars.link", "from", "to", "été", "x1", "notable", "oops"]
    return st.sampled_from(words)


def _arguments():
    return st.builds(syntax.Name, _names()) | _numbers() | st.builds(syntax.Text, _texts())


def _texts():
    return st.text(st.characters(codec="utf-8"), max_size=5)


def _numbers():
    finite = st.floats(0, allow_nan=False, allow_infinity=False)
    return st.builds(syntax.Number, finite | st.integers(0, 10**6).map(float))


def _features():
    arguments = st.lists(_arguments(), max_size=3).map(tuple)
    return st.builds(syntax.Feature, _names(), arguments)


def _terms():
    leaves = _numbers() | _features() | st.builds(syntax.Text, _texts()) | _truths()
    return st.recursive(
        leaves,
        lambda inner: (
            st.builds(syntax.Arithmetic, inner, st.sampled_from("+-*/"), inner)
            | st.builds(syntax.Minus, inner)
        ),
        max_leaves=4,
    )


def _truths():
    return st.sampled_from([syntax.TRUE, syntax.FALSE])


def _comparisons():
    operators = st.sampled_from(["<", "<=", "=", "!=", ">=", ">"])
    return st.builds(syntax.Comparison, _terms(), operators, _terms())


def _quantifiers(inner):
    names = st.builds(syntax.Name, _names())
    return st.builds(syntax.ForAll, names, names, inner) | st.builds(
        syntax.Exists, names, names, inner
    )
