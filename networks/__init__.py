"""Road networks: where points lie, along which road, and where the roads lead.

Read in this order: `geometry` (polylines), `parts` (a network in plain parts), `stretches` and
`topology` (which junctions are crossings, which edges make a link), `graph` (directed roads),
`turns` (left, right, straight, back), `links` (positions along links), `regions` (areas),
`markings`, `signals` (where traffic lights are), `surroundings` (what lies beside the roads),
`roads` (the `RoadMap`), `ahead` (what is ahead of what), `prediction` (who would touch whom),
`assembling` (from parts to map), `checking` and `reading` (SUMO networks), `building` (made-up
ones), `errors`.
"""

from networks.ahead import RoadsAhead
from networks.errors import NetworkError, NetworkFileError, UnknownPlaceError
from networks.markings import Marking, MarkingKind
from networks.reading import read_road_map
from networks.regions import Places
from networks.roads import Moved, RoadMap
from networks.signals import Signals, SignalState
from networks.surroundings import Surroundings
from networks.turns import Turn

__all__ = [
    "Marking",
    "MarkingKind",
    "Moved",
    "NetworkError",
    "NetworkFileError",
    "Places",
    "RoadMap",
    "RoadsAhead",
    "SignalState",
    "Signals",
    "Surroundings",
    "Turn",
    "UnknownPlaceError",
    "read_road_map",
]
