"""Colours, letters and shapes that the parts of a picture share."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from matplotlib.patheffects import Stroke, withStroke

from traffic.explaining.explanation import Seen

__all__ = [
    "FAINT",
    "INK",
    "PAPER",
    "STYLE",
    "colour_of_band",
    "colours_of",
    "draw_box",
    "draw_name",
    "draw_trail",
    "instants_text",
    "seconds_text",
]

INK: Final = "#1f2733"
FAINT: Final = "#7b8696"
PAPER: Final = "#ffffff"
_PALETTE: Final = ("#f28e1c", "#2f7fd0", "#2c9b62", "#c2447e", "#7a5bc4", "#9a7b1f")
_HALO: Final = "#10151c"

STYLE: Final[dict[str, Any]] = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "text.color": INK,
    "axes.edgecolor": "#c6ccd6",
    "axes.labelcolor": INK,
    "xtick.color": FAINT,
    "ytick.color": INK,
    "axes.linewidth": 0.8,
}


def colours_of(symbols: Sequence[str]) -> dict[str, str]:
    """Return a colour for each object."""
    return {symbol: _PALETTE[at % len(_PALETTE)] for at, symbol in enumerate(symbols)}


def draw_box(axes: Axes, seen: Seen, corners: Any, colour: str, *, is_below: bool = False) -> None:
    """Outline an object; dashed if it was predicted, and say what it is called."""
    outline = np.asarray(corners, dtype=np.float64)
    is_predicted = seen.percept is None
    box = Polygon(
        outline,
        closed=True,
        fill=False,
        edgecolor=colour,
        linewidth=1.8,
        linestyle=(0, (3, 2)) if is_predicted else "-",
        zorder=6,
    )
    box.set_path_effects([Stroke(linewidth=3.4, foreground=_HALO, alpha=0.75), withStroke()])
    axes.add_patch(box)
    name = f"{seen.symbol} (predicted)" if is_predicted else seen.symbol
    draw_name(axes, name, outline, colour, is_below=is_below)


def draw_name(axes: Axes, name: str, outline: Any, colour: str, *, is_below: bool = False) -> None:
    """Write what an object is called, above its outline or below it."""
    is_upside_down = axes.yaxis_inverted()
    rows = outline[:, 1]
    edge = rows.max() if is_below == is_upside_down else rows.min()
    label = axes.annotate(
        name,
        (float(outline[:, 0].mean()), float(edge)),
        xytext=(0, -5 if is_below else 5),
        textcoords="offset points",
        ha="center",
        va="top" if is_below else "bottom",
        fontsize=9,
        fontweight="bold",
        color=colour,
        zorder=8,
        annotation_clip=True,
    )
    label.set_path_effects([withStroke(linewidth=2.6, foreground=_HALO)])
    label.set_clip_on(True)


def draw_trail(axes: Axes, points: Any, colour: str) -> None:
    """Draw where an object has been, the older the fainter."""
    line = np.asarray(points, dtype=np.float64)
    if len(line) < 2:  # noqa: PLR2004, two ends
        return
    n = len(line) - 1
    for at in range(n):
        share = (at + 1) / n
        (piece,) = axes.plot(
            line[at : at + 2, 0],
            line[at : at + 2, 1],
            color=colour,
            linewidth=1.6,
            alpha=0.15 + 0.75 * share,
            solid_capstyle="round",
            zorder=5,
        )
        piece.set_clip_on(True)


def seconds_text(milliseconds: float) -> str:
    """Return a time in seconds, to the hundredth where it has one."""
    seconds = milliseconds / 1000
    rounded = f"{seconds:.2f}".rstrip("0")
    return f"{rounded}0 s" if rounded.endswith(".") else f"{rounded} s"


def instants_text(names: Sequence[str]) -> str:
    """Return the names of instants at one time."""
    return " = ".join(names)


def colour_of_band(arguments: Sequence[str], colours: Mapping[str, str]) -> str:
    """Return the colour of the first object among some words."""
    return next((colours[each] for each in arguments if each in colours), FAINT)
