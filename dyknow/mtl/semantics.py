"""The meaning of formulas over a finished trace, written down naively; the oracle of the tests.

A trace is known from the time of its first state up to and including the time of its last one;
whether there are states after that is not known. A formula is about the time of the first
state. There are two time models:

- `hold`: a state holds from its time until the next one, at every nanosecond, so that there is
  exactly one state at each time-point (Heintz 2009, 7.5.2, with a time-point of one nanosecond);
- `points`: there are the time-points of the states and no others. An interval in which none of
  them lies is empty: `always` is true of it, `eventually` false. When the next state will come
  is not known, so an interval that reaches beyond the last state may hold more of them.

The verdict is that of Kleene's strong three-valued logic, operator by operator: what is not
known yet counts as undecided, and a formula is decided as soon as its known parts decide it
whatever the others are. `eventually [a, b] f` needs a state, and so `eventually [200, oo] true`
becomes true when a state arrives 200 ms or more after the first. A formula whose parts depend
on one another may be decided later than its meaning allows: `eventually [0, 10] q -> eventually
[0, 20] q` is true in any case, but undecided before q has come or 10 ms are over.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from dyknow.mtl import syntax
from dyknow.mtl.columns import AtomColumns
from dyknow.mtl.syntax import Atom, Formula, Interval, TimeModel, Verdict
from dyknow.time import TimePoint

__all__ = ["Trace", "deciding_state", "evaluate"]

Trace = Sequence[tuple[TimePoint, Mapping[str, Any]]]
"""Times, strictly ascending, and the features of the state at each, by their printed terms."""


def evaluate(formula: Formula, trace: Trace, time_model: TimeModel = TimeModel.HOLD) -> Verdict:
    """Return the verdict on *formula*, which has no quantifiers, after all states of *trace*.

    Takes a time proportional to the number of operators and the square of the number of
    time-points: of nanoseconds, in the model `hold`.
    """
    if not trace:
        return Verdict.UNDECIDED
    return _Meaning(trace, time_model).after(len(trace), formula)


def deciding_state(
    formula: Formula, trace: Trace, time_model: TimeModel = TimeModel.HOLD
) -> tuple[Verdict, int | None]:
    """Return the verdict and the index of the first state that decides it, if any does."""
    meaning = _Meaning(trace, time_model)
    for index in range(len(trace)):
        verdict = meaning.after(index + 1, formula)
        if verdict is not Verdict.UNDECIDED:
            return verdict, index
    return Verdict.UNDECIDED, None


class _Meaning:
    """The verdicts on formulas at the time-points of one trace."""

    def __init__(self, trace: Trace, time_model: TimeModel) -> None:
        self._trace = trace
        self._time_model = time_model
        self._known = trace
        self._columns: dict[Atom, AtomColumns] = {}
        self._found: dict[tuple[int, int], Verdict] = {}

    def after(self, count: int, formula: Formula) -> Verdict:
        """Return the verdict on *formula* when the first *count* states are known."""
        self._known = self._trace[:count]
        self._found.clear()
        return self.at(formula, self._trace[0][0])

    def at(self, formula: Formula, now: int) -> Verdict:
        """Return the verdict on *formula* at a time-point of the trace, found out only once."""
        place = (id(formula), now)
        if place not in self._found:
            self._found[place] = self._verdict(formula, now)
        return self._found[place]

    def _verdict(self, formula: Formula, now: int) -> Verdict:  # noqa: C901, PLR0911, PLR0912
        """Return the verdict on *formula* at a time-point of the trace."""
        match formula:
            case syntax.Truth(value):
                return Verdict.TRUE if value else Verdict.FALSE
            case syntax.Feature() | syntax.Comparison():
                return self._atom(formula, now)
            case syntax.Negation(body):
                return Verdict(-self.at(body, now))
            case syntax.Conjunction(bodies):
                return min(self.at(body, now) for body in bodies)
            case syntax.Disjunction(bodies):
                return max(self.at(body, now) for body in bodies)
            case syntax.Implication(left, right):
                return max(Verdict(-self.at(left, now)), self.at(right, now))
            case syntax.Equivalence(left, right):
                return Verdict(self.at(left, now) * self.at(right, now))
            case syntax.Always(within, body):
                return min(self._over(within, body, now), default=Verdict.TRUE)
            case syntax.Eventually(within, body):
                return max(self._over(within, body, now), default=Verdict.FALSE)
            case syntax.Until(within, left, right):
                return self._until(within, left, right, now)
            case syntax.ForAll() | syntax.Exists():
                raise ValueError("expected a formula without quantifiers: use expand first")

    def _atom(self, atom: Atom, now: int) -> Verdict:
        columns = self._columns.setdefault(atom, AtomColumns((atom,)))
        state = next(state for time, state in reversed(self._known) if time <= now)
        return Verdict.TRUE if columns.of_state(state) else Verdict.FALSE

    def _over(self, within: Interval, body: Formula, now: int) -> list[Verdict]:
        """Return the verdicts on *body* in the known part of the interval, and in the rest."""
        known = self._time_points(now + within.start, self._last(within, now))
        return [self.at(body, t) for t in known] + self._unknown(within, now)

    def _until(self, within: Interval, left: Formula, right: Formula, now: int) -> Verdict:
        verdict, left_so_far = Verdict.FALSE, Verdict.TRUE
        for t in self._time_points(now, self._last(within, now)):
            if t >= now + within.start:
                verdict = max(verdict, min(left_so_far, self.at(right, t)))
            left_so_far = min(left_so_far, self.at(left, t))
        return max([verdict, *(min(left_so_far, v) for v in self._unknown(within, now))])

    def _time_points(self, first: int, last: int) -> Iterable[int]:
        """Return the time-points from *first* up to and including *last*."""
        if self._time_model is TimeModel.HOLD:
            return range(first, last + 1)
        return [time for time, _ in self._known if first <= time <= last]

    def _last(self, within: Interval, now: int) -> int:
        end = self._known[-1][0]
        return end if within.end is None else min(end, now + within.end)

    def _unknown(self, within: Interval, now: int) -> list[Verdict]:
        """Return `UNDECIDED` if a part of the interval has not come yet."""
        known = within.end is not None and now + within.end <= self._known[-1][0]
        return [] if known else [Verdict.UNDECIDED]
