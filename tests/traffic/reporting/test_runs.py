"""The page of a run: self-contained, safe, whole in a browser, and honest about what it lacks."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from perception.overlay import FilmWriter
from tests.support.browsing import in_browser, needs_browser
from traffic.errors import RequestError
from traffic.reporting.films import film_beside
from traffic.reporting.pages import write_page
from traffic.reporting.reports import read_report
from traffic.reporting.runs import page_of_run, page_of_runs
from traffic.request import RunRequest
from traffic.results import Manoeuvre, Score, read_result, write_result
from traffic.running import run_scenario
from traffic.totals import total_score

NAMESPACE = "http://www.w3.org/2000/svg"


def page_of(folder: Path, film: Path | None = None, result=None) -> str:
    """Return the page of the run in *folder*, with another result if one is given."""
    return page_of_run(folder, result or read_result(folder), film, lambda *_: None)


def data_of(page: str) -> dict:
    """Return the data in a page."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    return json.loads(found[1])


@pytest.fixture(scope="module")
def page(finished_run, tmp_path_factory) -> str:
    """Return the page of a run of seven seconds; a turn in it is said to have been missed."""
    first = finished_run.result.recognitions[0]
    missed = Manoeuvre(
        kind=first.chronicle,
        vehicles=list(first.truth.values()),
        place=[],
        begin=first.begin,
        end=first.end,
    )
    run = tmp_path_factory.mktemp("missing") / "run"
    shutil.copytree(finished_run.folder, run)
    write_result(finished_run.result.model_copy(update={"missed": [missed]}), run)
    return page_of(run)


@pytest.fixture(scope="module")
def filmed(tmp_path_factory) -> tuple[Path, Path]:
    """Return the folder and the film of a run through the cameras."""
    place = tmp_path_factory.mktemp("filmed")
    request = RunRequest.from_texts(
        scenario="crossing", duration="1 s", overlay=place / "run.mp4", out=place / "run"
    )
    run_scenario(request, lambda *_: None)
    return place / "run", place / "run.mp4"


def test_a_page_needs_nothing_from_elsewhere(page):
    """No address but that of the SVG namespace, no style sheet, font or script of others."""
    assert set(re.findall(r"https?://[^\s\"'<)]+", page)) == {NAMESPACE}
    assert not re.search(r"<link|<script[^>]+src|@import|url\((?!#)", page)


def test_names_cannot_become_markup(finished_run):
    """A scenario with markup in its name is shown as it is written, in the page and its data."""
    evil = "</script><script>alert(1)</script>"
    first = finished_run.result.recognitions[0].model_copy(update={"chronicle": evil})
    result = finished_run.result.model_copy(
        update={"scenario": evil, "failures": [evil], "recognitions": [first]}
    )

    page = page_of(finished_run.folder, result=result)

    assert "<script>alert" not in page
    assert "&lt;/script&gt;&lt;script&gt;alert(1)" in page
    assert data_of(page)["items"][0]["kind"] == evil


def test_a_page_is_small(page):
    """Seven seconds with many cars take less than 300 kB, so a minute less than 1.5 MB."""
    assert len(page.encode()) < 300_000


def test_everything_listed_is_explained(page, finished_run):
    """Each recognition with its events, constraints, objects, links and attributes."""
    data = data_of(page)

    assert len(data["items"]) == len(finished_run.result.recognitions) + 1
    for item in data["items"][:-1]:
        reason = data["reasons"][item["id"]]
        assert reason["number"] == item["number"]
        assert reason["events"]
        assert all(each["holds"] for each in reason["constraints"])
        assert [each["symbol"] for each in reason["objects"]] == item["cars"]
        assert all(each["links"] for each in reason["objects"])
        assert any(item["cars"][0] in band["objects"] for band in reason["bands"])
        streams = {each["stream"] for each in reason["events"]}
        assert streams <= data["processes"].keys()


def test_what_was_believed_of_a_missed_car_is_told(page):
    """Its attributes at about that time: it left a link and entered another."""
    data = data_of(page)

    (missed,) = (item for item in data["items"] if item["verdict"] == "missed")
    names = [band["name"] for band in data["reasons"][missed["id"]]["bands"]]
    assert f"cars.link[{missed['cars'][0]}]" in names
    assert missed["instead"] == [1]


def test_the_map_covers_the_tracks(page):
    """Roads, crossings and markings are there, and the first view is where cars were."""
    data = data_of(page)

    assert data["map"]["roads"].count("M") > 10
    assert {each["name"] for each in data["map"]["names"]} >= {"centre", "north"}
    _, _, width, height = data["map"]["box"]
    assert width > 100
    assert height > 100


@pytest.mark.slow
@needs_browser
@pytest.mark.parametrize("width", [1280, 390])
def test_a_browser_shows_why(page, tmp_path, width):
    """The address chooses a recognition and a time; map, table and reasons show them."""
    path = tmp_path / "page.html"
    write_page(page, path)
    items = data_of(page)["items"]
    item = items[1]

    dom = in_browser(path, width, f"recognition=2&t={(item['begin'] + 100) / 1000}")

    assert re.search(r'<tr data-id="recognition=2" aria-selected="true"', dom)
    assert f"{(item['begin'] + 100) / 1000:.1f} s</output>" in dom
    assert dom.count('class="item"') == len(items)
    assert "attributes over time" in dom
    assert "<h3>Constraints</h3>" in dom
    assert 'class="tick"' in dom
    assert 'class="tick no"' not in dom
    shown = re.findall(r'<path [^>]*visibility="visible"[^>]*transform="translate', dom)
    assert len(shown) > 5
    car = item["cars"][0]
    assert re.search(rf'<text visibility="visible"[^>]*>{car}</text>', dom)


@pytest.mark.slow
@needs_browser
def test_a_browser_shows_what_was_missed(page, tmp_path):
    """A miss can be chosen like a recognition; what was recognised instead can be gone to."""
    path = tmp_path / "page.html"
    write_page(page, path)

    dom = in_browser(path, 1280, "missed=1")

    assert "it happened in view, and was not recognised" in dom
    assert "What was believed of them" in dom
    assert 'href="#recognition=1"' in dom


@pytest.mark.slow
@needs_browser
def test_the_film_is_part_of_the_page(filmed, tmp_path):
    """It is in step with the run: its frames have the times of the images."""
    folder, film = filmed
    assert film_beside(folder) == film
    path = tmp_path / "page.html"
    read_report([folder]).write_page(path, None, lambda *_: None)

    dom = in_browser(path, 1280, "t=0.5")

    page = path.read_text(encoding="utf-8")
    assert len(data_of(page)["film"]) > 10_000
    assert "What this page lacks" not in page
    assert '<video id="film"' in dom
    assert 'src="blob:' in dom
    assert "Nothing was recognised in this run" in dom


def test_the_film_of_another_run_is_refused(finished_run, filmed, tmp_path):
    """A run without cameras has no film, and another film has not as many frames."""
    folder, film = filmed
    other = tmp_path / "other.mp4"
    with FilmWriter(other, (64, 48), frames_per_second=25.0) as writer:
        writer.write(np.zeros((48, 64, 3), dtype=np.uint8))

    with pytest.raises(RequestError, match="--film: expected no film, because this run was made"):
        page_of(finished_run.folder, film)
    with pytest.raises(RequestError, match=r"with \d+ frames, found '.*other.mp4, with 1'"):
        page_of(folder, other)


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda run: shutil.rmtree(run / "explanations"), "keeps nothing to explain it by"),
        (
            lambda run: _replace(
                run / "explanations" / "description.json", '"version": 1', '"version": 9'
            ),
            "version 9; another version of this program has made it",
        ),
        (
            lambda run: (run / "explanations" / "states.parquet").unlink(),
            "is missing; expected it",
        ),
        (
            lambda run: _replace(
                run / "origin.json", '"network_sha256": "', '"network_sha256": "0'
            ),
            "has changed since",
        ),
        (lambda run: (run / "origin.json").unlink(), "does not say what the run was made from"),
    ],
)
def test_what_is_missing_is_told(finished_run, tmp_path, damage, told):
    """The page is written all the same, with what there is."""
    run = tmp_path / "run"
    shutil.copytree(finished_run.folder, run)
    damage(run)

    page = page_of(run)

    lacks = page.partition("What this page lacks")[2].partition("</section>")[0]
    assert told in lacks.replace("&#39;", "'")
    assert len(data_of(page)["items"]) == len(finished_run.result.recognitions)


def _replace(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


@pytest.mark.slow
@needs_browser
def test_a_page_that_lacks_all_but_the_result_works(finished_run, tmp_path):
    """Time line and table are there; of the reasons it says that they are not."""
    run = tmp_path / "run"
    shutil.copytree(finished_run.folder, run)
    shutil.rmtree(run / "explanations")
    path = tmp_path / "page.html"
    write_page(page_of(run), path)

    dom = in_browser(path, 390, "recognition=1")

    assert "This page has no explanation of it" in dom
    assert 'class="item"' in dom


def test_several_runs_have_one_page(finished_run):
    """The counts are added up, and those of each run are there, if it looked for the kind."""
    result = finished_run.result
    other = result.model_copy(update={"score": {"red_light": Score.of(4, 3, 2, 0)}})
    results = {Path("runs/a"): result, Path("runs/b"): result, Path("runs/c"): other}

    page = page_of_runs(results, total_score(list(results.values())))

    turn = result.score["turn"]
    assert f"{2 * turn.correct} of {2 * turn.truth}" in page
    assert page.count(f"{turn.correct} of {turn.truth}") >= 2
    assert page.count("2 of 4") >= 2
    assert page.count("not looked for") == len(result.score) + 2
    assert "runs/b" in page
    assert set(re.findall(r"https?://[^\s\"'<)]+", page)) <= {NAMESPACE}
