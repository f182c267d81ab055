"""How residuals follow from one another, learnt once and applied for any times.

A residual (`dyknow.mtl.residuals`) speaks of instants, so there are as many residuals as there
are ways in which states can be spaced: with irregular sampling each of them is new. What they
have in common is their *shape*: the residual with the times of the past states taken out of it.
There are few shapes, and from one shape, the truth of the atoms, and some comparisons of times
with durations of the formula follows the next: this is a *rule*. A rule is learnt when it is
first needed, by progressing the residual and watching which comparisons were made
(`dyknow.mtl.moments`); from then on a step is a call of a small function (`dyknow.mtl.decisions`).
"""

from itertools import count

from dyknow.mtl.decisions import DecisionTree, Rule, Times
from dyknow.mtl.graph import FormulaGraph
from dyknow.mtl.moments import Comparisons, Moment, PlainComparisons, RecordedComparisons
from dyknow.mtl.residuals import Progression, Residual
from dyknow.mtl.syntax import Verdict

__all__ = ["NEVER", "RuleBook", "Shape"]

NEVER = -(1 << 62)
"""The time of the last state where there has been none."""

_STREAK = 64
_PAUSE = 1024

_Names = tuple[tuple[int, int], ...]


def _unknown(now: int, past: Times) -> None:
    """Stand for a rule that has not been learnt."""


class Shape(dict[int, Rule["Shape"]]):
    """A residual without its times, and the rules that lead on from it by the truth of the atoms.

    Attributes:
        residual: The residual, in which each bound is a place in *names*; None if it is decided
            or no state has been seen.
        names: For each bound the number of a time of the past and a duration since then.
        verdict: The verdict.
        number: A number that no other shape has.
        reach: A duration that no comparison of its times exceeds.
        trees: Where the rules come from.
    """

    __slots__ = ("names", "number", "reach", "residual", "trees", "verdict")

    def __init__(
        self, number: int, residual: Residual | None, names: _Names, verdict: Verdict, reach: int
    ) -> None:
        super().__init__()
        self.residual = residual
        self.names = names
        self.verdict = verdict
        self.number = number
        self.reach = reach
        self.trees: dict[int, DecisionTree[Shape]] = {}

    def __missing__(self, bits: int) -> Rule["Shape"]:
        return _unknown

    def forget(self) -> None:
        """Forget all rules."""
        self.clear()
        self.trees.clear()


class RuleBook:
    """The shapes and rules of one formula, learnt as they are needed.

    When there are more rules than the limit, all are forgotten and learnt anew. Where nearly
    every step needs a rule of its own, learning stops for a while.

    Attributes:
        initial: The shape before the first state.
        false: The shape of what is decided to be false.
        true: The shape of what is decided to be true.
        limit: How many rules are kept.
        size: How many rules there are.
    """

    def __init__(self, graph: FormulaGraph, limit: int) -> None:
        self._progression = Progression(graph)
        self._numbers = count()
        self.initial = self._constant(Verdict.UNDECIDED)
        self.false = self._constant(Verdict.FALSE)
        self.true = self._constant(Verdict.TRUE)
        self.limit = limit
        self.size = 0
        self._shapes: dict[tuple[Residual, _Names], Shape] = {}
        self._learnt_at = NEVER
        self._streak = 0
        self._pause = 0

    def _constant(self, verdict: Verdict) -> Shape:
        return Shape(next(self._numbers), None, (), verdict, 0)

    @property
    def progression(self) -> Progression:
        """How residuals follow from one another."""
        return self._progression

    def follow(self, shape: Shape, past: Times, bits: int, now: int) -> tuple[Shape, Times]:
        """Return what is left after one more state.

        Args:
            shape: The shape of what was left before it.
            past: The times that belong to it, from the last state backwards.
            bits: The truth of atom number i in bit i.
            now: The time of the state.

        Returns:
            The shape of what is left, and its times.
        """
        return shape[bits](now, past) or self.learn(shape, past, bits, now)

    def learn(self, shape: Shape, past: Times, bits: int, now: int) -> tuple[Shape, Times]:
        """Do as `follow` does where the shape has no rule for it, and remember the rule."""
        if shape.verdict is not Verdict.UNDECIDED:
            return shape, (now,)
        if shape.residual is not None:
            shape = self._shapes.setdefault((shape.residual, shape.names), shape)
        times = (*past, now)
        tree = shape.trees.get(bits)
        found = tree.find(times) if tree is not None else None
        if tree is not None and found is not None:
            if tree.is_worth_compiling():
                shape[bits] = tree.compiled(len(past))
            return found
        if self._is_futile(past[0], now):
            following, kept = self._progress(shape, bits, times, PlainComparisons(times))
        else:
            comparisons = RecordedComparisons(times)
            following, kept = self._progress(shape, bits, times, comparisons)
            self._forget_when_full()
            tree = shape.trees.setdefault(bits, DecisionTree())
            tree.add(comparisons.record, following, kept)
            self.size += 1
        return following, tuple([times[number] for number in kept])

    def residual(self, shape: Shape, past: Times) -> Residual | None:
        """Return a residual with its instants, or None if it is decided or not begun."""
        if shape.residual is None:
            return None
        bounds = [past[number] + offset - past[0] for number, offset in shape.names]
        return shape.residual.mapped(bounds.__getitem__)

    def _progress(
        self, shape: Shape, bits: int, times: Times, comparisons: Comparisons
    ) -> tuple[Shape, tuple[int, ...]]:
        """Return the next shape, and the numbers of the times that belong to it."""
        if shape.residual is None:
            return self._named(self._progression.first(bits), len(times) - 1)
        names = [Moment.make(*name, times, comparisons) for name in shape.names]
        moved = shape.residual.mapped(names.__getitem__)
        last = Moment.make(0, 0, times, comparisons)
        return self._named(self._progression.next(moved, bits, last), len(times) - 1)

    def _named(self, residual: Residual, now: int) -> tuple[Shape, tuple[int, ...]]:
        """Take the times out of a residual."""
        match self._progression.verdict(residual):
            case Verdict.TRUE:
                return self.true, (now,)
            case Verdict.FALSE:
                return self.false, (now,)
            case Verdict.UNDECIDED:
                return self._undecided(residual, now)

    def _undecided(self, residual: Residual, now: int) -> tuple[Shape, tuple[int, ...]]:
        bounds: list[tuple[int, int]] = []

        def place(bound: int) -> int:
            moment = (bound.state, bound.offset) if isinstance(bound, Moment) else (now, bound)
            bounds.append(moment)
            return len(bounds) - 1

        bare = residual.mapped(place)
        kept = (now, *sorted({state for state, _ in bounds} - {now}))
        names = tuple((kept.index(state), offset) for state, offset in bounds)
        shape = self._shapes.get((bare, names))
        if shape is None:
            offsets = [offset for _, offset in names] or [0]
            reach = self._progression.longest + max(offsets) - min(offsets)
            shape = Shape(next(self._numbers), bare, names, Verdict.UNDECIDED, reach)
            self._shapes[bare, names] = shape
        return shape, kept

    def _is_futile(self, last: int, now: int) -> bool:
        """Return whether rules are learnt step by step without ever being used."""
        if self._pause:
            self._pause -= 1
            return True
        self._streak = self._streak + 1 if last == self._learnt_at else 0
        self._learnt_at = now
        if self._streak < _STREAK:
            return False
        self._streak, self._pause = 0, _PAUSE
        return True

    def _forget_when_full(self) -> None:
        if max(self.size, len(self._shapes)) < self.limit:
            return
        for shape in (self.initial, *self._shapes.values()):
            shape.forget()
        self._shapes.clear()
        self.size = 0
