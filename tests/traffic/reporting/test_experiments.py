"""The pages of experiments: self-contained, safe, and what they show in a real browser."""

import re
from pathlib import Path

import pytest

from tests.support.browsing import in_browser, needs_browser
from traffic.experiments.cases import Outcome, cases_of
from traffic.experiments.cell_files import bundled_cell_files
from traffic.experiments.designs import Design
from traffic.experiments.findings import Findings, findings_of, read_experiment_or_table
from traffic.experiments.measures import Counts
from traffic.experiments.running import Experiment
from traffic.experiments.tables import measure_cells
from traffic.reporting.experiments import page_of_experiments
from traffic.reporting.pages import write_page

PLACE = (
    "measure=overtake.detection&columns=position_noise&rows=scenario.acts.overtake.speed"
    "&groups=sample_period"
)
"""What is shown, as an address says it."""

PUBLISHED = bundled_cell_files()["table-8.2-published"]


def experiment(description: str = "Noise and periods.") -> Findings:
    """Return an experiment of ten runs a cell, of which one more is missed in each next cell."""
    design = Design(
        name="trial",
        folder=Path(),
        description=description,
        scenario="rural",
        runs_per_cell=10,
        first_seed=31,
        measures=("overtake.detection", "overtake.false_alarms"),
        fixed={"view": "truth"},
        factors={
            "sample_period": (100, "200 ms"),
            "scenario.acts.overtake.speed": (15, 20),
            "position_noise": (0, 4, 9),
        },
    )
    outcomes = {
        case.key: Outcome(
            case.key, case.cell, case.seed, {"overtake": Counts(1, 1, case.seed - 31 >= case.cell)}
        )
        for case in cases_of(design)
    }
    cells = measure_cells(design, outcomes)
    errors = ["cell 1, seed 2: gave up"]
    return findings_of(Experiment(Path("x"), design, cells, errors, {"python": "3"}, outcomes))


def test_a_page_needs_nothing_from_elsewhere() -> None:
    """No address but that of the SVG namespace, no style sheet, font or script of others."""
    page = page_of_experiments([experiment()])

    assert set(re.findall(r"https?://[^\s\"'<)]+", page)) == {"http://www.w3.org/2000/svg"}
    assert not re.search(r"<link|<script[^>]+src|@import|url\(", page)
    assert "cell 1, seed 2: gave up" in page


def test_texts_cannot_become_markup() -> None:
    """A description with markup is shown as it is written, in the page and in its data."""
    page = page_of_experiments([experiment("</script><script>alert(1)</script>")])

    assert "<script>alert" not in page
    assert "&lt;/script&gt;&lt;script&gt;alert(1)" in page


@pytest.mark.slow
@needs_browser
@pytest.mark.parametrize("width", [1280, 390])
def test_a_browser_shows_the_shares(tmp_path: Path, width: int) -> None:
    """Heat map, curves and table are there, without an error, on a desktop and on a phone."""
    page = tmp_path / "page.html"
    write_page(page_of_experiments([experiment()]), page)

    dom = in_browser(page, width, f"{PLACE}&cell=1.0.2&run=0.33")

    assert '<button type="button" class="good strong" style="--weight:100%"' in dom
    assert "200 ms · 15 m/s · 9 m: 20 % (5–51 %), 2 of 10" in dom
    assert dom.count('class="point"') == 12
    assert "overtake.detection by position noise" in dom
    assert "All that is chosen: 46 % (55 of 120)" in dom
    assert "8 of 10 runs fall short" in dom
    assert (
        "traffic run rural --view truth --sample-period '200 ms' --set "
        "scenario.acts.overtake.speed=15 --position-noise 9 --seed 33 --out look\n"
        "traffic report look --html look.html"
    ) in dom


@pytest.mark.slow
@needs_browser
@pytest.mark.parametrize("width", [1280, 390])
def test_a_browser_shows_experiments_side_by_side(tmp_path: Path, width: int) -> None:
    """The cells that both have, of each; what only one has is told and can be chosen."""
    page = tmp_path / "page.html"
    sides = [read_experiment_or_table(PUBLISHED), experiment()]
    write_page(page_of_experiments(sides), page)

    dom = in_browser(page, width, f"{PLACE}&cell=0.1.3")

    assert dom.count('<table class="heat"') == 2
    assert "table-8.2-published has 28 cells that not all have" in dom
    assert "100 ms · 20 m/s · 4 m" in dom
    assert "54–100 % · 9 of 10" not in dom
    assert "59–99 % · 9 of 10" in dom
    assert "only table-8.2-published" in dom
    assert dom.count('class="point"') == 2 * 4 * 2
