"""`traffic benchmark`: measure, beside published figures and other libraries."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["benchmark"]


def benchmark(
    name: Annotated[
        str,
        typer.Argument(
            help="streams, tables, synchronisation, progression, chronicles, recordings or memory."
        ),
    ],
    *,
    out: Annotated[
        Path | None, typer.Option(help="Write the result and its pictures to this new folder.")
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of tables.")
    ] = False,
    quick: Annotated[
        bool, typer.Option("--quick", help="Small sizes, few repetitions: does it work at all?")
    ] = False,
    duration: Annotated[
        str | None, typer.Option(help="With 'memory': simulated time; default '8h'.")
    ] = None,
) -> None:
    """Measure speed or size, beside published figures and other libraries; takes minutes."""
    from traffic.benchmarks.registry import run_benchmark
    from traffic.commands.showing_benchmarks import progress, show_benchmark

    with progress(name) as on_progress:
        result = run_benchmark(name, on_progress, quick=quick, duration=duration, out=out)
    if json:
        sys.stdout.write(result.model_dump_json(indent=1) + "\n")
    else:
        show_benchmark(result)
    if out is not None:
        sys.stderr.write(f"result and pictures written to {out}\n")
