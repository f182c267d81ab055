"""The monitoring system: what the symbols of the specification stand for.

How the processes are connected stands in `data/specifications/monitoring.kpl`, not here. This
module translates what the packages have into what their neighbours want, which is also the
complete list of what flows between them.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from anchoring.cars import Car
from anchoring.links import LinkSettings, LinkUnit
from anchoring.on_road_objects import OnRoadObject
from anchoring.processes import LinkProcess
from anchoring.structures import LinkHistory, ObjectLinkageStructures
from anchoring.world_objects import WorldObject
from chronicles.models import models_from_chronicles
from chronicles.parser import read_chronicles
from chronicles.processes import ChronicleRecogniser
from dyknow.kpl.check import check
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import Implementations, Network, build_network
from dyknow.kpl.syntax import Specification
from dyknow.mtl.syntax import Formula
from dyknow.streams.process import Source
from dyknow.streams.sample import Sample
from dyknow.time import Duration, TimePoint
from networks.markings import MarkingKind
from networks.roads import RoadMap
from perception.camera import Camera
from perception.painting import GroundPainter
from perception.processes import ColourCamera, ThermalCamera, VisionPercepts, make_painter
from perception.scene import Ground, build_surroundings
from traffic.bundled import data_folder
from traffic.features.changes import Changes
from traffic.features.link_turns import LinkTurns
from traffic.features.moving import Moving
from traffic.features.pairs import NearPairs
from traffic.features.positions import NoisyPositions
from traffic.features.relations import CarRelations
from traffic.features.stability import StableFor

__all__ = ["MonitoringSystem", "World", "read_specification"]

_SPECIFICATION = "monitoring.kpl"


@dataclass(frozen=True, slots=True)
class World:
    """What surrounds the system: the map, the eyes, and chance.

    Attributes:
        road_map: The map.
        vehicles: The source of true vehicles, which cameras film and noise is added to.
        camera: The pose of the cameras; None if there are none.
        generator: Source of all randomness in sensors.
    """

    road_map: RoadMap
    vehicles: Source
    camera: Camera | None
    generator: np.random.Generator


class MonitoringSystem:
    """The network of the specification, ready to run.

    Args:
        world: What surrounds it.
        parameters: Values for the parameters of the specification.
        outputs: Names of the output streams that are wanted; only what they need is built.

    Attributes:
        network: The network.
        structures: Which symbol was linked to which objects, down to the percepts.
    """

    def __init__(
        self, world: World, parameters: Mapping[str, object], outputs: tuple[str, ...]
    ) -> None:
        self._histories: list[LinkHistory] = []
        self._road_map = world.road_map
        implementations = Implementations(
            sources=_sources(world), units=_units(world), link=self._link
        )
        self.network: Network = build_network(
            read_specification(), implementations, parameters, outputs
        )
        self.structures = ObjectLinkageStructures(self._histories)

    def _link(
        self,
        unit: str,
        establish: Formula,
        reestablish: Formula,
        maintain: Formula,
        settings: Mapping[str, Any],
    ) -> LinkProcess:
        conditions = LinkSettings(establish, reestablish, maintain, **settings)
        process = LinkProcess(self._link_unit(unit), conditions)
        self._histories.append(process.history)
        return process

    def _link_unit(self, name: str) -> LinkUnit:
        units: dict[str, LinkUnit] = {
            "WorldObject": WorldObject(),
            "OnRoadObject": OnRoadObject(self._road_map),
            "Car": Car(self._road_map),
        }
        return units[name]


class _Constant:
    """A source of one sample at time 0."""

    def __init__(self, value: object) -> None:
        self._value = value

    def samples(self) -> Iterator[Sample[Any]]:
        """Yield the sample."""
        yield Sample(self._value, TimePoint(0), TimePoint(0))


def read_specification() -> Specification:
    """Return the bundled specification of the whole application, checked."""
    path = data_folder() / "specifications" / _SPECIFICATION
    specification = parse_specification(path.read_text(encoding="utf-8"), str(path))
    check(specification)
    return specification


def _sources(world: World) -> dict[str, Any]:
    return {
        "vehicles": lambda: world.vehicles,
        "camera_pose": lambda: _Constant(world.camera),
        "link_turns": lambda: LinkTurns(world.road_map),
    }


def _units(world: World) -> dict[str, Any]:
    country, colour, thermal, positions = world.generator.spawn(4)
    painter = cache(lambda: _painter(world.road_map, country))
    vocabularies = {"link": world.road_map.links, "crossing": world.road_map.crossings}
    return {
        "ColourCamera": lambda: ColourCamera(painter=painter(), generator=colour),
        "ThermalCamera": lambda: ThermalCamera(painter=painter(), generator=thermal),
        "VisionPercepts": lambda: VisionPercepts(roads=world.road_map.road_polygons()),
        "NoisyPositions": partial(NoisyPositions, positions),
        "Moving": Moving,
        "StableFor": StableFor,
        "NearPairs": NearPairs,
        "CarRelations": CarRelations,
        "Changes": partial(Changes, vocabularies),
        "Chronicles": _chronicles,
    }


def _chronicles(*, file: str, max_delay: Duration) -> ChronicleRecogniser:
    """Recognise the chronicles of a file: one of the bundled ones by name, or any by its path."""
    path = Path(file)
    if not path.suffix:
        path = data_folder() / "chronicles" / f"{file}.chronicle"
    models = models_from_chronicles(read_chronicles(path))
    return ChronicleRecogniser(models, max_delay=max_delay)


def _painter(road_map: RoadMap, generator: np.random.Generator) -> GroundPainter:
    """Return what paints the country for both cameras."""
    ground = _ground(road_map)
    return make_painter(ground, build_surroundings(ground, generator), generator)


def _ground(road_map: RoadMap) -> Ground:
    lines = {kind: [m.points for m in road_map.markings if m.kind == kind] for kind in MarkingKind}
    return Ground(
        roads=tuple(road_map.road_polygons()),
        junctions=tuple(road_map.crossing_polygons()),
        solid_lines=(*lines[MarkingKind.EDGE], *lines[MarkingKind.CENTRE_SOLID]),
        dashed_lines=(*lines[MarkingKind.LANE], *lines[MarkingKind.CENTRE_DASHED]),
    )
