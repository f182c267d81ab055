"""What was believed of the vehicles of a manoeuvre that was not recognised."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from dyknow.time import MILLISECOND, SECOND
from traffic.explaining.kept import KeptRun
from traffic.explaining.walking import Walker
from traffic.reporting.bands import bands_about
from traffic.reporting.items import symbols_of
from traffic.results import Manoeuvre

__all__ = ["believed_of", "symbols_there"]

_BEFORE = 10 * SECOND
_MOST = 4


def believed_of(walker: Walker, missed: Manoeuvre) -> dict[str, Any]:
    """Return the attributes of the vehicles of a manoeuvre at about its time.

    If no recognition tells their symbols, it is those of the objects that were believed to be
    where it happened: what is `there`.
    """
    known = symbols_of(walker.run.result, missed.vehicles)
    there = [] if known else symbols_there(walker.run, missed)
    found = [bands_about(walker, [each], missed.begin, missed.end) for each in there]
    if known:
        found = [bands_about(walker, known, missed.begin, missed.end)]
    return {
        "there": there,
        "marks": [[missed.begin, "begins"], [missed.end, "ends"]],
        "span": found[0]["span"] if found else None,
        "bands": [band for each in found for band in each["bands"]],
    }


def symbols_there(run: KeptRun, missed: Manoeuvre) -> list[str]:
    """Return the objects that were in the crossing of a manoeuvre, from its link if it has one."""
    vocabularies = run.description.vocabularies
    crossings = _numbers(vocabularies.get("crossing", ()), missed.place)
    links = _numbers(vocabularies.get("link", ()), missed.place[:1])
    if not crossings:
        return []
    states = run.read("states")
    times = states["valid_time"].to_numpy(np.int64)
    begin, end = round(missed.begin * MILLISECOND), round(missed.end * MILLISECOND)
    inside = states[(times >= begin) & (times <= end) & states["crossing"].isin(crossings)]
    before = states[(times >= begin - _BEFORE) & (times <= end) & states["link"].isin(links)]
    sorts = run.description.sorts
    came = set(_objects(before))
    there = [each for each in dict.fromkeys(_objects(inside)) if not links or each in came]
    return [f"{sorts[stream]}{number}" for stream, number in there][:_MOST]


def _numbers(names: Sequence[str], wanted: Sequence[str]) -> list[int]:
    return [number for number, name in enumerate(names) if name in wanted]


def _objects(states: pd.DataFrame) -> list[tuple[str, int]]:
    return list(zip(states["stream"].astype(str), states["id"].astype(int), strict=True))
