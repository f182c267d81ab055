"""Link conditions: formulas about pairs of a lower and an upper object, as columns.

In a condition `from` is the lower object and `to` the upper one. A feature is a column of the
table of the object it is about, or else what the unit of the link computes.
"""

from collections.abc import Iterable, Iterator
from itertools import product

import numpy as np

from anchoring.links import DEVIATION, DISTANCE, LinkUnit
from anchoring.motion import Floats
from dyknow.errors import UnknownNameError
from dyknow.mtl.columns import AtomColumns, evaluate_atoms
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.progression import ProgressionTable, Truths
from dyknow.mtl.syntax import FALSE, Atom, Comparison, Feature, Formula, Name, Number, descendants
from dyknow.source_text import nearest_name
from dyknow.streams.table import Column, Table

__all__ = ["Condition"]

_ROUNDING = 1e-6
"""Metres by which two ways of computing a distance may differ."""

_USUAL_DEVIATION = 3.0
"""Standard deviations within which most objects are found again."""


class Condition:
    """A condition of a link and the features that it mentions.

    Attributes:
        table: The formula and its residuals.
        is_false: Whether the formula is false from the start.
        reach: The distance in metres beyond which every comparison of the distance with a number
            is as true as infinitely far away.
        free_atoms: The numbers of the other atoms that mention the upper object.
        mentions_upper: Whether any atom does.
    """

    def __init__(self, formula: Formula, unit: LinkUnit) -> None:
        self.table = ProgressionTable(formula)
        self._unit = unit
        self.is_false = formula == FALSE
        atoms = self.table.atoms
        reaches = [_reach(atom) for atom in atoms]
        self.reach = max((reach for reach in reaches if reach is not None), default=0.0)
        self.free_atoms = tuple(i for i, reach in enumerate(reaches) if reach is None)
        self._bound_atoms = tuple(i for i, reach in enumerate(reaches) if reach is not None)
        self._features = _features(atoms)
        self.mentions_upper = any(map(_mentions_upper, self._features))
        self._bound_features = _features(atoms[i] for i in self._bound_atoms)
        self._bound_columns = AtomColumns([atoms[i] for i in self._bound_atoms])

    def truth(self, lower: Table, upper: Table) -> Truths:
        """Return the truth of each atom for each pair, shape (atoms, n).

        Args:
            lower: n objects linked from.
            upper: The n objects linked to, or none if the condition is about `from` alone.

        Raises:
            UnknownNameError: The condition mentions a feature that there is not.
        """
        n = len(lower)
        if not n:
            return np.zeros((len(self.table.atoms), 0), dtype=np.bool_)
        features = {text_from_formula(f): self._column(f, lower, upper) for f in self._features}
        return evaluate_atoms(self.table, features, n)

    def truth_beyond_reach(self, lower: Table) -> Iterator[Truths]:
        """Yield what the truth of the atoms may be for *lower* and something beyond reach.

        The free atoms are false at first and then take on all other combinations.
        """
        n = len(lower)
        nobody = Table(self._unit.sort, (), {})
        features = {
            text_from_formula(f): np.full(n, np.inf)
            if f.name == DISTANCE
            else self._column(f, lower, nobody)
            for f in self._bound_features
        }
        truth = np.zeros((len(self.table.atoms), n), dtype=np.bool_)
        truth[self._bound_atoms, :] = self._bound_columns.of_features(features, n)
        for values in product((False, True), repeat=len(self.free_atoms)):
            truth[self.free_atoms, :] = np.array(values, dtype=np.bool_)[:, None]
            yield truth

    def separation(self, lower: Table, upper: Table) -> tuple[Floats, float]:
        """Return how far apart each pair is, and from where on it is better to be left alone.

        It is the deviation if the unit knows one, otherwise the distance, or else 0.
        """
        for name, gate in ((DEVIATION, _USUAL_DEVIATION), (DISTANCE, self.reach)):
            found = self._unit.feature(name, ("from", "to"), lower, upper)
            if found is not None:
                return found, gate
        return np.zeros(len(lower)), 0.0

    def _column(self, feature: Feature, lower: Table, upper: Table) -> Column:
        arguments = tuple(_argument(a) for a in feature.arguments)
        if arguments == ("from",) and feature.name in lower:
            return lower[feature.name]
        if arguments == ("to",) and feature.name in upper:
            return upper[feature.name]
        column = self._unit.feature(feature.name, arguments, lower, upper)
        if column is None:
            known = (*lower.columns, *upper.columns, DISTANCE, DEVIATION)
            near = nearest_name(feature.name, known)
            raise UnknownNameError("feature", feature.name, feature.span, near)
        return column


def _features(atoms: Iterable[Atom]) -> tuple[Feature, ...]:
    """Return the features in *atoms*, each once."""
    nodes = (node for atom in atoms for node, _ in descendants(atom))
    return tuple(dict.fromkeys(node for node in nodes if isinstance(node, Feature)))


def _argument(argument: object) -> str:
    return argument.name if isinstance(argument, Name) else ""


def _mentions_upper(feature: Feature) -> bool:
    return any(_argument(a) == "to" for a in feature.arguments)


def _reach(atom: Atom) -> float | None:
    """Return the distance beyond which *atom* does not change, or None if there is none."""
    if not any(map(_mentions_upper, _features([atom]))):
        return 0.0
    match atom:
        case Comparison(Feature(name), _, Number(limit)) | Comparison(
            Number(limit), _, Feature(name)
        ) if name == DISTANCE:
            return limit + _ROUNDING
        case _:
            return None
