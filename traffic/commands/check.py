"""`traffic check`: every fault of files that people write."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["check"]


def check(
    files: Annotated[
        list[Path],
        typer.Argument(
            help="KPL (.kpl), chronicles (.chronicle), formulas (.mtl), scenarios (.toml)."
        ),
    ],
) -> None:
    """Report every fault of the files, each with its place; run nothing."""
    from traffic.checking import faults_of_file, warnings_of_file

    n_faults = 0
    for file in files:
        faults = faults_of_file(file)
        n_faults += len(faults)
        for fault in faults:
            sys.stdout.write(fault + "\n")
        if not faults:
            for warning in warnings_of_file(file):
                sys.stdout.write(warning + "\n")
            sys.stdout.write(f"{file}: no faults\n")
    if n_faults:
        sys.exit(2)
