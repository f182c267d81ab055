"""What a user asks of the regression suite, read from the command line and checked."""

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from dyknow.time import Duration, duration_from_text
from traffic.errors import RequestError
from traffic.recording.finding import find_recording
from traffic.recording.rebuilding import describe, open_run
from traffic.regression.cutting import Piece
from traffic.regression.making import Addition
from traffic.regression.manifest import Making, Manifest, read_manifest
from traffic.regression.suite import Entry, bundled_suite, chosen, entries
from traffic.request import labels_from
from traffic.settings import SCENARIO

__all__ = ["RegressionRequest", "Task"]

_NAME = re.compile(r"[a-z0-9][a-z0-9-]*")


class Task(StrEnum):
    """What is to be done; the options of the command are called alike."""

    REPLAY = "replay"
    LIST = "list"
    UPDATE = "update"
    REMAKE = "remake"
    ADD = "add"


@dataclass(frozen=True, slots=True)
class RegressionRequest:
    """What a user asks of a regression suite.

    Attributes:
        manifest: What the suite says of its recordings.
        task: What is to be done.
        entries: With which recordings.
        changes: With --set, new values of settings, by name.
        addition: What is to be added, if anything is.
    """

    manifest: Manifest
    task: Task
    entries: tuple[Entry, ...] = ()
    changes: Mapping[str, object] = field(default_factory=dict)
    addition: Addition | None = None

    @property
    def makings(self) -> tuple[Making, ...]:
        """How the recordings that were asked for are made, as far as that is known."""
        names = {entry.name for entry in self.entries}
        known = self.manifest.makings.values()
        return tuple(each for each in known if each.name in names and each.scenario is not None)

    @property
    def described(self) -> tuple[Making | None, ...]:
        """What the suite says of each of the recordings that were asked for."""
        return tuple(self.manifest.makings.get(entry.name) for entry in self.entries)

    @property
    def hints(self) -> dict[str, str]:
        """What to do about each recording if it cannot be read."""
        remade = {making.name for making in self.makings}
        return {
            entry.name: f"'traffic regress --remake {entry.name}' makes it anew"
            if entry.name in remade
            else "record its run again, remove it, and add it anew"
            for entry in self.entries
        }

    @classmethod
    def from_texts(
        cls,
        *,
        names: Collection[str] = (),
        suite: Path | None = None,
        tasks: Collection[Task] = (),
        changes: Mapping[str, object] | None = None,
        addition: Mapping[str, Any] | None = None,
    ) -> "RegressionRequest":
        """Read what a user wrote on the command line.

        Args:
            names: Of recordings.
            suite: The folder; the bundled one by default.
            tasks: What is to be done, at most one of them.
            changes: What stands after --set.
            addition: What stands after the options that go with --add, by name; None or an empty
                text for those that were not given.

        Raises:
            RequestError: An option is impossible, or has no meaning beside another one.
            RecordingError: What is to be added is no recording.
            RegressionError: What the suite says of its recordings has faults.
        """
        folder = suite or bundled_suite()
        task = _one_of(tasks)
        if changes and task is not Task.REPLAY:
            raise RequestError("--set", f"nothing beside --{task}", next(iter(changes)))
        for name in changes or ():
            if name.startswith(SCENARIO):
                raise RequestError("--set", "a setting of the specification: runs are over", name)
        if task is Task.ADD:
            if names:
                raise RequestError("--add", "no names of recordings beside it", next(iter(names)))
            added = _addition(addition or {}, folder)
            return cls(read_manifest(folder), task, addition=added)
        for option, value in (addition or {}).items():
            if value:
                fault = "nothing, because it only has a meaning with --add"
                raise RequestError(option, fault, value)
        manifest = read_manifest(folder)
        return cls(manifest, task, _entries(manifest, names, task), changes or {})


def _one_of(tasks: Collection[Task]) -> Task:
    if len(tasks) > 1:
        first, second, *_ = tasks
        raise RequestError(f"--{second}", f"nothing beside --{first}", f"--{second}")
    return next(iter(tasks), Task.REPLAY)


def _entries(manifest: Manifest, names: Collection[str], task: Task) -> tuple[Entry, ...]:
    """Return the recordings of a suite, and those that it should have."""
    folder = manifest.folder
    there = {entry.name for entry in entries(folder)}
    known = sorted(there | {*manifest.makings})
    wanted = chosen(known, names, folder)
    for name in wanted:
        making = manifest.makings.get(name)
        if task is Task.REMAKE and name in names and (making is None or making.scenario is None):
            known = [each.name for each in manifest.makings.values() if each.scenario is not None]
            expected = f"recordings of which 'suite.toml' says the scenario: {', '.join(known)}"
            raise RequestError("--remake", expected, name)
    return tuple(Entry(folder, name) for name in wanted)


def _addition(options: Mapping[str, Any], folder: Path) -> Addition:
    name, recognise = options.get("--name"), options.get("--recognise")
    if not name or _NAME.fullmatch(name) is None:
        expected = "a name of small letters, digits and '-' for what is added"
        raise RequestError("--name", expected, name or "nothing")
    path = find_recording(options["--add"], "--add")
    end = options.get("--to")
    return Addition(
        path,
        Piece(
            _time(options.get("--from") or "0", "--from"),
            _time(end, "--to") if end else _end(path),
        ),
        Entry(folder, name),
        options.get("--shows") or "",
        labels_from(recognise, "--recognise", "names such as 'turns'") if recognise else None,
    )


def _time(text: str, option: str) -> Duration:
    try:
        return duration_from_text(text)
    except ValueError as error:
        expected = "a time such as '200', '1.5 s' or '1 min'"
        raise RequestError(option, expected, text) from error


def _end(recording: Path) -> Duration:
    with open_run(recording) as opened:
        return describe(opened).origin.scenario.duration
