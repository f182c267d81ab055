"""What a regression suite has and what its replays find, as text and diffs."""

from collections import Counter
from collections.abc import Iterable

from rich.console import Console
from rich.markup import escape

from traffic.regression.listing import Listed
from traffic.regression.manifest import Making
from traffic.regression.regressing import Regression
from traffic.regression.suite import Entry

__all__ = ["show_added", "show_listed", "show_regressions", "show_remade", "show_updated"]

_COLOURS = {"fault": "red", "differs": "red", "as expected": "green"}


def show_regressions(regressions: Iterable[Regression]) -> int:
    """Print each recording as it is done, with its differences; return the exit status."""
    console = Console(soft_wrap=True)
    counts, seconds = Counter[str](), 0.0
    for each in regressions:
        seconds += each.seconds
        verdict = "fault" if each.fault else "differs" if each.difference else "as expected"
        counts[verdict] += 1
        said = f"[{_COLOURS[verdict]}]{verdict}[/]"
        name = escape(f"{each.entry.name:32}")
        console.print(f"{name} {said} ({each.seconds:.1f} s)", highlight=False)
        if each.fault:
            console.print(f"  {escape(each.fault)}", highlight=False)
        for line in each.difference:
            console.print(_coloured(line), highlight=False)
    total = counts.total()
    more = "".join(f", {counts[each]} {each}" for each in ("differs", "fault") if counts[each])
    console.print(
        f"{counts['as expected']} of {total} recordings as expected{more}, in {seconds:.1f} s",
        highlight=False,
    )
    return 2 if counts["fault"] else 1 if counts["differs"] else 0


def show_listed(recordings: Iterable[Listed]) -> None:
    """Print what a suite has."""
    console = Console(soft_wrap=True)
    count, seconds, size = 0, 0.0, 0
    for each in recordings:
        count, seconds, size = count + 1, seconds + each.seconds, size + each.size
        name = f"[bold]{escape(each.entry.name)}[/]"
        if each.fault:
            console.print(f"{name}\n  [red]{escape(each.fault)}[/]", highlight=False)
            continue
        facts = f"{each.made}; {each.view}; {each.seconds:g} s, {each.size / 1000:.0f} kB"
        console.print(name, highlight=False)
        for line in (each.shows, facts, each.expected):
            if line:
                console.print(f"  {escape(line)}", highlight=False)
    console.print(f"{count} recordings, {seconds:g} s, {size / 1e6:.1f} MB", highlight=False)


def show_updated(regressions: Iterable[Regression]) -> int:
    """Print which expectations have changed; return the exit status."""
    console = Console(soft_wrap=True)
    counts = Counter[str]()
    for each in regressions:
        if each.fault:
            console.print(f"[red]{escape(each.fault)}[/]", highlight=False)
        elif each.difference:
            console.print(f"changed {escape(str(each.entry.expected))}", highlight=False)
        counts.update(fault=bool(each.fault), changed=bool(each.difference))
    if not counts["changed"]:
        console.print("nothing has changed")
    return 2 if counts["fault"] else 0


def show_remade(entries: Iterable[tuple[Entry, bool]]) -> None:
    """Print which recordings have been made anew, and of which something else is expected now."""
    console = Console(soft_wrap=True)
    for entry, is_other in entries:
        also = "; what is expected of it has changed" if is_other else ""
        console.print(f"made {escape(str(entry.recording))} anew{also}", highlight=False)


def show_added(entry: Entry, making: Making) -> None:
    """Print what was added."""
    console = Console(soft_wrap=True)
    size = entry.recording.stat().st_size / 1000
    path = escape(str(entry.recording))
    console.print(f"added {path} ({size:.0f} kB); expected:", highlight=False)
    console.print(escape(entry.read_expected()), highlight=False, end="")
    if making.scenario is None:
        why = "its run is not one of a bundled scenario with settings that 'suite.toml' can say"
        console.print(f"it cannot be made again by --remake: {why}", highlight=False)


def _coloured(line: str) -> str:
    colour = {"+": "green", "-": "red", "@": "dim"}.get(line[:1], "default")
    return f"[{colour}]{escape(line)}[/]"
