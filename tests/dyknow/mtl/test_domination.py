"""Instants that need not be remembered."""

import numpy as np
import pytest

from dyknow.mtl.domination import redundant
from dyknow.mtl.graph import FormulaGraph
from dyknow.mtl.instants import between
from dyknow.mtl.knowledge import NOTHING, Knowledge
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.rules import NEVER, RuleBook
from dyknow.mtl.syntax import TimeModel, Verdict
from dyknow.time import MILLISECOND


def given_up(text, waiting, known, *, keep_earlier=False):
    """The redundant instants, given what is known about the features by name."""
    graph = FormulaGraph(parse_formula(text))
    knowledge = [known.get(str(getattr(f, "name", "")), NOTHING) for f in graph.formulas]
    return redundant(graph.nodes, graph.root, waiting, knowledge, keep_earlier=keep_earlier)


@pytest.mark.parametrize(
    ("text", "redundant_instants"),
    [
        ("eventually p", (-8, 0)),
        ("always p", (-9, -1)),
        ("eventually [0, 20 ns] p", ()),
        ("always [0, 20 ns] p", ()),
        ("eventually p and eventually q", (-8, 0)),
        ("always p or always q", (-9, -1)),
        ("eventually p and always q", ()),
        ("p until q", ()),
    ],
)
def test_without_knowledge_only_the_form_counts(text, redundant_instants):
    """Of nine instants one is enough if there is no bound, the first or the last."""
    assert given_up(text, (-9, 0), {}) == redundant_instants


@pytest.mark.parametrize(
    ("text", "known", "redundant_instants"),
    [
        ("eventually [0, 20 ns] p", Knowledge(false=between(-9, 1)), (-9, -1)),
        ("always [0, 20 ns] p", Knowledge(true=between(-9, 1)), (-8, 0)),
        ("eventually [0, 20 ns] p", Knowledge(false=between(-5, 1)), (-5, -1)),
        ("eventually [3 ns, 20 ns] p", Knowledge(false=between(-5, 1)), (-8, -2)),
        ("p until q", Knowledge(true=between(-9, 1)), (-8, 0)),
    ],
)
def test_what_is_known_makes_instants_alike(text, known, redundant_instants):
    """Where nothing tells two instants apart, one of them is enough."""
    assert given_up(text, (-9, 0), {"p": known}) == redundant_instants


def test_instants_are_compared_across_gaps():
    """The last of one interval and the first of the next are neighbours."""
    waiting = (-20, -18, -12, -10, -4, 0)
    known = {"p": Knowledge(false=between(-30, -11))}

    assert given_up("eventually p", waiting, {}) == (-19, -18, -12, -10, -4, 0)
    assert given_up("eventually [0, 40 ns] p", waiting, known) == (-20, -18, -12, -11)
    assert given_up("eventually [0, 40 ns] p", waiting, known, keep_earlier=True) == ()


@pytest.mark.parametrize("time_model", TimeModel)
@pytest.mark.parametrize(
    "text",
    [
        "eventually (q and eventually p)",
        "always (q -> eventually p)",
        "always (q or always not p)",
        "eventually (q and (r until p))",
        "always (q -> not (r until [100, oo] p))",
        "eventually (q and eventually (r and eventually p))",
        "always (q -> always (r -> eventually p))",
        "always (q or (always eventually r and eventually always p))",
        "eventually [300, oo] (q and eventually [200, oo] p)",
        "eventually (q and eventually p and always r)",
        "q until (r until p)",
    ],
)
@pytest.mark.parametrize("holds", [0.0, 0.03, 0.5])
def test_unbounded_operators_run_in_constant_memory(text, holds, time_model):
    """A handful of times is all that is remembered of hundreds of states."""
    graph = FormulaGraph(parse_formula(text), time_model)
    names = [getattr(atom, "name", "") for atom in graph.atoms]
    book = RuleBook(graph, 1000)
    shape, past = book.initial, (NEVER,)
    rng = np.random.default_rng(1)
    for step in range(300):
        truth = {"p": rng.random() < holds, "q": rng.random() < 0.5, "r": rng.random() < 0.5}
        bits = sum(int(truth[name]) << i for i, name in enumerate(names))
        shape, past = book.follow(shape, past, bits, step * 100 * MILLISECOND)
        assert len(past) <= 6
        if shape.verdict is not Verdict.UNDECIDED:
            shape, past = book.initial, (NEVER,)
