"""Settings that a user may change without writing a specification or a scenario anew.

A change is written NAME=VALUE. What NAME says:

* `scenario.PATH`: a value of the scenario file, such as `scenario.camera.altitude` or
  `scenario.flows.0.rate_per_hour`; tables of an array are numbered, or called by their `name`
  or `kind`;
* `LABEL.SETTING`: a setting of the process that makes the stream of that label, such as
  `car_relations.gap` or `cars.remove_after`; of one that recognises chronicles also a parameter of
  their file, such as `overtakes.longest`;
* `LABEL/N`: the policy under which the process of that label takes its Nth stream, such as
  `world_objects/1 = "sample every 200, use most recent"`;
* any other: a parameter of the specification, such as `stability`.
"""

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from dyknow.errors import SpecificationError
from dyknow.kpl.names import Declarations
from dyknow.kpl.parser import parse_policy, value_from
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    GeneratorDeclaration,
    Link,
    Setting,
    Specification,
    StreamTerm,
    UnitInstance,
    Value,
)
from dyknow.source_text import SourceText, Span, nearest_name
from traffic.errors import RequestError

__all__ = [
    "SCENARIO",
    "Changes",
    "change_from_text",
    "changed_specification",
    "parameters_in",
]

SCENARIO = "scenario."
"""How the name of a setting of the scenario begins."""

Changes = Mapping[str, object]
"""New values of settings, by name: texts as KPL or TOML write them, numbers, truth values."""

_OPTION = "--set"
_POLICY = re.compile(r"(.+)/(\d+)")
_NUMBER = re.compile(r"[+-]?\d+(\.\d+)?([eE][+-]?\d+)?")


def change_from_text(text: str) -> tuple[str, object]:
    """Return name and value of a change that a user wrote as NAME=VALUE.

    Raises:
        RequestError: It is not written like that.
    """
    name, sign, value = text.partition("=")
    if not sign or not name.strip() or not value.strip():
        raise RequestError(_OPTION, "NAME=VALUE", text)
    return name.strip(), _plain(value.strip())


def parameters_in(changes: Changes, specification: Specification) -> dict[str, object]:
    """Return the changes that are about parameters.

    Raises:
        RequestError: There is no parameter of a name.
    """
    known = Declarations(specification).parameters
    found = {name: value for name, value in changes.items() if _is_parameter(name)}
    for name in found:
        if name not in known:
            raise RequestError(_OPTION, _expected("parameter", name, list(known)), name)
    return found


def changed_specification(specification: Specification, changes: Changes) -> Specification:
    """Return the specification with the settings and policies of its processes changed.

    Changes of parameters and of the scenario are left to others.

    Raises:
        RequestError: What is to be changed is not there, or cannot have the new value.
    """
    for name, value in changes.items():
        if name.startswith(SCENARIO) or _is_parameter(name):
            continue
        if (policy := _POLICY.fullmatch(name)) is not None:
            specification = _with_policy(specification, policy[1], int(policy[2]), value)
        else:
            label, _, setting = name.rpartition(".")
            specification = _with_setting(specification, label, setting, value)
    return specification


def _with_setting(
    specification: Specification, label: str, setting: str, value: object
) -> Specification:
    generator = _generator(specification, label)
    process = generator.process
    if not isinstance(process, UnitInstance | Link):
        found = f"'{label}', which is made by no unit and no link"
        raise RequestError(_OPTION, "the label of a process that has settings", found)
    others = tuple(each for each in process.settings if each.name != setting)
    text = SourceText(_OPTION, f"{label}.{setting} = {value}")
    given = Setting(setting, _value(value), span=Span(text, 0, len(text.text)))
    changed = replace(process, settings=(*others, given))
    return _replaced(specification, generator, replace(generator, process=changed))


def _with_policy(
    specification: Specification, label: str, number: int, value: object
) -> Specification:
    generator = _generator(specification, label)
    process = generator.process
    try:
        constraints = parse_policy(str(value))
    except SpecificationError as error:
        raise RequestError(_OPTION, f"a policy: {error}", value) from error
    match process:
        case UnitInstance(streams=streams) if 1 <= number <= len(streams):
            changed: UnitInstance | Link = replace(
                process, streams=_with_constraints(streams, number, constraints)
            )
        case Link(stream=stream) if number == 1:
            changed = replace(process, stream=replace(stream, constraints=constraints))
        case _:
            raise RequestError(_OPTION, f"an input that '{label}' has", f"{label}/{number}")
    return _replaced(specification, generator, replace(generator, process=changed))


def _with_constraints(
    streams: tuple[StreamTerm, ...], number: int, constraints: Any
) -> tuple[StreamTerm, ...]:
    changed = replace(streams[number - 1], constraints=constraints)
    return (*streams[: number - 1], changed, *streams[number:])


def _generator(specification: Specification, label: str) -> GeneratorDeclaration:
    generators = {
        text_from(each.label): each
        for each in specification.declarations
        if isinstance(each, GeneratorDeclaration)
    }
    if label not in generators:
        raise RequestError(_OPTION, _expected("label", label, list(generators)), label)
    return generators[label]


def _replaced(
    specification: Specification, old: GeneratorDeclaration, new: GeneratorDeclaration
) -> Specification:
    declarations = tuple(new if each is old else each for each in specification.declarations)
    return replace(specification, declarations=declarations)


def _is_parameter(name: str) -> bool:
    return "." not in name and "/" not in name


def _expected(kind: str, name: str, known: list[str]) -> str:
    nearest = nearest_name(name, known)
    hint = f"'{nearest}'" if nearest else f"one of {', '.join(known)}"
    return f"a {kind} of the specification (perhaps {hint})"


def _value(given: object) -> Value:
    return value_from(given if isinstance(given, bool | int | float) else str(given))


def _plain(text: str) -> object:
    """Return the number or truth value that *text* is, or *text* itself."""
    if text in ("true", "false"):
        return text == "true"
    if _NUMBER.fullmatch(text) is None:
        return text
    return float(text) if set(text) & set(".eE") else int(text)
