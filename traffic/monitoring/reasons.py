"""Which observations bring a verdict about.

Reasons are observations that suffice: whatever else the atoms had been at the other times, the
formula would have been decided in the same way, at the same state or before. This is tried out.
Each atom gets two values, one for where it stands positively in the formula and one for where it
stands negatively, and what is not observed takes the values that speak most against the verdict.
As a formula can only become truer by this, or only falser, no other values could prevent the
verdict. None of the reasons can be left out, and none can begin later or end earlier.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple

from dyknow.mtl import syntax
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.progression import ProgressionTable
from dyknow.mtl.syntax import Atom, Feature, Formula, Verdict, descendants
from dyknow.time import TimePoint
from traffic.monitoring.past import Past, PastState

__all__ = ["Reason", "reasons_of"]

_MOST_STEPS = 5_000_000
"""Of progression; when they are used up, what is left is told as it is, and may be too much."""


@dataclass(frozen=True, slots=True)
class Reason:
    """An atom that was true, or false, in some states one after another.

    Attributes:
        atom: The atom.
        value: Its truth.
        begin: The time of the first of the states.
        end: The time of the last of them.
        n_states: How many they are.
        values: The features in the atom, in the first of the states; none if the atom is one.
    """

    atom: str
    value: bool
    begin: TimePoint
    end: TimePoint
    n_states: int
    values: Mapping[str, Any]


def reasons_of(past: Past) -> tuple[Reason, ...] | None:
    """Return observations that bring the verdict of the monitor about, in order of time.

    None if they reach too far back, or if the verdict comes from how the formula's parts hang
    together, which observations do not show.
    """
    table = past.monitor.table
    for states in past.stretches():
        search = _Search(table, states, past.monitor.verdict)
        every = _runs(states, len(table.atoms))
        if search.do_suffice(every):
            found = sorted(search.reduced(every))
            return tuple(_reason(observation, table.atoms, states) for observation in found)
    return None


class _Observation(NamedTuple):
    """An atom in states one after another, by their numbers."""

    first: int
    last: int
    atom: int


def _runs(states: Sequence[PastState], n_atoms: int) -> list[_Observation]:
    """Return each atom in each longest stretch in which its truth stays, the latest first."""
    begun = [0] * n_atoms
    runs: list[_Observation] = []
    for at, (one, other) in enumerate(pairwise(states), start=1):
        changed = one.bits ^ other.bits
        for atom in range(n_atoms) if changed else ():
            if changed >> atom & 1:
                runs.append(_Observation(begun[atom], at - 1, atom))
                begun[atom] = at
    end = len(states) - 1
    runs.extend(_Observation(first, end, atom) for atom, first in enumerate(begun))
    return runs[::-1]


class _Search:
    """The search for observations that suffice."""

    def __init__(
        self, table: ProgressionTable, states: Sequence[PastState], verdict: Verdict
    ) -> None:
        number = {atom: at for at, atom in enumerate(table.atoms)}
        signed = _signed(table.formula, number, is_positive=True)
        self._table = ProgressionTable(signed, time_model=table.time_model)
        self._states = states
        self._verdict = verdict
        self._steps_left = _MOST_STEPS
        self._bits: dict[tuple[int, int], int] = {}
        self._signs = [_sign_and_number(atom) for atom in self._table.atoms]

    def do_suffice(self, observations: Iterable[_Observation]) -> bool:
        """Return whether there is the same verdict when nothing else is known.

        When too many steps have been made, nothing is said to suffice any more.
        """
        if self._steps_left <= 0:
            return False
        known = [0] * len(self._states)
        for first, last, atom in observations:
            for at in range(first, last + 1):
                known[at] |= 1 << atom
        self._steps_left -= len(known)
        monitor = Monitor(self._table)
        for state, mask in zip(self._states, known, strict=True):
            verdict = monitor.step_bits(state.time, self._bits_of(state.bits, mask))
            if verdict is not Verdict.UNDECIDED:
                return verdict is self._verdict
        return False

    def reduced(self, observations: list[_Observation]) -> list[_Observation]:
        """Return as few of the observations as suffice, each as short as can be."""
        kept = self._needed([], observations, is_new=False)
        for at in range(len(kept)):
            kept[at] = self._shortened(kept[at], kept[:at] + kept[at + 1 :])
        return kept

    def _needed(
        self, known: list[_Observation], others: list[_Observation], *, is_new: bool
    ) -> list[_Observation]:
        """Return those of *others* without which what is *known* does not suffice.

        This is the algorithm QuickXplain of Junker (2004), which prefers to keep what comes
        first. There is nothing to find out if *known* is the same as before (*is_new*).
        """
        if is_new and self.do_suffice(known):
            return []
        if len(others) <= 1:
            return others
        middle = len(others) // 2
        one, other = others[:middle], others[middle:]
        of_other = self._needed(known + one, other, is_new=bool(one))
        of_one = self._needed(known + of_other, one, is_new=bool(of_other))
        return of_one + of_other

    def _shortened(self, long: _Observation, others: list[_Observation]) -> _Observation:
        """Return the part of one observation that is needed beside *others*."""

        def suffices(first: int, last: int) -> bool:
            return self.do_suffice([*others, _Observation(first, last, long.atom)])

        low, high = long.first, long.last
        while low < high:
            middle = (low + high + 1) // 2
            low, high = (middle, high) if suffices(middle, long.last) else (low, middle - 1)
        first, high = low, long.last
        while low < high:
            middle = (low + high) // 2
            low, high = (low, middle) if suffices(first, middle) else (middle + 1, high)
        return _Observation(first, high, long.atom)

    def _bits_of(self, bits: int, known: int) -> int:
        """Return the truth of the signed atoms, where only the atoms in *known* are observed."""
        signed = self._bits.get((bits, known))
        if signed is None:
            signed = 0
            for at, (is_positive, number) in enumerate(self._signs):
                hopeful = is_positive == (self._verdict is Verdict.FALSE)
                value = bits >> number & 1 if known >> number & 1 else int(hopeful)
                signed |= value << at
            self._bits[bits, known] = signed
        return signed


def _reason(
    observation: _Observation, atoms: Sequence[Atom], states: Sequence[PastState]
) -> Reason:
    first, last = states[observation.first], states[observation.last]
    atom = atoms[observation.atom]
    printed = (text_from_formula(node) for node, _ in descendants(atom) if node != atom)
    return Reason(
        atom=text_from_formula(atom),
        value=bool(first.bits >> observation.atom & 1),
        begin=first.time,
        end=last.time,
        n_states=observation.last - observation.first + 1,
        values={term: first.values[term] for term in printed if term in first.values},
    )


_POSITIVE, _NEGATIVE = "positive", "negative"


def _signed(  # noqa: C901, PLR0911
    formula: Formula, number: Mapping[Atom, int], *, is_positive: bool
) -> Formula:
    """Return *formula* with a feature in place of each atom, by its number and its sign."""

    def inner(body: Formula, *, is_same: bool = True) -> Formula:
        return _signed(body, number, is_positive=is_positive == is_same)

    match formula:
        case syntax.Feature() | syntax.Comparison():
            sign = _POSITIVE if is_positive else _NEGATIVE
            return Feature(f"{sign}{number[formula]}")
        case syntax.Negation(body):
            return syntax.Negation(inner(body, is_same=False))
        case syntax.Conjunction(bodies) | syntax.Disjunction(bodies):
            return replace(formula, bodies=tuple(map(inner, bodies)))
        case syntax.Always(_, body) | syntax.Eventually(_, body):
            return replace(formula, body=inner(body))
        case syntax.Until(_, left, right):
            return replace(formula, left=inner(left), right=inner(right))
        case syntax.Implication(left, right):
            return syntax.Implication(inner(left, is_same=False), inner(right))
        case syntax.Equivalence(left, right):
            sides = syntax.Implication(left, right), syntax.Implication(right, left)
            return syntax.Conjunction(tuple(map(inner, sides)))
        case _:
            return formula


def _sign_and_number(atom: Atom) -> tuple[bool, int]:
    name = text_from_formula(atom)
    is_positive = name.startswith(_POSITIVE)
    return is_positive, int(name.removeprefix(_POSITIVE if is_positive else _NEGATIVE))
