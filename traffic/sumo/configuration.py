"""SUMO's own files, rewritten so that a run writes only into its folder.

A SUMO configuration, and the files that it names, say in many places where SUMO shall write:
options such as `tripinfo-output`, and attributes such as `file` of a detector. Here the
configuration is written anew into the run's folder. Input files are named by their absolute
paths; those that say where to write are copied with that changed. All else stays as it is, and
nothing is ever written beside the user's files.
"""

import gzip
import os
import re
import xml.etree.ElementTree as ET
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath

from traffic.errors import SimulatorError

__all__ = ["read_options", "relocate", "write_configuration"]

_INPUTS = frozenset(
    {
        "net-file", "route-files", "additional-files", "weight-files", "load-state",
        "fcd-output.filter-edges.input-file", "device.ssm.filter-edges.input-file",
        "astar.all-distances", "astar.landmark-distances", "phemlight-path",
        "device.fcd-replay.files", "edgedata-files", "alternative-net-file", "selection-file",
        "gui-settings-file",
    }
)  # fmt: skip
_OUTPUTS = re.compile(
    r".*-output|.*-dump|.*\.output|log|.*-log"
    r"|save-state\.(prefix|files)|pedestrian\.jupedsim\.(wkt|py)|device\.(ssm|toc)\.file"
)
_SWITCHES = frozenset({"no-step-log", "step-log", "duration-log"})
_DROPPED = frozenset(
    {
        "configuration-file", "save-configuration", "save-template", "save-schema",
        "remote-port", "num-clients", "gui-settings-file", "random",
    }
)  # fmt: skip
_SYNONYMS = {
    "n": "net-file", "net": "net-file",
    "r": "route-files", "routes": "route-files",
    "a": "additional-files", "additional": "additional-files",
    "w": "weight-files", "weights": "weight-files",
    "data-files": "edgedata-files", "m": "edgedata-files",
    "device.fcd-replay.file": "device.fcd-replay.files",
    "ndump": "netstate-dump", "netstate": "netstate-dump", "netstate-output": "netstate-dump",
    "person-fcd": "person-fcd-output", "summary": "summary-output",
    "tripinfo": "tripinfo-output", "personinfo": "personinfo-output",
    "vehroutes": "vehroute-output", "personroutes": "personroute-output",
    "statistics-output": "statistic-output", "l": "log", "log-file": "log",
    "c": "configuration-file", "configuration": "configuration-file",
    "C": "save-configuration", "save-config": "save-configuration",
    "N": "alternative-net-file", "g": "gui-settings-file",
}  # fmt: skip
_WRITING = re.compile(
    rb"""\b(?:file|output|dest|href)\s*=|key\s*=\s*["'](?:file|device\.(?:ssm|toc)\.file)["']"""
)
_READING_TAGS = frozenset({"rerouter", "variableSpeedSign", "calibrator"})
_PICTURES = ("imgFile", "osgFile", "edgesFile")
_NOWHERE = frozenset({"NUL", "nul", "/dev/null", ""})
_SOCKET = re.compile(r"[^/\\]+:\d+")


def read_options(configuration: Path) -> dict[str, str]:
    """Return the options of a SUMO configuration by their full names.

    Raises:
        SimulatorError: The file is missing or no XML.
    """
    root = _parse(configuration)
    options: dict[str, str] = {}
    for element in root.iter():
        value = element.get("value", element.get("v"))
        if value is not None:
            options[_SYNONYMS.get(element.tag, element.tag)] = _expand(value)
    return options


def relocate(options: Mapping[str, str], origin: Path, folder: Path) -> dict[str, str]:
    """Return *options* so that reading stays where it was and writing goes into *folder*.

    Files that say where to write are copied into *folder*, rewritten.

    Args:
        options: Of a configuration, by their full names.
        origin: The folder that relative paths in *options* refer to.
        folder: The folder of the new configuration; outputs go into `output` there.

    Raises:
        SimulatorError: A file that must be copied is missing or no XML.
    """
    relocation = _Relocation(folder)
    moved: dict[str, str] = {}
    for name, value in options.items():
        if name in _DROPPED:
            continue
        if name in _INPUTS:
            moved[name] = ",".join(relocation.read(part, origin) for part in _parts(value))
        elif _OUTPUTS.fullmatch(name) and name not in _SWITCHES:
            moved[name] = ",".join(
                relocation.write(part, origin, folder) for part in _parts(value)
            )
        elif name == "output-prefix":
            moved[name] = value.replace("/", "_")
        else:
            moved[name] = value
    return moved


def write_configuration(options: Mapping[str, str], path: Path) -> None:
    """Write *options* as a SUMO configuration."""
    root = ET.Element("configuration")
    for name, value in options.items():
        ET.SubElement(root, name, {"value": value})
    _write(root, path)


class _Relocation:
    """Where each file of a configuration is read from and written to.

    Args:
        folder: The folder of the new configuration.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._copies: dict[Path, str] = {}
        self._outputs: dict[Path, Path] = {}

    def read(self, name: str, origin: Path) -> str:
        """Return the path to read instead of *name*: the same file, or a copy of it."""
        path = Path(os.path.normpath(origin / name))
        if path not in self._copies:
            self._copies[path] = self._localise(path)
        return self._copies[path]

    def write(self, name: str, origin: Path, seen_from: Path) -> str:
        """Return the path to write instead of *name*, relative to the folder *seen_from*."""
        if name in _NOWHERE or _SOCKET.fullmatch(name):
            return name
        target = self._output(Path(os.path.normpath(origin / name)))
        return PurePosixPath(os.path.relpath(target, seen_from)).as_posix()

    def _output(self, original: Path) -> Path:
        if original not in self._outputs:
            taken = self._outputs.values()
            folder = self._folder / "output"
            folder.mkdir(parents=True, exist_ok=True)
            target = folder / original.name
            for i in range(2, len(taken) + 3):
                if target not in taken:
                    break
                target = folder / f"{i}_{original.name}"
            self._outputs[original] = target
        return self._outputs[original]

    def _localise(self, path: Path) -> str:
        """Return *path* itself, or that of a rewritten copy if the file says where to write."""
        if not path.is_file() or not _WRITING.search(_contents(path)):
            return str(path)
        root = _parse(path)
        inputs = self._folder / "input"
        inputs.mkdir(parents=True, exist_ok=True)
        for element in root.iter():
            self._rewrite(element, path.parent, inputs)
        copy = inputs / f"{len(self._copies)}_{path.name.removesuffix('.gz')}"
        _write(root, copy)
        return PurePosixPath(copy.relative_to(self._folder)).as_posix()

    def _rewrite(self, element: ET.Element, origin: Path, inputs: Path) -> None:
        """Rewrite the paths of one element of a file from *origin*, copied into *inputs*."""
        for name in ("file", "output", "dest", "href", *_PICTURES):
            value = element.get(name)
            if value is None:
                continue
            reads = name == "href" or name in _PICTURES
            if reads or (name == "file" and element.tag in _READING_TAGS):
                element.set(name, str((self._folder / self.read(value, origin)).resolve()))
            else:
                element.set(name, self.write(value, origin, inputs))
        if element.tag == "param" and _WRITING.search(f'key="{element.get("key")}"'.encode()):
            element.set("value", self.write(element.get("value", ""), origin, inputs))


def _contents(path: Path) -> bytes:
    try:
        raw = path.read_bytes()
        return gzip.decompress(raw) if raw.startswith(b"\x1f\x8b") else raw
    except (OSError, EOFError, zlib.error) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise SimulatorError(f"cannot read '{path}': {reason}") from error


def _parse(path: Path) -> ET.Element:
    try:
        return ET.fromstring(_contents(path))
    except ET.ParseError as error:
        line, column = error.position
        fault = str(error).split(":")[0]
        raise SimulatorError(
            f"{path}:{line}:{column + 1}: not well-formed XML: {fault}"
        ) from error
    except (LookupError, ValueError) as error:  # what the XML says of its encoding
        raise SimulatorError(f"{path}:1:1: not well-formed XML: {error}") from error


def _write(root: ET.Element, path: Path) -> None:
    tree = ET.ElementTree(root)
    ET.indent(tree, "    ")
    tree.write(path, encoding="UTF-8", xml_declaration=True)


def _parts(value: str) -> Iterable[str]:
    return [part.strip() for part in re.split(r"[,;]", value) if part.strip()]


def _expand(value: str) -> str:
    """Fill in environment variables, which SUMO allows as `${NAME}`."""
    return re.sub(r"\$\{(\w+)\}", lambda match: os.environ.get(match[1], match[0]), value)
