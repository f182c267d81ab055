"""`traffic report --html`: what may be asked for together."""

from pathlib import Path

import pytest

from traffic.errors import RequestError
from traffic.reporting.reports import RunsReport


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
