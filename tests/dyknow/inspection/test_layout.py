"""Boxes stand in columns, apart from each other, and arrows run through the gaps."""

from itertools import combinations, islice, pairwise, permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.inspection.layout import Arrow, Box, count_crossings, lay_out

GAP, SPACING = 40.0, 12.0


@st.composite
def graphs(draw):
    """Draw boxes in layers and arrows to the right."""
    layers = draw(st.lists(st.integers(min_value=1, max_value=4), min_size=1, max_size=5))
    boxes = [
        Box(f"b{layer}{at}", layer, draw(st.sampled_from([60.0, 90.0])), 30.0 + 10 * at)
        for layer, count in enumerate(layers)
        for at in range(count)
    ]
    pairs = [(a, b) for a in boxes for b in boxes if a.layer < b.layer]
    chosen = draw(st.lists(st.sampled_from(pairs), max_size=10)) if pairs else []
    arrows = [Arrow(a.name, b.name, number) for number, (a, b) in enumerate(chosen)]
    return boxes, arrows


@settings(derandomize=True, deadline=None, max_examples=40)
@given(graphs())
def test_boxes_keep_their_distance(graph):
    """Boxes of a column do not touch, and columns stand apart."""
    boxes, arrows = graph

    layout = lay_out(boxes, arrows, gap=GAP, spacing=SPACING)

    for one, other in combinations(boxes, 2):
        (x, y), (other_x, other_y) = layout.place[one.name], layout.place[other.name]
        if one.layer == other.layer:
            assert x == other_x
            apart = max(other_y - (y + one.height), y - (other_y + other.height))
            assert apart >= SPACING - 1e-6
        elif one.layer < other.layer:
            assert other_x - (x + one.width) >= GAP
    assert all(y >= -1e-6 for _, y in layout.place.values())


@settings(derandomize=True, deadline=None, max_examples=40)
@given(graphs())
def test_arrows_lead_from_box_to_box(graph):
    """An arrow leaves the right side of its tail and enters the left side of its head."""
    boxes, arrows = graph
    by_name = {box.name: box for box in boxes}

    layout = lay_out(boxes, arrows, gap=GAP, spacing=SPACING)

    for arrow, route in zip(arrows, layout.routes, strict=True):
        tail, head = by_name[arrow.tail], by_name[arrow.head]
        x, y = layout.place[arrow.tail]
        assert route[0] == pytest.approx((x + tail.width, y + tail.height / 2))
        x, y = layout.place[arrow.head]
        assert route[-1][0] == x
        assert y < route[-1][1] < y + head.height
        assert all(one[0] < other[0] for one, other in pairwise(route))


@settings(derandomize=True, deadline=None, max_examples=40)
@given(graphs())
def test_arrows_enter_at_places_of_their_own(graph):
    """No two arrows enter a box at the same place."""
    layout = lay_out(*graph, gap=GAP, spacing=SPACING)

    ends = [route[-1] for route in layout.routes]
    assert len(set(ends)) == len(ends)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(
    st.permutations(range(4)),
    st.permutations(range(4)),
    st.lists(st.tuples(st.integers(0, 3), st.integers(0, 3)), max_size=8, unique=True),
)
def test_crossings_are_counted_as_defined(left, right, pairs):
    """Two links cross if their ends are in opposite order."""
    order = [[f"l{n}" for n in left], [f"r{n}" for n in right]]
    links = [(f"l{a}", f"r{b}") for a, b in pairs]
    at = {name: place for column in order for place, name in enumerate(column)}

    naive = sum(
        (at[a] < at[c] and at[b] > at[d]) or (at[a] > at[c] and at[b] < at[d])
        for (a, b), (c, d) in combinations(links, 2)
    )

    assert count_crossings(order, links) == naive


def test_a_chain_is_straight():
    """Boxes that follow each other stand on one line, whatever stands beside them."""
    boxes = [Box(f"b{n}", n, 50.0, 30.0) for n in range(6)]
    others = [Box(f"c{n}", n, 50.0, 30.0) for n in range(6)]
    arrows = [Arrow(f"b{n}", f"b{n + 1}") for n in range(5)]

    layout = lay_out([*boxes, *others], arrows, gap=GAP, spacing=SPACING)

    assert len({round(y, 6) for route in layout.routes for _, y in route}) == 1


def test_crossings_that_can_be_avoided_are():
    """Two chains that are declared crosswise are drawn side by side."""
    boxes = [Box(name, layer, 50.0, 30.0) for layer, name in enumerate("ace")]
    boxes += [Box(name, layer, 50.0, 30.0) for layer, name in [(0, "b"), (2, "f"), (1, "d")]]
    for order in islice(permutations(boxes), 0, None, 37):
        arrows = [Arrow(*pair) for pair in ("ad", "df", "bc", "ce")]

        layout = lay_out(order, arrows, gap=GAP, spacing=SPACING)

        above = {layout.place[x][1] < layout.place[y][1] for x, y in ("ab", "dc", "fe")}
        assert len(above) == 1


def test_arrows_lead_to_the_right():
    """An arrow to its own layer is refused."""
    boxes = [Box("a", 0, 1.0, 1.0), Box("b", 0, 1.0, 1.0)]

    with pytest.raises(ValueError, match="'b' is not to the right of 'a'"):
        lay_out(boxes, [Arrow("a", "b")], gap=1.0, spacing=1.0)


def test_nothing_can_be_laid_out():
    """No boxes make an empty picture."""
    layout = lay_out([], [], gap=1.0, spacing=1.0)

    assert (layout.width, layout.height) == (0.0, 0.0)
