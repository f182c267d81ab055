"""A system at work: kept to a pace, its recognitions collected and scored."""

import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

from chronicles.events import Recognition
from dyknow.runtime.clock import WallClock
from dyknow.runtime.failures import Failure
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.names import input_name
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.service.governor import GovernorSettings, LoadGovernor
from dyknow.streams.sample import Sample
from dyknow.time import MILLISECOND, SECOND, Duration, TimePoint, text_from_duration
from traffic.errors import RequestError
from traffic.features.reckless import RecklessCars
from traffic.origin import Origin
from traffic.overlaying import Overlay
from traffic.recording.periods import KeepPeriods
from traffic.request import View
from traffic.results import Lateness, RecklessDriverResult, RunResult, Timing
from traffic.scoring.score import Scorer, Verdict, unjudged
from traffic.system import (
    MonitoringSystem,
    outputs_of_sort,
)

__all__ = ["IMAGES", "Companion", "OnProgress", "Told", "Watch", "told_of"]

IMAGES = ("colour_images", "thermal_images")
"""The output streams that a film needs beside the cars."""

_CARS = "cars"
_RECOGNITIONS = "recognitions"
_RECKLESS_DRIVERS = "reckless_drivers"

OnProgress = Callable[[float, float], None]
"""Told the seconds simulated so far and the seconds in all."""


class Companion(Protocol):
    """Keeps pace with a run."""

    def advance(self, now: TimePoint) -> None:
        """Take note that the work of the instant *now* begins."""

    def finish(self) -> None:
        """Take note that the run is over."""


@dataclass(frozen=True, slots=True)
class Told:
    """What a result says of a run that the run itself does not find out.

    Attributes:
        scenario: Name of the scenario.
        settings: What was asked for.
        duration: How long the run is to be.
        deadline: In real time, how late the work of an instant may be done.
    """

    scenario: str
    settings: Mapping[str, str | int | float | None]
    duration: Duration
    deadline: Duration


def told_of(origin: Origin) -> Told:
    """Return what a result says of a run with this origin."""
    asked, scenario = origin.request, origin.scenario
    settings: dict[str, str | int | float | None] = {
        "view": asked["view"],
        "seed": asked["seed"],
        "sample period ms": int(asked["sample_period_ns"] or 0) / MILLISECOND,
        "position noise m": asked["position_noise"] if asked["view"] == View.TRUTH else None,
        "duration s": scenario.duration / SECOND,
        "changes": asked.get("changes"),
    }
    return Told(scenario.name, settings, scenario.duration, scenario.step_length)


class Watch:
    """A system at work: what it recognises is collected, and scored if the truth is known.

    Args:
        system: The system, before it runs.
        scorer: Knows the truth, from outside; None if nothing does.
        is_governed: Whether streams may stand back when the work falls behind the clock.

    Attributes:
        keep_periods: Told what has been changed because of that.
    """

    def __init__(
        self, system: MonitoringSystem, scorer: Scorer | None, *, is_governed: bool = True
    ) -> None:
        self.keep_periods: KeepPeriods = lambda _: None
        self._is_governed = is_governed
        self._network = system.network
        self._scorer = scorer if _CARS in outputs_of_sort(system.specification, _CARS) else None
        self._recognitions: list[Recognition] = []
        self._violations: Counter[str] = Counter()
        self._last_violation: StreamViolation | None = None
        self._failures: list[str] = []
        told = set(outputs_of_sort(system.specification, _RECOGNITIONS))
        self._outputs = [name for name in self._network.outputs if name in told]
        reckless = outputs_of_sort(system.specification, _RECKLESS_DRIVERS)
        self._reckless = [name for name in self._network.outputs if name in reckless]
        self._reckless_cars = RecklessCars()
        for output in self._reckless:
            self._network.subscribe(output, self._reckless_cars.receive)
        if self._scorer is not None:
            self._network.subscribe(_CARS, self._scorer.observe_cars)
        for output in self._outputs:
            self._network.subscribe(output, self._note)
        self._network.kernel.subscribe_violations(self._count)
        self._network.kernel.subscribe_failures(self._report)

    def show(self, overlay: Overlay) -> None:
        """Let *overlay* receive what it shows.

        Raises:
            RequestError: The system has no cars.
        """
        if _CARS not in self._network.outputs:
            expected = f"a specification with an output stream '{_CARS}'"
            raise RequestError("--overlay", expected, "none")
        colour, thermal = IMAGES
        self._network.subscribe(colour, overlay.receive_colour)
        self._network.subscribe(thermal, overlay.receive_thermal)
        self._network.subscribe(_CARS, overlay.receive_cars)
        for output in self._outputs:
            self._network.subscribe(output, overlay.receive_recognitions)
        for output in self._reckless:
            self._network.subscribe(output, overlay.receive_reckless_drivers)

    def complete(
        self,
        told: Told,
        on_progress: OnProgress,
        companion: Companion | None = None,
        *,
        real_time: bool = False,
    ) -> RunResult:
        """Run to the end and judge what was recognised.

        The *companion* keeps pace with it. In *real_time* an instant is worked on when it is
        that time on the clock on the wall; nothing else changes, unless the specification allows
        streams to stand back when the work falls behind.
        """
        total = told.duration / SECOND
        kernel = self._network.kernel
        pace = _Pace(kernel, told.deadline) if real_time else None

        def tell(now: TimePoint) -> None:
            if pace is not None and self._is_governed and pace.has_changed(now):
                self.keep_periods(pace.governor.changes)
            if companion is not None:
                companion.advance(now)
            on_progress(now / SECOND, total)

        began = time.perf_counter()
        kernel.run(TimePoint(told.duration), tell, pace.clock if pace else None)
        wall = time.perf_counter() - began
        if companion is not None:
            companion.finish()
        verdict = self._verdict()
        return RunResult(
            scenario=told.scenario,
            settings=dict(told.settings),
            recognitions=verdict.recognitions,
            missed=verdict.missed,
            score=verdict.score,
            timing=Timing(
                simulated_s=total,
                wall_s=wall,
                real_time_factor=total / wall,
                stages={str(label): each.seconds for label, each in kernel.accounts.items()},
                lateness=pace.lateness() if pace else None,
            ),
            violations=dict(self._violations),
            failures=self._failures,
            reckless_drivers=self._reckless_drivers() if self._reckless else None,
        )

    def _verdict(self) -> Verdict:
        self._recognitions.sort(key=lambda recognition: (recognition.begin, recognition.end))
        if self._scorer is None:
            return unjudged(self._recognitions)
        return self._scorer.judge(self._recognitions)

    def _reckless_drivers(self) -> list[RecklessDriverResult]:
        return [
            RecklessDriverResult(
                symbol=each.symbol,
                car=each.car,
                since=each.since / MILLISECOND,
                until=None if each.until is None else each.until / MILLISECOND,
                acts=each.n_acts,
                last_act_at=each.last_act_at / MILLISECOND,
            )
            for each in self._reckless_cars.found
        ]

    def _note(self, sample: Sample[tuple[Recognition, ...]]) -> None:
        self._recognitions.extend(sample.value)

    def _count(self, violation: StreamViolation) -> None:
        """Count a violation; once, if several who are called alike have the stream."""
        name, last = _name_of(violation), self._last_violation
        self._last_violation = violation
        is_known = last is not None and last.violation is violation.violation
        if not (is_known and last is not None and _name_of(last) == name):
            self._violations[name] += 1

    def _report(self, failure: Failure) -> None:
        at = text_from_duration(failure.time)
        self._failures.append(f"process '{failure.label}' failed at {at} ms: {failure.text}")


def _name_of(violation: StreamViolation) -> str:
    """Return what a stream is called: an input by its number, an output by its provider."""
    if violation.number:
        return input_name(violation.receiver, violation.number)
    if violation.receiver == violation.provider:
        return violation.receiver
    return f"{violation.provider} for {violation.receiver}"


class _Pace:
    """The clock on the wall, and the governor of what may stand back when work is late by it."""

    def __init__(self, kernel: Kernel, deadline: Duration) -> None:
        self.clock = WallClock(deadline)
        settings = GovernorSettings(late_after=deadline)
        self.governor = LoadGovernor(kernel, lambda: self.clock.last_lateness, settings)

    def has_changed(self, now: TimePoint) -> bool:
        """Let streams stand back, or no longer; return whether any did."""
        before = len(self.governor.changes)
        self.governor.watch(now)
        return len(self.governor.changes) > before

    def lateness(self) -> Lateness:
        """Return how late the work was done."""
        late = self.clock.lateness
        return Lateness(
            max_ms=late.largest / MILLISECOND,
            mean_ms=late.mean / MILLISECOND,
            late_share=self.clock.n_missed / late.samples if late.samples else 0.0,
            period_changes=len(self.governor.changes),
        )
