"""Which chronicles are asked for."""

from collections.abc import Sequence
from dataclasses import dataclass

from chronicles.acceptance import Acceptance
from chronicles.boundedness import UnlimitedEvent, warnings
from chronicles.models import Model, models_from_chronicles
from chronicles.parser import read_chronicles
from chronicles.recognition import Recogniser
from traffic.errors import RequestError
from traffic.recognising.library import path_of

__all__ = ["Question", "read_question"]


@dataclass(frozen=True, slots=True)
class Question:
    """Chronicles that are to be recognised.

    Attributes:
        models: The chronicles.
        acceptance: Which events are as their files declare them.
        warnings: The events that an instance may await without end.
    """

    models: tuple[Model, ...]
    acceptance: Acceptance
    warnings: tuple[UnlimitedEvent, ...]


def read_question(names: Sequence[str]) -> Question:
    """Read chronicle files.

    Args:
        names: Paths of files, or names of families that come with the program.

    Raises:
        OSError: A file cannot be read.
        RequestError: There is no such family, no chronicle at all, or two of one name.
        SpecificationErrors: A file has faults.
    """
    files = [read_chronicles(path_of(name)) for name in names]
    models = tuple(model for file in files for model in models_from_chronicles(file))
    if not models:
        raise RequestError("CHRONICLES", "at least one chronicle", ", ".join(names))
    try:
        Recogniser(models)
    except ValueError as error:
        raise RequestError("CHRONICLES", "chronicles that fit together", error) from error
    found = tuple(warning for file in files for warning in warnings(file))
    return Question(models, Acceptance(files), found)
