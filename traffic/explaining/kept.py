"""A finished run, opened to be explained: what it found out, and what it keeps."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from pydantic import ValidationError

from chronicles.events import Recognition, recognition_from_json
from chronicles.specified import read_with_settings
from chronicles.syntax import Chronicle, ChronicleFile
from dyknow.errors import SpecificationErrors
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.settings import plain_value
from dyknow.kpl.syntax import GeneratorDeclaration, Link, Setting, UnitInstance
from dyknow.mtl.printer import text_from_formula
from traffic.errors import ExplanationError
from traffic.explaining.format import DESCRIPTION, FOLDER, FORMAT, SCHEMAS, VERSION, Description
from traffic.explaining.roles import Roles
from traffic.origin import Origin
from traffic.results import RunResult, read_result
from traffic.system import CHRONICLES_SETTINGS, IMAGE_SORTS, chronicle_file

__all__ = ["KeptChronicle", "KeptRun", "open_kept_run", "records_of"]

_RECORDING = b"\x89MCAP"
_SPECIFICATION = "specification"
_NUMBERED = re.compile(r"^\d+-")
"""Before the name of a file, where another one that was kept has the same name."""


@dataclass(frozen=True, slots=True)
class KeptChronicle:
    """A chronicle of a run.

    Attributes:
        path: Of the file that it is from.
        file: What that says, with the values that its parameters had in the run.
        chronicle: The chronicle.
        stream: The label of the stream of its recognitions; empty if that is not known.
    """

    path: Path
    file: ChronicleFile
    chronicle: Chronicle
    stream: str


class KeptRun:
    """A finished run with what it keeps for explanations; files are read when they are needed.

    Attributes:
        folder: Of the run.
        result: What it found out.
        description: What the files are about.
        roles: What its streams are to an explanation.
    """

    def __init__(self, folder: Path, result: RunResult, description: Description) -> None:
        self.folder = folder
        self.result = result
        self.description = description
        network: Any = description.network
        self.roles = Roles(network, IMAGE_SORTS)

    @cached_property
    def origin(self) -> Origin:
        """What the run was made from."""
        path = self.folder / "origin.json"
        try:
            return Origin.model_validate_json(path.read_text(encoding="utf-8"))
        except (OSError, ValidationError, UnicodeDecodeError) as error:
            fault = f"'{path}' does not say what the run was made from"
            raise ExplanationError(f"{fault}: {_short(error)}") from error

    @cached_property
    def events(self) -> pd.DataFrame:
        """All events."""
        return self.read("events")

    @cached_property
    def links(self) -> pd.DataFrame:
        """All links."""
        return self.read("links")

    @cached_property
    def images(self) -> pd.DataFrame:
        """The times of all images."""
        return self.read("images")

    @cached_property
    def recognitions(self) -> Sequence[tuple[dict[str, Any], Recognition]]:
        """All recognitions, with the rows of their samples."""
        return [
            (row, recognition_from_json(json.loads(row["document"])))
            for row in records_of(self.read("recognitions"))
        ]

    @cached_property
    def chronicles(self) -> Sequence[KeptChronicle]:
        """All chronicles of the run; those of a file as often as it was used."""
        return [
            KeptChronicle(path, file, chronicle, stream)
            for path in sorted((self.folder / _SPECIFICATION).glob("*.chronicle"))
            for stream, file in self._readings(path)
            for chronicle in file.chronicles
        ]

    @cached_property
    def conditions(self) -> Mapping[str, Mapping[str, str]]:
        """The conditions of each link process, as the specification writes them."""
        found = {}
        for label in self.roles.links:
            process = _process(self.process_of(label))
            if isinstance(process, Link):
                found[label] = {
                    "establish": text_from_formula(process.establish),
                    "reestablish": text_from_formula(process.reestablish),
                    "maintain": text_from_formula(process.maintain),
                }
        return found

    def _readings(self, path: Path) -> Sequence[tuple[str, ChronicleFile]]:
        """Return what a chronicle file says to each process that has read it, by its label."""
        found = []
        for label in self.roles.recognitions:
            settings = _settings(self.process_of(label))
            name = settings.get("file")
            if name is None or not _is_copy(path.name, str(plain_value(name.value))):
                continue
            values = [each for each in settings.values() if each.name not in CHRONICLES_SETTINGS]
            try:
                found.append((label, read_with_settings(path, values, CHRONICLES_SETTINGS)))
            except SpecificationErrors:  # it has read another file of this name
                continue
        return found or [("", read_with_settings(path, (), CHRONICLES_SETTINGS))]

    def process_of(self, label: str) -> str:
        """Return what makes a stream, as the specification writes it; its label if unknown."""
        known = self.roles.generators.get(label)
        return label if known is None else " ".join(known["process"].split())

    def value_of(self, column: str, code: int) -> str | None:
        """Return what a number in a column stands for; None for no value."""
        names = self.description.vocabularies.get(column)
        if code < -1:
            return None
        if names is None:
            return {0: "false", 1: "true"}.get(code, str(code))
        if code < 0:
            return f"no_{column}"
        return names[code] if code < len(names) else str(code)

    def read(self, name: str, filters: list[tuple[str, str, Any]] | None = None) -> pd.DataFrame:
        """Return the rows of a file that *filters* let through.

        Raises:
            ExplanationError: The file is missing or damaged.
        """
        path = self.folder / FOLDER / f"{name}.parquet"
        try:
            table = pq.read_table(path, filters=filters)
        except FileNotFoundError as error:
            raise ExplanationError(
                f"'{path}' is missing; expected it beside the others"
            ) from error
        except (OSError, pa.ArrowException) as error:
            raise ExplanationError(f"'{path}' is damaged: {_short(error)}") from error
        if table.schema.names != SCHEMAS[name].names:
            expected, found = ", ".join(SCHEMAS[name].names), ", ".join(table.schema.names)
            raise ExplanationError(f"'{path}': expected the columns {expected}, found {found}")
        frame: pd.DataFrame = table.to_pandas(types_mapper=_TYPES.get)
        return frame


_TYPES = {pa.int64(): pd.Int64Dtype(), pa.int32(): pd.Int32Dtype()}


def records_of(frame: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the rows of *frame*, each as values by column."""
    return [{str(name): value for name, value in row.items()} for row in frame.to_dict("records")]


def open_kept_run(folder: Path) -> KeptRun:
    """Open the run in *folder* to explain what it recognised.

    Raises:
        ExplanationError: It is no run, was made by another version, or was damaged.
        ResultError: It is no finished run.
    """
    if folder.is_file():
        raise ExplanationError(_not_a_folder(folder))
    if not folder.exists():
        raise ExplanationError(f"'{folder}' does not exist; expected the folder of a run")
    result = read_result(folder)
    path = folder / FOLDER / DESCRIPTION
    try:
        text = path.read_text(encoding="utf-8")
        description = Description.model_validate_json(text)
    except FileNotFoundError as error:
        raise ExplanationError(
            f"'{folder}' keeps nothing to explain it by: an older version of this program has "
            "made it; make the run again"
        ) from error
    except OSError as error:
        raise ExplanationError(f"cannot read '{path}': {error.strerror}") from error
    except (ValidationError, UnicodeDecodeError) as error:
        raise ExplanationError(f"'{path}' is damaged: {_short(error)}") from error
    if (description.format, description.version) != (FORMAT, VERSION):
        found = f"{description.format!r}, version {description.version}"
        raise ExplanationError(
            f"'{path}': expected {FORMAT!r}, version {VERSION}, found {found}; another version of "
            "this program has made it, make the run again"
        )
    return KeptRun(folder, result, description)


def _not_a_folder(path: Path) -> str:
    with path.open("rb") as file:
        is_recording = file.read(len(_RECORDING)) == _RECORDING
    if is_recording:
        return (
            f"'{path}' is a recording; 'traffic replay {path} --out FOLDER' makes a run of it "
            "that can be explained"
        )
    return f"'{path}' is a file; expected the folder of a run"


def _process(text: str) -> Any:
    """Return the process that *text* describes; None if it is not written like one."""
    specification = parse_specification(f"strmgen it = {text}", "<process>")
    (declaration,) = specification.declarations
    return declaration.process if isinstance(declaration, GeneratorDeclaration) else None


def _settings(text: str) -> dict[str, Setting]:
    """Return the settings of the process that *text* describes, by name."""
    process = _process(text)
    settings = process.settings if isinstance(process, UnitInstance) else ()
    return {each.name: each for each in settings}


def _is_copy(name: str, setting: str) -> bool:
    """Return whether a kept file of that name is one that a specification calls *setting*."""
    return _NUMBERED.sub("", name) == _NUMBERED.sub("", chronicle_file(setting).name)


def _short(error: Exception) -> str:
    if isinstance(error, ValidationError):
        fault = error.errors()[0]
        return f"{'.'.join(map(str, fault['loc']))}: {fault['msg']}"
    return str(error).splitlines()[0]
