"""`traffic experiment`: batches of runs."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["experiment"]


def experiment(
    design: Annotated[
        str | None,
        typer.Argument(
            help="A bundled name or a TOML file; without it, the bundled ones are told."
        ),
    ] = None,
    *,
    workers: Annotated[
        int | None, typer.Option(help="Processes of this machine; default: one per processor.")
    ] = None,
    cluster: Annotated[
        str | None, typer.Option(help="Address of a Dask cluster, such as 'tcp://host:8786'.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder; default: 'experiments' and the design's name.")
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with what is in the folder.")
    ] = False,
    check: Annotated[
        bool, typer.Option("--check", help="Only check, and estimate the time; write nothing.")
    ] = False,
    yes: Annotated[bool, typer.Option("--yes", help="Begin, however many runs it is.")] = False,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of tables.")
    ] = False,
) -> None:
    """Do all runs of a design, on processes of this machine or on a cluster, and measure them.

    Exit status: 0 done, 1 all runs failed, 2 the design or an option is at fault.
    """
    from traffic.commands.showing_experiments import (
        experiment_progress,
        show_designs,
        show_estimate,
        show_experiment,
    )
    from traffic.experiments.documents import json_from_experiment
    from traffic.experiments.request import ExperimentRequest
    from traffic.experiments.running import estimate_experiment, run_experiment

    if design is None:
        show_designs()
        return
    request = ExperimentRequest.from_options(
        design=design, workers=workers, cluster=cluster, out=out, resume=resume, yes=yes
    )
    if check:
        show_estimate(estimate_experiment(request))
        return
    with experiment_progress() as on_progress:
        found = run_experiment(request, on_progress)
    if json:
        sys.stdout.write(json_from_experiment(found) + "\n")
    else:
        show_experiment(found)
    sys.stderr.write(f"experiment written to {request.folder}\n")
    if found.has_failed:
        sys.stderr.write("traffic: all runs failed, so nothing was measured\n")
        sys.exit(1)
