"""Tables and the progress bar of `traffic benchmark`."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from traffic.benchmarks.results import (
    BenchmarkResult,
    Experiment,
    Figure,
    Measurement,
    Published,
    Ratio,
)

__all__ = ["progress", "show_benchmark"]

_MANY = 24
_GIGABYTE = 1e9


@contextmanager
def progress(name: str) -> Iterator[Callable[[float, str], None]]:
    """Give a function to call with the share that is done and what comes next."""
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[next]}"))
    console = Console(stderr=True)
    with Progress(
        *columns, TimeRemainingColumn(), console=console, disable=not sys.stderr.isatty()
    ) as bar:
        task = bar.add_task(f"measuring {name}", total=1.0, next="")

        def on_progress(share: float, what: str) -> None:
            bar.update(task, completed=share, next=what)

        yield on_progress


def show_benchmark(result: BenchmarkResult) -> None:
    """Print what was measured, and on what machine."""
    console = Console()
    machine = result.machine
    size = f"{machine.memory / _GIGABYTE:.0f} GB"
    where = f"{machine.processor}, {machine.cores} cores, {size}, {machine.system}"
    versions = ", ".join(f"{name} {version}" for name, version in machine.versions.items())
    console.print(f"[bold]{escape(result.benchmark)}[/]: {escape(result.what)}", highlight=False)
    console.print(f"[dim]{escape(where)}\n{escape(versions)}[/]", highlight=False)
    for experiment in result.findings.experiments:
        console.print(_curves(experiment))
    if result.findings.figures:
        console.print(_figures(result.findings.figures))
    if result.findings.ratios:
        console.print(_ratios(result.findings.ratios))
    for note in result.findings.notes:
        console.print(f"[dim]{escape(note)}[/]", highlight=False)
    if result.quick:
        console.print("[yellow]Measured with --quick: the figures say little.[/]")


def _curves(experiment: Experiment) -> Table:
    title = f"{experiment.what}\n{experiment.y}, {experiment.unit}: median (least to most)"
    table = Table(experiment.x, box=SIMPLE_HEAD, title=escape(title), title_justify="left")
    for series in experiment.series:
        table.add_column(escape(series.name), justify="right")
    published = experiment.published
    if published is not None:
        table.add_column(escape(f"{published.source}, {published.unit}"), justify="right")
        table.caption = escape(published.remark)
    for at, point in enumerate(experiment.series[0].points):
        if _is_shown(at, len(experiment.series[0].points)):
            cells = [_cell(series.points[at].y) for series in experiment.series]
            table.add_row(_number(point.x), *cells, *_beside(point.x, published))
    return table


def _is_shown(at: int, of: int) -> bool:
    """Return whether row *at* is printed; of very many, some two dozen are."""
    return of <= _MANY or at % (of // _MANY) == 0 or at == of - 1


def _cell(measurement: Measurement) -> str:
    spread = _spread(measurement)
    return (
        f"{_number(measurement.median)} [dim]({spread})[/]"
        if spread
        else _number(measurement.median)
    )


def _beside(x: float, published: Published | None) -> list[str]:
    if published is None:
        return []
    known = dict(published.points)
    return [_number(known[x]) if x in known else ""]


def _figures(figures: list[Figure]) -> Table:
    table = Table("", "median (least to most)", "", "published", box=SIMPLE_HEAD)
    for figure in figures:
        published = escape(figure.published or "")
        table.add_row(escape(figure.name), _cell(figure.value), escape(figure.unit), published)
    return table


def _ratios(ratios: list[Ratio]) -> Table:
    table = Table("peer", "takes … times as long as DyKnow", "to", box=SIMPLE_HEAD)
    for ratio in ratios:
        peer = f"{ratio.peer} {ratio.version}"
        table.add_row(escape(peer), _cell(ratio.times_as_long), escape(ratio.what))
    return table


def _spread(measurement: Measurement) -> str:
    if measurement.repetitions == 1:
        return ""
    return f"{_number(measurement.low)} to {_number(measurement.high)}"


def _number(value: float) -> str:
    if value == int(value):
        return f"{int(value)}"
    return f"{value:.3g}" if abs(value) < 1_000 else f"{value:.0f}"  # noqa: PLR2004
