"""The page of an experiment: self-contained, safe, and what it shows in a real browser."""

import re
from pathlib import Path

import pytest

from tests.support.browsing import in_browser, needs_browser
from traffic.experiments.designs import Design
from traffic.experiments.measures import Share
from traffic.experiments.running import Experiment
from traffic.experiments.tables import CellMeasures
from traffic.reporting.experiments import page_of_experiment
from traffic.reporting.pages import write_page


def experiment(description: str = "Noise and periods.") -> Experiment:
    """Return an experiment with two factors, whose shares can be told apart."""
    design = Design(
        name="trial",
        folder=Path(),
        description=description,
        scenario="rural",
        runs_per_cell=10,
        measures=("overtake.recall", "overtake.false_alarms"),
        factors={"position_noise": (0, 4), "view": ("truth", "vision")},
    )
    cells = [
        CellMeasures(
            cell,
            10,
            0,
            {"overtake.recall": Share(40 + i, 60), "overtake.false_alarms": Share(i, 10)},
        )
        for i, cell in enumerate(design.combinations())
    ]
    return Experiment(Path("x"), design, cells, ["cell 1, seed 2: gave up"], {"python": "3"})


def test_a_page_needs_nothing_from_elsewhere() -> None:
    """No address but that of the SVG namespace, no style sheet, font or script of others."""
    page = page_of_experiment(experiment())

    assert set(re.findall(r"https?://[^\s\"'<)]+", page)) == {"http://www.w3.org/2000/svg"}
    assert not re.search(r"<link|<script[^>]+src|@import|url\(", page)
    assert "cell 1, seed 2: gave up" in page


def test_texts_cannot_become_markup() -> None:
    """A description with markup is shown as it is written, in the page and in its data."""
    page = page_of_experiment(experiment("</script><script>alert(1)</script>"))

    assert "<script>alert" not in page
    assert "&lt;/script&gt;&lt;script&gt;alert(1)" in page


@pytest.mark.slow
@needs_browser
@pytest.mark.parametrize("width", [1280, 390])
def test_a_browser_shows_the_shares(tmp_path: Path, width: int) -> None:
    """Heat map, curves and table are there, without an error, on a desktop and on a phone."""
    page = tmp_path / "page.html"
    write_page(page_of_experiment(experiment()), page)

    dom = in_browser(page, width)

    assert "71.7 %" in dom
    assert "43/60" in dom
    assert dom.count("<circle") == 4
    assert "overtake.recall by position_noise" in dom
    assert "All that is chosen: 69.2 % (166 of 240)" in dom
