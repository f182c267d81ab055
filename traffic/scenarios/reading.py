"""Finds and reads scenarios, and says everything that is wrong with one, with its place."""

import gzip
import html
import re
import zlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from dyknow.source_text import did_you_mean, nearest_name
from dyknow.time import MINUTE, Duration
from traffic.bundled import bundled_or_path, data_folder
from traffic.errors import ScenarioError
from traffic.scenarios.acts import ACTS
from traffic.scenarios.changing import put_all
from traffic.scenarios.fields import Settings
from traffic.scenarios.model import (
    CameraSettings,
    Circulation,
    Flow,
    Scenario,
    Trips,
    TurnShares,
    VehicleType,
)
from traffic.scenarios.places import KeyPath
from traffic.scenarios.toml_files import details_of, faults_of, message_of, read_toml

__all__ = [
    "bundled_scenarios",
    "find_scenario",
    "read_scenario",
    "scenario_of_configuration",
    "scenario_path",
]

_GZIP = b"\x1f\x8b"


def bundled_scenarios() -> tuple[Scenario, ...]:
    """Return the scenarios that come with the program, in order of name."""
    return tuple(read_scenario(path) for path in _bundled_paths().values())


def find_scenario(name: str, changes: Mapping[str, object] | None = None) -> Scenario:
    """Return the bundled scenario of that name, or read the file of that path.

    Args:
        name: Name or path.
        changes: New values of some of its settings, by path (`traffic.settings`).

    Raises:
        ScenarioError: There is neither, or the file has faults.
    """
    return read_scenario(scenario_path(name), changes)


def scenario_path(name: str) -> Path:
    """Return the path of the bundled scenario of that name, or *name* as a path.

    Raises:
        ScenarioError: There is neither.
    """
    return bundled_or_path(name, _bundled_paths(), "scenario", ScenarioError)


def read_scenario(path: Path, changes: Mapping[str, object] | None = None) -> Scenario:
    """Read a scenario from a file.

    Args:
        path: The file.
        changes: New values of some of its settings, by path (`traffic.scenarios.changing`).

    Raises:
        ScenarioError: The file cannot be read or has faults; all of them are named.
        RequestError: A change is about something that is not there.
    """
    source, values = read_toml(path, ScenarioError)
    changed = put_all(changes or {}, values)
    if "name" in values:
        found_name = [("the name of a scenario is that of its file", ("name",))]
        raise ScenarioError(*faults_of(found_name, source))
    try:
        scenario = Scenario.model_validate(
            {"name": path.stem, **values}, context={"folder": path.parent}
        )
    except ValidationError as error:
        found = [_fault(detail) for detail in details_of(error)]
        _raise_for_changes(found, changed)
        raise ScenarioError(*faults_of(found, source)) from error
    misplaced = list(_misplaced_names(scenario))
    _raise_for_changes(misplaced, changed)
    faults = faults_of(misplaced, source)
    if faults:
        raise ScenarioError(*faults)
    return scenario


def scenario_of_configuration(path: Path, duration: Duration = MINUTE) -> Scenario:
    """Return a scenario that runs any SUMO configuration for *duration*, without a camera.

    Raises:
        ScenarioError: There is no such file.
    """
    if not path.is_file():
        raise ScenarioError(f"no SUMO configuration at '{path}'")
    return Scenario(name=path.stem, sumocfg=path, duration=duration)


def _bundled_paths() -> dict[str, Path]:
    return {path.stem: path for path in sorted((data_folder() / "scenarios").glob("*.toml"))}


def _raise_for_changes(
    found: Iterable[tuple[str, KeyPath]], changed: Mapping[KeyPath, str]
) -> None:
    """Blame the changes if a fault is where something was changed: the file does not say that."""
    faults = [
        f"--set {name}: {message}"
        for message, path in found
        for place, name in changed.items()
        if path[: len(place)] == place or place[: len(path)] == path
    ]
    if faults:
        raise ScenarioError(*faults)


def _fault(detail: ErrorDetails) -> tuple[str, KeyPath]:
    """Return what to say about a fault, and its path; an act's kind is no part of a path."""
    match detail["type"], detail["loc"]:
        case "union_tag_not_found", path:
            return "the key 'kind' is missing", path
        case "union_tag_invalid", path:
            kind = str(detail["ctx"]["tag"])
            return _unknown("kind of act", kind, list(ACTS)), (*path, "kind")
        case _, ("acts", int() as number, str(), *inner):
            return message_of(detail, _known_keys), ("acts", number, *inner)
        case _, path:
            return message_of(detail, _known_keys), path


def _known_keys(path: KeyPath) -> list[str]:
    """Return the keys that may stand where the last of *path* stands."""
    sections: Mapping[str, type[Settings]] = {
        "camera": CameraSettings,
        "vehicle_types": VehicleType,
        "flows": Flow,
        "trips": Trips,
        "circulations": Circulation,
        "turns": TurnShares,
    }
    outer = [part for part in path[:-1] if isinstance(part, str)]
    if outer[:1] == ["acts"]:
        return list(ACTS[outer[1]].model_fields)
    model = sections.get(outer[-1], Scenario) if outer else Scenario
    return [key for key in model.model_fields if (model, key) != (Scenario, "name")]


def _misplaced_names(scenario: Scenario) -> Iterator[tuple[str, KeyPath]]:
    """Yield each name of the scenario that stands for nothing, with its path."""
    known = [vehicle_type.name for vehicle_type in scenario.vehicle_types]
    for i, name in enumerate(known):
        if name in known[:i]:
            yield f"there is a vehicle type '{name}' already", ("vehicle_types", i, "name")
    for path, weights in _casts(scenario):
        for name in weights:
            if name not in known:
                yield _unknown("vehicle type", name, known), (*path, name)
    yield from _misplaced_files(scenario)


def _casts(scenario: Scenario) -> Iterator[tuple[KeyPath, Mapping[str, float]]]:
    """Yield each table of weights of vehicle types, with its path."""
    for kind in ("flows", "trips", "circulations"):
        for i, demand in enumerate(getattr(scenario, kind)):
            yield (kind, i, "types"), demand.types
    for i, act in enumerate(scenario.acts):
        for key, weights in act.casts.items():
            yield ("acts", i, key), weights


def _routes(scenario: Scenario) -> Iterator[tuple[KeyPath, tuple[str, ...]]]:
    """Yield each route, with its path."""
    for i, flow in enumerate(scenario.flows):
        yield ("flows", i, "route"), flow.route
    for i, act in enumerate(scenario.acts):
        for key, route in act.routes.items():
            yield ("acts", i, key), route


def _misplaced_files(scenario: Scenario) -> Iterator[tuple[str, KeyPath]]:
    if scenario.sumocfg is not None and not scenario.sumocfg.is_file():
        yield f"no SUMO configuration at '{scenario.sumocfg}'", ("sumocfg",)
    if scenario.network is None:
        return
    if not scenario.network.is_file():
        networks = [path.name for path in sorted((data_folder() / "networks").iterdir())]
        name = scenario.network.name
        yield f"{_unknown('network', name, networks)} (no file '{scenario.network}')", ("network",)
        return
    try:
        text = _network_text(scenario.network)
    except (OSError, EOFError, zlib.error) as error:
        yield f"cannot read '{scenario.network}': {error}", ("network",)
    else:
        yield from _misplaced_roads(scenario, text)


def _network_text(path: Path) -> str:
    raw = path.read_bytes()
    return (gzip.decompress(raw) if raw.startswith(_GZIP) else raw).decode(errors="replace")


def _misplaced_roads(scenario: Scenario, network: str) -> Iterator[tuple[str, KeyPath]]:
    """Yield the names that are not in the text of the network, which may be broken."""
    roads = _ids("edge", network)
    for path, route in _routes(scenario):
        for name in route:
            if name not in roads:
                yield _unknown("road", name, roads), path
    camera = scenario.camera
    if camera is not None and isinstance(camera.look_at, str):
        junctions = _ids("junction", network)
        if camera.look_at not in junctions:
            yield _unknown("junction", camera.look_at, junctions), ("camera", "look_at")


def _ids(tag: str, network: str) -> list[str]:
    found = re.findall(rf"""<{tag}\s(?:[^>]*?\s)?id=(?:"([^":][^"]*)"|'([^':][^']*)')""", network)
    return [html.unescape(double or single) for double, single in found]


def _unknown(kind: str, name: str, known: list[str]) -> str:
    hint = did_you_mean(nearest_name(name, known))
    return f"no {kind} called '{name}'{hint}"
