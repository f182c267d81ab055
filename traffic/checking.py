"""Finds every fault of a file that a person wrote, whichever of our languages it is in."""

from collections.abc import Callable, Mapping
from pathlib import Path

from chronicles import boundedness
from chronicles import check as chronicle_check
from chronicles import unused as chronicles_unused
from chronicles.parser import parse_chronicles
from dyknow.errors import SpecificationError, SpecificationErrors
from dyknow.kpl import unused
from dyknow.kpl.check import faults_of_text
from dyknow.kpl.parser import read_specification
from dyknow.mtl.declarations import document_faults
from dyknow.mtl.parser import parse_document
from dyknow.source_text import Span
from traffic.errors import ExperimentError, RegressionError, RequestError, ScenarioError
from traffic.experiments.reading import check_design, read_design
from traffic.regression.manifest import read_makings
from traffic.scenarios import read_scenario
from traffic.scenarios.toml_files import read_toml

__all__ = ["faults_of_file", "warnings_of_file"]

Faults = list[SpecificationError]
Warnings = list[tuple[Span, str]]


def faults_of_file(path: Path) -> list[str]:
    """Return a text for each fault of the file, beginning with its place.

    The ending of the name says what it is: `.kpl`, `.chronicle`, `.mtl` (a formula) or `.toml` (a
    scenario, a design of experiments, or how the recordings of a suite are made). That a file
    cannot be read is its only fault then.

    Raises:
        RequestError: The ending is none of these.
    """
    if path.suffix == ".toml":
        return _faults_of_toml(path)
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

    These are the declarations of a specification that no output stream needs, and of chronicles
    those that nothing uses and the events that they may await without end.
    """
    find = _WARNINGS_BY_ENDING.get(path.suffix)
    if find is None:
        return []
    found = find(path.read_text(encoding="utf-8"), str(path))
    return [f"{span.place}: warning: {message}\n{span.excerpt()}" for span, message in found]


def _faults_of_toml(path: Path) -> list[str]:
    """Return the faults of a design (it has measures), a suite (recordings), or a scenario."""
    try:
        keys = read_toml(path, ScenarioError)[1].keys()
        if "measures" in keys:
            check_design(path, read_design(path))
        elif "recordings" in keys:
            read_makings(path)
        else:
            read_scenario(path)
    except (ExperimentError, RegressionError, ScenarioError) as error:
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


def _warnings_of_specification(text: str, name: str) -> Warnings:
    found = unused.warnings(read_specification(text, name).specification)
    return [(each.span, each.message) for each in found]


def _warnings_of_chronicles(text: str, name: str) -> Warnings:
    file = parse_chronicles(text, name)
    pairs = [(each.span, each.message) for each in chronicles_unused.warnings(file)]
    pairs += [(each.span, each.message) for each in boundedness.warnings(file)]
    return sorted(pairs, key=lambda pair: pair[0].start)


_FAULTS_BY_ENDING: Mapping[str, Callable[[str, str], Faults]] = {
    ".kpl": faults_of_text,
    ".chronicle": _faults_of_chronicles,
    ".mtl": _faults_of_formula,
}

_WARNINGS_BY_ENDING: Mapping[str, Callable[[str, str], Warnings]] = {
    ".kpl": _warnings_of_specification,
    ".chronicle": _warnings_of_chronicles,
}
