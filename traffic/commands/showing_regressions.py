"""What the regression suite finds, as a table and diffs."""

from collections.abc import Iterable

from rich.console import Console
from rich.markup import escape

from traffic.regression.regressing import Regression
from traffic.regression.suite import Entry

__all__ = ["show_added", "show_regressions", "show_updated"]


def show_regressions(regressions: Iterable[Regression], total: int) -> bool:
    """Print each recording as it is done, with its differences; return whether there are none."""
    console = Console(soft_wrap=True)
    n_different, seconds = 0, 0.0
    for each in regressions:
        seconds += each.seconds
        n_different += bool(each.difference)
        said = "[red]differs[/]" if each.difference else "[green]as expected[/]"
        console.print(f"{each.entry.name:32} {said} ({each.seconds:.1f} s)", highlight=False)
        for line in each.difference:
            console.print(_coloured(line), highlight=False)
    console.print(
        f"{total - n_different} of {total} recordings as expected, in {seconds:.1f} s",
        highlight=False,
    )
    return n_different == 0


def show_updated(entries: Iterable[Entry]) -> None:
    """Print which expectations have changed."""
    console = Console(soft_wrap=True)
    n_changed = 0
    for entry in entries:
        console.print(f"changed {entry.expected}", highlight=False)
        n_changed += 1
    if not n_changed:
        console.print("nothing has changed")


def show_added(entry: Entry) -> None:
    """Print what was added."""
    console = Console(soft_wrap=True)
    size = entry.recording.stat().st_size / 1000
    console.print(f"added {entry.recording} ({size:.0f} kB); expected:", highlight=False)
    console.print(escape(entry.expected.read_text(encoding="utf-8")), highlight=False, end="")


def _coloured(line: str) -> str:
    colour = {"+": "green", "-": "red", "@": "dim"}.get(line[:1], "default")
    return f"[{colour}]{escape(line)}[/]"
