"""`traffic compare`: two experiments, or two runs, side by side."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["compare"]


def compare(
    one: Annotated[
        Path, typer.Argument(help="Folder of an experiment or of a run, or a table (.csv).")
    ],
    other: Annotated[Path, typer.Argument(help="Another one, with the same measures.")],
    *,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of a table.")
    ] = False,
) -> None:
    """Show what differs between two experiments or runs, and whether that may be chance."""
    from traffic.commands.showing_comparisons import json_from_comparison, show_comparison
    from traffic.experiments.comparing import compare as compared
    from traffic.experiments.findings import named_apart, read_findings

    found = compared(*named_apart([read_findings(one), read_findings(other)]))
    if json:
        sys.stdout.write(json_from_comparison(found) + "\n")
    else:
        show_comparison(found)
