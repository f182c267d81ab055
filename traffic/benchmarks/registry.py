"""All benchmarks by name, and running one of them."""

import time
from pathlib import Path

from dyknow.time import Duration, duration_from_text
from traffic.benchmarks import (
    chronicles,
    memory,
    progression,
    recordings,
    streams,
    synchronisation,
    tables,
)
from traffic.benchmarks.machine import this_machine
from traffic.benchmarks.measuring import Benchmark, OnProgress, Plan
from traffic.benchmarks.pictures import write_pictures
from traffic.benchmarks.results import BenchmarkResult
from traffic.errors import RequestError
from traffic.results import run_folder

__all__ = ["BENCHMARKS", "run_benchmark"]

BENCHMARKS: dict[str, Benchmark] = {
    "streams": streams.BENCHMARK,
    "tables": tables.BENCHMARK,
    "synchronisation": synchronisation.BENCHMARK,
    "progression": progression.BENCHMARK,
    "chronicles": chronicles.BENCHMARK,
    "recordings": recordings.BENCHMARK,
    "memory": memory.BENCHMARK,
}

_RESULT_FILE = "benchmark.json"


def run_benchmark(
    name: str,
    on_progress: OnProgress,
    *,
    quick: bool = False,
    duration: str | None = None,
    out: Path | None = None,
) -> BenchmarkResult:
    """Measure what *name* stands for, and write the result and its pictures to *out*.

    Raises:
        RequestError: There is no such benchmark, or it does not simulate a given time.
        ResultError: The folder exists already or cannot be written.
    """
    benchmark = BENCHMARKS.get(name)
    if benchmark is None:
        raise RequestError("NAME", f"one of {', '.join(BENCHMARKS)}", name)
    plan = Plan(quick=quick, duration=_duration(benchmark, duration))
    if out is None:
        return _measured(name, benchmark, plan, on_progress)
    with run_folder(out) as folder:
        result = _measured(name, benchmark, plan, on_progress)
        text = result.model_dump_json(indent=1)
        (folder / _RESULT_FILE).write_text(f"{text}\n", encoding="utf-8")
        write_pictures(result, folder)
    return result


def _measured(
    name: str, benchmark: Benchmark, plan: Plan, on_progress: OnProgress
) -> BenchmarkResult:
    began = time.perf_counter()
    findings = benchmark.run(plan, on_progress)
    return BenchmarkResult(
        benchmark=name,
        what=benchmark.what,
        quick=plan.quick,
        seconds=time.perf_counter() - began,
        machine=this_machine(benchmark.peers),
        findings=findings,
    )


def _duration(benchmark: Benchmark, text: str | None) -> Duration | None:
    if text is None:
        return None
    if not benchmark.has_duration:
        able = ", ".join(each for each, other in BENCHMARKS.items() if other.has_duration)
        raise RequestError("--duration", f"nothing, for it only has a meaning with {able}", text)
    try:
        duration = duration_from_text(text)
    except ValueError as error:
        raise RequestError("--duration", "a time such as '8h' or '10min'", text) from error
    if duration <= 0:
        raise RequestError("--duration", "a time above 0", text)
    return duration
