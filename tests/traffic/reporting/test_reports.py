"""`traffic report`: what may be asked for together, and in which forms it is told."""

import json
from pathlib import Path

import pandas as pd
import pytest

from traffic.errors import RequestError, ResultError
from traffic.reporting.reports import ExperimentsReport, RunsReport, read_report

PUBLISHED = Path("table-8.2-published")
OTHER = """sample_period,position_noise,runs,overtake.detection,overtake.false_alarms
100 ms,0,20,1,0
0.2 s,4,20,0.75,0.05
400,4,20,0.5,
"""


def test_a_film_belongs_to_one_run(finished_run, tmp_path):
    """The page of several has no place for it."""
    result = finished_run.result
    report = RunsReport({Path("a"): result, Path("b"): result})

    with pytest.raises(RequestError, match="--film: expected one run only"):
        report.write_page(tmp_path / "page.html", Path("film.mp4"), lambda *_: None)


def test_pages_are_written_whole(finished_run, tmp_path):
    """One run, and several."""
    result, folder = finished_run.result, finished_run.folder

    RunsReport({folder: result}).write_page(tmp_path / "one.html", None, lambda *_: None)
    RunsReport({Path("a"): result, Path("b"): result}).write_page(
        tmp_path / "two.html", None, lambda *_: None
    )

    for name in ("one.html", "two.html"):
        assert (tmp_path / name).read_text(encoding="utf-8").endswith("</html>")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one.html", "two.html"]


@pytest.fixture
def other(tmp_path):
    """Return the path of a table with three cells, two of which are published."""
    path = tmp_path / "other.csv"
    path.write_text(OTHER)
    return path


def test_experiments_stand_side_by_side(other, tmp_path):
    """As CSV and JSON: the cells of both, and what only one has is empty."""
    report = read_report([PUBLISHED, other])
    report.write_csv(tmp_path / "both.csv")
    table = pd.read_csv(tmp_path / "both.csv")
    document = json.loads(report.as_json())

    assert isinstance(report, ExperimentsReport)
    assert len(table) == len(document["cells"]) == 13
    row = table[(table["sample_period"] == 200) & (table["position_noise"] == 4)].iloc[0]
    assert row["table-8.2-published:overtake.detection.successes"] == 5
    assert row["other:overtake.detection.successes"] == 15
    assert table["table-8.2-published:overtake.detection"].isna().sum() == 1
    assert document["measures"] == ["overtake.detection"]
    assert document["experiments"][0]["held"] == {"scenario.acts.overtake.speed": 15}
    last = document["cells"][-1]
    assert last["cell"] == {"sample_period": 400, "position_noise": 4}
    assert last["experiments"]["table-8.2-published"] is None
    assert last["experiments"]["other"]["overtake.detection"]["trials"] == 20


def test_one_table_is_told_like_an_experiment(other, tmp_path):
    """Its page, its cells as CSV, and as JSON."""
    report = read_report([other])
    report.write_page(tmp_path / "page.html", None, lambda *_: None)
    report.write_csv(tmp_path / "again.csv")

    assert (tmp_path / "page.html").read_text(encoding="utf-8").endswith("</html>")
    assert read_report([tmp_path / "again.csv"]).sides[0].cells == report.sides[0].cells
    assert json.loads(report.as_json())["table"] == "other"


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (["table-8.2-published", "run"], "either runs or experiments: 'table-8.2-published' is"),
        (["table-8.2-published"] * 2, "each experiment once, found 'table-8.2-published' again"),
        (["table-8.2-published", "recall.csv"], "that share a measure, found overtake.detection"),
    ],
)
def test_what_does_not_go_together_is_refused(tmp_path, monkeypatch, names, said):
    """Runs and experiments, one of them twice, and experiments that measure other things."""
    monkeypatch.chdir(tmp_path)
    Path("recall.csv").write_text("runs,overtake.recall,overtake.recall.trials\n2,1,5\n")

    with pytest.raises(ResultError, match=said):
        read_report([Path(name) for name in names])
