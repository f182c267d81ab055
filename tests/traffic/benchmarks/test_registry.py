"""Every benchmark measures something, and says so in one form."""

import json

import pytest
from typer.testing import CliRunner

from traffic.__main__ import app
from traffic.benchmarks.registry import BENCHMARKS, run_benchmark
from traffic.benchmarks.results import BenchmarkResult
from traffic.errors import RequestError, ResultError


def ignore(share, what):
    """Take no note of the progress."""


@pytest.mark.parametrize("name", BENCHMARKS)
def test_every_benchmark_has_one_form(name):
    """A quick benchmark gives curves, says what it ran on, and tells how far it is."""
    shares = []

    result = run_benchmark(name, lambda share, _: shares.append(share), quick=True)

    assert BenchmarkResult.model_validate_json(result.model_dump_json()) == result
    assert result.quick
    assert result.machine.versions["python"]
    assert result.machine.cores >= 1
    assert shares == sorted(shares)
    assert 0 <= shares[0] <= shares[-1] <= 1
    assert result.findings.experiments
    for experiment in result.findings.experiments:
        assert len({len(series.points) for series in experiment.series}) == 1


def test_results_are_written_with_their_pictures(tmp_path):
    """A folder gets the document, and each experiment as PNG and as SVG."""
    out = tmp_path / "out"

    result = run_benchmark("synchronisation", ignore, quick=True, out=out)

    written = (out / "benchmark.json").read_text(encoding="utf-8")
    assert BenchmarkResult.model_validate_json(written) == result
    for ending in ("svg", "png"):
        assert (out / f"synchronisation.{ending}").stat().st_size > 1_000


def test_the_command_prints_one_document():
    """With --json there is one document on standard output and nothing else."""
    shown = CliRunner().invoke(app, ["benchmark", "tables", "--quick", "--json"])

    assert shown.exit_code == 0, shown.output
    assert json.loads(shown.stdout)["benchmark"] == "tables"


def test_the_command_prints_tables():
    """Without --json, curves and figures are tables, with a word about quick ones."""
    shown = CliRunner(env={"COLUMNS": "200"}).invoke(app, ["benchmark", "streams", "--quick"])

    assert shown.exit_code == 0, shown.output
    for text in ("Heintz (2009), figure 5.7", "delay for one more stream", "--quick"):
        assert text in shown.stdout


def test_the_help_names_every_benchmark():
    """Who reads the help knows what can be measured."""
    shown = CliRunner(env={"COLUMNS": "200"}).invoke(app, ["benchmark", "--help"])

    for name in BENCHMARKS:
        assert name in shown.stdout


@pytest.mark.parametrize(
    ("name", "duration", "message"),
    [
        ("speed", None, r"NAME: expected one of streams, .* found 'speed'"),
        ("streams", "1h", "--duration: expected nothing, for it only has a meaning with memory"),
        ("memory", "long", "--duration: expected a time such as"),
        ("memory", "-1 s", "--duration: expected a time above 0"),
    ],
)
def test_impossible_wishes_are_refused(name, duration, message):
    """An unknown name, and a duration that means nothing, are refused before anything runs."""
    with pytest.raises(RequestError, match=message):
        run_benchmark(name, ignore, duration=duration)


def test_results_are_never_written_over(tmp_path):
    """A folder that exists is not touched."""
    with pytest.raises(ResultError, match="exists already"):
        run_benchmark("tables", ignore, quick=True, out=tmp_path)
