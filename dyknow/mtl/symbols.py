"""The symbols of formulas: what has to be known before they can be evaluated.

These are the features, which streams must provide, and the domains of quantification, which must
be fixed before a formula is monitored (Heintz, 'Semantically grounded stream reasoning integrated
with ROS', section VI.6, the service that extracts the symbols of a formula group).
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from dyknow.mtl import syntax
from dyknow.mtl.syntax import Feature, Formula, Node, parts

__all__ = ["Symbols", "extract_symbols"]


@dataclass(frozen=True, slots=True)
class Symbols:
    """The symbols of one or more formulas, each once, in order of their first occurrence.

    Attributes:
        features: The features with their arguments as written.
        sorts: The domains that quantifiers range over.
    """

    features: tuple[Feature, ...]
    sorts: tuple[str, ...]


def extract_symbols(formulas: Iterable[Formula]) -> Symbols:
    """Return the symbols of *formulas*; bound variables that stand alone are not among them."""
    features: dict[Feature, None] = {}
    sorts: dict[str, None] = {}
    for formula in formulas:
        for found in _symbols(formula):
            if isinstance(found, Feature):
                features[found] = None
            else:
                sorts[found] = None
    return Symbols(tuple(features), tuple(sorts))


def _symbols(formula: Formula) -> Iterator[Feature | str]:
    waiting: list[tuple[Node, frozenset[str]]] = [(formula, frozenset())]
    while waiting:
        node, bound = waiting.pop()
        match node:
            case Feature(name, arguments) if arguments or name not in bound:
                yield node
            case syntax.ForAll(variable, domain) | syntax.Exists(variable, domain):
                yield domain.name
                bound |= {variable.name}
            case _:
                pass
        waiting.extend((part, bound) for part in reversed(parts(node)))
