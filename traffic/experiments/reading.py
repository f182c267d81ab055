"""Finds and reads designs, and says everything that is wrong with one before anything runs."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from dyknow.errors import SpecificationErrors
from dyknow.source_text import did_you_mean, nearest_name
from traffic.bundled import bundled_or_path, data_folder
from traffic.errors import ExperimentError, TrafficError
from traffic.experiments.cases import Case, request_of, scenario_file
from traffic.experiments.designs import Cell, Design, Level, LevelRange, Sampling
from traffic.experiments.measures import kind_of
from traffic.experiments.trials import trials_of
from traffic.request import RunRequest
from traffic.running import CheckedRequest, RequestChecks
from traffic.scenarios.places import KeyPath
from traffic.scenarios.toml_files import details_of, faults_of, message_of, read_toml

__all__ = ["CheckedDesign", "bundled_designs", "check_design", "find_design", "read_design"]

_SCENARIO = "scenario"
_SEED = "seed"

Found = Iterator[tuple[str, KeyPath]]


def bundled_designs() -> dict[str, Path]:
    """Return the designs that come with the program, by name."""
    return {path.stem: path for path in sorted((data_folder() / "designs").glob("*.toml"))}


def find_design(name: str) -> Path:
    """Return the path of the bundled design of that name, or *name* as a path.

    Raises:
        ExperimentError: There is neither.
    """
    return bundled_or_path(name, bundled_designs(), "design", ExperimentError)


def read_design(path: Path, folder: Path | None = None) -> Design:
    """Read a design; whether its settings are possible is not asked yet.

    Args:
        path: The file.
        folder: What its paths are beside; the folder of the file by default.

    Raises:
        ExperimentError: The file cannot be read or has faults; all of them are named.
    """
    source, values = read_toml(path, ExperimentError)
    names = [
        (f"a design has no key '{key}'; it is the file's", (key,)) for key in _OWN & {*values}
    ]
    if names:
        raise ExperimentError(*faults_of(names, source))
    where = {"name": path.stem, "folder": (folder or path.parent).absolute()}
    try:
        design = Design.model_validate({**where, **values})
    except ValidationError as error:
        found = [(message_of(each, _known_keys), each["loc"]) for each in details_of(error)]
        raise ExperimentError(*dict.fromkeys(faults_of(found, source))) from error
    if faults := faults_of(_contradictions(design), source):
        raise ExperimentError(*faults)
    return design


@dataclass(frozen=True, slots=True)
class CheckedDesign:
    """A design of which every setting has been found possible.

    Attributes:
        design: The design.
        files: That its runs read.
        simulated_seconds: How long its runs are in all.
    """

    design: Design
    files: tuple[Path, ...]
    simulated_seconds: float


def check_design(path: Path, design: Design) -> CheckedDesign:
    """Find out whether every level of every factor is possible; nothing is simulated.

    Each level is tried once, with the first levels of the other factors (`trials`).

    Raises:
        ExperimentError: Something is not; everything that is not is named, with its place.
    """
    source, _ = read_toml(path, ExperimentError)
    found: list[tuple[str, KeyPath]] = []
    checks = RequestChecks()
    checked: list[CheckedRequest] = []
    scenarios: dict[Path, None] = {}
    seconds: list[float] = []
    for trial in trials_of(design):
        settings = {**design.fixed, **trial.cell}
        try:
            request = _request(design, settings)
            if trial.is_whole:
                checked.append(checks.check(request))
            scenarios[scenario_file(_case(design, settings))] = None
            seconds.append(request.simulated_seconds)
        except (TrafficError, SpecificationErrors) as error:
            found.append((_fault(error), _culprit(design, trial.cell, checks) or trial.place))
    found += _unknown_measures(design, checked)
    if found:
        raise ExperimentError(*dict.fromkeys(faults_of(found, source)))
    files = (file for each in checked for file in each.files)
    return CheckedDesign(
        design=design,
        files=tuple(dict.fromkeys([*scenarios, *files])),
        simulated_seconds=sum(seconds) / len(seconds) * design.n_runs,
    )


_OWN = {"name", "folder"}


def _known_keys(path: KeyPath) -> list[str]:
    """Return the keys that may stand where the last of *path* stands."""
    if path and path[0] == "sampling":
        return list(Sampling.model_fields)
    if path and path[0] == "factors":
        return ["from", "to", "step"]
    return [key for key in Design.model_fields if key not in _OWN]


def _contradictions(design: Design) -> Found:
    """Yield what cannot be meant, whatever the settings are."""
    yield from _odd_cells(design)
    for name, levels in design.factors.items():
        yield from _odd_levels(name, levels, is_sampled=design.sampling is not None)
    varying = set(design.varying)
    for name in sorted(varying & set(design.fixed)):
        yield f"'{name}' cannot be fixed and vary", ("fixed", name)
    for section, names in (("factors", varying), ("fixed", set(design.fixed))):
        if _SEED in names:
            yield "expected 'first_seed' and 'runs_per_cell' instead of a seed", (section, _SEED)
    given = [design.scenario is not None, _SCENARIO in varying, _SCENARIO in design.fixed]
    if sum(given) != 1:
        expected = "'scenario' once: as a key, fixed, or as a factor"
        yield f"expected {expected}, found it {sum(given)} times", (_SCENARIO,)


def _odd_cells(design: Design) -> Found:
    if design.cells and (design.factors or design.sampling):
        yield "expected either 'cells' or 'factors', found both", ("cells",)
    for number, cell in enumerate(design.cells):
        if cell.keys() != design.cells[0].keys():
            yield "expected the same settings in all cells", ("cells", number)


def _odd_levels(name: str, levels: tuple[Level, ...] | LevelRange, *, is_sampled: bool) -> Found:
    if isinstance(levels, LevelRange):
        if not is_sampled:
            yield "a range of levels needs the table 'sampling'", ("factors", name)
    elif len(set(map(repr, levels))) != len(levels):
        yield f"'{name}' has a level twice", ("factors", name)


def _request(design: Design, settings: dict[str, Level]) -> RunRequest:
    return request_of(_case(design, settings), Path("unwritten"))


def _case(design: Design, settings: dict[str, Level]) -> Case:
    others = {name: level for name, level in settings.items() if name != _SCENARIO}
    scenario = str(settings.get(_SCENARIO, design.scenario or ""))
    return Case(0, design.first_seed, scenario, others, design.folder)


def _culprit(design: Design, cell: Cell, checks: RequestChecks) -> KeyPath | None:
    """Return the place of the setting without which a cell would be possible, if it is one."""
    settings = {**design.fixed, **cell}
    for name in settings.keys() - {_SCENARIO}:
        try:
            others = {key: level for key, level in settings.items() if key != name}
            checks.check(_request(design, others))
        except (TrafficError, SpecificationErrors):
            continue
        return ("fixed" if name in design.fixed else "factors", name)
    return None


def _unknown_measures(design: Design, checked: list[CheckedRequest]) -> Found:
    """Yield the measures of kinds that no run scores."""
    kinds = sorted({kind for each in checked for kind in each.kinds})
    if not checked:
        return
    for measure in design.measures:
        kind = kind_of(measure)
        if kind not in kinds:
            hint = did_you_mean(nearest_name(kind, kinds))
            known = ", ".join(kinds)
            yield f"no run scores '{kind}'{hint} (they score {known})", ("measures",)


def _fault(error: Exception) -> str:
    if isinstance(error, SpecificationErrors):
        return "; ".join(str(each) for each in error.exceptions)
    return "\n".join(dict.fromkeys(str(error).split("\n")))
