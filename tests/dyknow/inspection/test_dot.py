"""The text for Graphviz keeps to the grammar of its language."""

import re
import shutil
import subprocess

import pytest
from hypothesis import given, settings

from dyknow.inspection.dot import dot_from
from dyknow.inspection.snapshot import Snapshot
from tests.support.snapshots import small_network, snapshots

TOKEN = re.compile(
    r'\s*(?:(?P<id>"(?:[^"\\]|\\.)*"|[A-Za-z_]\w*|\d+)|(?P<sign>->|[{}\[\]=;,]))', re.S
)


def graph_of(text: str) -> tuple[list[str], list[tuple[str, str]]]:
    """Return nodes and edges of a graph; raise ValueError where the grammar is not kept."""
    tokens, at = [], 0
    while text[at:].strip():
        match = TOKEN.match(text, at)
        if match is None:
            raise ValueError(f"no token at {text[at : at + 20]!r}")
        tokens.append(match["id"] or match["sign"])
        at = match.end()
    return Reader(tokens).graph()


class Reader:
    """Reads the part of the language that pictures of networks need."""

    def __init__(self, tokens):
        self.tokens = tokens

    def take(self, *expected):
        """Take one token, one of *expected* if there are any."""
        token = self.tokens.pop(0) if self.tokens else "the end"
        if expected and token not in expected:
            raise ValueError(f"expected {expected}, found {token}")
        return token

    def graph(self):
        """Read the whole text."""
        self.take("digraph")
        self.take()
        self.take("{")
        nodes, edges = [], []
        while self.tokens[0] != "}":
            self.statement(nodes, edges)
        self.take("}")
        if self.tokens:
            raise ValueError(f"expected the end, found {self.tokens[0]}")
        return nodes, edges

    def statement(self, nodes, edges):
        """Read a node, an edge, or the setting of an attribute."""
        name = self.take()
        if self.tokens[0] == "=":
            self.take("=")
            self.take()
        elif self.tokens[0] == "->":
            self.take("->")
            edges.append((name, self.take()))
            self.attributes()
        else:
            if name not in ("graph", "node", "edge"):
                nodes.append(name)
            self.attributes()
        self.take(";")

    def attributes(self):
        """Read attributes in brackets."""
        self.take("[")
        while True:
            self.take()
            self.take("=")
            self.take()
            if self.take(",", "]") == "]":
                return


@settings(derandomize=True, deadline=None, max_examples=25)
@given(snapshots())
def test_the_text_keeps_to_the_grammar(snapshot):
    """Whatever is in the labels, there is a node for each box and an edge for each stream."""
    nodes, edges = graph_of(dot_from(snapshot, 'a "title"\\'))

    outputs = [stream for stream in snapshot.streams if stream.is_output]
    assert len(nodes) == len(set(nodes)) == len(snapshot.processes) + len(outputs)
    assert len(edges) == len(snapshot.streams)
    assert {end for edge in edges for end in edge} <= set(nodes)


def test_edges_carry_the_figures():
    """Rate, delay and violations stand on the edges."""
    text = dot_from(small_network())

    assert 'label="10\u202fHz · 40\u202fms\\n2 violated"' in text
    assert '"percepts[vision]" -> "cars"' in text


def test_an_empty_network_is_a_graph():
    """Nothing makes a graph without nodes."""
    assert graph_of(dot_from(Snapshot())) == ([], [])


@pytest.mark.skipif(shutil.which("dot") is None, reason="Graphviz is not installed")
def test_graphviz_takes_it():
    """Graphviz draws the text."""
    done = subprocess.run(
        ["dot", "-Tsvg"],
        input=dot_from(small_network()),
        capture_output=True,
        text=True,
        check=True,
    )

    assert "<svg" in done.stdout
