"""Runs and experiments on the terminal."""

from traffic.commands.showing import show_result, show_scores
from traffic.commands.showing_experiments import show_experiment
from traffic.reporting.reports import ExperimentReport, Report

__all__ = ["show_report"]


def show_report(report: Report) -> None:
    """Print a run, the scores of several and their sum, or the measures of an experiment."""
    if isinstance(report, ExperimentReport):
        show_experiment(report.experiment)
    elif len(report.results) == 1:
        show_result(*report.results.values())
    else:
        scores = {str(run): result.score for run, result in report.results.items()}
        show_scores({**scores, "all": report.total})
