"""The same formulas in other libraries for monitoring, where they are installed.

None of them follows a formula with an unbounded operator that speaks of the future. mstlo and
rtamt get what stands inside `always`, for which they give a verdict at each state: mstlo as soon
as it can, rtamt when the horizon has passed. reelay knows the past alone and gets the formula
that says the same a horizon later. Their times are seconds in mstlo and numbers of states in the
others, which do not know irregular periods.
"""

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from dyknow.time import SECOND, TimePoint
from traffic.benchmarks.machine import missing_distributions, version_of
from traffic.benchmarks.sequences import FORMULAS, FormulaUnderTest

__all__ = ["PEERS", "MonitorPeer", "Step", "installed_peers", "missing_peers"]

PEERS = ("mstlo-python", "reelay", "rtamt")

Step = Callable[[TimePoint, bool], object]
"""Gives one state to a monitor: its time, and whether p is true."""


@dataclass(frozen=True, slots=True)
class MonitorPeer:
    """Another library for monitoring.

    Attributes:
        name: Of the distribution.
        version: Of the installed one.
        monitor: Makes a monitor of a formula.
        is_soon_made: Whether a thousand monitors are made in seconds.
    """

    name: str
    version: str
    monitor: Callable[[FormulaUnderTest], Step]
    is_soon_made: bool


def installed_peers() -> list[MonitorPeer]:
    """Return the peers that are installed."""
    makers = {
        "mstlo-python": (_monitor_of_mstlo, True),
        "reelay": (_monitor_of_reelay, False),
        "rtamt": (_monitor_of_rtamt, True),
    }
    versions = {name: version_of(name) for name in PEERS}
    return [
        MonitorPeer(name, version, *makers[name])
        for name, version in versions.items()
        if version is not None
    ]


def missing_peers() -> list[str]:
    """Return a sentence for each peer that is not installed."""
    return missing_distributions(PEERS)


_EVENTUALLY, _EVENTUALLY_ALWAYS = (formula.name for formula in FORMULAS)

_IN_MSTLO = {
    _EVENTUALLY: "F[0,1](p > 0.5)",
    _EVENTUALLY_ALWAYS: "(!(p > 0.5)) -> (F[0,1](G[0,0.999](p > 0.5)))",
}
_IN_RTAMT = {
    _EVENTUALLY: "out = eventually[0:10](p > 0.5)",
    _EVENTUALLY_ALWAYS: "out = (not(p > 0.5)) -> (eventually[0:10](always[0:9](p > 0.5)))",
}
_IN_REELAY = {
    _EVENTUALLY: "once[0:10]{p: true}",
    _EVENTUALLY_ALWAYS: "(once[19:19]{p: false}) -> (once[0:10](historically[0:9]{p: true}))",
}


def _monitor_of_mstlo(formula: FormulaUnderTest) -> Step:
    library = import_module("mstlo_python")
    parsed = library.parse_formula(_IN_MSTLO[formula.name])
    monitor = library.Monitor(parsed, semantics="EagerQualitative")

    def step(now: TimePoint, value: bool) -> object:  # noqa: FBT001 - as all steps
        return monitor.update("p", float(value), now / SECOND).verdicts()

    return step


def _monitor_of_rtamt(formula: FormulaUnderTest) -> Step:
    specification: Any = import_module("rtamt").StlDiscreteTimeSpecification()
    specification.declare_var("p", "float")
    specification.declare_var("out", "float")
    specification.spec = _IN_RTAMT[formula.name]
    specification.parse()
    specification.pastify()
    number = 0

    def step(_now: TimePoint, value: bool) -> object:  # noqa: FBT001 - as all steps
        nonlocal number
        number += 1
        return specification.update(number - 1, [("p", float(value))])

    return step


def _monitor_of_reelay(formula: FormulaUnderTest) -> Step:
    library = import_module("reelay")
    monitor = library.discrete_timed_monitor(pattern=_IN_REELAY[formula.name], condense=False)

    def step(_now: TimePoint, value: bool) -> object:  # noqa: FBT001 - as all steps
        return monitor.update({"p": value})

    return step
