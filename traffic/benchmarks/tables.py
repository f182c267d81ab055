"""Delivery of tables: the states of many objects at the price of one sample.

A table is handed on as it is, whatever it holds, so that a stream of the states of a thousand
objects costs what a stream of one value costs. The thesis has a stream for each object.
"""

from collections.abc import Callable, Mapping

import numpy as np

from dyknow.streams.table import Table
from traffic.benchmarks.measuring import Benchmark, OnProgress, Plan, measure, series
from traffic.benchmarks.results import Experiment, Figure, Findings, Measurement
from traffic.benchmarks.workloads import Workload, many_streams

__all__ = ["BENCHMARK"]

_MICROSECONDS = 1e6
_N_STREAMS = 20
_N_OBJECTS = (1, 10, 100, 1_000, 10_000)
_PLAIN = 0
_COMPARED = 1_000


def run(plan: Plan, on_progress: OnProgress) -> Findings:
    """Measure the delay of tables of more and more objects, and of a plain value."""
    workload = Workload(many_streams(_N_STREAMS))
    n_samples, repetitions = (10, 2) if plan.quick else (300, 100)
    values: Mapping[int, object] = {_PLAIN: 1, **{n: _table_of(n) for n in _N_OBJECTS}}
    trials = {n: _trial(workload, n_samples, value) for n, value in values.items()}
    found = measure(trials, repetitions, on_progress, what="objects in a table")
    plain = found.pop(_PLAIN)
    experiment = Experiment(
        name="tables",
        what=f"tables of n objects through {_N_STREAMS} streams, each 'sample every 100', "
        f"{n_samples} samples",
        x="objects in a table",
        y="delay of the stream served last",
        unit="µs",
        series=[series("DyKnow", found)],
        logarithmic=True,
    )
    ratios = [table / value for table, value in zip(found[_COMPARED], plain, strict=True)]
    figures = [
        Figure(name="delay of a number", unit="µs", value=Measurement.of(plain)),
        Figure(
            name=f"delay of a table of {_COMPARED} objects, divided by that of a number",
            unit="",
            value=Measurement.of(ratios),
        ),
    ]
    return Findings(experiments=[experiment], figures=figures)


BENCHMARK = Benchmark("Delay of tables of many objects, beside that of a number.", run)


def _table_of(n: int) -> Table:
    columns = {name: np.zeros(n) for name in ("x", "y", "speed", "heading")}
    return Table("car", np.arange(n), columns)


def _trial(workload: Workload, n_samples: int, value: object) -> Callable[[], float]:
    return lambda: workload.delay(n_samples, value) * _MICROSECONDS
