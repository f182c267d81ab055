"""What a map says, in short."""

from collections import Counter

import pytest

from networks.errors import NetworkFileError
from networks.reading import read_road_map
from traffic.bundled import data_folder
from traffic.maps import summary_of_map

CROSSING = data_folder() / "networks" / "crossing" / "crossing.net.xml"


def test_a_summary_says_what_the_map_knows():
    """Counts, sides, and for each crossing its links and the ways through it."""
    road_map = read_road_map(CROSSING)

    summary = summary_of_map(CROSSING)

    assert [crossing.name for crossing in summary.crossings] == list(road_map.crossings)
    assert (summary.lanes, summary.links) == (len(road_map.lanes), len(road_map.links))
    assert not summary.left_hand
    turns = sum((Counter(crossing.turns) for crossing in summary.crossings), Counter())
    assert turns == Counter(str(turn) for turn in road_map.turn_names.values())
    centre = next(crossing for crossing in summary.crossings if crossing.name == "centre")
    assert len(centre.links) == 4
    assert centre.turns["left"] == centre.turns["right"] == centre.turns["straight"] == 4


def test_a_map_that_cannot_be_read_is_refused(tmp_path):
    """The error names the file."""
    with pytest.raises(NetworkFileError, match=r"none\.net\.xml: no such file"):
        summary_of_map(tmp_path / "none.net.xml")
