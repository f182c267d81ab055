"""Tables and the progress bar of experiments."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as Bar
from rich.table import Column, Table

from traffic.experiments.conducting import OnProgress, Progress
from traffic.experiments.estimating import Estimate
from traffic.experiments.levels import headings_of
from traffic.experiments.measures import Share
from traffic.experiments.reading import bundled_designs, read_design
from traffic.experiments.running import Experiment
from traffic.experiments.tables import CellMeasures

__all__ = [
    "INTERVALS",
    "experiment_progress",
    "share_text",
    "show_cells",
    "show_designs",
    "show_estimate",
    "show_experiment",
]

INTERVALS = "in brackets, where the truth lies with a confidence of 95 %, in percent (Wilson)"
"""What stands below a table of shares."""

_MOST_ERRORS = 10
_ENOUGH = 100
"""From so many of a unit of time on, the next larger one is told."""


@contextmanager
def experiment_progress() -> Iterator[OnProgress]:
    """Give a function to call with how far an experiment has come.

    On a terminal it is shown as a bar, elsewhere as a line of text for each tenth that is done.
    """
    if not sys.stderr.isatty():
        yield _Lines().tell
        return
    columns = (BarColumn(), TextColumn("{task.fields[told]}"))
    with Bar(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task("", told="starting")

        def on_progress(progress: Progress) -> None:
            bar.update(task, completed=progress.done, total=progress.total, told=_told(progress))

        yield on_progress


def show_designs() -> None:
    """Print the designs that come with the program."""
    table = Table("design", "runs", "what", box=SIMPLE_HEAD)
    for name, path in bundled_designs().items():
        design = read_design(path)
        table.add_row(escape(name), f"{design.n_runs:,}", escape(design.description))
    Console().print(table)


def show_estimate(estimate: Estimate) -> None:
    """Print how many runs there are and how long they may take."""
    Console().print(
        f"{estimate.runs:,} runs of {_time(estimate.simulated_seconds)} simulated time in all, "
        + (
            f"about {_time(estimate.seconds)} here"
            if estimate.seconds is not None
            else f"of which the first fails: {escape(estimate.error or '')}"
        ),
        highlight=False,
    )


def show_experiment(experiment: Experiment) -> None:
    """Print the measures of all cells, with the intervals that they lie in."""
    design = experiment.design
    console = Console()
    console.print(f"[bold]{escape(design.name)}[/]: {escape(design.description)}", highlight=False)
    show_cells(design.varying, design.measures, experiment.cells)
    for error in experiment.errors[:_MOST_ERRORS]:
        console.print(f"[red]failed[/]: {escape(error)}", highlight=False)
    if len(experiment.errors) > _MOST_ERRORS:
        console.print(f"and {len(experiment.errors) - _MOST_ERRORS} more", highlight=False)


def show_cells(
    varying: Sequence[str], measures: Sequence[str], cells: Sequence[CellMeasures]
) -> None:
    """Print a row for each cell."""
    names = [*headings_of(varying), "runs", "failed", *measures]
    columns = [Column(escape(name), overflow="fold") for name in names]
    table = Table(*columns, box=SIMPLE_HEAD, caption=INTERVALS)
    for cell in cells:
        levels = [escape(str(cell.cell[name])) for name in varying]
        shares = [share_text(cell.shares[measure]) for measure in measures]
        table.add_row(*levels, str(cell.runs), str(cell.failed or ""), *shares)
    Console().print(table)


def share_text(share: Share) -> str:
    """Return a share with its interval, as it is printed."""
    if share.value is None:
        return "[dim]–[/]"
    low, high = share.interval
    return f"{share.value:.1%} [dim]({100 * low:.0f}–{100 * high:.0f})[/]"


class _Lines:
    """Tells in lines how far an experiment has come."""

    def __init__(self) -> None:
        self._tenths = 0

    def tell(self, progress: Progress) -> None:
        tenths = 10 * progress.done // progress.total
        if tenths > self._tenths:
            self._tenths = tenths
            sys.stderr.write(f"{_told(progress)}\n")


def _told(progress: Progress) -> str:
    failed = f", {progress.failed} failed" if progress.failed else ""
    left = progress.seconds_left
    time_left = "" if left is None else f", {_time(left)} left"
    rate = "" if progress.rate is None else f", {progress.rate:.1f}/s"
    done = f"{progress.done} of {progress.total} done"
    return f"{done}{failed}, {progress.running} running{rate}{time_left}"


def _time(seconds: float) -> str:
    if seconds < _ENOUGH:
        return f"{seconds:.0f} s"
    minutes = seconds / 60
    return f"{minutes:.0f} min" if minutes < _ENOUGH else f"{minutes / 60:.1f} h"
