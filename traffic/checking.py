"""Finds every fault of a file that a person wrote, whichever of our languages it is in."""

from collections.abc import Callable, Mapping
from pathlib import Path

from chronicles import check as chronicle_check
from chronicles.parser import parse_chronicles
from dyknow.errors import SpecificationError, SpecificationErrors
from dyknow.kpl.check import faults_of_text
from dyknow.kpl.parser import read_specification
from dyknow.kpl.unused import warnings
from dyknow.mtl.declarations import document_faults
from dyknow.mtl.parser import parse_document
from traffic.errors import RequestError, ScenarioError
from traffic.scenarios import read_scenario

__all__ = ["faults_of_file", "warnings_of_file"]

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


def warnings_of_file(path: Path) -> list[str]:
    """Return a text for each thing in a file without faults that may not be meant so.

    These are the declarations of a specification that no output stream needs.
    """
    if path.suffix != ".kpl":
        return []
    reading = read_specification(path.read_text(encoding="utf-8"), str(path))
    found = warnings(reading.specification)
    return [f"{each.span.place}: warning: {each.message}\n{each.span.excerpt()}" for each in found]


def _faults_of_scenario(path: Path) -> list[str]:
    try:
        read_scenario(path)
    except ScenarioError as error:
        return list(error.faults)
    return []


def _faults_of_chronicles(text: str, name: str) -> Faults:
    try:
        return chronicle_check.faults(parse_chronicles(text, name))
    except SpecificationErrors as errors:
        return [fault for fault in errors.exceptions if isinstance(fault, SpecificationError)]


def _faults_of_formula(text: str, name: str) -> Faults:
    try:
        return document_faults(parse_document(text, name))
    except SpecificationError as error:
        return [error]


_FAULTS_BY_ENDING: Mapping[str, Callable[[str, str], Faults]] = {
    ".kpl": faults_of_text,
    ".chronicle": _faults_of_chronicles,
    ".mtl": _faults_of_formula,
}
