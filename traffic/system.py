"""The monitoring system: what the symbols of the specification stand for.

How the processes are connected stands in `data/specifications/monitoring.kpl`, not here. This
module translates what the packages have into what their neighbours want, which is also the
complete list of what flows between them.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cache, lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from anchoring.cars import Car
from anchoring.links import LinkSettings, LinkUnit
from anchoring.on_road_objects import OnRoadObject
from anchoring.processes import LinkProcess
from anchoring.reckless_drivers import RecklessDriver
from anchoring.structures import LinkHistory, ObjectLinkageStructures
from anchoring.world_objects import WorldObject
from chronicles.marking import RecognitionMarks
from chronicles.models import Model, models_from_chronicles
from chronicles.processes import ChronicleRecogniser
from chronicles.recognised import RecognitionEvents
from chronicles.specified import read_with_settings
from dyknow.kpl.check import check
from dyknow.kpl.names import descendants
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import Implementations, Network, build_network
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    ANY_SORT,
    GeneratorDeclaration,
    Label,
    Link,
    Setting,
    SourceDeclaration,
    SourceInstance,
    Specification,
    StreamDeclaration,
    StreamTerm,
    UnitDeclaration,
    UnitInstance,
)
from dyknow.mtl.syntax import Formula
from dyknow.streams.process import Source
from dyknow.streams.sample import Sample
from dyknow.time import Duration, TimePoint
from networks.markings import MarkingKind
from networks.roads import RoadMap
from networks.signals import SignalState
from perception.camera import Camera
from perception.lamps import Lamps
from perception.painting import GroundPainter
from perception.processes import (
    ColourCamera,
    SignalLamps,
    ThermalCamera,
    VisionPercepts,
    make_painter,
)
from perception.scene import Ground, build_surroundings
from traffic.bundled import data_folder
from traffic.errors import RequestError
from traffic.features.angular import AngularRelations
from traffic.features.changes import Changes
from traffic.features.danger import CollisionCourses
from traffic.features.following import Following
from traffic.features.headways import Headways
from traffic.features.link_turns import LinkTurns
from traffic.features.moving import Moving
from traffic.features.oncoming import FacingTraffic
from traffic.features.pairs import NearPairs
from traffic.features.parking import BesideBuilding
from traffic.features.positions import NoisyPositions
from traffic.features.relations import CarRelations
from traffic.features.sides import Sides
from traffic.features.stability import StableFor
from traffic.features.standing import Standing
from traffic.features.stop_lines import StopLines
from traffic.features.swaying import SWINGS, Swaying
from traffic.features.travelling import Travelling
from traffic.features.unfiltered import UnfilteredCars
from traffic.world import World

__all__ = [
    "CHRONICLES_SETTINGS",
    "IMAGE_SORTS",
    "Made",
    "MonitoringSystem",
    "bundled_specification",
    "chronicle_file",
    "image_labels",
    "implementations_of",
    "labels_of_sort",
    "outputs_behind",
    "outputs_of",
    "outputs_of_sort",
    "read_specification",
    "sort_of",
    "specification_from",
    "vocabularies_of",
]

_SPECIFICATION = "monitoring.kpl"
_MOST_TEXTS = 32
"""So many specifications and chronicle files are kept, to be used in the next run as well."""

IMAGE_SORTS = frozenset({"colour_image", "thermal_image"})
"""The sorts of images in the specification."""


CHRONICLES_SETTINGS = frozenset({"file", "max_delay"})
"""The settings of the unit `Chronicles`; others are for the parameters of its file."""


class MonitoringSystem:
    """The network of a specification, ready to run.

    Args:
        world: What surrounds it.
        parameters: Values for the parameters of the specification.
        outputs: Names of the output streams that are wanted; only what they need is built. None
            for all.
        specification: Which processes and streams there are; the bundled one by default.
        sources: What makes the source of a symbol, in place of what the world offers.

    Attributes:
        specification: Which processes and streams there are.
        parameters: The values that were given for its parameters.
        implementations: What its symbols stand for.
        network: The network.
        structures: Which symbol was linked to which objects, down to the percepts.
        files: That units have read, such as chronicles, and what lies beside the roads.
        chronicles: Names of the chronicles that can be recognised.
    """

    def __init__(
        self,
        world: World,
        parameters: Mapping[str, object],
        outputs: tuple[str, ...] | None = None,
        *,
        specification: Specification | None = None,
        sources: Mapping[str, Callable[[], Source]] | None = None,
    ) -> None:
        made = Made()
        self.specification = specification or read_specification()
        self.parameters = dict(parameters)
        self.implementations = implementations_of(world, sources, made)
        self.network: Network = build_network(
            self.specification, self.implementations, parameters, outputs
        )
        self.structures = ObjectLinkageStructures(made.histories)
        beside = world.road_map.surroundings.file
        self.files = tuple(dict.fromkeys([*made.files, *([beside] if beside else [])]))
        self.chronicles = tuple(dict.fromkeys(made.chronicles))


@dataclass(frozen=True, slots=True)
class Made:
    """What became known while the parts of a system were made.

    Attributes:
        histories: Of the link processes, in the order in which they were made.
        files: That units have read.
        chronicles: Names of the chronicles of all recognisers.
    """

    histories: list[LinkHistory] = field(default_factory=list)
    files: list[Path] = field(default_factory=list)
    chronicles: list[str] = field(default_factory=list)


def implementations_of(
    world: World,
    sources: Mapping[str, Callable[[], Source]] | None = None,
    made: Made | None = None,
) -> Implementations:
    """Return what the symbols of a specification stand for in *world*.

    The units that are made of one answer share the randomness of the world: to compute the same
    again, make another world of the same seed and ask again.

    Args:
        world: What surrounds the system.
        sources: What makes the source of a symbol, in place of what the world offers.
        made: Is told what becomes known when the parts are made.
    """
    made = Made() if made is None else made
    return Implementations(
        sources={**_sources(world), **(sources or {})},
        units=_units(world, made),
        link=_Links(world.road_map, made.histories).make,
    )


class _Links:
    """Makes link processes, and collects their histories."""

    def __init__(self, road_map: RoadMap, histories: list[LinkHistory]) -> None:
        self._road_map = road_map
        self._histories = histories

    def make(
        self,
        unit: str,
        establish: Formula,
        reestablish: Formula,
        maintain: Formula,
        settings: Mapping[str, Any],
    ) -> LinkProcess:
        known = [each.name for each in fields(LinkSettings)]
        if unknown := [name for name in settings if name not in known]:
            raise ValueError(f"a link process has no setting '{unknown[0]}'")
        if "remove_after" not in settings:
            raise ValueError("a link process needs the setting 'remove_after'")
        least = settings.get("least_states", 1)
        if not isinstance(least, int) or least < 1:
            raise ValueError(
                f"expected 'least_states' to be a whole number of at least 1: {least}"
            )
        conditions = LinkSettings(establish, reestablish, maintain, **settings)
        process = LinkProcess(self._unit(unit), conditions)
        self._histories.append(process.history)
        return process

    def _unit(self, name: str) -> LinkUnit:
        units: dict[str, Callable[[], LinkUnit]] = {
            "WorldObject": WorldObject,
            "OnRoadObject": lambda: OnRoadObject(self._road_map),
            "Car": lambda: Car(self._road_map),
            "RecklessDriver": RecklessDriver,
        }
        if name not in units:
            raise ValueError(f"expected one of {', '.join(units)} to be linked, found '{name}'")
        return units[name]()


def _camera_pose(camera: Camera | None) -> Source:
    if camera is None:
        raise ValueError("there is no camera; expected the view 'vision'")
    return _Constant(camera)


class _Constant:
    """A source of one sample at time 0."""

    def __init__(self, value: object) -> None:
        self._value = value

    def samples(self) -> Iterator[Sample[Any]]:
        """Yield the sample."""
        yield Sample(self._value, TimePoint(0), TimePoint(0))


def bundled_specification() -> Path:
    """Return the path of the specification of the whole application."""
    return data_folder() / "specifications" / _SPECIFICATION


def chronicle_file(name: str) -> Path:
    """Return the path of a chronicle file: a bundled one by its name, or any by its path."""
    path = Path(name)
    return path if path.suffix else data_folder() / "chronicles" / f"{name}.chronicle"


def read_specification(path: Path | None = None, option: str = "--specification") -> Specification:
    """Return the specification of a file, the bundled one by default, checked.

    Args:
        path: The file.
        option: Where a user wrote its name.

    Raises:
        SpecificationErrors: The specification has faults.
        RequestError: The file cannot be read.
    """
    path = path or bundled_specification()
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise RequestError(option, "a file that can be read", path) from error
    except UnicodeDecodeError as error:
        raise RequestError(option, "a text in UTF-8", path) from error
    return specification_from(text, str(path))


def image_labels(specification: Specification) -> frozenset[str]:
    """Return the labels of all generators of images, and of states of images."""
    sorts = _sorts_in(specification)
    made = {text_from(each.label): each.process for each in sorts.generators}
    used = {
        text_from(each.provider): each.provider
        for each in descendants(specification.declarations)
        if isinstance(each, StreamTerm)
    }
    return frozenset(
        label for label, process in {**used, **made}.items() if sorts.of(process) & IMAGE_SORTS
    )


def labels_of_sort(specification: Specification, *wanted: str) -> tuple[str, ...]:
    """Return the labels of the generators whose process gives values of one of these sorts."""
    sorts = _sorts_in(specification)
    return tuple(
        text_from(each.label)
        for each in sorts.generators
        if isinstance(each.process, SourceInstance | UnitInstance | Link)
        and sorts.of(each.process) <= set(wanted)
    )


def sort_of(specification: Specification, label: str) -> str:
    """Return the sort of the values of a declared generator; `any` if it is not one."""
    sorts = _sorts_in(specification)
    made = [each.process for each in sorts.generators if text_from(each.label) == label]
    found = frozenset[str]().union(*map(sorts.of, made))
    return next(iter(found)) if len(found) == 1 else ANY_SORT


def outputs_of(specification: Specification) -> tuple[str, ...]:
    """Return the names of the output streams of *specification*, without those of images."""
    sorts = _sorts_in(specification)
    return tuple(
        output.name.text
        for output in sorts.outputs
        if not sorts.of(output.stream.provider) & IMAGE_SORTS
    )


def outputs_behind(specification: Specification, labels: Collection[str]) -> tuple[str, ...]:
    """Return the names of the output streams that are made of the streams of *labels*."""
    sorts = _sorts_in(specification)
    features = {label.partition("[")[0] for label in labels}
    return tuple(
        output.name.text
        for output in sorts.outputs
        if sorts.features_behind(output.stream.provider) & features
    )


def outputs_of_sort(specification: Specification, sort: str) -> tuple[str, ...]:
    """Return the names of the output streams of *specification* that have this sort alone."""
    sorts = _sorts_in(specification)
    return tuple(
        output.name.text for output in sorts.outputs if sorts.of(output.stream.provider) == {sort}
    )


@lru_cache(maxsize=_MOST_TEXTS)
def specification_from(text: str, name: str) -> Specification:
    """Return the specification that *text* says, checked; *name* is for messages.

    It never changes, so it is read once.

    Raises:
        SpecificationErrors: The specification has faults.
    """
    specification = parse_specification(text, name)
    check(specification)
    return specification


@lru_cache(maxsize=_MOST_TEXTS)
def _sorts_in(specification: Specification) -> "_Sorts":
    return _Sorts(specification)


class _Sorts:
    """Which sorts of values flow where, as far as a specification says so by its own names."""

    def __init__(self, specification: Specification) -> None:
        declarations = list(descendants(specification.declarations))
        self.generators = [each for each in declarations if isinstance(each, GeneratorDeclaration)]
        self.outputs = [each for each in declarations if isinstance(each, StreamDeclaration)]
        self._sort_by_process = {
            each.name.text: each.sort.name
            for each in declarations
            if isinstance(each, SourceDeclaration | UnitDeclaration)
        }
        self._generators_by_feature: dict[str, list[GeneratorDeclaration]] = {}
        for generator in self.generators:
            self._generators_by_feature.setdefault(generator.label.feature.text, []).append(
                generator
            )

        self._features_before = {
            feature: frozenset[str]().union(*(_features_in(each.process) for each in made))
            for feature, made in self._generators_by_feature.items()
        }

    def of(self, node: Any) -> frozenset[str]:
        """Return the sorts of what a process or a provider gives, or of what that is made of."""
        if isinstance(node, SourceInstance | UnitInstance | Link):
            return frozenset({self._sort_by_process.get(_process_name(node), ANY_SORT)})
        reached: dict[str, frozenset[str]] = {}
        self._reach(node, reached)
        return frozenset().union(*reached.values())

    def features_behind(self, node: Any) -> frozenset[str]:
        """Return the features of all generators that a process or a provider is made of."""
        found = set[str]()
        new = set(_features_in(node))
        while new:
            found |= new
            new = {f for feature in new for f in self._features_before.get(feature, ())} - found
        return frozenset(found)

    def _reach(self, node: Any, reached: dict[str, frozenset[str]]) -> None:
        """Note the sorts of the processes that make the values of *node*, by their features."""
        for feature in _features_in(node) - reached.keys():
            reached[feature] = frozenset()
            for generator in self._generators_by_feature.get(feature, ()):
                process = generator.process
                if isinstance(process, SourceInstance | UnitInstance | Link):
                    reached[feature] |= self.of(process)
                else:
                    self._reach(process, reached)


def _process_name(process: SourceInstance | UnitInstance | Link) -> str:
    return (process.source if isinstance(process, SourceInstance) else process.unit).text


def _features_in(node: Any) -> frozenset[str]:
    return frozenset(each.feature.text for each in descendants(node) if isinstance(each, Label))


def _sources(world: World) -> dict[str, Any]:
    return {
        "vehicles": lambda: world.vehicles,
        "signals": lambda: world.signals,
        "camera_pose": lambda: _camera_pose(world.camera),
        "link_turns": lambda: LinkTurns(world.road_map),
    }


def vocabularies_of(road_map: RoadMap) -> dict[str, Sequence[str]]:
    """Return the names that the numbers in a column stand for, by the name of the column."""
    return {
        "link": road_map.links,
        "crossing": road_map.crossings,
        "signal": road_map.signals.names,
        "over": road_map.signals.names,
        "beyond": road_map.signals.names,
        "state": tuple(state.name.lower() for state in SignalState),
        "swing": SWINGS,
        "beside_building": road_map.surroundings.names,
    }


def _units(world: World, made: Made) -> dict[str, Any]:
    country, colour, thermal, positions = world.generator.spawn(4)
    painter = cache(lambda: _painter(world.road_map, country))
    vocabularies = vocabularies_of(world.road_map)
    lamps = Lamps(world.road_map.signals.lines)
    return {
        "ColourCamera": lambda: ColourCamera(painter=painter(), generator=colour, lamps=lamps),
        "ThermalCamera": lambda: ThermalCamera(painter=painter(), generator=thermal),
        "SignalLamps": lambda: SignalLamps(lamps=lamps),
        "VisionPercepts": lambda: VisionPercepts(
            roads=world.road_map.road_polygons(), lamps=lamps
        ),
        "NoisyPositions": partial(NoisyPositions, positions),
        "Moving": Moving,
        "StableFor": StableFor,
        "NearPairs": NearPairs,
        "CarRelations": partial(CarRelations, world.road_map),
        "UnfilteredCars": partial(UnfilteredCars, world.road_map),
        "AngularRelations": AngularRelations,
        "Travelling": Travelling,
        "FacingTraffic": partial(FacingTraffic, world.road_map),
        "Headways": partial(Headways, world.road_map),
        "Following": Following,
        "Swaying": Swaying,
        "CollisionCourses": partial(CollisionCourses, world.road_map),
        "BesideBuilding": partial(BesideBuilding, world.road_map),
        "Standing": Standing,
        "StopLines": partial(StopLines, world.road_map),
        "Sides": partial(Sides, world.road_map),
        "Changes": partial(Changes, vocabularies),
        "Chronicles": _Chronicles(made).recogniser,
        "RecognitionEvents": RecognitionEvents,
        "RecognitionMarks": RecognitionMarks,
    }


class _Chronicles:
    """Makes recognisers, and notes which files they have read, and what they recognise."""

    def __init__(self, made: Made) -> None:
        self._made = made

    def recogniser(
        self, *, file: str, max_delay: Duration, **parameters: Setting
    ) -> ChronicleRecogniser:
        """Recognise the chronicles of a file, with values for its parameters."""
        path = chronicle_file(file)
        models = _models(path, path.read_bytes(), tuple(parameters.values()))
        self._made.files.append(path)
        self._made.chronicles.extend(model.name for model in models)
        return ChronicleRecogniser(models, max_delay=max_delay)


@lru_cache(maxsize=_MOST_TEXTS)
def _models(path: Path, _content: bytes, parameters: tuple[Setting, ...]) -> tuple[Model, ...]:
    """Return the chronicles of a file; read once as long as the file stays as it is."""
    return models_from_chronicles(read_with_settings(path, parameters, CHRONICLES_SETTINGS))


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
        buildings=tuple(road_map.surroundings.outlines()),
    )
