"""`traffic network`: road networks, from plain XML to what the map says of them."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["app"]

app = typer.Typer(no_args_is_help=True, help="Build road networks, and show what a map knows.")


@app.command()
def build(
    source: Annotated[Path, typer.Argument(help="Folder with SUMO's plain XML (.nod, .edg, …).")],
    target: Annotated[Path, typer.Argument(help="The network to write (.net.xml).")],
    *,
    left_hand: Annotated[
        bool, typer.Option("--left-hand", help="Vehicles drive on the left.")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Replace a file that exists already.")
    ] = False,
) -> None:
    """Compile a network with netconvert (needs the extra 'build')."""
    from traffic.errors import RequestError
    from traffic.sumo.building import build_network

    if target.exists() and not force:
        raise RequestError("TARGET", "a file that does not exist yet (or --force)", target)
    build_network(source, target, left_hand=left_hand)
    sys.stdout.write(f"{target}\n")


@app.command()
def show(
    network: Annotated[Path, typer.Argument(help="A compiled network (.net.xml).")],
    *,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of a table.")
    ] = False,
) -> None:
    """List the crossings, the links that meet there, and how one turns between them."""
    from traffic.commands.showing import show_network
    from traffic.maps import summary_of_map

    summary = summary_of_map(network)
    if json:
        sys.stdout.write(summary.model_dump_json(indent=1) + "\n")
    else:
        show_network(summary)
