"""The link process as the literature writes it down: one object at a time, all pairs, no columns.

The definition of Heintz, Kvarnström and Doherty (2009), section IV.B, with the choices that
`anchoring.processes` documents; the oracle of its tests.
"""

from itertools import combinations, permutations

import numpy as np

from dyknow.mtl.columns import evaluate_atoms
from dyknow.mtl.monitors import MonitorColumns
from dyknow.mtl.progression import ProgressionTable
from dyknow.streams.table import Table

GATE_MARGIN = 1.01


class FlatUnit:
    """A unit without filters: an upper object is where its lower one was seen last.

    Columns are position, `loud` of the lower object, and `calm`, which the upper object keeps
    from the lower object that it was created from.
    """

    sort = "thing"

    def __init__(self, *, trusts_predictions: bool = False) -> None:
        self.trusts_predictions = trusts_predictions

    def create(self, ids, lower, now):
        """Return the objects as they are first seen."""
        return Table(self.sort, ids, {"position": lower["position"], "calm": ~lower["loud"]})

    def predict(self, upper, now):
        """Return the objects where they were."""
        return upper

    def update(self, upper, lower, now):
        """Return the objects where they are seen."""
        return upper.with_columns(position=lower["position"])

    def feature(self, name, arguments, lower, upper):
        """Return `xydist(from, to)`."""
        if (name, arguments) == ("xydist", ("from", "to")):
            return np.linalg.norm(lower["position"] - upper["position"], axis=1)
        return None

    def places(self, upper):
        """Return the one place of each object."""
        return upper["position"], np.arange(len(upper))

    def published(self, upper):
        """Return all columns."""
        return upper


class _Formula:
    """One formula followed for one object or pair."""

    def __init__(self, formula) -> None:
        self.monitor = MonitorColumns(ProgressionTable(formula))
        self.monitor.add(1)

    def step(self, now, features) -> int:
        columns = {term: np.array([value]) for term, value in features.items()}
        return int(self.monitor.step(now, evaluate_atoms(self.monitor.table, columns, 1))[0])


class NaiveLinks:
    """Links, and positions of upper objects, after each state."""

    def __init__(self, settings, gate, *, trusts_predictions=False) -> None:
        self.settings, self.gate, self.trusts = settings, gate, trusts_predictions
        self.things = {}  # upper id -> position, calm, anchored at, anchored in
        self.former = {}  # lower id -> upper id of its link, if it may be taken up
        self.away = set()  # waiting lower ids that are not observed
        self.number = 0
        self.link = {}  # lower id -> (upper id, maintain)
        self.waiting = {}  # lower id -> (establish, {upper id: reestablish})
        self.last = {}  # waiting lower id -> its features, when it was seen last, in which state
        self.next_id = 1

    def step(self, now, seen) -> dict[int, int]:
        """Take in *seen*: id -> (position, loud, observed); return the links."""
        self.number += 1
        usable = self._drop(now, seen)
        self._resume(usable)
        for p in usable - set(self.waiting) - set(self.link):
            self._wait(p)
        self.away = set(self.waiting) - usable
        self._update_candidates()
        broken = self._maintain(now, seen)
        self._make_links(now, seen)
        for p, (o, _) in self.link.items():
            self.things[o][0] = seen[p][0]
            if seen[p][2]:
                self.things[o][2:] = now, self.number
        for p in broken:
            self._wait(p)
        self._update_candidates()
        for o in [o for o, t in self.things.items() if self._is_lost(t, now)]:
            del self.things[o]
            self.link = {p: link for p, link in self.link.items() if link[0] != o}
        return {p: o for p, (o, _) in self.link.items()}

    def _wait(self, p) -> None:
        self.waiting[p] = (_Formula(self.settings.establish), {})
        self.last.pop(p, None)

    def _is_lost(self, known, now) -> bool:
        """Whether something known by (.., .., when, in which state) has been away too long."""
        return (
            now - known[2] >= self.settings.remove_after
            and self.number - known[3] >= self.settings.least_states
        )

    def _resume(self, usable) -> None:
        """Make the links again whose lower objects are back."""
        linked = {o for o, _ in self.link.values()}
        for p in usable - set(self.link):
            o = self.former.get(p)
            if o in self.things and o not in linked:
                self.link[p] = (o, _Formula(self.settings.maintain))

    def _make_links(self, now, seen) -> None:
        established, reestablished = self._verdicts(now, seen)
        for p, o in self._assigned(reestablished, seen):
            self._connect(p, o)
            established.discard(p)
        for p in sorted(established):
            self.things[self.next_id] = [seen[p][0], not seen[p][1], now, self.number]
            self._connect(p, self.next_id)
            self.next_id += 1

    def _drop(self, now, seen) -> set[int]:
        """Forget what vanished and return the ids that are observed."""
        usable = {p for p, (_, _, observed) in seen.items() if observed}
        for p in list(self.link):
            if p not in usable and not (self.trusts and p in seen):
                del self.link[p]
        for p in set(self.waiting) - usable:
            self.waiting[p][1].clear()
            if p not in self.last or self._is_lost(self.last[p], now):
                del self.waiting[p]
        return usable

    def _update_candidates(self) -> None:
        free = set(self.things) - {o for o, _ in self.link.values()}
        for p, (_, pairs) in self.waiting.items():
            if p in self.away:
                continue
            for o in set(pairs) - free:
                del pairs[o]
            for o in free - set(pairs):
                pairs[o] = _Formula(self.settings.reestablish)

    def _connect(self, p, o) -> None:
        self.waiting.pop(p)
        self.former = {q: old for q, old in self.former.items() if old != o} | {p: o}
        self.link[p] = (o, _Formula(self.settings.maintain))

    def _features(self, p, o, seen):
        values = {"loud(from)": seen[p][1]}
        if o is not None:
            position, calm, *_ = self.things[o]
            values["calm(to)"] = calm
            values["xydist(from, to)"] = float(np.hypot(*(np.array(seen[p][0]) - position)))
        return values

    def _maintain(self, now, seen) -> list[int]:
        broken = [
            p
            for p, (o, maintain) in self.link.items()
            if maintain.step(now, self._features(p, o, seen)) < 0
        ]
        for p in broken:
            del self.link[p], self.former[p]
        return broken

    def _verdicts(self, now, seen):
        established, reestablished = set(), []
        for p, (establish, pairs) in self.waiting.items():
            if p not in self.away:
                self.last[p] = self._features(p, None, seen), None, now, self.number
            if establish.step(now, self.last[p][0]) > 0 and p not in self.away:
                established.add(p)
            for o, reestablish in pairs.items():
                if reestablish.step(now, self._features(p, o, seen)) > 0:
                    reestablished.append((p, o))
        return established, reestablished

    def _assigned(self, pairs, seen):
        """Return the best choice among *pairs*, by trying all."""
        if not pairs:
            return []
        distance = {(p, o): self._features(p, o, seen)["xydist(from, to)"] for p, o in pairs}
        left_out = max(self.gate, GATE_MARGIN * max(distance.values()) + 0.01) ** 2
        lowers = sorted({p for p, _ in pairs})
        uppers = sorted({o for _, o in pairs})
        best, chosen = np.inf, []
        for count in range(min(len(lowers), len(uppers)) + 1):
            for some in combinations(lowers, count):
                for others in permutations(uppers, count):
                    choice = list(zip(some, others, strict=True))
                    if any(pair not in distance for pair in choice):
                        continue
                    cost = sum(distance[pair] ** 2 for pair in choice)
                    cost += left_out * (len(lowers) - count)
                    if cost < best:
                        best, chosen = cost, choice
        return chosen
