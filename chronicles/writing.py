"""Functions written out for one step of one chronicle.

What happens most often, that an event begins an instance or joins one, differs from chronicle to
chronicle in which limits have to be looked at, which values have to be put together, and where
the new instance is found again. Written out for the step, as a person would write it for this
chronicle alone, it takes half the time of a function that looks all of this up.

The text of a function has numbers in it and refers to everything else by name, so that steps of
the same shape, as those of a thousand chronicles made after one pattern are, share their code.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from operator import itemgetter
from types import CodeType
from typing import Any

from chronicles.constraints import INSTANT, NEVER
from chronicles.events import Event
from chronicles.instances import Index, Instance, Stage
from chronicles.patterns import Values

__all__ = ["Limits", "Recipe", "Source", "written_beginning", "written_joining"]

Recipe = Callable[[Event, int, Values], None]
"""Joins an event with what it fits to, given its time and the values of its slot's variables."""

Limits = tuple[tuple[int, int], ...]
"""Numbers of slots, and how much later or earlier they can be."""

_FEW = 6
"""How many limits are looked at one by one and not in a loop."""


@dataclass(frozen=True, slots=True)
class Source:
    """How the values of a new instance are come by.

    Attributes:
        combine: From those of the old instance and of the event; None if they are the same as
            the old ones, or for an instance that begins, as those of the event.
        allows: Whether they are allowed; None if all are.
    """

    combine: Callable[..., Values] | None
    allows: Callable[[Values], bool] | None


def written_beginning(
    at: int, windows: Sequence[int], reach: Limits, source: Source, stage: Stage
) -> Recipe:
    """Return what begins an instance of *stage* with an event of slot *at*.

    Args:
        at: The slot.
        windows: Until when each slot can be filled, whatever has happened.
        reach: Which slots the event limits, and how much later they can be.
        source: Where the values come from.
        stage: Where the instance belongs.
    """
    lines = [
        "def step(event, now, values):",
        f" arranged = {'combine(values)' if source.combine else 'values'}",
        *([" if not allows(arranged): return"] if source.allows else []),
        " times = windows.copy()",
        f" times[{at}] = now",
        *_limiting(" ", reach, any(windows[j] < NEVER for j, _ in reach)),
        *_admission(" ", "return", f"nothing.copy(); events[{at}] = event", stage),
    ]
    nothing = [None] * len(windows)
    return _made(lines, source, stage, reach=reach, windows=list(windows), nothing=nothing)


def written_joining(
    at: int,
    index: Index,
    key: Callable[[Values], Values] | None,
    limits: tuple[Limits, Limits],
    source: Source,
    stage: Stage,
) -> Recipe:
    """Return what joins an event of slot *at* with instances, which gives some of *stage*.

    Args:
        at: The slot.
        index: Where the instances are found.
        key: From the values of the event to those in the index; None if they are the same.
        limits: How long after which slots the event must come; which slots it limits then, and
            how much later they can be.
        source: Where the values come from.
        stage: Where the new instances belong.
    """
    pauses, reach = limits
    lines = [
        "def step(event, now, values):",
        f" bucket = index.get({'key(values)' if key else 'values'})",
        " if bucket is None: return",
        " for instance in bucket:",
        "  times, old = instance.times, instance.values",
        f"  if now > times[{at}]: continue",
        *_pausing("  ", pauses),
        f"  arranged = {'combine(old, values)' if source.combine else 'old'}",
        *(["  if not allows(arranged): continue"] if source.allows else []),
        "  times = times.copy()",
        f"  times[{at}] = now",
        *_limiting("  ", reach, is_limited=True),
        *_admission("  ", "continue", f"instance.events.copy(); events[{at}] = event", stage),
    ]
    return _made(lines, source, stage, index=index, key=key, pauses=pauses, reach=reach)


def _pausing(indent: str, pauses: Limits) -> Iterator[str]:
    if len(pauses) > _FEW:
        yield f"{indent}if any(now - times[i] < pause for i, pause in pauses): continue"
        return
    for i, pause in pauses:
        yield f"{indent}if now - times[{i}] < {pause}: continue"


def _limiting(indent: str, reach: Limits, is_limited: bool) -> Iterator[str]:  # noqa: FBT001
    """Yield what limits other slots, which may be limited already."""
    if len(reach) > _FEW:
        yield f"{indent}for j, limit in reach:"
        yield f"{indent} if now + limit < times[j]: times[j] = now + limit"
        return
    for j, limit in reach:
        if is_limited:
            yield f"{indent}if now + {limit} < times[{j}]: times[{j}] = now + {limit}"
        else:
            yield f"{indent}times[{j}] = now + {limit}"


def _admission(indent: str, leave: str, events: str, stage: Stage) -> Iterator[str]:
    """Yield what takes in the new instance, or leaves it if it is dead already."""
    if stage.schedule is None:
        yield f"{indent}events = {events}"
        yield f"{indent}admit(Instance(stage, arranged, times, events), now)"
        return
    first, *others = stage.awaited
    if len(others) > _FEW:
        yield f"{indent}deadline = min(awaited(times))"
    else:
        yield f"{indent}deadline = times[{first}]"
        for i in others:
            yield f"{indent}if times[{i}] < deadline: deadline = times[{i}]"
    yield f"{indent}if deadline < now: {leave}"
    yield f"{indent}events = {events}"
    yield f"{indent}new = Instance(stage, arranged, times, events)"
    for i, (_, key) in enumerate(stage.entries):
        yield f"{indent}place = {f'key_{i}(arranged)' if key else 'arranged'}"
        yield f"{indent}found = index_{i}.get(place)"
        yield f"{indent}if found is None: index_{i}[place] = {{new: None}}"
        yield f"{indent}else: found[new] = None"
    yield f"{indent}if deadline < {NEVER}: schedule(new, deadline + {INSTANT})"


def _made(lines: Iterable[str], source: Source, stage: Stage, **names: Any) -> Recipe:
    known = {
        "Instance": Instance,
        "stage": stage,
        "admit": stage.admit,
        "schedule": stage.schedule,
        "awaited": itemgetter(*stage.awaited) if stage.awaited else None,
        "combine": source.combine,
        "allows": source.allows,
        **{f"index_{i}": index for i, (index, _) in enumerate(stage.entries)},
        **{f"key_{i}": key for i, (_, key) in enumerate(stage.entries)},
        **names,
    }
    exec(_code("\n".join(lines)), known)
    step: Recipe = known["step"]
    return step


@cache
def _code(text: str) -> CodeType:
    return compile(text, "<step of a chronicle>", "exec")
