"""Why a generator cannot keep a policy, seeing what its process promises.

The definition of what a policy means (Heintz 2009, 4.5.10) always has an answer: if need be the
empty stream. Whoever subscribes would starve without knowing why. What a process promises is
therefore a policy too, its output policy, and a policy is refused when a process that does no
more than it promises would leave it unkept. What is not promised either way is not held against
a policy.
"""

from collections.abc import Callable, Iterator

from dyknow.streams.policy import Approximation, Order, Policy, SampleEvery
from dyknow.time import text_from_duration

__all__ = ["refusal"]


def refusal(offered: Policy, wanted: Policy) -> str | None:
    """Return why a stream that keeps *offered* cannot be made to keep *wanted*, or None."""
    for reason_against in _CONSTRAINTS:
        if reason := reason_against(offered, wanted):
            return reason
    return None


def _change(offered: Policy, wanted: Policy) -> str | None:
    if not isinstance(offered.change, SampleEvery) or not isinstance(wanted.change, SampleEvery):
        return None
    if wanted.approximation is Approximation.MOST_RECENT:
        return None
    for period in offered.change.periods():
        if not _is_served(wanted.change, period, offered.change.deviation):
            return (
                f"the process gives {_sampling(period, offered.change)}, "
                f"{_sampling(wanted.change.period, wanted.change)} cannot be picked out of it"
            )
    return None


def _is_served(wanted: SampleEvery, period: int, deviation: int) -> bool:
    """Return whether samples *period* apart, give or take *deviation*, let *wanted* be kept."""
    shortest, longest = period - deviation, period + deviation
    for aim in wanted.periods():
        first, last = aim - wanted.deviation, aim + wanted.deviation
        if last - first >= longest and last >= longest:
            return True
        steps = -(-first // shortest)
        if steps * longest <= last:
            return True
    return False


def _delay(offered: Policy, wanted: Policy) -> str | None:
    if wanted.approximation is Approximation.MOST_RECENT or offered.max_delay is None:
        return None
    if wanted.allows_delay(offered.max_delay):
        return None
    promised, allowed = _texts(offered.max_delay, wanted.max_delay or 0)
    return f"the process needs a delay of up to {promised}, the policy allows at most {allowed}"


def _duration(offered: Policy, wanted: Policy) -> str | None:
    begins, ends = _texts(offered.first, offered.end or 0)
    first, last = _texts(wanted.first, wanted.end or 0)
    if wanted.end is not None and wanted.end < offered.first:
        return f"the process gives nothing before {begins}, the policy ends at {last}"
    if wanted.approximation is Approximation.MOST_RECENT:
        if wanted.first < offered.first:
            return f"the process gives nothing before {begins} to approximate the value at {first}"
    elif offered.end is not None and offered.end < wanted.first:
        return f"the process gives nothing after {ends}, the policy begins at {first}"
    return None


def _order(offered: Policy, wanted: Policy) -> str | None:
    if wanted.order is Order.STRICT and offered.effective_order is Order.MONOTONE:
        return "the process may give several samples of one valid time, the policy allows one"
    return None


_CONSTRAINTS: tuple[Callable[[Policy, Policy], str | None], ...] = (
    _change,
    _delay,
    _duration,
    _order,
)


def _sampling(period: int, change: SampleEvery) -> str:
    deviation = f" deviation {text_from_duration(change.deviation)}" if change.deviation else ""
    return f"a sample every {text_from_duration(period)}{deviation}"


def _texts(*durations: int) -> Iterator[str]:
    return map(text_from_duration, durations)
