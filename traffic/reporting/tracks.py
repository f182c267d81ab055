"""Where objects were over time, as a page has it: whole numbers, each the change to the last.

Places are decimetres, x to the east and y to the south as on a screen; headings are degrees
counter-clockwise from east; times milliseconds. A thinned-out grid of times is common to all
objects, and between two of its times a page goes along a straight line.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from dyknow.time import MILLISECOND
from traffic.explaining.kept import KeptRun

__all__ = ["thinned", "tracks_of"]

_STEP_MS = 200
_PER_METRE = 10

Whole = npt.NDArray[np.int64]


def tracks_of(run: KeptRun) -> dict[str, Any]:
    """Return the tracks of all objects that the events of a run are about."""
    states = run.read("states")
    grid = thinned(np.unique(states["valid_time"].to_numpy(np.int64)) // MILLISECOND)
    states["at"] = states["valid_time"].to_numpy(np.int64) // MILLISECOND
    states = states[states["at"].isin(grid)].sort_values("at", kind="stable")
    sorts = run.description.sorts
    cars = [
        {
            "symbol": f"{sorts[str(label)]}{number}",
            "size": [round(float(each.median()), 2) for each in (of["length"], of["width"])],
            "pieces": list(_pieces(of, np.searchsorted(grid, of["at"].to_numpy(np.int64)))),
        }
        for (label, number), of in states.groupby(["stream", "id"], observed=True)
    ]
    return {"times": _changes(grid), "cars": cars}


def thinned(times: Whole) -> Whole:
    """Return those of some ascending times that are not too near to the last one returned.

    Args:
        times: shape (n,), milliseconds.
    """
    kept = []
    last = -_STEP_MS
    for time in times.tolist():
        if time - last >= _STEP_MS:
            kept.append(time)
            last = time
    return np.array(kept, dtype=np.int64)


def _pieces(states: pd.DataFrame, places: Whole) -> Iterator[dict[str, Any]]:
    """Yield the stretches of a track that have a state at every time of the grid."""
    x, y = (states[name].to_numpy(np.float64) for name in ("x", "y"))
    heading = np.nan_to_num(states["heading"].to_numpy(np.float64))
    seen = states["observed"].to_numpy(bool)
    for part in np.split(np.arange(len(places)), np.flatnonzero(np.diff(places) != 1) + 1):
        turned = np.rint(np.degrees(np.unwrap(heading[part])))
        yield {
            "from": int(places[part[0]]),
            "x": _changes(np.rint(_PER_METRE * x[part])),
            "y": _changes(np.rint(-_PER_METRE * y[part])),
            "h": _changes(turned),
            "unseen": np.flatnonzero(~seen[part]).tolist(),
        }


def _changes(values: npt.NDArray[Any]) -> list[int]:
    """Return the first value and by how much each of the others differs from the one before."""
    whole = values.astype(np.int64)
    changes: list[int] = np.diff(whole, prepend=np.int64(0)).tolist()
    return changes
