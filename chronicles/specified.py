"""Chronicle files that a specification names, with settings as the values of their parameters."""

from collections.abc import Collection, Iterable
from pathlib import Path

from chronicles.errors import ChronicleError
from chronicles.parameters import amount_from
from chronicles.parser import read_chronicles
from chronicles.syntax import Amount, ChronicleFile
from dyknow.errors import SortMismatchError, SpecificationError, SpecificationErrors
from dyknow.kpl.parameters import kind_of
from dyknow.kpl.syntax import Number, Setting, Text, Time

__all__ = ["read_with_settings"]


def read_with_settings(
    path: Path, settings: Iterable[Setting], own: Collection[str]
) -> ChronicleFile:
    """Read a chronicle file, whose parameters are set by settings of the unit that reads it.

    Args:
        path: The file.
        settings: The values of parameters.
        own: The names of the settings that the unit has itself; no parameter may be called so.

    Raises:
        SpecificationErrors: The file has faults, or no such parameters, or a setting is none.
    """
    values: dict[str, Amount] = {}
    faults: list[SpecificationError] = []
    for setting in settings:
        try:
            values[setting.name] = _amount(setting)
        except SpecificationError as error:
            faults.append(error)
    if faults:
        raise SpecificationErrors(f"{len(faults)} fault(s)", faults)
    file = read_chronicles(path, values)
    for parameter in file.parameters:
        if parameter.name in own:
            message = (
                f"the unit that reads this file has a setting '{parameter.name}' of its own; "
                "expected another name for the parameter"
            )
            faults.append(ChronicleError(message, parameter.span))
    if faults:
        raise SpecificationErrors(f"{len(faults)} fault(s)", faults)
    return file


def _amount(setting: Setting) -> Amount:
    match setting.value:
        case Number(number):
            return amount_from(number, setting.span)
        case Time(time):
            return amount_from(f"{time} ns", setting.span)
        case Text(text):  # a negative length, which KPL cannot write otherwise
            return amount_from(text, setting.span)
        case value:
            what = f"the setting '{setting.name}'"
            raise SortMismatchError(what, "time or number", kind_of(value), setting.span)
