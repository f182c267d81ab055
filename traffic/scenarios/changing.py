"""New values in the tables of a scenario, before they are validated."""

from collections.abc import Mapping
from typing import Any

from traffic.errors import RequestError
from traffic.scenarios.places import KeyPath

__all__ = ["put_all"]

_OPTION = "--set"
_PREFIX = "scenario."


def put_all(changes: Mapping[str, object], values: dict[str, Any]) -> dict[KeyPath, str]:
    """Put new values into the tables of a TOML file; return their names by path.

    A name is the keys from the root inwards with dots between them, such as
    `camera.altitude`. Tables of an array are numbered from 0, or called by their `name` or
    `kind`: `vehicle_types.car.max_speed`, `flows.0.rate_per_hour`.

    Args:
        changes: New values by name.
        values: The tables, which are changed; a table that is missing is made, so that the
            reader can say whether there may be one.

    Raises:
        RequestError: A part of a name stands for nothing.
    """
    return {_put(name, value, values): _PREFIX + name for name, value in changes.items()}


def _put(name: str, value: object, values: dict[str, Any]) -> KeyPath:
    place: Any = values
    path: list[str | int] = []
    *parts, last = name.split(".")
    for part in parts:
        step = _step(place, part, name)
        place = place.setdefault(step, {}) if isinstance(place, dict) else place[step]
        path.append(step)
    step = _step(place, last, name)
    place[step] = value
    return (*path, step)


def _step(place: object, part: str, name: str) -> str | int:
    """Return the key or the number that *part* of a name stands for."""
    if isinstance(place, dict):
        return part
    if not isinstance(place, list):
        raise RequestError(_OPTION, f"a table or an array before '{part}'", _PREFIX + name)
    if part.isdecimal() and int(part) < len(place):
        return int(part)
    for i, table in enumerate(place):
        if isinstance(table, dict) and part in (table.get("name"), table.get("kind")):
            return i
    expected = f"a number below {len(place)}, or the name of a table, where '{part}' stands"
    raise RequestError(_OPTION, expected, _PREFIX + name)
