"""What a road map says, in short, for people who look at a network for the first time."""

from collections import Counter
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from networks.reading import read_road_map

__all__ = ["CrossingSummary", "MapSummary", "summary_of_map"]


class CrossingSummary(BaseModel):
    """One crossing.

    Attributes:
        name: As `--look-at` understands it.
        centre: metres in the world frame.
        links: Names of the links that meet there.
        turns: How many ways lead through it, by way of turning.
    """

    model_config = ConfigDict(frozen=True)

    name: str
    centre: tuple[float, float]
    links: list[str]
    turns: dict[str, int]


class MapSummary(BaseModel):
    """A network as the road map sees it.

    Attributes:
        network: The file.
        roads: Number of directed roads, ways through junctions included.
        lanes: Number of lanes.
        links: Number of links.
        left_hand: Whether one drives on the left.
        crossings: In the order of the map.
    """

    model_config = ConfigDict(frozen=True)

    network: str
    roads: int
    lanes: int
    links: int
    left_hand: bool
    crossings: list[CrossingSummary]


def summary_of_map(path: Path) -> MapSummary:
    """Read a compiled network and summarise it.

    Raises:
        NetworkError: The network cannot be read.
    """
    road_map = read_road_map(path)
    crossings = []
    for index, name in enumerate(road_map.crossings):
        through = {place: turn for place, turn in road_map.turn_names.items() if place[1] == name}
        links = sorted({link for first, _, last in through for link in (first, last)})
        x, y = road_map.crossing_centre(index)
        turns = Counter(str(turn) for turn in through.values())
        centre = (round(float(x), 1), round(float(y), 1))
        crossings.append(CrossingSummary(name=name, centre=centre, links=links, turns=turns))
    return MapSummary(
        network=str(path),
        roads=len(road_map.roads),
        lanes=len(road_map.lanes),
        links=len(road_map.links),
        left_hand=road_map.left_hand,
        crossings=crossings,
    )
