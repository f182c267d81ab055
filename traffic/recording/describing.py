"""What a recording says of its run besides the streams: enough to make the same system again."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from dyknow.kpl.syntax import Specification
from dyknow.service.governor import PeriodChange
from traffic.errors import ReplayError
from traffic.origin import PROGRAM, Origin, versions
from traffic.recording.periods import changes_from_text, text_from_changes
from traffic.system import specification_from

__all__ = ["COMPLETE", "RunDescription", "metadata_of_periods"]

COMPLETE = {"complete": "yes"}
"""What a recording says in the end, if it has got there."""

_SPECIFICATION = "specification"
_PLACE = "specification.place"
_PARAMETERS = "parameters"
_OUTPUTS = "outputs"
_ORIGIN = "origin"
_PERIODS = "period_changes"


def metadata_of_periods(changes: Sequence[PeriodChange]) -> dict[str, str]:
    """Return as texts for a recording which sample periods have been changed so far."""
    return {_PERIODS: text_from_changes(changes)} if changes else {}


@dataclass(frozen=True, slots=True)
class RunDescription:
    """What a run was made from, as its recording says it.

    Attributes:
        origin: Versions, request, scenario, network, files.
        text: The specification as it was written.
        place: The name of its file.
        parameters: The values that were given to its parameters.
        outputs: The output streams that were asked for.
        is_complete: Whether the recording goes to the end of the run.
        period_changes: The sample periods that were changed because of the load.
    """

    origin: Origin
    text: str
    place: str
    parameters: Mapping[str, Any]
    outputs: tuple[str, ...]
    is_complete: bool = True
    period_changes: tuple[PeriodChange, ...] = ()

    @property
    def specification(self) -> Specification:
        """The specification.

        Raises:
            SpecificationErrors: It has faults, which it had not when it was recorded: it was
                written for another version of the language.
        """
        return specification_from(self.text, self.place)

    @property
    def named_text(self) -> tuple[str, str]:
        """The name of the file of the specification, without its folder, and the text."""
        return Path(self.place).name, self.text

    def as_metadata(self) -> dict[str, str]:
        """Return the description as texts for a recording that begins."""
        return {
            _SPECIFICATION: self.text,
            _PLACE: self.place,
            _PARAMETERS: json.dumps(dict(self.parameters)),
            _OUTPUTS: json.dumps(self.outputs),
            _ORIGIN: self.origin.model_dump_json(),
            **metadata_of_periods(self.period_changes),
        }

    @classmethod
    def from_metadata(cls, metadata: Mapping[str, str], path: Path) -> "RunDescription":
        """Return what the recording at *path* says.

        Raises:
            ReplayError: It is not a recording of 'traffic run', or says it in another form.
        """
        missing = [name for name in (_SPECIFICATION, _ORIGIN) if name not in metadata]
        if missing:
            fault = f"expected a recording of 'traffic run', found one without '{missing[0]}'"
            raise ReplayError(path, fault)
        try:
            return cls(
                origin=Origin.model_validate_json(metadata[_ORIGIN]),
                text=metadata[_SPECIFICATION],
                place=metadata.get(_PLACE, str(path)),
                parameters=json.loads(metadata.get(_PARAMETERS, "{}")),
                outputs=tuple(json.loads(metadata.get(_OUTPUTS, "[]"))),
                is_complete=COMPLETE.items() <= metadata.items(),
                period_changes=changes_from_text(metadata.get(_PERIODS, "[]")),
            )
        except (ValidationError, ValueError, TypeError) as error:
            said = str(error).splitlines()[0]
            fault = f"what it says of its run cannot be read: {said}{_writer(metadata[_ORIGIN])}"
            raise ReplayError(path, fault) from error


def _writer(origin: str) -> str:
    """Return, as the end of a message, which version of this program wrote an origin, if known."""
    try:
        then = json.loads(origin)["versions"][PROGRAM]
    except (ValueError, TypeError, KeyError):
        return ""
    return f"; version {then} of this program wrote it, this is {versions()[PROGRAM]}"
