"""Decision trees over the differences of times, which become functions when they have grown.

A tree says what follows from the times of some past states and of a new one. It is grown from
the records of comparisons that `dyknow.mtl.moments` makes: the comparisons are the branches, in
the order in which they were made, and what came out in the end is the leaf.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from dyknow.mtl.moments import Comparison

__all__ = ["DecisionTree", "Rule"]

_T = TypeVar("_T")

Times = tuple[int, ...]
Rule = Callable[[int, Times], tuple[_T, Times] | None]
"""From the new time and those of the past to what follows and the times that are kept; None if
that is not known."""

_DEEPEST = 40
_WORTH = 8
_INDENT = "    "


@dataclass(slots=True)
class _Leaf(Generic[_T]):
    """What follows, and the numbers of the times that are kept."""

    value: _T
    kept: tuple[int, ...]


@dataclass(slots=True)
class _Branch(Generic[_T]):
    """Whether one time less another is below a bound, and where that leads."""

    one: int
    other: int
    bound: int
    closer: "_Branch[_T] | _Leaf[_T] | None" = None
    further: "_Branch[_T] | _Leaf[_T] | None" = None


class DecisionTree(Generic[_T]):
    """What follows from times, as far as it has been seen.

    Attributes:
        size: The number of leaves.
    """

    def __init__(self) -> None:
        self._root: _Branch[_T] | _Leaf[_T] | None = None
        self.size = 0
        self._compiled_size = 0
        self._uses = 0

    def find(self, times: Sequence[int]) -> tuple[_T, Times] | None:
        """Return what follows and the times that are kept; the last of *times* is the new one."""
        node = self._root
        while isinstance(node, _Branch):
            closer = times[node.one] - times[node.other] < node.bound
            node = node.closer if closer else node.further
        if node is None:
            return None
        return node.value, tuple([times[number] for number in node.kept])

    def add(self, record: Sequence[Comparison], value: _T, kept: tuple[int, ...]) -> None:
        """Add a leaf that is reached by the comparisons of *record*."""
        leaf = _Leaf(value, kept)
        self.size += 1
        node = self._root
        if not record:
            self._root = leaf
            return
        if node is None:
            node = self._root = _Branch(*record[0][:3])
        for at, (_, _, _, closer) in enumerate(record):
            assert isinstance(node, _Branch)
            below = node.closer if closer else node.further
            if below is None:
                below = leaf if at + 1 == len(record) else _Branch(*record[at + 1][:3])
                if closer:
                    node.closer = below
                else:
                    node.further = below
            node = below

    def is_worth_compiling(self) -> bool:
        """Count a use and return whether leaves were added that are used often enough."""
        self._uses += 1
        return self.size > self._compiled_size and _WORTH * self._uses >= self.size

    def compiled(self, n_past: int) -> Rule[_T]:
        """Return the tree as a function; branches that lie too deep are left out.

        Args:
            n_past: The number of past times.
        """
        self._compiled_size, self._uses = self.size, 0
        values: dict[str, Any] = {}
        names = [f"t{number}" for number in range(n_past)] + ["now"]
        body = "\n".join(_lines(self._root, names, values, _INDENT))
        exec(f"def rule(now, past):\n{_INDENT}({', '.join(names[:-1])},) = past\n{body}\n", values)
        rule: Rule[_T] = values["rule"]
        return rule


def _lines(
    node: _Branch[_T] | _Leaf[_T] | None, names: list[str], values: dict[str, Any], indent: str
) -> list[str]:
    """Return the lines of a function that decides as *node* and all below it do."""
    lines: list[str] = []
    while isinstance(node, _Branch):
        difference = f"{names[node.one]} - {names[node.other]}"
        if isinstance(node.further, _Branch):
            lines.append(f"{indent}if {difference} < {node.bound}:")
            aside, node = node.closer, node.further
        else:
            lines.append(f"{indent}if {difference} >= {node.bound}:")
            aside, node = node.further, node.closer
        if len(indent) >= _DEEPEST * len(_INDENT):
            aside = None
        lines += _lines(aside, names, values, indent + _INDENT)
    if node is None:
        return [*lines, f"{indent}return None"]
    name = f"value{len(values)}"
    values[name] = node.value
    kept = "".join(f"{names[number]}, " for number in node.kept)
    return [*lines, f"{indent}return {name}, ({kept})"]
