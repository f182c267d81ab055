"""Sample periods that were changed under load: a recording keeps them, a replay repeats them."""

import json
from collections.abc import Callable, Sequence

from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.service.governor import PeriodChange
from dyknow.streams.policy import SampleEvery
from dyknow.time import Duration, TimePoint

__all__ = ["KeepPeriods", "PeriodRepeater", "changes_from_text", "text_from_changes"]

KeepPeriods = Callable[[Sequence[PeriodChange]], None]
"""Takes all changes of sample periods that there have been, whenever there is one more."""


def text_from_changes(changes: Sequence[PeriodChange]) -> str:
    """Return a text for a recording; times are nanoseconds."""
    return json.dumps(
        [
            [each.time, each.provider, each.receiver, each.number, each.before, each.after]
            for each in changes
        ]
    )


def changes_from_text(text: str) -> tuple[PeriodChange, ...]:
    """Return the changes that a recording tells of.

    Raises:
        ValueError, TypeError: It is not what `text_from_changes` writes.
    """
    return tuple(
        PeriodChange(
            TimePoint(time), Label(provider), Label(receiver), number, Duration(old), Duration(new)
        )
        for time, provider, receiver, number, old, new in json.loads(text)
    )


class PeriodRepeater:
    """Changes sample periods at the same instants again, of all streams that still allow it."""

    def __init__(self, kernel: Kernel, changes: Sequence[PeriodChange]) -> None:
        self._kernel = kernel
        self._changes = list(changes)

    def advance(self, now: TimePoint) -> None:
        """Take note that the work of the instant *now* begins."""
        while self._changes and self._changes[0].time <= now:
            self._repeat(self._changes.pop(0))

    def _repeat(self, change: PeriodChange) -> None:
        for proxy in self._kernel.streams:
            ends = (proxy.provider, proxy.receiver, proxy.number)
            is_meant = ends == (change.provider, change.receiver, change.number)
            if is_meant and change.after in _periods_of(proxy):
                proxy.set_period(change.after)


def _periods_of(proxy: StreamProxy) -> Sequence[int]:
    change = proxy.policy.change
    return change.periods() if isinstance(change, SampleEvery) else ()
