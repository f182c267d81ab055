"""Runs and experiments on the terminal."""

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.table import Column, Table

from traffic.commands.showing import show_result, show_scores
from traffic.commands.showing_experiments import INTERVALS, share_text, show_cells, show_experiment
from traffic.experiments.beside import Beside, remarks_about
from traffic.experiments.findings import Findings
from traffic.experiments.levels import headings_of
from traffic.reporting.reports import ExperimentsReport, Report

__all__ = ["show_report"]


def show_report(report: Report) -> None:
    """Print a run, the scores of several and their sum, or the measures of experiments."""
    if isinstance(report, ExperimentsReport):
        if len(report.sides) > 1:
            _show_beside(report.beside)
        else:
            _show_findings(report.sides[0])
    elif len(report.results) == 1:
        show_result(*report.results.values())
    else:
        scores = {str(run): result.score for run, result in report.results.items()}
        show_scores({**scores, "all": report.total})


def _show_findings(findings: Findings) -> None:
    if findings.experiment is not None:
        show_experiment(findings.experiment)
        return
    Console().print(_titled(findings), highlight=False)
    show_cells(findings.varying, findings.measures, findings.cells)


def _show_beside(beside: Beside) -> None:
    """Print the shares in the cells that all have, and what they do not have in common.

    If there is no such cell, all are printed.
    """
    console = Console()
    for side in beside.sides:
        console.print(_titled(side), highlight=False)
    for measure in beside.measures:
        console.print(_beside_table(beside, measure))
    for remark in remarks_about(beside):
        console.print(escape(remark), highlight=False)


def _titled(findings: Findings) -> str:
    description = f": {escape(findings.description)}" if findings.description else ""
    return f"[bold]{escape(findings.name)}[/]{description}"


def _beside_table(beside: Beside, measure: str) -> Table:
    names = [*headings_of(beside.factors), *(side.name for side in beside.sides)]
    columns = [Column(escape(name), overflow="fold") for name in names]
    table = Table(*columns, title=escape(measure), box=SIMPLE_HEAD, caption=INTERVALS)
    for row in beside.common or beside.rows:
        levels = [escape(str(level)) for level in row.cell.values()]
        found = ["" if each is None else share_text(each.shares[measure]) for each in row.found]
        table.add_row(*levels, *found)
    return table
