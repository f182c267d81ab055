"""Finds every fault of a file that a person wrote, whichever of our languages it is in."""

from collections.abc import Callable, Mapping
from pathlib import Path

from chronicles import check as chronicle_check
from chronicles.parser import parse_chronicles
from dyknow.errors import SpecificationError
from dyknow.kpl import check as kpl_check
from dyknow.kpl.parser import parse_specification
from dyknow.mtl import check as formula_check
from dyknow.mtl.parser import parse_formula
from traffic.errors import RequestError, ScenarioError
from traffic.scenarios import read_scenario

__all__ = ["faults_of_file"]

Faults = list[SpecificationError]


def faults_of_file(path: Path) -> list[str]:
    """Return a text for each fault of the file, beginning with its place.

    The ending of the name says what it is: `.kpl`, `.chronicle`, `.mtl` (a formula) or `.toml` (a
    scenario). That a file cannot be read is its only fault then.

    Raises:
        RequestError: The ending is none of these.
    """
    if path.suffix == ".toml":
        return _faults_of_scenario(path)
    find = _FAULTS_BY_ENDING.get(path.suffix)
    if find is None:
        endings = ", ".join([*_FAULTS_BY_ENDING, ".toml"])
        raise RequestError("FILE", f"a name that ends in one of {endings}", path)
    try:
        return [fault.report() for fault in find(path.read_text(encoding="utf-8"), str(path))]
    except OSError as error:
        return [f"cannot read '{path}': {error.strerror}"]
    except UnicodeDecodeError:
        return [f"'{path}' is not a text in UTF-8"]


def _faults_of_scenario(path: Path) -> list[str]:
    try:
        read_scenario(path)
    except ScenarioError as error:
        return list(error.faults)
    return []


def _faults_of_specification(text: str, name: str) -> Faults:
    try:
        specification = parse_specification(text, name)
    except SpecificationError as error:
        return [error]
    return kpl_check.faults(specification)


def _faults_of_chronicles(text: str, name: str) -> Faults:
    try:
        return chronicle_check.faults(parse_chronicles(text, name))
    except SpecificationError as error:
        return [error]


def _faults_of_formula(text: str, name: str) -> Faults:
    try:
        return formula_check.faults(parse_formula(text, name))
    except SpecificationError as error:
        return [error]


_FAULTS_BY_ENDING: Mapping[str, Callable[[str, str], Faults]] = {
    ".kpl": _faults_of_specification,
    ".chronicle": _faults_of_chronicles,
    ".mtl": _faults_of_formula,
}
