"""The link process: links the objects of a stream to objects of a more specific sort.

It runs the state machine of Heintz (2009), figure 8.4, and of Heintz, Kvarnström and Doherty
(2009), section IV.B, for all objects of a frame at once. An unlinked lower object waits for its
establish condition, and for the reestablish condition of each unlinked upper object; a linked one
is followed by its maintain condition. What the sources leave open is settled as follows.

- Conditions that begin because the input changes (an object appears or vanishes) are about the
  present state on; those that begin because a verdict fell are about the next state on.
- If establish and reestablish become true at once, reestablish wins: no new symbol without need.
- If several reestablish conditions become true at once, each object takes part in at most one
  link; see `anchoring.candidates.best_pairs`.
- A lower object that is itself only predicted (its column `observed` is false) is as good as
  vanished, unless the unit trusts predictions.
- A lower object that vanished and is observed again, under its own name, takes up its link at
  once if the upper object is there still and without a link: nothing has refuted it. One that
  waited for its establish condition goes on waiting, as it was seen last, for as long as an
  upper object would; it is linked when it is observed.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from anchoring.candidates import Candidates, Unlinked
from anchoring.conditions import Condition
from anchoring.links import LinkEnd, LinkSettings, LinkUnit
from anchoring.rows import Mask, Rows, take, with_rows
from anchoring.structures import LinkHistory
from dyknow.mtl.monitors import MonitorColumns
from dyknow.mtl.progression import Truths
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Ids, Table, concatenate, positions_of
from dyknow.time import TimePoint

__all__ = ["LinkProcess"]

_LINKED = -1
"""As `since` of an upper object: it is linked."""

_NO_ONE = -1
"""As `lower` of an upper object: no lower object may take up its link."""

_NEVER = -1
"""As the number of a state: there was none yet."""


class LinkProcess(Reactive):
    """A computational unit from tables of lower objects to tables of upper objects.

    For each sample that arrives a sample with the states of all upper objects is emitted, valid
    at the same time. Samples that are not later than the one before are ignored.

    Args:
        unit: Computes the states of the upper objects.
        settings: The conditions, and when an upper object is given up.

    Attributes:
        history: All links ever made.
    """

    def __init__(self, unit: LinkUnit, settings: LinkSettings) -> None:
        self.history = LinkHistory()
        self._unit = unit
        self._remove_after = settings.remove_after
        self._least_states = settings.least_states
        self._waiting = _Waiting(Condition(settings.establish, unit))
        self._standing = _Standing(Condition(settings.maintain, unit))
        self._candidates = Candidates(Condition(settings.reestablish, unit), unit)
        self._uppers = _Uppers(Table(unit.sort, (), {}))
        self._next_id = 1
        self._step = 0
        self._time: TimePoint | None = None

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Take in the lower objects and return the upper ones at the same valid time."""
        sample = inputs[0]
        if not isinstance(sample.value, Table) or sample.available_time != now:
            return ()
        if self._time is not None and sample.valid_time <= self._time:
            return ()
        self._time = sample.valid_time
        self._take_in(sample.value, sample.valid_time)
        return (Sample(self._unit.published(self._uppers.table), sample.valid_time, now),)

    def _take_in(self, lower: Table, now: TimePoint) -> None:
        self._step += 1
        if not self._uppers.table.columns and lower.columns:
            self._uppers.table = self._unit.create(_NOBODY, lower.select(_NOBODY), now)
        observed = lower.columns.get("observed", np.ones(len(lower), dtype=np.bool_))
        self._drop_vanished(lower, observed, now)
        self._resume(lower, observed, now)
        self._predict(np.flatnonzero(self._uppers.since != _LINKED), now)
        broken = self._break_links(lower, now)
        self._begin_waiting(lower.ids[observed], broken)
        self._link_waiting(lower, observed, now)
        self._compute(lower, observed, now)
        self._waiting.add(broken, self._step + 1)
        self._remove_unanchored(now)

    def _drop_vanished(self, lower: Table, observed: Mask, now: TimePoint) -> None:
        """Remove the links of lower objects that are gone, and what waits for them."""
        at = positions_of(self._standing.lower, lower.ids)
        there = at >= 0
        if not self._unit.trusts_predictions:
            there[there] = observed[at[there]]
        self._unlink(self._standing.upper[~there], self._step, now, LinkEnd.VANISHED)
        self._standing.keep(there)
        waiting = self._waiting
        is_back = np.isin(waiting.ids, lower.ids[observed])
        waiting.since[is_back & (waiting.seen_in < self._step - 1)] = self._step
        begun = waiting.seen_in != _NEVER
        waiting.keep(is_back | (begun & self._may_return(waiting.seen_at, waiting.seen_in, now)))

    def _resume(self, lower: Table, observed: Mask, now: TimePoint) -> None:
        """Make the links again whose lower objects had vanished and are back."""
        uppers = self._uppers
        free = np.flatnonzero((uppers.since != _LINKED) & (uppers.lower != _NO_ONE))
        at = positions_of(uppers.lower[free], lower.ids)
        back = at >= 0
        back[back] = observed[at[back]]
        back &= ~np.isin(uppers.lower[free], self._standing.lower)
        self._link(take(lower, at[back]), uppers.table.ids[free[back]], now)

    def _predict(self, rows: Rows, now: TimePoint) -> None:
        if len(rows):
            table = self._uppers.table
            predicted = self._unit.predict(table.select(rows), now)
            self._uppers.table = with_rows(table, rows, predicted)

    def _break_links(self, lower: Table, now: TimePoint) -> Ids:
        """Remove the links whose maintain condition has become false; return their lower ids."""
        standing, table = self._standing, self._uppers.table
        at = positions_of(standing.lower, lower.ids)
        on = positions_of(standing.upper, table.ids)
        known = table.select(on) if standing.condition.mentions_upper else table.select(_NOBODY)
        truth = standing.condition.truth(take(lower, at), known)
        violated = standing.monitor.step(now, truth) < 0
        broken = standing.lower[violated]
        self._unlink(standing.upper[violated], self._step + 1, now, LinkEnd.VIOLATED)
        self._uppers.lower[on[violated]] = _NO_ONE
        standing.keep(~violated)
        self._predict(on[violated], now)
        return broken

    def _unlink(self, upper: Ids, since: int, now: TimePoint, reason: LinkEnd) -> None:
        uppers = self._uppers
        uppers.since[positions_of(upper, uppers.table.ids)] = since
        for object_id in upper.tolist():
            self.history.remove(uppers.table.symbol(object_id), now, reason)

    def _begin_waiting(self, observed: Ids, broken: Ids) -> None:
        known = np.concatenate((self._standing.lower, self._waiting.ids, broken))
        self._waiting.add(observed[~np.isin(observed, known)], self._step)

    def _link_waiting(self, lower: Table, observed: Mask, now: TimePoint) -> None:
        """Evaluate establish and reestablish, and make the links that follow."""
        waiting, uppers = self._waiting, self._uppers
        rows = np.flatnonzero(np.isin(waiting.ids, lower.ids[observed]))
        table = lower.select(positions_of(waiting.ids[rows], lower.ids))
        truth = waiting.condition.truth(table, uppers.table.select(_NOBODY))
        new = waiting.step(rows, truth, now, self._step)
        free = np.flatnonzero((uppers.since != _LINKED) & (uppers.since <= self._step))
        at, on = self._candidates.step(
            now,
            self._step,
            Unlinked(table, waiting.since[rows]),
            Unlinked(uppers.table.select(free), uppers.since[free]),
        )
        new[at] = False
        self._link(table.select(at), uppers.table.ids[free[on]], now)
        begun = table.select(np.flatnonzero(new)[np.argsort(table.ids[new])])
        self._link(begun, self._created(begun, now), now)
        new[at] = True
        waiting.keep(~np.isin(waiting.ids, table.ids[new]))

    def _created(self, lower: Table, now: TimePoint) -> Ids:
        ids = np.arange(self._next_id, self._next_id + len(lower), dtype=np.int64)
        self._next_id += len(lower)
        if len(lower):
            self._uppers.add(self._unit.create(ids, lower, now))
        return ids

    def _link(self, lower: Table, upper: Ids, now: TimePoint) -> None:
        self._standing.add(lower.ids, upper)
        uppers = self._uppers
        rows = positions_of(upper, uppers.table.ids)
        uppers.lower[np.isin(uppers.lower, lower.ids)] = _NO_ONE
        uppers.lower[rows], uppers.since[rows] = lower.ids, _LINKED
        for from_id, to_id in zip(lower.ids.tolist(), upper.tolist(), strict=True):
            self.history.make(uppers.table.symbol(to_id), lower.symbol(from_id), now)

    def _compute(self, lower: Table, observed: Mask, now: TimePoint) -> None:
        """Compute the states of all linked upper objects."""
        standing, uppers = self._standing, self._uppers
        on = positions_of(standing.upper, uppers.table.ids)
        order = np.argsort(on)
        on, at = on[order], positions_of(standing.lower[order], lower.ids)
        if len(on):
            states = self._unit.update(take(uppers.table, on), take(lower, at), now)
            uppers.table = with_rows(uppers.table, on, states)
        anchored = on[observed[at]]
        uppers.anchored_at[anchored], uppers.anchored_in[anchored] = now, self._step

    def _remove_unanchored(self, now: TimePoint) -> None:
        """Give up the upper objects that no percept has fed for too long."""
        uppers = self._uppers
        kept = self._may_return(uppers.anchored_at, uppers.anchored_in, now)
        if kept.all():
            return
        linked = uppers.since == _LINKED
        self._unlink(uppers.table.ids[~kept & linked], self._step, now, LinkEnd.GIVEN_UP)
        uppers.keep(kept)
        self._standing.keep(np.isin(self._standing.upper, uppers.table.ids))

    def _may_return(self, seen_at: Ids, seen_in: Ids, now: TimePoint) -> Mask:
        """Return which objects, seen last at that time and in that state, may come back."""
        recent: Mask = now - seen_at < self._remove_after
        recent |= self._step - seen_in < self._least_states
        return recent


class _Waiting:
    """Lower objects without a link, and how far their establish condition has come.

    Attributes:
        ids: shape (n,).
        since: shape (n,), the number of the first state that a pair with each may be about.
        truth: shape (atoms, n), of the condition when each was seen last.
        seen_at: shape (n,), when that was.
        seen_in: shape (n,), the number of that state; `_NEVER` before the first one.
    """

    def __init__(self, condition: Condition) -> None:
        self.condition = condition
        self.monitor = MonitorColumns(condition.table)
        self.ids: Ids = _NOBODY
        self.since: Ids = _NOBODY
        self.truth: Truths = np.zeros((len(condition.table.atoms), 0), dtype=np.bool_)
        self.seen_at: Ids = _NOBODY
        self.seen_in: Ids = _NOBODY

    def add(self, ids: Ids, since: int) -> None:
        n = len(ids)
        self.monitor.add(n)
        self.ids = np.concatenate((self.ids, ids))
        self.since = np.concatenate((self.since, np.full(n, since)))
        unknown = np.zeros((len(self.truth), n), dtype=np.bool_)
        self.truth = np.concatenate((self.truth, unknown), axis=1)
        self.seen_at = np.concatenate((self.seen_at, np.full(n, _NEVER)))
        self.seen_in = np.concatenate((self.seen_in, np.full(n, _NEVER)))

    def step(self, rows: Rows, truth: Truths, now: TimePoint, step: int) -> Mask:
        """Take in the *truth* of the condition in the state of *rows*, and of no others.

        Returns:
            In which of the rows the condition has become true by now.
        """
        self.truth[:, rows] = truth
        self.seen_at[rows], self.seen_in[rows] = now, step
        true: Mask = self.monitor.step(now, self.truth)[rows] > 0
        return true

    def keep(self, mask: Mask) -> None:
        if mask.all():
            return
        self.monitor.keep(mask)
        self.ids, self.since, self.truth = self.ids[mask], self.since[mask], self.truth[:, mask]
        self.seen_at, self.seen_in = self.seen_at[mask], self.seen_in[mask]


class _Standing:
    """The links, and how far their maintain condition has come.

    Attributes:
        lower: shape (n,), ids of the objects linked from.
        upper: shape (n,), ids of the objects linked to.
    """

    def __init__(self, condition: Condition) -> None:
        self.condition = condition
        self.monitor = MonitorColumns(condition.table)
        self.lower: Ids = _NOBODY
        self.upper: Ids = _NOBODY

    def add(self, lower: Ids, upper: Ids) -> None:
        self.monitor.add(len(lower))
        self.lower = np.concatenate((self.lower, lower))
        self.upper = np.concatenate((self.upper, upper))

    def keep(self, mask: Mask) -> None:
        self.monitor.keep(mask)
        self.lower, self.upper = self.lower[mask], self.upper[mask]


class _Uppers:
    """The upper objects, linked or not.

    Attributes:
        table: Their states.
        since: shape (n,), the number of the state since which each is unlinked, or `_LINKED`.
        lower: shape (n,), ids of the lower objects that each is or was linked to, or `_NO_ONE`.
        anchored_at: shape (n,), when each was last linked to an observed object.
        anchored_in: shape (n,), the number of the state of that moment.
    """

    def __init__(self, table: Table) -> None:
        self.table = table
        self.since: Ids = _NOBODY
        self.lower: Ids = _NOBODY
        self.anchored_at: Ids = _NOBODY
        self.anchored_in: Ids = _NOBODY

    def add(self, table: Table) -> None:
        self.table = concatenate([self.table, table])
        nothing = np.full(len(table), _LINKED, dtype=np.int64)
        self.since = np.concatenate((self.since, nothing))
        self.lower = np.concatenate((self.lower, np.full(len(table), _NO_ONE, dtype=np.int64)))
        self.anchored_at = np.concatenate((self.anchored_at, nothing))
        self.anchored_in = np.concatenate((self.anchored_in, nothing))

    def keep(self, mask: Mask) -> None:
        self.table = self.table.select(mask)
        self.since, self.lower = self.since[mask], self.lower[mask]
        self.anchored_at, self.anchored_in = self.anchored_at[mask], self.anchored_in[mask]


_NOBODY: Ids = np.empty(0, dtype=np.int64)
