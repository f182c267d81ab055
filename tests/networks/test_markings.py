"""What is painted on roads."""

import numpy as np
import pytest

from networks.building import Road, network_parts
from networks.markings import MarkingKind, markings_of

PLACES = {"west": (0.0, 0.0), "east": (100.0, 0.0)}


def painted(road, *, left_hand=False):
    """Return kind and lateral position of each line of a road along the x axis."""
    markings = markings_of(network_parts(PLACES, [road], left_hand=left_hand))
    assert all(np.ptp(m.points[:, 1]) < 1e-9 for m in markings)
    return sorted((str(m.kind), round(float(m.points[0, 1]), 6)) for m in markings)


@pytest.mark.parametrize("left_hand", [False, True])
def test_two_lanes_each_way(left_hand):
    """Edges outside, lines between lanes, and one solid centre line."""
    assert painted(Road("west", "east", 2), left_hand=left_hand) == [
        ("centre_solid", 0.0),
        ("edge", -6.4),
        ("edge", 6.4),
        ("lane", -3.2),
        ("lane", 3.2),
    ]


def test_where_one_may_overtake_the_centre_line_is_dashed():
    """The centre line tells whether the other direction's lane may be used."""
    kinds = [kind for kind, _ in painted(Road("west", "east", may_overtake=True))]

    assert kinds == [MarkingKind.CENTRE_DASHED, MarkingKind.EDGE, MarkingKind.EDGE]


def test_a_one_way_road_has_two_edges():
    """Without another direction there is no centre line."""
    assert painted(Road("west", "east", one_way=True)) == [("edge", -3.2), ("edge", 0.0)]
