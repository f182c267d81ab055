"""`traffic inspect`: the network of a finished run, its streams, and what went wrong in them."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["inspect"]


def inspect(
    run: Annotated[Path, typer.Argument(help="Folder that 'traffic run' wrote, or a recording.")],
    *,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of tables.")
    ] = False,
    dot: Annotated[
        Path | None, typer.Option(help="Write the network for Graphviz to this new file (.dot).")
    ] = None,
    svg: Annotated[
        Path | None, typer.Option(help="Write a picture of the network to this new file (.svg).")
    ] = None,
) -> None:
    """Show processes, streams, rates, delays, violations and caches of a run; runs nothing."""
    from traffic.commands.showing_networks import show_snapshot
    from traffic.inspecting import check_picture, read_network, write_dot, write_svg

    check_picture(dot, "--dot", ".dot")
    check_picture(svg, "--svg", ".svg")
    network, missing = read_network(run)
    if missing is not None:
        sys.stderr.write(f"traffic: {missing}\n")
    title = run.resolve().name
    if dot is not None:
        write_dot(network, dot, title)
    if svg is not None:
        write_svg(network, svg, title)
    if json:
        sys.stdout.write(network.to_json())
    else:
        show_snapshot(network, title)
