"""How the recordings of a suite were made, in a file beside them, so that they can be made again.

As TOML, in `suite.toml`:

    [[recordings]]
    name = "tailgating"
    shows = "One car presses another for four seconds."
    scenario = "tailgating"
    seed = 11
    settings = { view = "truth", position_noise = 1, recognise = "following" }
    from = "20 s"
    to = "40 s"

Settings are those of an experiment (`traffic.experiments.designs`).
"""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    field_validator,
    model_validator,
)

from dyknow.time import duration_from_text
from traffic.errors import RegressionError
from traffic.regression.cutting import Piece
from traffic.regression.suite import replace_text
from traffic.request import RunRequest
from traffic.scenarios.places import KeyPath
from traffic.scenarios.toml_files import details_of, faults_of, message_of, read_toml

__all__ = ["Making", "Manifest", "read_makings", "read_manifest", "text_from_making"]

_FILE = "suite.toml"


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Making(_Table):
    """What a recording shows, and how it was made.

    Attributes:
        name: Of the recording, without its ending.
        shows: What it is in the suite for, a sentence.
        scenario: Name of a bundled one; None if no manifest can say how the run was made.
        seed: Of the run.
        settings: Of the run, as an experiment has them.
        begin: Where time 0 of the recording is in the run; `from` in the file.
        end: Where it ends in the run; `to` in the file.
    """

    name: str
    shows: str = ""
    scenario: str | None = None
    seed: Annotated[int, Field(ge=0)] = 1
    settings: dict[str, bool | int | float | str] = {}
    begin: Annotated[str, Field(alias="from")]
    end: Annotated[str, Field(alias="to")]

    @field_validator("begin", "end")
    @classmethod
    def _is_a_time(cls, text: str) -> str:
        duration_from_text(text)
        return text

    @model_validator(mode="after")
    def _is_ordered(self) -> "Making":
        if not 0 <= self.piece.begin < self.piece.end:
            raise ValueError(f"expected 'from' before 'to', found {self.begin} and {self.end}")
        return self

    @property
    def piece(self) -> Piece:
        """The piece of the run."""
        return Piece(duration_from_text(self.begin), duration_from_text(self.end))

    @property
    def run(self) -> tuple[str, int, str]:
        """What tells two runs apart."""
        return self.scenario or "", self.seed, json.dumps(self.settings, sort_keys=True)

    def request(self, out: Path) -> RunRequest:
        """Return the request of the run, to be written to the folder *out*.

        Raises:
            TrafficError: There is no such scenario, or a setting is impossible.
        """
        if self.scenario is None:
            raise RegressionError(f"nothing says how the run of '{self.name}' was made")
        return RunRequest.from_settings(self.scenario, self.settings, seed=self.seed, out=out)


class _File(_Table):
    recordings: tuple[Making, ...] = ()


class Manifest:
    """What the recordings of a suite show and how they were made, by name.

    Args:
        folder: Of the suite.
        makings: Of those recordings of which it is known, in the order of the file.
    """

    def __init__(self, folder: Path, makings: tuple[Making, ...]) -> None:
        self.folder = folder
        self.makings: Mapping[str, Making] = {making.name: making for making in makings}

    def add(self, making: Making) -> None:
        """Write one more at the end of the file."""
        path = self.folder / _FILE
        text = path.read_text(encoding="utf-8") if path.exists() else ""
        parts = [text.rstrip("\n"), text_from_making(making)]
        replace_text(path, "\n\n".join(part for part in parts if part))


def read_manifest(folder: Path) -> Manifest:
    """Return what stands in the folder of a suite about its recordings; it may be nothing.

    Raises:
        RegressionError: The file cannot be read or has faults; all of them are named.
    """
    path = folder / _FILE
    return Manifest(folder, read_makings(path) if path.exists() else ())


def read_makings(path: Path) -> tuple[Making, ...]:
    """Return what a file says about the recordings beside it.

    Raises:
        RegressionError: The file cannot be read or has faults; all of them are named.
    """
    source, values = read_toml(path, RegressionError)
    try:
        makings = _File.model_validate(values).recordings
    except ValidationError as error:
        found = dict.fromkeys(
            (message_of(each, _known_keys), each["loc"]) for each in details_of(error)
        )
        raise RegressionError(*faults_of(found, source)) from error
    if faults := faults_of(_repeated(makings), source):
        raise RegressionError(*faults)
    return makings


def text_from_making(making: Making) -> str:
    """Return a table of the file."""
    settings = ", ".join(f"{_key(k)} = {_value(v)}" for k, v in making.settings.items())
    known = making.scenario is not None
    lines = [
        "[[recordings]]",
        f"name = {_value(making.name)}",
        f"shows = {_value(making.shows)}",
        *([f"scenario = {_value(making.scenario or '')}"] if known else []),
        *([f"seed = {making.seed}"] if known else []),
        *([f"settings = {{ {settings} }}"] if settings else []),
        f"from = {_value(making.begin)}",
        f"to = {_value(making.end)}",
    ]
    return "\n".join(lines) + "\n"


def _key(name: str) -> str:
    return name if name.replace("_", "").isalnum() and name.isascii() else _value(name)


def _value(value: bool | int | float | str) -> str:  # noqa: FBT001, a value of a setting
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _known_keys(path: KeyPath) -> list[str]:
    if len(path) == 1:
        return list(_File.model_fields)
    return [field.alias or name for name, field in Making.model_fields.items()]


def _repeated(makings: tuple[Making, ...]) -> Iterator[tuple[str, KeyPath]]:
    names: set[str] = set()
    for number, making in enumerate(makings):
        if making.name in names:
            yield f"there is another recording '{making.name}'", ("recordings", number, "name")
        names.add(making.name)
