"""Random formulas and traces, shared by the tests of metric temporal logic."""

from hypothesis import strategies as st

from dyknow.mtl import syntax
from dyknow.mtl.syntax import Formula, Interval
from dyknow.time import Duration

__all__ = [
    "FOUR_FEATURES",
    "TWO_FEATURES",
    "any_formulas",
    "intervals",
    "plain_formulas",
    "quantified_formulas",
    "small_formulas",
    "traces",
    "wide_traces",
]

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


FOUR_FEATURES = ("p0", "p1", "p2", "p3")


@st.composite
def plain_formulas(draw, longest=6):
    """Formulas with every operator in which no feature occurs twice, so that nothing follows."""
    shape = draw(small_formulas(st.just(syntax.Feature("p")), longest, size=4))
    names = iter(FOUR_FEATURES)
    return _with_leaves(shape, lambda: syntax.Feature(next(names)))


@st.composite
def quantified_formulas(draw, longest=4):
    """Formulas with quantifiers over two objects, nested in operators."""
    leaves = st.sampled_from(
        [syntax.Feature("p", (syntax.Name(name),)) for name in ("a", "b", "x")]
        + [syntax.Comparison(syntax.Feature("x"), "=", syntax.Text("a"))]
    )
    inner = draw(small_formulas(leaves, longest, size=3))
    kind = draw(st.sampled_from([syntax.ForAll, syntax.Exists]))
    whole = kind(syntax.Name("x"), syntax.Name("D"), inner)
    within = draw(intervals(longest))
    return draw(
        st.sampled_from([whole, syntax.Always(within, whole), syntax.Eventually(within, whole)])
    )


@st.composite
def wide_traces(draw, features=FOUR_FEATURES, most=7, longest=7):
    """Traces of several boolean features at irregular times."""
    count = draw(st.integers(1, most))
    gaps = draw(st.lists(st.integers(1, longest), min_size=count, max_size=count))
    bits = draw(st.lists(st.integers(0, 15), min_size=count, max_size=count))
    states = [{f: bool(b >> i & 1) for i, f in enumerate(features)} for b in bits]
    return [(sum(gaps[: i + 1]), state) for i, state in enumerate(states)]


def _with_leaves(formula, leaf):
    """The formula with each of its atoms replaced by what *leaf* gives."""
    if isinstance(formula, syntax.Feature):
        return leaf()
    inner = [_with_leaves(part, leaf) for part in syntax.operands(formula)]
    return syntax.with_operands(formula, inner)


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
