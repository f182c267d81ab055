"""Results of benchmarks as pictures: what was measured, beside what the literature has."""

from pathlib import Path
from textwrap import fill
from typing import Any, Final

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from traffic.benchmarks.results import BenchmarkResult, Experiment, Published, Series

__all__ = ["draw", "write_pictures"]

_COLOURS = ("#3a6fb0", "#c07a1c", "#2f7d5b", "#8a55b5")
_PUBLISHED = "#7d8796"
_STYLE: Final[dict[str, Any]] = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#8a93a3",
    "axes.grid": True,
    "grid.color": "#e3e7ee",
    "axes.axisbelow": True,
    "xtick.color": "#5a6475",
    "ytick.color": "#5a6475",
    "svg.fonttype": "none",
    "svg.hashsalt": "benchmark",
}
_ENDINGS = (".png", ".svg")
_DOTS_PER_INCH = 160
_FEW = 40
_HIGH = 1e5


def write_pictures(result: BenchmarkResult, folder: Path) -> list[Path]:
    """Write a picture of each experiment into *folder*, as PNG and as SVG; return the files."""
    written = []
    for experiment in result.findings.experiments:
        with style.context(_STYLE):
            picture = draw(experiment, result)
            for ending in _ENDINGS:
                path = folder / f"{experiment.name}{ending}"
                metadata = {"Date": None} if ending == ".svg" else {}
                picture.savefig(path, dpi=_DOTS_PER_INCH, metadata=metadata)
                written.append(path)
    return written


def draw(experiment: Experiment, result: BenchmarkResult) -> Figure:
    """Draw one experiment; if there is a published curve, it gets a panel of its own.

    Two panels, and not two curves in one, because the machines and the units differ by so much
    that one of the curves would lie on an axis.
    """
    published = experiment.published
    picture = Figure(figsize=(8.4 if published else 5.2, 3.7), layout="constrained")
    panels = list(picture.subplots(1, 2 if published else 1, squeeze=False)[0])
    if published is not None:
        _draw_published(panels[0], experiment, published)
    _draw_measured(panels[-1], experiment, result)
    for panel in panels:
        _dress(panel, experiment)
    picture.suptitle(experiment.what, fontsize=9, color="#39424f")
    return picture


def _draw_published(panel: Axes, experiment: Experiment, published: Published) -> None:
    x, y = zip(*published.points, strict=True)
    mark = "o-" if len(x) <= _FEW else "-"
    panel.plot(x, y, mark, color=_PUBLISHED, markersize=4, linewidth=1.2)
    panel.set_title(f"{published.source}\n{fill(published.remark, 58)}", fontsize=8)
    panel.set_ylabel(f"{experiment.y}, {published.unit}")


def _draw_measured(panel: Axes, experiment: Experiment, result: BenchmarkResult) -> None:
    machine = result.machine
    for colour, series in zip(_COLOURS, experiment.series, strict=False):
        _draw_series(panel, series, colour, experiment.unit)
    where = f"{machine.processor}, Python {machine.versions['python']}"
    panel.set_title(f"here: {where}", fontsize=8)
    panel.set_ylabel(f"{experiment.y}, {experiment.unit}")
    if len(experiment.series) > 1 or experiment.series[0].line is not None:
        panel.legend(frameon=False, fontsize=8, loc="upper left")


def _draw_series(panel: Axes, series: Series, colour: str, unit: str) -> None:
    x = np.array([point.x for point in series.points])
    median = [point.y.median for point in series.points]
    low = [point.y.low for point in series.points]
    high = [point.y.high for point in series.points]
    panel.fill_between(x, low, high, color=colour, alpha=0.18, linewidth=0)
    mark = "o-" if len(x) <= _FEW else "-"
    label = series.name
    if series.line is not None:
        label = f"{label}: {series.line.slope:.2g} {unit} for one more"
        fitted = [series.line.at(place) for place in x]
        panel.plot(x, fitted, "--", color="#1b2330", linewidth=0.8)
    panel.plot(x, median, mark, color=colour, markersize=4, linewidth=1.2, label=label)


def _dress(panel: Axes, experiment: Experiment) -> None:
    panel.set_xlabel(experiment.x)
    if experiment.logarithmic:
        panel.set_xscale("log")
        panel.xaxis.set_major_formatter(FuncFormatter(lambda x, _: _power(x)))
        if any(series.line is not None for series in experiment.series):
            panel.set_yscale("log")
            return
    else:
        panel.set_xlim(left=0)
        panel.xaxis.set_major_locator(MaxNLocator(integer=True))
    panel.set_ylim(bottom=0, top=_room_above(panel))


def _power(x: float) -> str:
    """Write a power of ten, the high ones with their exponents for want of room."""
    return f"{x:,.0f}" if x < _HIGH else f"$10^{{{np.log10(x):.0f}}}$"


def _room_above(panel: Axes) -> float:
    return float(panel.get_ylim()[1]) * 1.28
