"""What lies beside the roads: buildings, and areas in which one may park.

They are polygons in SUMO's format, in a file beside the network: `town.poly.xml` for
`town.net.xml`, as polyconvert makes it. A part of the type says what a polygon is, `building` or
`parking` (so `building`, `building.house` and `amenity.parking` are known); all others are left
out.
"""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from xml.parsers import expat

import numpy as np
import numpy.typing as npt
import shapely

from networks.errors import NetworkFileError
from networks.geometry import Floats, Indices, Points

__all__ = ["Surroundings", "read_surroundings", "surroundings_file"]

Shapes = npt.NDArray[np.object_]

_NONE = -1
_ENDINGS = (".net.xml", ".net.xml.gz")
_FEWEST_CORNERS = 3


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Buildings and parking areas; never changed after they are made.

    Attributes:
        names: Of the buildings.
        buildings: shape (b,), shapely polygons.
        parking: shape (p,), shapely polygons.
        file: Where they were read from, if they were.
    """

    names: tuple[str, ...] = ()
    buildings: Shapes = field(default_factory=lambda: np.empty(0, dtype=np.object_))
    parking: Shapes = field(default_factory=lambda: np.empty(0, dtype=np.object_))
    file: Path | None = None

    def outlines(self) -> list[Points]:
        """Return the outlines of the buildings, each shape (k, 2), metres."""
        return [shapely.get_coordinates(each.exterior)[:-1] for each in self.buildings]

    def nearest_building(self, points: Points, within: float) -> Indices:
        """Return the building that is nearest to each point, or -1.

        Args:
            points: shape (n, 2), metres.
            within: Buildings that are farther away do not count, metres.
        """
        nearest = np.full(len(points), _NONE, dtype=np.int32)
        if len(self.buildings) and len(points):
            asked, found = self._tree_of_buildings.query_nearest(
                shapely.points(points), max_distance=within, all_matches=False
            )
            nearest[asked] = found
        return nearest

    def distance_to_parking(self, points: Points) -> Floats:
        """Return the metres from each point to the nearest parking area, 0 inside."""
        distance = np.full(len(points), np.inf)
        if len(self.parking) and len(points):
            (asked, _), found = self._tree_of_parking.query_nearest(
                shapely.points(points), return_distance=True, all_matches=False
            )
            distance[asked] = found
        return distance

    @cached_property
    def _tree_of_buildings(self) -> shapely.STRtree:
        return shapely.STRtree(self.buildings)

    @cached_property
    def _tree_of_parking(self) -> shapely.STRtree:
        return shapely.STRtree(self.parking)


def surroundings_file(network: Path) -> Path:
    """Return where the polygons that belong to a network file are, if there are any."""
    ending = next((each for each in _ENDINGS if network.name.endswith(each)), network.suffix)
    return network.with_name(f"{network.name.removesuffix(ending)}.poly.xml")


def read_surroundings(network: Path) -> Surroundings:
    """Return what lies beside the roads of a network file: nothing, if there are no polygons.

    Raises:
        NetworkFileError: The file with the polygons cannot be read, is no XML, names a building
            twice, or has a building or parking area without a shape in metres.
    """
    path = surroundings_file(network)
    if not path.is_file():
        return Surroundings()
    reader = _Reader(path)
    try:
        reader.run(path.read_bytes())
    except OSError as fault:
        raise NetworkFileError(path, f"cannot be read: {fault.strerror}") from fault
    except expat.ExpatError as fault:
        message = f"not well-formed XML: {expat.ErrorString(fault.code)}"
        line, column = fault.lineno, fault.offset + 1
        raise NetworkFileError(path, message, line=line, column=column) from fault
    return Surroundings(
        tuple(reader.buildings),
        np.array(list(reader.buildings.values()), dtype=np.object_),
        np.array(reader.parking, dtype=np.object_),
        path,
    )


class _Reader:
    """Collects polygons while a file is parsed."""

    def __init__(self, path: Path) -> None:
        self.buildings: dict[str, shapely.Polygon] = {}
        self.parking: list[shapely.Polygon] = []
        self._path = path
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start

    def run(self, text: bytes) -> None:
        """Read the whole file."""
        self._parser.Parse(text, True)  # noqa: FBT003, there is no keyword

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        if tag not in ("poly", "polygon"):
            return
        kinds = attributes.get("type", "").split(".")
        name = attributes.get("id", "")
        if "building" in kinds:
            if not name or name in self.buildings:
                raise self._fault(f"expected a name that no other building has, found '{name}'")
            self.buildings[name] = self._shape(attributes)
        elif "parking" in kinds:
            self.parking.append(self._shape(attributes))

    def _shape(self, attributes: dict[str, str]) -> shapely.Polygon:
        written = attributes.get("shape", "")
        try:
            corners = [[float(x) for x in corner.split(",")[:2]] for corner in written.split()]
            points = np.array(corners, dtype=np.float64).reshape(-1, 2)
        except ValueError as error:
            raise self._fault(f"expected corners such as '0,0 9,0 9,5', found '{written}'") from (
                error
            )
        if attributes.get("geo") in ("1", "true") or not np.isfinite(points).all():
            raise self._fault("expected a shape in metres")
        if len(points) < _FEWEST_CORNERS:
            raise self._fault(f"expected at least {_FEWEST_CORNERS} corners, found {len(points)}")
        return shapely.Polygon(points)

    def _fault(self, message: str) -> NetworkFileError:
        line, column = self._parser.CurrentLineNumber, self._parser.CurrentColumnNumber + 1
        return NetworkFileError(self._path, message, line=line, column=column)
