"""Progression: what it costs to follow one formula or a million, state by state.

These are the experiments of Heintz (2009), section 7.10, with the two formulas and all sequences
of states, at a regular period and at irregular ones. One formula is followed through the public
call, which gets a state as a mapping; of more, all are followed at once, with the truth of the
proposition given for each. There the objects are at different places of the sequence, except
where the time of each state is told, for which the thesis has them all do the same. Times are
those of the processor.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import psutil

from dyknow.mtl.monitors import Monitor, MonitorColumns
from dyknow.mtl.progression import ProgressionTable
from dyknow.time import TimePoint
from traffic.benchmarks.measuring import (
    Benchmark,
    OnProgress,
    Plan,
    line_through,
    measure,
    series,
    undisturbed,
)
from traffic.benchmarks.monitor_peers import PEERS, MonitorPeer, installed_peers, missing_peers
from traffic.benchmarks.results import (
    Experiment,
    Figure,
    Findings,
    Measurement,
    Published,
    Ratio,
    Series,
)
from traffic.benchmarks.sequences import (
    FORMULAS,
    JITTERS,
    Alternation,
    FormulaUnderTest,
    times,
    truth,
)

__all__ = ["BENCHMARK"]

_MICROSECONDS, _MEGABYTE = 1e6, 1e6
_NANOSECONDS = 1e3
"""In a microsecond."""

_IN_TIME = 100_000
"""Microseconds until the next state."""

_REGULAR, _WITH_JITTER = 0, 1
_N_VARIANTS = 16
_AT_ONCE = 1_000
_MACHINE = "DRC computer of the UAV, a Pentium-M of 1.4 GHz"


@dataclass(frozen=True, slots=True)
class _Sizes:
    """How much is measured.

    Attributes:
        n_states: For each number of objects, how many states are seen.
        n_shown: Of how many states the time of each is told.
        n_states_of_peers: How many states the other libraries see.
        n_objects_of_peers: How many monitors they have, where there are many.
        repetitions: How often everything is measured.
    """

    n_states: Mapping[int, int]
    n_shown: int
    n_states_of_peers: int
    n_objects_of_peers: int
    repetitions: int


_FULL = _Sizes({1: 20_000, 1_000: 2_000, 100_000: 200, 1_000_000: 44}, 88, 2_000, 1_000, 5)
_QUICK = _Sizes({1: 200, 1_000: 44}, 44, 44, 2, 2)


def run(plan: Plan, on_progress: OnProgress) -> Findings:
    """Measure both formulas, and other libraries with them."""
    sizes = _QUICK if plan.quick else _FULL
    experiments: list[Experiment] = []
    figures: list[Figure] = []
    for at, under_test in enumerate(FORMULAS):
        bench = _Bench(under_test, sizes, on_progress, (0.4 * at, 0.4 * (at + 1)))
        experiments += [bench.averages(), bench.with_jitter(), bench.state_by_state()]
        figures += bench.figures()
    memory = psutil.Process().memory_info().rss / _MEGABYTE
    n_objects = max(sizes.n_states)
    figures.append(
        Figure(
            name=f"memory of the program with {n_objects} objects",
            unit="MB",
            value=Measurement.of([memory]),
        )
    )
    on_progress(0.8, "other libraries")
    ratios = [
        ratio
        for peer in installed_peers()
        for under_test in FORMULAS
        for ratio in _ratios(peer, under_test, sizes)
    ]
    on_progress(1.0, "")
    return Findings(experiments=experiments, figures=figures, ratios=ratios, notes=missing_peers())


BENCHMARK = Benchmark(
    "Time of one formula and state, for one formula up to a million.", run, PEERS
)


class _Bench:
    """The measurements of one formula."""

    def __init__(
        self,
        under_test: FormulaUnderTest,
        sizes: _Sizes,
        on_progress: OnProgress,
        within: tuple[float, float],
    ) -> None:
        self._under_test = under_test
        self._sizes = sizes
        self._on_progress = on_progress
        begin, end = within
        self._parts = [begin + (end - begin) * share for share in (0, 0.45, 0.9, 1)]
        self._table = ProgressionTable(under_test.formula)
        self._shares: list[Figure] = []

    def averages(self) -> Experiment:
        """Measure all sequences at the regular period."""
        under_test = self._under_test
        curves = {str(each): (each, 0.0) for each in under_test.alternations}
        return Experiment(
            name=f"{under_test.name}-average",
            what=f"{under_test.text}, a state every 100 ms",
            x="formulas at once",
            y="average time for a state",
            unit="µs",
            series=self._by_number(curves, _REGULAR),
            published=Published(
                source=f"Heintz (2009), figure {under_test.average}",
                unit="µs",
                points=[(n, n * _IN_TIME / under_test.at_once) for n in self._sizes.n_states],
                remark=f"from the text: {under_test.at_once} formulas in 100 ms with "
                f"{under_test.worst}; {_MACHINE}",
            ),
            logarithmic=True,
        )

    def with_jitter(self) -> Experiment:
        """Measure the worst sequence at periods that vary."""
        under_test = self._under_test
        curves = {f"± {jitter:.0%}": (under_test.worst, jitter) for jitter in JITTERS}
        return Experiment(
            name=f"{under_test.name}-jitter",
            what=f"{under_test.text},\n{under_test.worst}, about every 100 ms",
            x="formulas at once",
            y="average time for a state",
            unit="µs",
            series=self._by_number(curves, _WITH_JITTER),
            logarithmic=True,
        )

    def state_by_state(self) -> Experiment:
        """Measure each state of a thousand formulas that do the same."""
        under_test = self._under_test
        n_shown = self._sizes.n_shown
        curves = [self._each_state(each) for each in under_test.alternations]
        return Experiment(
            name=f"{under_test.name}-by-state",
            what=f"{under_test.text}, {_AT_ONCE} times",
            x="state",
            y=f"time for {_AT_ONCE} formulas",
            unit="µs",
            series=curves,
            published=Published(
                source=f"Heintz (2009), figure {under_test.by_state}",
                unit="ms",
                points=[(at, under_test.published(at)) for at in range(n_shown)],
                remark=f"{under_test.remark}; {_MACHINE}",
            ),
        )

    def figures(self) -> list[Figure]:
        """Return what the curves do not show: times for one formula, and with empty tables."""
        under_test = self._under_test
        first = [
            max(self._times_of_states(ProgressionTable(under_test.formula), under_test.worst))
            for _ in range(self._sizes.repetitions)
        ]
        longest = Figure(
            name=f"{under_test.text}: longest time for {_AT_ONCE} formulas and a state, the "
            "first time",
            unit="µs",
            value=Measurement.of(first),
        )
        return [*self._shares, longest]

    def _by_number(
        self, curves: Mapping[str, tuple[Alternation, float]], part: int
    ) -> list[Series]:
        trials = {
            (name, n): self._trial(alternation, jitter, n)
            for name, (alternation, jitter) in curves.items()
            for n in self._sizes.n_states
        }
        within = (self._parts[part], self._parts[part + 1])
        found = measure(trials, self._sizes.repetitions, self._on_progress, within, "formulas")
        if part == _WITH_JITTER:
            self._shares = [self._share(name, n, found[name, n]) for name, n in trials]
        return [
            _fitted(series(name, {n: found[name, n] for n in self._sizes.n_states}))
            for name in curves
        ]

    def _share(self, name: str, n: int, found: Sequence[float]) -> Figure:
        """Return the time for one of *n* formulas."""
        under_test = self._under_test
        return Figure(
            name=f"{under_test.text}, {name}: one formula of {n}, one state",
            unit="ns",
            value=Measurement.of([each / n * _NANOSECONDS for each in found]),
            published=f"{under_test.least:.0f} to {under_test.most:.0f} µs (Heintz 2009, 7.10)",
        )

    def _trial(self, alternation: Alternation, jitter: float, n: int) -> Callable[[], float]:
        at = times(self._sizes.n_states[n], jitter)
        if n == 1:
            return lambda: _time_of_one(self._table, at, truth(alternation, at))
        variants = np.array([truth(alternation, at, before) for before in range(_N_VARIANTS)])
        return lambda: _time_of_many(self._table, at, variants, n)

    def _each_state(self, alternation: Alternation) -> Series:
        """Return the time of each state, when the tables have been filled before."""
        self._times_of_states(self._table, alternation)
        found = [
            self._times_of_states(self._table, alternation) for _ in range(self._sizes.repetitions)
        ]
        by_state = {at: list(each) for at, each in enumerate(zip(*found, strict=True))}
        return series(str(alternation), by_state)

    def _times_of_states(self, table: ProgressionTable, alternation: Alternation) -> list[float]:
        """Return the microseconds that each state of a thousand formulas takes."""
        at = times(self._sizes.n_shown, 0.0)
        values = truth(alternation, at)
        columns = MonitorColumns(table)
        columns.add(_AT_ONCE)
        found = []
        with undisturbed():
            for now, value in zip(at, values.tolist(), strict=True):
                given = np.full((1, _AT_ONCE), value)
                began = time.process_time()
                columns.step(now, given)
                found.append((time.process_time() - began) * _MICROSECONDS)
        return found


def _fitted(curve: Series) -> Series:
    """Return a curve with a line through all points but the first, which is measured otherwise."""
    return curve.model_copy(update={"line": line_through(curve.points[1:])})


def _time_of_one(
    table: ProgressionTable, at: Sequence[TimePoint], values: npt.NDArray[np.bool_]
) -> float:
    """Return the microseconds for a state of one formula, given as a mapping."""
    given = [(now, {"p": value}) for now, value in zip(at, values.tolist(), strict=True)]
    step = Monitor(table).step
    with undisturbed():
        began = time.process_time()
        for now, state in given:
            step(now, state)
        elapsed = time.process_time() - began
    return elapsed / len(given) * _MICROSECONDS


def _time_of_many(
    table: ProgressionTable,
    at: Sequence[TimePoint],
    variants: npt.NDArray[np.bool_],
    n: int,
) -> float:
    """Return the microseconds for a state of *n* formulas that are followed at once."""
    columns = MonitorColumns(table)
    columns.add(n)
    elapsed = 0.0
    with undisturbed():
        for number, now in enumerate(at):
            given = np.resize(variants[:, number], (1, n))
            began = time.process_time()
            columns.step(now, given)
            elapsed += time.process_time() - began
    return elapsed / len(at) * _MICROSECONDS


def _ratios(peer: MonitorPeer, under_test: FormulaUnderTest, sizes: _Sizes) -> list[Ratio]:
    """Compare one monitor with one of ours, and many with as many of ours."""
    at = times(sizes.n_states_of_peers, 0.0)
    table = ProgressionTable(under_test.formula)
    found = []
    for alternation in (under_test.alternations[0], under_test.worst):
        values = truth(alternation, at)
        _time_of_one(table, at, values)  # which fills the tables
        ratios = [
            _time_of_peer(peer, under_test, at, values) / _time_of_one(table, at, values)
            for _ in range(sizes.repetitions)
        ]
        found.append(_ratio(peer, f"{under_test.text}, {alternation}", ratios))
    n = sizes.n_objects_of_peers
    if peer.is_soon_made:
        at = times(44, 0.0)
        values = truth(under_test.worst, at)
        theirs = _time_of_peer(peer, under_test, at, values, n)
        ratios = [
            theirs / _time_of_many(table, at, values[None, :], n) for _ in range(sizes.repetitions)
        ]
        found.append(_ratio(peer, f"{under_test.text}, {under_test.worst}, {n} times", ratios))
    return found


def _ratio(peer: MonitorPeer, what: str, ratios: Sequence[float]) -> Ratio:
    return Ratio(
        peer=peer.name, version=peer.version, what=what, times_as_long=Measurement.of(ratios)
    )


def _time_of_peer(
    peer: MonitorPeer,
    under_test: FormulaUnderTest,
    at: Sequence[TimePoint],
    values: npt.NDArray[np.bool_],
    n: int = 1,
) -> float:
    """Return the microseconds for a state of *n* monitors of a peer."""
    steps = [peer.monitor(under_test) for _ in range(n)]
    given = list(zip(at, values.tolist(), strict=True))
    with undisturbed():
        began = time.process_time()
        for now, value in given:
            for step in steps:
                step(now, value)
        elapsed = time.process_time() - began
    return elapsed / len(given) * _MICROSECONDS
