"""Where an experiment is written: a folder that grows while runs finish.

`design.toml` is the design as it was written, `experiment.json` what its runs depend on besides,
`runs.jsonl` the finished runs. When all are done, `runs.parquet` and `cells.csv` are made of them.
A folder belongs to one design and one version of the program, for good.
"""

import fcntl
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from traffic.errors import ExperimentError
from traffic.experiments.cases import Outcome
from traffic.experiments.journal import read_lines
from traffic.origin import digest_of, versions

__all__ = ["Basis", "ExperimentFolder", "basis_of", "write_whole"]

_FORMAT = 1
_PARTIAL = ".partial"
"""The ending of a file that is being written."""


class Basis(BaseModel):
    """What the runs of an experiment depend on.

    Attributes:
        format: Version of the folder's format.
        design: Name of the design.
        design_sha256: Digest of the text of the design.
        versions: Of this program, of Python, and of what results may depend on.
        files_sha256: Digests of the scenarios, networks, specifications and chronicles that are
            read, by path.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    format: int = _FORMAT
    design: str
    design_sha256: str
    versions: dict[str, str]
    files_sha256: dict[str, str]

    def difference(self, other: "Basis") -> str | None:
        """Return what is not the same in the other one; None if everything is."""
        if self.format != other.format:
            return f"the format of the folder ({self.format}, now {other.format})"
        if self.design_sha256 != other.design_sha256:
            return "the design"
        for name, version in other.versions.items():
            if (was := self.versions.get(name)) != version:
                return f"the version of {name} ({was}, here {version})"
        paths = self.files_sha256.keys() | other.files_sha256.keys()
        for path in sorted(paths):
            if self.files_sha256.get(path) != other.files_sha256.get(path):
                return f"the file '{path}'"
        return None


def basis_of(design: Path, files: Iterable[Path]) -> Basis:
    """Return what runs of a design that read *files* depend on."""
    return Basis(
        design=design.stem,
        design_sha256=digest_of(design),
        versions=versions(),
        files_sha256={str(path): digest_of(path) for path in files},
    )


@dataclass(frozen=True, slots=True)
class ExperimentFolder:
    """The folder of an experiment.

    Attributes:
        path: Of the folder.
    """

    path: Path

    @property
    def is_there(self) -> bool:
        """Whether the folder holds an experiment, finished or not."""
        return self._basis_file.is_file()

    @property
    def design(self) -> Path:
        """The design as it was written."""
        return self.path / "design.toml"

    @property
    def journal(self) -> Path:
        """The finished runs, in the order in which they finished."""
        return self.path / "runs.jsonl"

    @property
    def runs(self) -> Path:
        """The table of all runs; there when all are done."""
        return self.path / "runs.parquet"

    @property
    def cells(self) -> Path:
        """The measures of all cells; there when all are done."""
        return self.path / "cells.csv"

    def forbid_another(self) -> None:
        """Make sure that an experiment may be begun.

        Raises:
            ExperimentError: The folder holds one, or something else.
        """
        if self.is_there:
            fault = f"'{self.path}' exists already; --resume goes on with what is there"
            raise ExperimentError(fault)
        if not self.path.exists():
            return
        if not self.path.is_dir():
            raise ExperimentError(f"--out: expected a folder, found the file '{self.path}'")
        if strange := sorted({each.name for each in self.path.iterdir()} - self._own):
            found = f"'{self.path}' with '{strange[0]}' in it"
            raise ExperimentError(f"--out: expected a new or empty folder, found {found}")

    def begin(self, design: Path, basis: Basis) -> None:
        """Make the folder; one that is empty, or where this was begun and not done, will do.

        Raises:
            ExperimentError: There is something else already, or it cannot be made.
        """
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            with self.locked():
                self.forbid_another()
                write_whole(self.design, design.read_bytes())
                write_whole(self._basis_file, basis.model_dump_json(indent=1).encode() + b"\n")
        except OSError as error:
            raise ExperimentError(f"cannot write to '{self.path}': {error.strerror}") from error

    def resume(self, basis: Basis) -> None:
        """Make sure that runs with this basis may be added to those that are there.

        Raises:
            ExperimentError: There is no experiment, or it has another basis.
        """
        different = self.basis().difference(basis)
        if different is not None:
            fault = (
                f"'{self.path}' cannot be resumed: {different} is not what it was when its runs "
                "were made, and runs of two kinds are not put into one table"
            )
            raise ExperimentError(fault)

    def basis(self) -> Basis:
        """Return what the runs that are there depend on.

        Raises:
            ExperimentError: There is no experiment, or its file is damaged.
        """
        try:
            return Basis.model_validate_json(self._basis_file.read_text(encoding="utf-8"))
        except OSError as error:
            fault = f"'{self.path}' holds no experiment: {error.strerror}"
            raise ExperimentError(fault) from error
        except ValidationError as error:
            first = error.errors()[0]
            key = ".".join(map(str, first["loc"]))
            fault = f"'{self._basis_file}' is damaged: {key}{': ' if key else ''}{first['msg']}"
            raise ExperimentError(fault) from error
        except UnicodeDecodeError as error:
            raise ExperimentError(f"'{self._basis_file}' is damaged: {error}") from error

    def outcomes(self) -> dict[str, Outcome]:
        """Return the finished runs by key; of two of one key, the one that finished first.

        Raises:
            ExperimentError: A line of the journal is damaged.
        """
        found: dict[str, Outcome] = {}
        if not self.journal.exists():
            return found
        for number, line in enumerate(read_lines(self.journal), start=1):
            try:
                outcome = Outcome.from_line(line)
            except ValueError as error:
                raise ExperimentError(f"{self.journal}:{number}: {error}") from error
            found.setdefault(outcome.key, outcome)
        return found

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Keep other programs from working in the folder while the block lasts.

        Raises:
            ExperimentError: Another one is at work there, or the folder cannot be written.
        """
        try:
            file = self.journal.open("ab")
        except OSError as error:
            raise ExperimentError(f"cannot write '{self.journal}': {error.strerror}") from error
        with file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError as error:
                raise ExperimentError(f"another program is at work in '{self.path}'") from error
            yield

    @property
    def _own(self) -> set[str]:
        """Names of what is there before an experiment has begun."""
        begun = (self.design, self._basis_file)
        return {self.journal.name, *(n for p in begun for n in (p.name, f"{p.name}{_PARTIAL}"))}

    @property
    def _basis_file(self) -> Path:
        return self.path / "experiment.json"


def write_whole(path: Path, content: bytes) -> None:
    """Write a file so that it is there whole or not at all.

    Raises:
        OSError: It cannot be written.
    """
    partial = path.with_name(f"{path.name}{_PARTIAL}")
    try:
        partial.write_bytes(content)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)
