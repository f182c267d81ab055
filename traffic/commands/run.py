"""`traffic run`: simulate, watch, recognise, score."""

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["run"]


def run(
    scenario: Annotated[
        str | None, typer.Argument(help="A bundled name (see 'traffic scenarios') or a TOML file.")
    ] = None,
    *,
    sumocfg: Annotated[
        Path | None, typer.Option(help="Any SUMO configuration, instead of a scenario.")
    ] = None,
    look_at: Annotated[
        str | None, typer.Option(help="Hover over this crossing (junction id) or point 'x,y'.")
    ] = None,
    view: Annotated[
        str,
        typer.Option(help="'vision': through the cameras; 'truth': positions of the simulator."),
    ] = "vision",
    recognise: Annotated[
        str | None,
        typer.Option(
            help="What: names such as 'turns,overtakes', or 'all'; default: the scenario's."
        ),
    ] = None,
    sample_period: Annotated[
        str, typer.Option(help="Period of the reasoning: milliseconds, or with a unit.")
    ] = "100",
    position_noise: Annotated[
        float, typer.Option(help="With --view truth: largest error per axis, metres.")
    ] = 0.0,
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 1,
    duration: Annotated[
        str | None, typer.Option(help="Simulated time, such as '60s'; default: the scenario's.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the run; default: a new one in 'runs'.")
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document instead of tables.")
    ] = False,
    overlay: Annotated[
        Path | None, typer.Option(help="Write both camera views with what is believed (.mp4).")
    ] = None,
    record: Annotated[
        Path | None, typer.Option(help="Write every stream to this file (.mcap).")
    ] = None,
    streams: Annotated[
        str | None, typer.Option(help="With --record: only these labels, separated by commas.")
    ] = None,
    record_images: Annotated[
        bool,
        typer.Option("--record-images", help="With --record: images too, as JPEG to look at."),
    ] = False,
    specification: Annotated[
        Path | None, typer.Option(help="Network of processes (.kpl); default: the bundled one.")
    ] = None,
    changes: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NAME=VALUE",
            help="Change a parameter or setting of the specification, or 'scenario.PATH'.",
        ),
    ] = None,
    real_time: Annotated[
        bool, typer.Option("--real-time", help="Keep to the clock on the wall; same results.")
    ] = False,
    longest_frame_period: Annotated[
        str | None,
        typer.Option(help="With --real-time: when behind, film less often, down to this."),
    ] = None,
) -> None:
    """Simulate traffic, watch it, and report what was recognised, scored against the truth."""
    from traffic.commands.showing import progress, show_result
    from traffic.request import RunRequest
    from traffic.running import run_scenario
    from traffic.settings import change_from_text

    request = RunRequest.from_texts(
        scenario=scenario,
        sumocfg=sumocfg,
        look_at=look_at,
        view=view,
        sample_period=sample_period,
        position_noise=position_noise,
        seed=seed,
        duration=duration,
        out=out,
        overlay=overlay,
        record=record,
        streams=streams,
        record_images=record_images,
        specification=specification,
        real_time=real_time,
        longest_frame_period=longest_frame_period,
        recognise=recognise,
        changes=dict(map(change_from_text, changes or ())),
    )
    with progress() as on_progress:
        result, folder = run_scenario(request, on_progress)
    if json:
        sys.stdout.write(result.model_dump_json(indent=1) + "\n")
    else:
        show_result(result)
    sys.stderr.write(f"run written to {folder}\n")
