"""Check a SUMO road network file before sumolib reads it.

sumolib takes a network as netconvert writes it for granted, and does not tell where in the file
it stumbled. This pass over the XML finds the faults that people make when they edit or cut a
file, each with its place. It also reads the attribute `lefthand` of `<net>`, which sumolib does
not tell.
"""

import gzip
import math
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import IO
from xml.parsers import expat

from networks.errors import NetworkFileError

__all__ = ["NetworkFile", "check_network_file"]

_REQUIRED = {
    "edge": ("id",),
    "lane": ("id", "index", "speed", "length", "shape"),
    "junction": ("id", "type", "x", "y", "incLanes", "intLanes"),
    "connection": ("from", "to", "fromLane", "toLane", "dir", "state"),
}
_NUMBERS = {"lane": ("speed", "length", "width"), "junction": ("x", "y")}
_FEWEST_POINTS = {"lane": 2, "junction": 0}
_TRUE = frozenset(("1", "true", "yes", "on", "x", "t"))
_GZIP_MAGIC = b"\x1f\x8b"

_Place = tuple[int, int]


@dataclass(frozen=True, slots=True)
class NetworkFile:
    """What a check tells about a network file.

    Attributes:
        left_hand: Whether one drives on the left.
    """

    left_hand: bool


def check_network_file(path: Path) -> NetworkFile:
    """Check that *path* is a SUMO network, plain or packed with gzip.

    Raises:
        NetworkFileError: It is not; with line and column where they are known.
    """
    check = _Check(path)
    try:
        with path.open("rb") as raw:
            is_packed = raw.read(len(_GZIP_MAGIC)) == _GZIP_MAGIC
        with gzip.open(path) if is_packed else path.open("rb") as source:
            check.run(source)
    except FileNotFoundError as fault:
        raise NetworkFileError(path, "no such file") from fault
    except (OSError, EOFError, zlib.error) as fault:
        reason = fault.strerror if isinstance(fault, OSError) and fault.strerror else str(fault)
        raise NetworkFileError(path, f"cannot be read: {reason}") from fault
    return NetworkFile(check.left_hand)


class _Check:
    """One pass over a file; stops at the first fault, as later ones often follow from it."""

    def __init__(self, path: Path) -> None:
        self.left_hand = False
        self._path = path
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._root = ""
        self._edge = ""
        self._lanes_of_edge: dict[str, int] = {}
        self._lanes: set[str] = set()
        self._junctions: set[str] = set()
        self._junctions_wanted: dict[str, tuple[str, _Place]] = {}

    def run(self, source: IO[bytes] | gzip.GzipFile) -> None:
        try:
            self._parser.ParseFile(source)
        except expat.ExpatError as fault:
            place = (fault.lineno, fault.offset + 1)
            raise self._fault(f"broken XML: {expat.ErrorString(fault.code)}", place) from fault
        except (LookupError, ValueError) as fault:  # what the XML says of its encoding
            raise self._fault(f"broken XML: {fault}", (1, 1)) from fault
        for junction, (edge, place) in self._junctions_wanted.items():
            if junction not in self._junctions:
                raise self._fault(
                    f"edge '{edge}' refers to junction '{junction}', which is not declared", place
                )

    def _place(self) -> _Place:
        return self._parser.CurrentLineNumber, self._parser.CurrentColumnNumber + 1

    def _fault(self, fault: str, place: _Place | None = None) -> NetworkFileError:
        line, column = place or self._place()
        return NetworkFileError(self._path, fault, line=line, column=column)

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        if not self._root:
            self._enter_network(name, attributes)
            return
        if name == "junction" and attributes.get("type") == "internal":
            return
        for wanted in _REQUIRED.get(name, ()):
            if wanted not in attributes:
                raise self._fault(f"expected an attribute '{wanted}' of <{name}>")
        for number in _NUMBERS.get(name, ()):
            if number in attributes and not _is_number(attributes[number]):
                raise self._fault(
                    f"expected a number as '{number}' of {name} '{attributes['id']}', "
                    f"found '{attributes[number]}'"
                )
        if name in _FEWEST_POINTS:
            self._check_shape(name, attributes)
        self._enter(name, attributes)

    def _enter(self, name: str, attributes: dict[str, str]) -> None:
        match name:
            case "edge":
                self._enter_edge(attributes)
            case "lane":
                self._lanes.add(attributes["id"])
                self._lanes_of_edge[self._edge] = self._lanes_of_edge.get(self._edge, 0) + 1
            case "junction":
                self._junctions.add(attributes["id"])
            case "connection":
                self._check_connection(attributes)
            case _:
                pass

    def _enter_network(self, name: str, attributes: dict[str, str]) -> None:
        if name != "net":
            raise self._fault(f"expected a SUMO network <net>, found <{name}>")
        if "version" not in attributes:
            raise self._fault("expected an attribute 'version' of <net>")
        self._root = name
        self.left_hand = attributes.get("lefthand", "") in _TRUE

    def _enter_edge(self, attributes: dict[str, str]) -> None:
        self._edge = attributes["id"]
        if self._edge in self._lanes_of_edge:
            raise self._fault(f"edge '{self._edge}' is declared twice")
        self._lanes_of_edge[self._edge] = 0
        if attributes.get("function"):
            return
        for wanted in ("from", "to"):
            if wanted not in attributes:
                raise self._fault(f"expected an attribute '{wanted}' of edge '{self._edge}'")
            self._junctions_wanted.setdefault(attributes[wanted], (self._edge, self._place()))

    def _check_shape(self, name: str, attributes: dict[str, str]) -> None:
        corners = [corner.split(",") for corner in attributes.get("shape", "").split()]
        for corner in corners:
            if len(corner) not in (2, 3) or not all(map(_is_number, corner)):
                raise self._fault(
                    f"expected a point x,y in the shape of {name} '{attributes['id']}', "
                    f"found '{','.join(corner)}'"
                )
        if len(corners) < _FEWEST_POINTS[name]:
            raise self._fault(
                f"expected two points or more in the shape of {name} '{attributes['id']}'"
            )

    def _check_connection(self, attributes: dict[str, str]) -> None:
        for end, lane in (("from", "fromLane"), ("to", "toLane")):
            edge, index = attributes[end], attributes[lane]
            if edge not in self._lanes_of_edge:
                raise self._fault(f"the connection refers to edge '{edge}', which is not declared")
            count = self._lanes_of_edge[edge]
            if not index.isdecimal() or int(index) >= count:
                raise self._fault(
                    f"the connection refers to lane {index} of edge '{edge}', which has {count}"
                )
        via = attributes.get("via")
        if via and via not in self._lanes:
            raise self._fault(f"the connection leads over lane '{via}', which is not declared")


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False
