"""How runs of an experiment are done again: which, and by which command line."""

import shlex
from dataclasses import replace
from pathlib import Path

import pytest
import typer
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.__main__ import app
from traffic.bundled import data_folder
from traffic.experiments.cases import Case, Outcome, cases_of, request_of
from traffic.experiments.designs import Design, Level
from traffic.experiments.measures import MEASURES, Counts
from traffic.experiments.repeating import command_of, runs_of_cells
from traffic.experiments.running import Experiment
from traffic.request import RunRequest
from traffic.settings import change_from_text

SETTINGS: dict[str, st.SearchStrategy[Level]] = {
    "sample_period": st.sampled_from([100, "200", "0.3 s"]),
    "position_noise": st.sampled_from([0, 2, 4.5]),
    "duration": st.sampled_from(["20 s", "1 min"]),
    "recognise": st.sampled_from(["overtakes", "turns,overtakes", "all"]),
    "stability": st.sampled_from([300, "500 ms"]),
    "car_relations.gap": st.floats(0.1, 9),
    "world_objects/1": st.just("sample every 200, use most recent"),
    "scenario.flows.0.rate_per_hour": st.integers(100, 900),
    "scenario.camera.altitude": st.sampled_from([120, 150.5]),
}
"""Settings that a run through the simulator's positions can have."""


def asked_for(command: str, seed: int, out: Path) -> RunRequest:
    """Return what the command line asks for, as the program reads it."""
    program, name, *words = shlex.split(command)
    assert (program, name) == ("traffic", "run")
    command_run = typer.main.get_command(app).commands["run"]  # type: ignore[attr-defined]
    words += ["--seed", str(seed), "--out", str(out)]
    options = command_run.make_context("run", words, resilient_parsing=False).params
    del options["json"]
    changes = dict(map(change_from_text, options.pop("changes") or ()))
    return RunRequest.from_texts(changes=changes, **options)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.fixed_dictionaries({"view": st.just("truth")}, optional=SETTINGS), st.integers(0, 10**6))
def test_the_command_line_asks_for_the_run(chosen: dict[str, Level], seed: int) -> None:
    """What the program reads from it is what the experiment asked for."""
    case = Case(0, seed, "rural", chosen, Path())
    out = Path("look")

    found = asked_for(command_of(case), seed, out)

    expected = request_of(case, out)
    assert replace(found, changes={}) == replace(expected, changes={})
    assert {k: str(v) for k, v in found.changes.items()} == {
        k: str(v) for k, v in expected.changes.items()
    }


def test_files_are_found_where_the_runs_have_read_them(tmp_path: Path) -> None:
    """A scenario beside the design is not beside its copy in the folder of the experiment."""
    source = data_folder() / "scenarios" / "rural.toml"
    case = Case(0, 1, "own/rural.toml", {"specification": "my network.kpl"}, tmp_path)

    command = command_of(case, [str(source), "/there/my network.kpl"])

    assert shlex.split(command) == [
        "traffic", "run", str(source), "--specification", "/there/my network.kpl",
    ]  # fmt: skip
    assert str(tmp_path / "own/rural.toml") in command_of(case)


counts = st.builds(
    lambda truth, correct, false: Counts(truth, min(truth, correct) + false, min(truth, correct)),
    st.integers(0, 2), st.integers(0, 2), st.integers(0, 1),
)  # fmt: skip


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(st.one_of(st.none(), counts), min_size=6, max_size=6))
def test_the_runs_to_look_at_are_those_that_spoil_the_measure(found: list[Counts | None]) -> None:
    """Those in which something was missed or false, as the measure asks; not those that failed."""
    measures = tuple(f"overtake.{what}" for what in MEASURES)
    design = Design(
        name="trial", folder=Path(), scenario="rural", runs_per_cell=3, first_seed=7,
        measures=measures, factors={"position_noise": (0, 4)},
    )  # fmt: skip
    outcomes = {
        case.key: Outcome(
            case.key, case.cell, case.seed,
            {} if each is None else {"overtake": each},
            "gave up" if each is None else None,
        )
        for case, each in zip(cases_of(design), found, strict=True)
    }  # fmt: skip
    experiment = Experiment(Path("x"), design, [], [], {}, outcomes)

    cells = runs_of_cells(experiment)

    spoils = {
        "recall": lambda run: run.correct < run.truth,
        "precision": lambda run: run.correct < run.recognised,
        "detection": lambda run: run.correct < run.truth,
        "false_alarms": lambda run: run.correct < run.recognised,
        "faultless": lambda run: run.correct < max(run.truth, run.recognised),
    }
    for number, runs in enumerate(cells):
        done = [(o.seed, o.counts.get("overtake")) for o in outcomes.values() if o.cell == number]
        assert set(runs.failed) == {seed for seed, run in done if run is None}
        for measure in measures:
            is_spoilt = spoils[measure.partition(".")[2]]
            expected = {seed for seed, run in done if run is not None and is_spoilt(run)}
            assert set(runs.missed[measure]) == expected


@pytest.mark.parametrize("missing", [True, False])
def test_a_finished_run_that_is_missing_is_left_out(*, missing: bool) -> None:
    """An experiment of which outcomes are not known has nothing to look at."""
    design = Design(
        name="trial", folder=Path(), scenario="rural", measures=("overtake.recall",), factors={}
    )
    (case,) = cases_of(design)
    outcome = Outcome(case.key, 0, 1, {"overtake": Counts(2, 1, 1)})
    outcomes = {} if missing else {case.key: outcome}

    (runs,) = runs_of_cells(Experiment(Path("x"), design, [], [], {}, outcomes))

    assert runs.missed == {"overtake.recall": () if missing else (1,)}
    assert runs.command == "traffic run rural"
