"""Tracks as a page has them, taken apart again as its script does it."""

from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.time import MILLISECOND
from traffic.explaining.kept import open_kept_run
from traffic.reporting.tracks import thinned, tracks_of

TIMES = st.lists(st.integers(0, 5_000), unique=True).map(sorted)


@settings(derandomize=True, deadline=None, max_examples=80)
@given(TIMES)
def test_times_are_thinned_out_evenly(times):
    """The first stays, two that stay are 200 ms apart, and what went was nearer to one before."""
    kept = thinned(np.array(times, dtype=np.int64)).tolist()

    assert kept[:1] == times[:1]
    assert all(later - earlier >= 200 for earlier, later in pairwise(kept))
    assert all(any(0 < time - k < 200 for k in kept) for time in set(times) - set(kept))


def test_tracks_are_where_the_objects_were_believed_to_be(finished_run):
    """All states at the times of the grid come back, to half a decimetre and half a degree."""
    run = open_kept_run(finished_run.folder)
    states = run.read("states")

    tracks = tracks_of(run)

    times = np.cumsum(tracks["times"])
    found = {}
    for car in tracks["cars"]:
        for piece in car["pieces"]:
            columns = zip(*(np.cumsum(piece[name]) for name in "xyh"), strict=True)
            for at, (x, y, heading) in enumerate(columns, start=piece["from"]):
                seen = at - piece["from"] not in piece["unseen"]
                found[car["symbol"], times[at]] = (x / 10, -y / 10, heading, seen)
    expected = states[(states["valid_time"] // MILLISECOND).isin(times)]
    assert len(found) == len(expected) > 100
    for row in expected.itertuples():
        x, y, heading, seen = found[f"car{row.id}", row.valid_time // MILLISECOND]
        assert abs(x - row.x) < 0.051
        assert abs(y - row.y) < 0.051
        assert abs((heading - np.degrees(row.heading) + 180) % 360 - 180) < 0.51
        assert seen == row.observed
