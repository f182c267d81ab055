"""Tables of a network: its processes, its streams, and what went wrong."""

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


def show_snapshot(network: Snapshot, title: str) -> None:
    """Print the processes, the streams, and what went wrong in them."""
    console = Console()
    console.print(f"[bold]{escape(title)}[/]: {escape(_summary(network))}", highlight=False)
    console.print(_processes(network))
    console.print(_streams(network))
    faults = [stream for stream in network.streams if stream.violations]
    failed = [process for process in network.processes if process.failures]
    if faults:
        console.print(_violations(faults))
    for process in failed:
        failures = amount_text(process.failures, "failure")
        console.print(f"[red]'{escape(process.label)}' has ended after {failures}[/]")
    if not faults and not failed:
        console.print("[green]no violations, no failures[/]")


def _summary(network: Snapshot) -> str:
    counts = f"{len(network.processes)} processes, {len(network.streams)} streams"
    work = f", {network.seconds:.3g} s of processor time" if network.seconds else ""
    return f"{network.span / SECOND:g} s, {counts}{work}"


def _processes(network: Snapshot) -> Table:
    table = Table("process", "kind", "made of", box=SIMPLE_HEAD, title="Processes")
    for name in ("depth", "calls", "samples", "CPU s", "share", "cache", "violations"):
        table.add_column(name, justify="right")
    total = network.seconds or 1.0
    for process in network.processes:
        table.add_row(
            escape(process.label),
            process.kind.value,
            escape(implementation_text(process)),
            str(process.depth),
            "–" if process.calls is None else count_text(process.calls),
            count_text(process.samples),
            "–" if process.seconds is None else f"{process.seconds:.2f}",
            "–" if process.seconds is None else f"{process.seconds / total:.0%}",
            _cache(process),
            _count_of_faults(process.violations),
        )
    return table


def _streams(network: Snapshot) -> Table:
    table = Table("from", "to", "policy", box=SIMPLE_HEAD, title="Streams")
    for name in ("samples", "rate", "delay", "99 %", "violations", "late"):
        table.add_column(name, justify="right")
    for stream in network.streams:
        table.add_row(
            escape(stream.provider),
            escape(stream.name),
            escape(stream.policy),
            count_text(stream.samples),
            rate_text(stream.rate),
            delay_text(stream.mean_delay),
            delay_text(stream.delay_99),
            _count_of_faults(stream.violations),
            _count_of_faults(stream.late),
        )
    return table


def _violations(streams: list[StreamFigures]) -> Table:
    table = Table("stream", "from", "violations", "of them late", "of", box=SIMPLE_HEAD)
    table.title = "Violations"
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
