"""Tables of a network: its processes, its streams, and what went wrong."""

import os
from collections import Counter
from collections.abc import Sequence

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from dyknow.inspection.snapshot import ProcessFigures, Snapshot, StreamFigures
from dyknow.inspection.wording import (
    amount_text,
    count_text,
    delay_text,
    implementation_text,
    rate_text,
)
from dyknow.time import SECOND

__all__ = ["show_snapshot"]

_NARROW = 150
_UNLIMITED = 1_000
_PROCESS_NUMBERS = (
    "depth", "calls", "samples", "CPU s", "share", "cache", "violations",
)  # fmt: skip
_FAULTS = ("violations", "late")
_STREAM_NUMBERS = ("samples", "rate", "delay", "99 %", *_FAULTS)


def show_snapshot(network: Snapshot, title: str) -> None:
    """Print the processes, the streams, and what went wrong in them.

    A file or another program gets lines as long as they need to be, unless `COLUMNS` says how
    long they may be. On a narrow screen, labels are folded rather than cut, and what is
    less important is left out.
    """
    console = _console()
    is_narrow = console.width < _NARROW
    console.print(f"[bold]{escape(title)}[/]: {escape(_summary(network))}", highlight=False)
    console.print(_processes(network, is_narrow=is_narrow))
    console.print(_streams(network, is_narrow=is_narrow))
    faults = [stream for stream in network.streams if stream.violations]
    failed = [process for process in network.processes if process.failures]
    if faults:
        console.print(_violations(faults))
    for process in failed:
        failures = amount_text(process.failures, "failure")
        console.print(f"[red]'{escape(process.label)}' has ended after {failures}[/]")
    if not faults and not failed:
        console.print("[green]no violations, no failures[/]")


def _console() -> Console:
    console = Console()
    is_free = not console.is_terminal and "COLUMNS" not in os.environ
    return Console(width=_UNLIMITED) if is_free else console


def _table(title: str, texts: Sequence[str], numbers: Sequence[str]) -> Table:
    table = Table(box=SIMPLE_HEAD, title=title, title_justify="left")
    for name in texts:
        table.add_column(name, overflow="fold")
    for name in numbers:
        table.add_column(name, justify="right", no_wrap=True)
    return table


def _summary(network: Snapshot) -> str:
    counts = f"{len(network.processes)} processes, {len(network.streams)} streams"
    work = f", {network.seconds:.3g} s of processor time" if network.seconds else ""
    return f"{network.span / SECOND:g} s, {counts}{work}"


def _processes(network: Snapshot, *, is_narrow: bool) -> Table:
    has_faults = any(process.violations for process in network.processes)
    left_out = {"kind", "depth", "calls", "cache"} if is_narrow else set()
    if not has_faults:
        left_out.add("violations")
    rows = [_process_cells(process, network.seconds or 1.0) for process in network.processes]
    texts = [name for name in ("process", "kind", "made of") if name not in left_out]
    numbers = [name for name in _PROCESS_NUMBERS if name not in left_out]
    table = _table("Processes", texts, numbers)
    for row in rows:
        table.add_row(*(row[name] for name in (*texts, *numbers)))
    return table


def _process_cells(process: ProcessFigures, total: float) -> dict[str, str]:
    seconds = process.seconds
    return {
        "process": escape(process.label),
        "kind": process.kind.value,
        "made of": escape(implementation_text(process)),
        "depth": str(process.depth),
        "calls": "–" if process.calls is None else count_text(process.calls),
        "samples": count_text(process.samples),
        "CPU s": "–" if seconds is None else f"{seconds:.2f}",
        "share": "–" if seconds is None else f"{seconds / total:.0%}",
        "cache": _cache(process),
        "violations": _count_of_faults(process.violations),
    }


def _streams(network: Snapshot, *, is_narrow: bool) -> Table:
    """Return a table of streams; receivers of one name that got the same share a row."""
    has_faults = any(stream.violations for stream in network.streams)
    numbers = _STREAM_NUMBERS if has_faults else _STREAM_NUMBERS[: -len(_FAULTS)]
    texts = ("stream",) if is_narrow else ("from", "to", "policy")
    table = _table("Streams", texts, numbers)
    for stream, count in Counter(network.streams).items():
        name = escape(stream.name) + (f" [dim]× {count}[/]" if count > 1 else "")
        cells = [escape(stream.provider), name, escape(stream.policy)]
        if is_narrow:
            policy = f"\n  [dim]with {cells[2]}[/]" if stream.policy else ""
            cells = [f"{cells[0]} → {name}{policy}"]
        figures = (
            count_text(stream.samples),
            rate_text(stream.rate),
            delay_text(stream.mean_delay),
            delay_text(stream.delay_99),
            _count_of_faults(stream.violations),
            _count_of_faults(stream.late),
        )
        table.add_row(*cells, *figures[: len(numbers)])
    return table


def _violations(streams: list[StreamFigures]) -> Table:
    table = _table("Violations", ("stream", "from"), ("violations", "of them late", "of"))
    for stream in sorted(streams, key=lambda stream: -stream.violations):
        table.add_row(
            escape(stream.name),
            escape(stream.provider),
            count_text(stream.violations),
            count_text(stream.late),
            amount_text(stream.samples, "sample"),
        )
    return table


def _cache(process: ProcessFigures) -> str:
    if process.cache_limit is None:
        return "–"
    return f"{process.cached} of {process.cache_limit}"


def _count_of_faults(count: int) -> str:
    return f"[red]{count_text(count)}[/]" if count else ""
