"""How an event joins the partial instances that it fits to.

A match is put together from *connected* parts: sets of events whose patterns share variables.
Each event joins the parts that it has a variable in common with, at any size that still leaves a
complete match possible; what shares no variable with it is left alone, so that cars that have
nothing to do with each other never meet. Since each part is made when its last event comes, and
taking that event away leaves the parts that it joined, every match is found exactly once,
whatever the order in which the events of one instant are listed.

For each slot and each combination of stages that an event can join, a *recipe* is made once:
a function that knows the index to look into, the limits to test, and the places of the values.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache, reduce
from itertools import product
from operator import or_

from chronicles.constraints import NEVER, UNBOUNDED
from chronicles.events import Event
from chronicles.instances import Instance, Stage
from chronicles.models import Model, Slot
from chronicles.patterns import Values, projection
from chronicles.writing import Limits, Recipe, Source, written_beginning, written_joining

__all__ = ["Joiner"]

_LEAST_TO_SWEEP = 256

_Find = Callable[[int, Values], Iterable[Instance]]


@dataclass(frozen=True, slots=True)
class _Parts:
    """Stages that have nothing to do with each other.

    Attributes:
        parts: The stages.
        mask: The slots that they have filled, as a set of bits.
        near: The slots next to these.
        later_than: The slots that must be filled before one of these.
    """

    parts: tuple[Stage, ...]
    mask: int
    near: int
    later_than: int

    def fits(self, stage: Stage) -> bool:
        """Return whether *stage* has nothing to do with any of them."""
        return not self.mask & (stage.mask | stage.near)

    def joined(self, other: "_Parts") -> "_Parts":
        """Return both together."""
        return _Parts(
            self.parts + other.parts,
            self.mask | other.mask,
            self.near | other.near,
            self.later_than | other.later_than,
        )


class Joiner:
    """The stages of one chronicle and the recipes that lead from one to another.

    Stages are made when the first instance gets there: of the many sets of slots that can be
    filled, few ever are. Those that have become empty can be forgotten.

    Args:
        model: The chronicle.
        prepare: Makes a new stage ready for instances.

    Attributes:
        stages: The stages made so far, by the set of their slots.
        recipes: For each slot what to do with an event.
    """

    def __init__(self, model: Model, prepare: Callable[[Stage], None]) -> None:
        self._model = model
        self._prepare = prepare
        self._everything = (1 << len(model.slots)) - 1
        self._later_than = [_places(limit < 0 for limit in limits) for limits in model.limits]
        self._combinations: list[list[_Parts]] = []
        self._most = _LEAST_TO_SWEEP
        self.stages: dict[int, Stage] = {}
        self.recipes: list[list[Recipe]] = [[] for _ in model.slots]
        self._add_beginnings()

    @property
    def is_crowded(self) -> bool:
        """Whether there may be many stages without instances."""
        return len(self.stages) > self._most

    def forget_empty_stages(self) -> None:
        """Forget the stages without instances; no event may be on its way through the recipes."""
        kept = [stage for stage in self.stages.values() if not stage.is_empty]
        self.stages = {stage.mask: stage for stage in kept}
        self._most = max(_LEAST_TO_SWEEP, 2 * len(kept))
        for recipes in self.recipes:
            recipes.clear()
        self._add_beginnings()
        for stage in kept:
            self._add_recipes(stage)

    def _stage(self, mask: int) -> Stage:
        stage = self.stages.get(mask)
        if stage is None:
            stage = self.stages[mask] = Stage(self._model, mask)
            for i in stage.awaited:
                stage.index_by(_link(self._model.slots[i].pattern.variables, stage.variables)[0])
            stage.seal()
            self._prepare(stage)
            self._add_recipes(stage)
        return stage

    def _add_beginnings(self) -> None:
        nothing = _Parts((), 0, 0, 0)
        self._combinations = [[nothing] for _ in self._model.slots]
        for slot in self._model.slots:
            if self._is_possible(slot, nothing):
                self.recipes[slot.index].append(self._begin_first(slot))

    def _add_recipes(self, stage: Stage) -> None:
        """Make recipes of *stage*, alone and together with others it has nothing to do with."""
        later_than = reduce(or_, (self._later_than[i] for i in stage.filled))
        alone = _Parts((stage,), stage.mask, stage.near, later_than)
        is_connected = stage.mask | stage.near == self._everything
        for i in stage.awaited:
            slot, combinations = self._model.slots[i], self._combinations[i]
            found = (
                [alone]
                if is_connected
                else [p.joined(alone) for p in combinations if p.fits(stage)]
            )
            if not is_connected:
                combinations += found
            self.recipes[i] += [
                self._joining(slot, each.parts) for each in found if self._is_possible(slot, each)
            ]

    def _is_possible(self, slot: Slot, parts: "_Parts") -> bool:
        """Return whether the open slots next to some parts and *slot* can be filled later."""
        mask, near = parts.mask | 1 << slot.index, parts.near | slot.neighbours
        return not near & ~mask & (parts.later_than | self._later_than[slot.index])

    def _begin_first(self, slot: Slot) -> Recipe:
        """Return what writes the recipe for an event that joins nothing, when there is one."""
        recipes = self.recipes[slot.index]

        def begin_first(event: Event, now: int, values: Values) -> None:
            step = self._begin(slot)
            recipes[recipes.index(begin_first)] = step
            step(event, now, values)

        return begin_first

    def _begin(self, slot: Slot) -> Recipe:
        """Return the recipe for an event that joins nothing."""
        mask = 1 << slot.index
        windows = [NEVER if s.latest >= UNBOUNDED else s.latest for s in self._model.slots]
        source = Source(
            self._arrangement(slot.pattern.variables, mask), self._restriction(mask, ())
        )
        reach = self._reach(slot, ())
        return written_beginning(slot.index, windows, reach, source, self._stage(mask))

    def _joining(self, slot: Slot, parts: tuple[Stage, ...]) -> Recipe:
        """Return the recipe for an event that joins one instance of each of *parts*."""
        if len(parts) == 1:
            return self._going_on(slot, parts[0])
        find = [self._finder(slot, part) for part in parts]
        at = slot.index
        mask = reduce(or_, (part.mask for part in parts), 1 << at)
        sources = [*(v for part in parts for v in part.variables), *slot.pattern.variables]
        arrange = self._arrangement(sources, mask)
        allows = self._restriction(mask, parts)
        filled = [part.filled for part in parts]
        reach = self._reach(slot, ())

        def join(event: Event, now: int, values: Values) -> None:
            for instances in product(*[finder(now, values) for finder in find]):
                if not _fit(instances, filled):
                    continue
                found = tuple([v for one in instances for v in one.values]) + values
                arranged = arrange(found) if arrange else found
                if allows is None or allows(arranged):
                    joined = _joined(instances)
                    joined.times[at], joined.events[at] = now, event
                    joined.stage, joined.values = self._stage(mask), arranged
                    for j, limit in reach:
                        joined.times[j] = min(joined.times[j], now + limit)
                    joined.stage.admit(joined, now)

        return join

    def _going_on(self, slot: Slot, part: Stage) -> Recipe:
        """Return the recipe for an event that joins one instance, the usual case.

        It is written when an event first finds an instance, so that nothing is made of the many
        steps that no instance ever takes.
        """
        shared, key = _link(slot.pattern.variables, part.variables)
        index = part.index_by(shared)
        mask = part.mask | 1 << slot.index
        recipes = self.recipes[slot.index]

        def go_on_first(event: Event, now: int, values: Values) -> None:
            if (key(values) if key else values) in index:
                limits = self._pauses(slot, part), self._reach(slot, part.filled)
                source = Source(self._combination(slot, part), self._restriction(mask, (part,)))
                step = written_joining(slot.index, index, key, limits, source, self._stage(mask))
                recipes[recipes.index(go_on_first)] = step
                step(event, now, values)

        return go_on_first

    def _combination(self, slot: Slot, part: Stage) -> Callable[[Values, Values], Values] | None:
        """Return what puts the values of an instance and of an event together.

        It is None if the event has no variable that the instance does not have.
        """
        if set(slot.pattern.variables) <= set(part.variables):
            return None
        source = (*part.variables, *slot.pattern.variables)
        arrange = self._arrangement(source, part.mask | 1 << slot.index)
        if arrange is None:
            return lambda old, new: (*old, *new)
        return lambda old, new: arrange((*old, *new))

    def _finder(self, slot: Slot, part: Stage) -> _Find:
        """Return a function that finds the instances of *part* that an event fits to."""
        at = slot.index
        shared, key = _link(slot.pattern.variables, part.variables)
        index = part.index_by(shared)
        pauses = self._pauses(slot, part)

        def find(now: int, values: Values) -> Iterable[Instance]:
            bucket = index.get(key(values) if key else values)
            if bucket is None:
                return ()
            found = [instance for instance in bucket if now <= instance.times[at]]
            for i, pause in pauses:
                found = [instance for instance in found if now - instance.times[i] >= pause]
            return found

        return find

    def _pauses(self, slot: Slot, part: Stage) -> Limits:
        """Return after which slots of *part* a time must pass until *slot*, and which.

        Left out is what follows from the others and from the order in which events come.
        """
        limits = self._model.limits
        asked = {i: -limits[slot.index][i] for i in part.filled if limits[slot.index][i] < 0}
        for i in list(asked):
            others = (max(asked.get(j, 0), 0) - limits[j][i] for j in part.filled if j != i)
            if any(pause >= asked[i] for pause in others):
                del asked[i]
        return tuple(asked.items())

    def _reach(self, slot: Slot, filled: Sequence[int]) -> Limits:
        """Return which slots an event of *slot* limits, and how much later they can be.

        Left out are the slots in *filled*, and those that the events of these limit as much.
        """
        limits = self._model.limits
        own = limits[slot.index]
        return tuple(
            (j, own[j])
            for j in range(len(own))
            if own[j] < UNBOUNDED
            and j != slot.index
            and j not in filled
            and not any(min(own[i], 0) + limits[i][j] <= own[j] for i in filled)
        )

    def _arrangement(self, source: Sequence[str], mask: int) -> Callable[[Values], Values] | None:
        return projection(source, self._variables(mask))

    def _variables(self, mask: int) -> tuple[str, ...]:
        slots = (slot for slot in self._model.slots if mask & 1 << slot.index)
        bound = {name for slot in slots for name in slot.pattern.variables}
        return tuple(name for name in self._model.variables if name in bound)

    def _restriction(self, mask: int, parts: tuple[Stage, ...]) -> Callable[[Values], bool] | None:
        """Return a test of what can be judged now and could not be judged for any of *parts*."""
        variables = self._variables(mask)
        tests = tuple(
            (projection(variables, r.variables) or _same, r.allows)
            for r in self._model.restrictions
            if set(r.variables) <= set(variables)
            and not any(set(r.variables) <= set(part.variables) for part in parts)
        )
        if not tests:
            return None
        return lambda values: all(allows(pick(values)) for pick, allows in tests)


def _places(truths: Iterable[bool]) -> int:
    """Return at which places the truths are, as a set of bits."""
    return sum(1 << i for i, truth in enumerate(truths) if truth)


@lru_cache(maxsize=4096)
def _link(
    asked: tuple[str, ...], known: tuple[str, ...]
) -> tuple[tuple[str, ...], Callable[[Values], Values] | None]:
    """Return the variables of an event that are known, and what finds their values.

    There is nothing to find if that is all of them.
    """
    shared = tuple(name for name in asked if name in known)
    return shared, projection(asked, shared)


def _same(values: Values) -> Values:
    return values


def _fit(instances: tuple[Instance, ...], filled: list[tuple[int, ...]]) -> bool:
    """Return whether no instance puts a limit on a slot that another one has filled later."""
    for one in instances:
        for other, slots in zip(instances, filled, strict=True):
            if one is not other and any(other.times[i] > one.times[i] for i in slots):
                return False
    return True


def _joined(instances: tuple[Instance, ...]) -> Instance:
    """Return what some instances with nothing in common are together."""
    first = instances[0]
    times = [min(found) for found in zip(*[one.times for one in instances], strict=True)]
    events = first.events.copy()
    for one in instances:
        for i in one.stage.filled:
            times[i], events[i] = one.times[i], one.events[i]
    return Instance(first.stage, first.values, times, events)
