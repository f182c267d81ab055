"""The load governor: what has to stand back when the network falls behind.

Process refinement (Heintz 2009, section 10.7) changes the policies of streams while the
application runs. A stream that is declared `sample every 100 up to 400 under load` says that it
may be sampled less often when there is too much to do. The governor doubles the periods of all
such streams, step by step, as long as the network is late, and takes the steps back when it has
kept up for a while.
"""

from collections.abc import Callable
from dataclasses import dataclass

from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.streams.policy import SampleEvery
from dyknow.time import SECOND, Duration, TimePoint

__all__ = ["GovernorSettings", "LoadGovernor", "PeriodChange"]

_RELIEF = Duration(5 * SECOND)


@dataclass(frozen=True, slots=True, kw_only=True)
class GovernorSettings:
    """When the governor acts.

    Attributes:
        late_after: A network whose work is done later than this is behind.
        patience: For so long it has to be behind before periods are lengthened, and again before
            each further step.
        relief: For so long it has to have kept up before a step is taken back.

    Raises:
        ValueError: A duration is not positive, or *relief* is shorter than *patience*, which
            would let the periods swing.
    """

    late_after: Duration
    patience: Duration = SECOND
    relief: Duration = _RELIEF

    def __post_init__(self) -> None:
        if min(self.late_after, self.patience, self.relief) <= 0:
            raise ValueError("the durations of a load governor must be positive")
        if self.relief < self.patience:
            raise ValueError("a load governor must not restore faster than it lengthens")


@dataclass(frozen=True, slots=True)
class PeriodChange:
    """A sample period that was changed because of the load.

    Attributes:
        time: The instant after whose work it was changed.
        provider: The label of the stream generator.
        receiver: The label of the process that receives the stream, or the name of an output.
        number: Which input of the receiver, from 1; 0 for an output.
        before: The period until then.
        after: The period from then on.
    """

    time: TimePoint
    provider: Label
    receiver: Label
    number: int
    before: Duration
    after: Duration


class LoadGovernor:
    """Lengthens and restores the sample periods of the streams that allow it.

    Attributes:
        level: How many steps have been taken: at level n a period is 2**n times what its policy
            asks for, or the longest that the policy allows.
        changes: All that has been changed, in order.
    """

    def __init__(
        self, kernel: Kernel, lateness: Callable[[], Duration], settings: GovernorSettings
    ) -> None:
        """Govern the streams of *kernel*, whose work was last done *lateness* too late."""
        self.level = 0
        self.changes: list[PeriodChange] = []
        self._kernel = kernel
        self._lateness = lateness
        self._settings = settings
        self._since: TimePoint | None = None
        self._was_late = False

    def watch(self, now: TimePoint) -> None:
        """Look at how late the work before the instant *now* was done, and act if need be.

        To be called as each instant begins, as `on_time` of `Kernel.run` does.
        """
        is_late = self._lateness() > self._settings.late_after
        if self._since is None or is_late != self._was_late:
            self._since, self._was_late = now, is_late
        lasted = now - self._since
        if is_late and lasted >= self._settings.patience and self._can_lengthen():
            self._go_to(self.level + 1, now)
        elif not is_late and lasted >= self._settings.relief and self.level:
            self._go_to(self.level - 1, now)
        elif self.level:
            self._apply(now)  # a stream may be new

    def _go_to(self, level: int, now: TimePoint) -> None:
        self.level = level
        self._since = now
        self._apply(now)

    def _apply(self, now: TimePoint) -> None:
        for proxy, change in self._governed():
            before, after = proxy.period or change.period, _period_at(self.level, change)
            if before != after:
                proxy.set_period(after)
                self.changes.append(
                    PeriodChange(now, proxy.provider, proxy.receiver, proxy.number, before, after)
                )

    def _can_lengthen(self) -> bool:
        return any(
            _period_at(self.level, change) < _period_at(self.level + 1, change)
            for _, change in self._governed()
        )

    def _governed(self) -> list[tuple[StreamProxy, SampleEvery]]:
        return [
            (proxy, proxy.policy.change)
            for proxy in self._kernel.streams
            if isinstance(proxy.policy.change, SampleEvery)
            and proxy.policy.change.longest is not None
        ]


def _period_at(level: int, change: SampleEvery) -> Duration:
    """Return 2**level times the period of *change*, or the longest that it allows."""
    return min(Duration(change.period << level), change.longest_period)
