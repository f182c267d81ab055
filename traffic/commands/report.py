"""`traffic report`: show a finished run again."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["report"]


def report(
    run: Annotated[Path, typer.Argument(help="Folder that 'traffic run' wrote.")],
    *,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of tables.")
    ] = False,
) -> None:
    """Show what a run recognised, against the truth; runs nothing."""
    from traffic.commands.showing import show_result
    from traffic.results import read_result

    result = read_result(run)
    if json:
        sys.stdout.write(result.model_dump_json(indent=1) + "\n")
    else:
        show_result(result)
