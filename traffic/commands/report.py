"""`traffic report`: show finished runs again."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["report"]


def report(
    runs: Annotated[list[Path], typer.Argument(help="Folders that 'traffic run' wrote.")],
    *,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of tables.")
    ] = False,
) -> None:
    """Show what a run recognised, against the truth, or the scores of several; runs nothing."""
    from pydantic_core import to_json

    from traffic.commands.showing import show_result, show_scores
    from traffic.results import read_result
    from traffic.totals import total_score

    results = [read_result(run) for run in runs]
    total = total_score(results)
    if json:
        document = results[0] if len(results) == 1 else {"runs": results, "score": total}
        sys.stdout.write(to_json(document, indent=1).decode() + "\n")
    elif len(results) == 1:
        show_result(results[0])
    else:
        scores = {str(run): result.score for run, result in zip(runs, results, strict=True)}
        show_scores({**scores, "all": total})
