"""The table of a comparison."""

from pydantic_core import to_json
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.table import Column, Table

from traffic.experiments.comparing import Comparison, Difference
from traffic.experiments.levels import headings_of
from traffic.experiments.measures import Share

__all__ = ["json_from_comparison", "show_comparison"]


def show_comparison(comparison: Comparison) -> None:
    """Print both sides of each measure of each cell, and where the difference lies."""
    caption = (
        "in brackets, where the difference lies with a confidence of 95 %, in percent (Newcombe); "
        "of twenty comparisons of equals, one looks clear by chance"
    )
    names = [
        *headings_of([*comparison.differences[0].cell]),
        "measure",
        comparison.one,
        comparison.other,
    ]
    columns = [Column(escape(name), overflow="fold") for name in names]
    widest = Column("difference", min_width=len("difference"))
    table = Table(*columns, widest, box=SIMPLE_HEAD, caption=caption)
    for each in comparison.differences:
        sides = (_share(each.one), _share(each.other))
        levels = [escape(str(level)) for level in each.cell.values()]
        table.add_row(*levels, escape(each.measure), *sides, _difference(each))
    console = Console()
    console.print(table)
    for remark in comparison.remarks:
        console.print(escape(remark), highlight=False)


def json_from_comparison(comparison: Comparison) -> str:
    """Return a comparison as one JSON document."""
    differences = [
        {
            "cell": dict(each.cell),
            "measure": each.measure,
            "one": each.one._asdict(),
            "other": each.other._asdict(),
            **each.interval._asdict(),
            "clear": each.is_clear,
        }
        for each in comparison.differences
    ]
    only = [{"side": name, "cell": dict(cell)} for name, cell in comparison.only]
    sides = {"one": comparison.one, "other": comparison.other}
    document = {**sides, "differences": differences, "only": only, "remarks": comparison.remarks}
    return to_json(document, indent=1).decode()


def _share(share: Share) -> str:
    if share.value is None:
        return "[dim]–[/]"
    return f"{share.value:.1%} [dim]of {share.trials}[/]"


def _difference(each: Difference) -> str:
    if each.one.value is None or each.other.value is None:
        return "[dim]–[/]"
    low, high = each.interval
    text = f"{each.other.value - each.one.value:+.1%} ({100 * low:+.0f} to {100 * high:+.0f})"
    colour = "green" if low > 0 else "red"
    return f"[{colour}]{text}[/]" if each.is_clear else f"[dim]{text}[/]"
