"""Recordings: how many samples a second of processor time are written and read, and their size.

What is recorded is a stream of numbers, and streams of tables that look like those of cars:
positions, speeds and headings that move on from sample to sample, and a link that stays. All
that makes a file whole is counted: schemas, compression, index, and closing it.
"""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.benchmarks.measuring import Benchmark, OnProgress, Plan, measure, series
from traffic.benchmarks.results import Experiment, Figure, Findings, Measurement
from traffic.benchmarks.workloads import PERIOD

__all__ = ["BENCHMARK"]

_TOPIC = "samples"
_NUMBERS = 0
_N_OBJECTS = (1, 10, 20, 100, 1_000)
_N_VALUES = 200_000
_MOST_SAMPLES = 20_000
_QUICK_SHARE = 100


def run(plan: Plan, on_progress: OnProgress) -> Findings:
    """Write and read recordings of numbers and of tables of more and more objects."""
    share = _QUICK_SHARE if plan.quick else 1
    trials = {n: _Trial(_stream(n, share)) for n in (_NUMBERS, *_N_OBJECTS)}
    with TemporaryDirectory() as folder:
        for n, trial in trials.items():
            trial.path = Path(folder) / f"{n}.mcap"
        measure(trials, 2 if plan.quick else 5, on_progress, what="objects in a table")
    tables = {n: trial for n, trial in trials.items() if n != _NUMBERS}
    experiment = Experiment(
        name="recordings",
        what=f"tables of n objects in {len(_table(0, 1).columns)} columns, a file each",
        x="objects in a table",
        y="samples per second of processor time",
        unit="1/s",
        series=[
            series("write", {n: trial.written for n, trial in tables.items()}),
            series("read", {n: trial.read for n, trial in tables.items()}),
        ],
        logarithmic=True,
    )
    return Findings(experiments=[experiment], figures=_figures(trials))


BENCHMARK = Benchmark("Speed of writing and reading recordings, and their size.", run)


@dataclass(slots=True)
class _Trial:
    """A recording of one stream, made and read once for each repetition."""

    stream: Sequence[Sample[Any]]
    path: Path = Path()
    written: list[float] = field(default_factory=list)
    read: list[float] = field(default_factory=list)
    bytes_per_sample: float = 0.0

    def __call__(self) -> float:
        """Write the recording, read it, and return how long both took."""
        began = time.process_time()
        with Recorder(self.path, metadata={}) as recorder:
            tap = recorder.generator(_TOPIC)
            for sample in self.stream:
                tap(sample)
        wrote = time.process_time()
        with open_recording(self.path) as recording:
            count = sum(1 for _ in recording.samples(_TOPIC))
        ended = time.process_time()
        self.written.append(len(self.stream) / (wrote - began))
        self.read.append(count / (ended - wrote))
        self.bytes_per_sample = self.path.stat().st_size / count
        self.path.unlink()
        return ended - began


def _figures(trials: Mapping[int, _Trial]) -> list[Figure]:
    figures = []
    for n, trial in trials.items():
        what = f"tables of {n} cars" if n != _NUMBERS else "numbers"
        size = Measurement.of([trial.bytes_per_sample])
        if n == _NUMBERS:
            for verb, speeds in (("written", trial.written), ("read", trial.read)):
                value = Measurement.of(speeds)
                figures.append(Figure(name=f"{what} {verb}", unit="1/s", value=value))
        figures.append(Figure(name=f"{what}, size of a sample", unit="bytes", value=size))
    return figures


def _stream(n: int, share: int) -> list[Sample[Any]]:
    """Return a stream of tables of *n* objects, or of numbers, of about the same size each."""
    n_samples = min(_MOST_SAMPLES, _N_VALUES // max(1, n)) // share
    times = [TimePoint(number * PERIOD) for number in range(n_samples)]
    if n == _NUMBERS:
        return [Sample(float(np.sin(at)), now, now) for at, now in enumerate(times)]
    return [Sample(_table(at, n), now, now) for at, now in enumerate(times)]


def _table(at: int, n: int) -> Table:
    """Return cars that have driven for a while; their last digits are as those of real ones."""
    ids = np.arange(n)
    speed = 10 + 5 * np.sin(ids + 0.01 * at)
    heading = np.sin(ids * 0.7 + 0.02 * at)
    columns = {
        "x": 3.7 * ids + speed * at * 0.1,
        "y": 50 * np.sin(ids) + heading,
        "speed": speed,
        "heading": heading,
        "length": 4 + 0.5 * np.cos(ids),
        "link": ids % 12,
        "moving": speed > 3,  # noqa: PLR2004, m/s
    }
    return Table("car", ids, columns)
