"""Draws the time line: what held when, and at which instants the chronicle asked for it."""

from collections.abc import Iterator, Mapping, Sequence
from textwrap import fill

from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter, MaxNLocator

from dyknow.time import MILLISECOND
from traffic.explaining.attributes import Steps
from traffic.explaining.drawing import (
    FAINT,
    INK,
    colour_of_band,
    instants_text,
    seconds_text,
)
from traffic.explaining.explanation import Counted
from traffic.explaining.story import Band, Story

__all__ = ["draw_time_line", "earlier_text"]

_LETTERS = 38
"""How many letters of a name stand on one line."""

_BAR = 0.44
_RAW = 0.12
_FALSE = ("false", None)
_LIGHTS = {"red": "#d64545", "yellow": "#e8b923", "green": "#3c9d5f"}
"""What signals show is drawn as they show it."""

_SHADE_COUNTED = "#3c9d5f"
_SHADE_FORBIDDEN = "#c0453c"
_LETTER_SHARE = 0.0078


def draw_time_line(axes: Axes, story: Story, colours: Mapping[str, str]) -> None:
    """Draw the bands of *story*, one row each, and its instants across them."""
    n = len(story.bands)
    axes.set_xlim(story.begin / 1000, story.end / 1000)
    axes.set_ylim(n - 0.35, -0.62)
    for row, band in enumerate(story.bands):
        if row % 2:
            axes.axhspan(row - 0.5, row + 0.5, color="#f5f7fa", zorder=0)
        colour = colour_of_band(band.steps.arguments, colours)
        for counted in band.counted:
            _draw_counted(axes, row, counted, story)
        _draw_values(axes, row, band, colour, story)
        _draw_events(axes, row, band)
    _draw_instants(axes, story)
    axes.set_yticks(range(n), [fill(band.name, _LETTERS) for band in story.bands], fontsize=9)
    for frame in story.frames:
        at = frame.time / 1000
        axes.plot(at, n - 0.35, marker="^", ms=6, color=INK, clip_on=False, zorder=9)
    axes.tick_params(axis="y", length=0, pad=8)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=12, steps=[1, 2, 5, 10]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda second, _: f"{second:g} s"))
    axes.tick_params(axis="x", length=3)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)


def _spans(steps: Steps, begin: float, end: float) -> Iterator[tuple[float, float, str | None]]:
    """Yield from when to when each value held, in milliseconds, between two times."""
    times = [time / MILLISECOND for time in steps.times]
    ends = [*times[1:], end]
    for since, until, value in zip(times, ends, steps.values, strict=True):
        first, last = max(since, begin), min(until, end)
        if first < last:
            yield first, last, value


def _draw_values(axes: Axes, row: int, band: Band, colour: str, story: Story) -> None:
    if band.is_chronicle:
        _draw_recognitions(axes, row, band, colour)
        return
    for first, last, value in _spans(band.steps, story.begin, story.end):
        _draw_span(axes, (first, last), row, value, colour, story)
    if band.raw is not None:
        for first, last, value in _spans(band.raw, story.begin, story.end):
            if value not in _FALSE and not str(value).startswith("no_"):
                place = (first / 1000, row + _BAR / 2 + 0.05)
                width = (last - first) / 1000
                axes.add_patch(Rectangle(place, width, _RAW, color=colour, alpha=0.45, lw=0))


def _draw_span(
    axes: Axes,
    span: tuple[float, float],
    row: int,
    value: str | None,
    colour: str,
    story: Story,
) -> None:
    first, width = span[0] / 1000, (span[1] - span[0]) / 1000
    low = row - _BAR / 2
    if value is None:
        axes.plot([first, first + width], [row, row], color=FAINT, lw=1, ls=":", zorder=3)
        return
    if value == "false" or value.startswith("no_"):
        axes.plot([first, first + width], [row, row], color=colour, lw=1.2, alpha=0.8, zorder=3)
        text, ink = ("" if value == "false" else value.replace("_", " ")), FAINT
        raised = 0.17
    else:
        colour = _LIGHTS.get(value, colour)
        bar = Rectangle(
            (first, low), width, _BAR, facecolor=colour, edgecolor="white", lw=1.0, zorder=3
        )
        axes.add_patch(bar)
        text, ink, raised = value, _ink_on(colour), 0.0
    room = width / ((story.end - story.begin) / 1000)
    if text and room > _LETTER_SHARE * (len(text) + 1):
        axes.text(
            first + width / 2,
            row - raised,
            text,
            ha="center",
            va="center",
            fontsize=8,
            color=ink,
            zorder=4,
            clip_on=True,
        )


def _draw_recognitions(axes: Axes, row: int, band: Band, colour: str) -> None:
    for each in band.events:
        begin, end = float(each.event.before or 0) / 1000, float(each.event.after or 0) / 1000
        bar = Rectangle(
            (begin, row - _BAR / 2), end - begin, _BAR, facecolor=colour, alpha=0.9, lw=0, zorder=3
        )
        axes.add_patch(bar)


def _draw_events(axes: Axes, row: int, band: Band) -> None:
    for each in band.events:
        axes.plot(
            each.event.time / 1000,
            row,
            marker="D",
            ms=6.5,
            mfc="white",
            mec=INK,
            mew=1.4,
            zorder=7,
        )


def _draw_counted(axes: Axes, row: int, counted: Counted, story: Story) -> None:
    first, last = max(counted.begin, story.begin), min(counted.end, story.end)
    if first >= last:
        return
    is_forbidden = counted.most == 0
    colour = _SHADE_FORBIDDEN if is_forbidden else _SHADE_COUNTED
    shade = Rectangle(
        (first / 1000, row - 0.42),
        (last - first) / 1000,
        0.84,
        facecolor=colour,
        edgecolor=colour,
        alpha=0.12,
        lw=0,
        zorder=1,
    )
    axes.add_patch(shade)
    for at in (first, last):
        axes.plot([at / 1000] * 2, [row - 0.42, row + 0.42], color=colour, lw=0.8, alpha=0.7)


def _draw_instants(axes: Axes, story: Story) -> None:
    shown = [(time, names) for time, names in story.instants.items()]
    last = -1e9
    level = 0
    for time, names in shown:
        at = time / 1000
        axes.axvline(at, color=INK, lw=0.9, ls=(0, (4, 3)), zorder=2, alpha=0.75)
        crowded = (time - last) / (story.end - story.begin) < 0.075  # noqa: PLR2004, of the width
        level = (level + 1) % 2 if crowded else 0
        last = time
        axes.annotate(
            f"{instants_text(names)}\n{seconds_text(time)}",
            (at, -0.62),
            xytext=(0, 3 + 22 * level),
            textcoords="offset points",
            ha="center",
            va="bottom",
            fontsize=8.5,
            fontweight="bold",
            annotation_clip=False,
        )


def earlier_text(earlier: Mapping[float, Sequence[str]]) -> str:
    """Return what is said of instants that lie before the time line."""
    return ", ".join(
        f"{instants_text(names)} at {seconds_text(time)}" for time, names in earlier.items()
    )


def _ink_on(colour: str) -> str:
    red, green, blue = to_rgb(colour)
    return "white" if 0.3 * red + 0.59 * green + 0.11 * blue < 0.62 else INK  # noqa: PLR2004
