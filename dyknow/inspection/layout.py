"""Where the boxes of a picture go: layers from left to right, few crossings, straight arrows.

The method is that of Sugiyama, Tagawa and Toda (1981), *Methods for visual understanding of
hierarchical system structures*: boxes stand in the columns of their layers, arrows across
several columns run through bends, boxes of a column are put in the order of the mean place of
their neighbours (the barycentre), and at last moved up and down until arrows are as straight as
that order allows. Arrows from one box share their bends, so that they part as late as they can.
They leave a box in the middle of its right side, and enter one spread over its left side.
"""

from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from scipy.optimize import LinearConstraint, milp
from scipy.sparse import csr_array

__all__ = ["Arrow", "Box", "Layout", "count_crossings", "lay_out"]

_SWEEPS = 24
_BEND_HEIGHT = 10.0
_WEIGHTS = (1.0, 2.0, 8.0)
"""What a climb costs, by how many of its two ends are bends."""
_LEAST = 1e-4
"""What it costs to stand lower down, so that nothing hangs in the air."""

Node = str | tuple[str, int]
"""A box by its name, or a bend: the name of the box that its arrows come from, and a layer."""


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangle to be placed.

    Attributes:
        name: Unique.
        layer: The column, from 0.
        width: Pixels.
        height: Pixels.
    """

    name: str
    layer: int
    width: float
    height: float


@dataclass(frozen=True, slots=True)
class Arrow:
    """A connection from a box to one in a higher layer; *number* tells apart those of one pair."""

    tail: str
    head: str
    number: int = 0


@dataclass(frozen=True, slots=True)
class Layout:
    """Where everything is; x goes to the right and y down, in pixels.

    Attributes:
        place: The upper left corner of each box, by name.
        routes: For each arrow the points that it runs through, from its tail to its head.
        width: Of the whole.
        height: Of the whole.
    """

    place: Mapping[str, tuple[float, float]]
    routes: tuple[tuple[tuple[float, float], ...], ...]
    width: float
    height: float


def lay_out(
    boxes: Sequence[Box], arrows: Sequence[Arrow], *, gap: float, spacing: float
) -> Layout:
    """Place *boxes* so that columns are *gap* apart, and boxes of a column *spacing*.

    Raises:
        ValueError: An arrow does not lead to a higher layer.
    """
    graph = _Graph(boxes, arrows)
    order = _ordered(graph)
    entries = graph.entries(order)
    centre = _straightened(graph, order, entries, spacing)
    left = _columns(graph, gap)
    top = min((centre[n] - graph.height(n) / 2 for n in centre), default=0.0)
    middle = {node: y - top for node, y in centre.items()}
    place = {box.name: (left[box.layer], middle[box.name] - box.height / 2) for box in boxes}
    return Layout(
        place=place,
        routes=tuple(_route(graph, arrow, entries[arrow], middle, left) for arrow in arrows),
        width=max((left[box.layer] + graph.width[box.layer] for box in boxes), default=0.0),
        height=max((place[box.name][1] + box.height for box in boxes), default=0.0),
    )


def count_crossings(order: Sequence[Sequence[Node]], links: Iterable[tuple[Node, Node]]) -> int:
    """Return how many pairs of links between neighbouring columns cross."""
    place = {node: at for column in order for at, node in enumerate(column)}
    column_of = {node: number for number, column in enumerate(order) for node in column}
    by_column: dict[int, list[tuple[int, int]]] = {}
    for tail, head in links:
        by_column.setdefault(column_of[tail], []).append((place[tail], place[head]))
    return sum(_inversions(head for _, head in sorted(pairs)) for pairs in by_column.values())


def _inversions(numbers: Iterable[int]) -> int:
    """Return how many pairs of *numbers* stand in the wrong order."""
    seen: list[int] = []
    inversions = 0
    for number in numbers:
        at = bisect_right(seen, number)
        inversions += len(seen) - at
        seen.insert(at, number)
    return inversions


class _Graph:
    """Boxes and bends in their columns, and the links between neighbouring columns."""

    def __init__(self, boxes: Sequence[Box], arrows: Sequence[Arrow]) -> None:
        self.box = {box.name: box for box in boxes}
        self.arrows = arrows
        n_columns = 1 + max((box.layer for box in boxes), default=-1)
        self.columns: list[list[Node]] = [[] for _ in range(n_columns)]
        self.width = [0.0] * n_columns
        for box in boxes:
            self.columns[box.layer].append(box.name)
            self.width[box.layer] = max(self.width[box.layer], box.width)
        self.links: dict[tuple[Node, Node], None] = {}
        for arrow in arrows:
            for link in pairwise(self.path(arrow)):
                self._link(*link)
        self.before: dict[Node, list[Node]] = {n: [] for column in self.columns for n in column}
        self.after: dict[Node, list[Node]] = {n: [] for column in self.columns for n in column}
        for tail, head in self.links:
            self.before[head].append(tail)
            self.after[tail].append(head)

    def path(self, arrow: Arrow) -> list[Node]:
        """Return the tail, the bends in the columns between, and the head of an arrow."""
        first, last = self.box[arrow.tail].layer, self.box[arrow.head].layer
        if first >= last:
            raise ValueError(f"'{arrow.head}' is not to the right of '{arrow.tail}'")
        bends: list[Node] = [(arrow.tail, layer) for layer in range(first + 1, last)]
        return [arrow.tail, *bends, arrow.head]

    def height(self, node: Node) -> float:
        """Return the height of a box or a bend."""
        return self.box[node].height if isinstance(node, str) else _BEND_HEIGHT

    def entries(self, order: Sequence[Sequence[Node]]) -> dict[Arrow, float]:
        """Return how far below the middle of its head each arrow enters, in order of tails."""
        place = {node: at for column in order for at, node in enumerate(column)}
        entering: dict[str, list[Arrow]] = {}
        for arrow in self.arrows:
            entering.setdefault(arrow.head, []).append(arrow)
        entries = {}
        for head, arrows in entering.items():
            arrows.sort(key=lambda arrow: place[self.path(arrow)[-2]])
            pitch = self.box[head].height / (len(arrows) + 1)
            for at, arrow in enumerate(arrows):
                entries[arrow] = (at - (len(arrows) - 1) / 2) * pitch
        return entries

    def climbs(self, entries: Mapping[Arrow, float]) -> list[tuple[Node, Node, float]]:
        """Return tail, head and entry of each link; one between two bends is there once."""
        climbs: dict[tuple[Node, Node, float], None] = {}
        for arrow, entry in entries.items():
            *inner, last = pairwise(self.path(arrow))
            climbs.update({(*link, 0.0): None for link in inner})
            climbs[(*last, entry)] = None
        return list(climbs)

    def _link(self, tail: Node, head: Node) -> None:
        self.links.setdefault((tail, head))
        if isinstance(head, tuple) and head not in self.columns[head[1]]:
            self.columns[head[1]].append(head)


def _ordered(graph: _Graph) -> list[list[Node]]:
    """Return the columns in the best order found by sweeps of barycentres."""
    order = [list(column) for column in graph.columns]
    best, fewest = order, count_crossings(order, graph.links)
    for sweep in range(_SWEEPS):
        forth = sweep % 2 == 0
        neighbours = graph.before if forth else graph.after
        order = _swept(order if forth else order[::-1], neighbours)
        order = order if forth else order[::-1]
        crossings = count_crossings(order, graph.links)
        if crossings < fewest:
            best, fewest = order, crossings
    return best


def _swept(
    order: Sequence[Sequence[Node]], neighbours: Mapping[Node, Sequence[Node]]
) -> list[list[Node]]:
    """Sort each column but the first by the mean place of neighbours in the one before it."""
    swept: list[list[Node]] = []
    at: dict[Node, float] = {}
    for column in order:
        own = {node: place / max(1, len(column) - 1) for place, node in enumerate(column)}
        key = {n: _mean([at[m] for m in neighbours[n]], own[n]) for n in column}
        swept.append(sorted(column, key=key.__getitem__))
        at.update({node: place / max(1, len(column) - 1) for place, node in enumerate(swept[-1])})
    return swept


def _straightened(
    graph: _Graph, order: Sequence[Sequence[Node]], entries: Mapping[Arrow, float], spacing: float
) -> dict[Node, float]:
    """Return the centre of each node, so that arrows climb as little as possible.

    The sum of the climbs, weighted so that bends hardly show, is the least that the order and
    the distances allow: a linear programme in the centres and, for each link, its climb.
    """
    nodes = [node for column in order for node in column]
    if not nodes:
        return {}
    number = {node: at for at, node in enumerate(nodes)}
    climbs = graph.climbs(entries)
    rows = _Rows(len(nodes) + len(climbs))
    for column in order:
        for upper, lower in pairwise(column):
            apart = (graph.height(upper) + graph.height(lower)) / 2 + spacing
            rows.add({number[upper]: 1.0, number[lower]: -1.0}, -apart)
    for at, (tail, head, entry) in enumerate(climbs, start=len(nodes)):
        rows.add({number[head]: 1.0, number[tail]: -1.0, at: -1.0}, -entry)
        rows.add({number[head]: -1.0, number[tail]: 1.0, at: -1.0}, entry)
    cost = [_LEAST] * len(nodes) + [_WEIGHTS[_bends(tail, head)] for tail, head, _ in climbs]
    found = milp(cost, constraints=rows.constraint()).x
    assert found is not None, "boxes can always be placed further down"
    return {node: float(y) for node, y in zip(nodes, found, strict=False)}


class _Rows:
    """The rows of a linear programme, each `coefficients · x <= bound`."""

    def __init__(self, width: int) -> None:
        self.bounds: list[float] = []
        self._width = width
        self._entries: list[tuple[float, int, int]] = []

    def add(self, coefficients: Mapping[int, float], bound: float) -> None:
        """Add a row."""
        row = len(self.bounds)
        self._entries += [(value, row, column) for column, value in coefficients.items()]
        self.bounds.append(bound)

    def constraint(self) -> tuple[LinearConstraint, ...]:
        """Return the rows in the form that the solver takes."""
        if not self._entries:
            return ()
        values, rows, columns = zip(*self._entries, strict=True)
        matrix = csr_array((values, (rows, columns)), shape=(len(self.bounds), self._width))
        return (LinearConstraint(matrix, ub=self.bounds),)


def _bends(tail: Node, head: Node) -> int:
    return isinstance(tail, tuple) + isinstance(head, tuple)


def _columns(graph: _Graph, gap: float) -> list[float]:
    """Return the left side of each column."""
    return [float(sum(graph.width[:n]) + n * gap) for n in range(len(graph.width))]


def _route(
    graph: _Graph,
    arrow: Arrow,
    entry: float,
    middle: Mapping[Node, float],
    left: Sequence[float],
) -> tuple[tuple[float, float], ...]:
    """Return the points of an arrow; between two bends of one column it is straight."""
    tail, head = graph.box[arrow.tail], graph.box[arrow.head]
    points = [(left[tail.layer] + tail.width, middle[tail.name])]
    for layer, bend in enumerate(graph.path(arrow)[1:-1], start=tail.layer + 1):
        points.append((left[layer], middle[bend]))
        points.append((left[layer] + graph.width[layer], middle[bend]))
    points.append((left[head.layer], middle[head.name] + entry))
    return tuple(points)


def _mean(values: Sequence[float], default: float) -> float:
    return sum(values) / len(values) if values else default
