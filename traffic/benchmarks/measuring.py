"""How a benchmark is asked for, and how a measurement is repeated.

Repetitions are taken in rounds, each of which measures everything once, so that a machine that
becomes slower or faster meanwhile does so for all of them.
"""

import gc
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from dyknow.time import Duration
from traffic.benchmarks.results import Findings, Line, Measurement, Point, Series

__all__ = ["Benchmark", "OnProgress", "Plan", "line_through", "measure", "series", "undisturbed"]

Key = TypeVar("Key", bound=Hashable)

OnProgress = Callable[[float, str], None]
"""Told which share of the work is done, and what comes next."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What is asked of a benchmark.

    Attributes:
        quick: Only show that it works: few repetitions, small sizes.
        duration: How much time is to be simulated, where that can be chosen; None for what is
            usual.
    """

    quick: bool = False
    duration: Duration | None = None


@dataclass(frozen=True, slots=True)
class Benchmark:
    """Something that can be measured.

    Attributes:
        what: What is measured, as a sentence.
        run: Measures.
        peers: The distributions that it is compared with where they are installed.
        has_duration: Whether `Plan.duration` means something to it.
    """

    what: str
    run: Callable[[Plan, OnProgress], Findings]
    peers: tuple[str, ...] = ()
    has_duration: bool = False


def measure(
    trials: Mapping[Key, Callable[[], float]],
    repetitions: int,
    on_progress: OnProgress,
    within: tuple[float, float] = (0.0, 1.0),
    what: str = "",
) -> dict[Key, list[float]]:
    """Return what each of *trials* gave, as often as there are *repetitions*.

    *within* says which part of the whole benchmark this is, from 0 to 1, and *what* is what the
    keys are numbers of.
    """
    begin, end = within
    found: dict[Key, list[float]] = {key: [] for key in trials}
    steps = repetitions * len(trials) or 1
    step = 0
    for _ in range(repetitions):
        for key, trial in trials.items():
            on_progress(begin + (end - begin) * step / steps, f"{key} {what}")
            found[key].append(trial())
            step += 1
    on_progress(end, "")
    return found


def series(name: str, found: Mapping[int, Sequence[float]], *, fitted: bool = False) -> Series:
    """Return measurements by x as a curve."""
    points = [Point(x=x, y=Measurement.of(values)) for x, values in sorted(found.items())]
    return Series(name=name, points=points, line=line_through(points) if fitted else None)


def line_through(points: Sequence[Point]) -> Line:
    """Return the line with the least squares of relative distance to the medians.

    Relative, because a measurement is uncertain by a share of its size.
    """
    x = np.array([point.x for point in points])
    y = np.array([point.y.median for point in points])
    weights = 1.0 / np.maximum(y, np.finfo(float).tiny)
    rows = np.column_stack([x, np.ones_like(x)]) * weights[:, None]
    (slope, intercept), *_ = np.linalg.lstsq(rows, y * weights)
    return Line(slope=float(slope), intercept=float(intercept))


@contextmanager
def undisturbed() -> Iterator[None]:
    """Let no garbage be collected while the block lasts."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()
