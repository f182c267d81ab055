"""What a run was made from, written into its folder so that it can be understood later."""

import hashlib
import platform
import shutil
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from traffic.request import RunRequest
from traffic.scenarios import Scenario
from traffic.sumo.opening import network_of

__all__ = [
    "PROGRAM",
    "Origin",
    "digest_of",
    "origin_of",
    "system_name",
    "versions",
    "write_origin",
]

PROGRAM = "dyknow-traffic"
"""What this program is called among the versions of an origin."""

_OTHERS = ("libsumo", "numpy", "opencv-python-headless", "scipy", "shapely")


class Origin(BaseModel):
    """What a run was made from; nothing here depends on when it ran.

    Attributes:
        versions: Of this program, of Python, and of what its results may depend on.
        system: Operating system and kind of machine.
        request: What was asked for, each option by its name.
        scenario: As it was run; durations in nanoseconds.
        network: Path of the compiled network.
        network_sha256: Digest of that file.
        files_sha256: Digests of the further files that were read, such as chronicles, by path.
    """

    model_config = ConfigDict(frozen=True)

    versions: dict[str, str]
    system: str
    request: dict[str, str | int | float | None]
    scenario: Scenario
    network: Path
    network_sha256: str
    files_sha256: dict[str, str] = {}


def origin_of(request: RunRequest, files: Iterable[Path] = ()) -> Origin:
    """Return what a run of *request*, which reads *files*, is made from."""
    network = network_of(request.scenario)
    return Origin(
        versions=versions(),
        system=system_name(),
        request={
            "view": str(request.view),
            "sample_period_ns": request.sample_period,
            "position_noise": request.position_noise,
            "seed": request.seed,
            "recognise": None if request.recognise is None else ",".join(request.recognise),
            "specification": None if request.specification is None else str(request.specification),
            "changes": ", ".join(f"{k} = {v}" for k, v in request.changes.items()) or None,
        },
        scenario=request.scenario,
        network=network.resolve(),
        network_sha256=digest_of(network),
        files_sha256={str(path): digest_of(path) for path in files},
    )


def versions() -> dict[str, str]:
    """Return the versions of this program, of Python, and of what results may depend on."""
    return {
        PROGRAM: _version(PROGRAM),
        "python": platform.python_version(),
        **{name: _version(name) for name in _OTHERS},
    }


def system_name() -> str:
    """Return the names of the operating system and of the kind of machine."""
    return f"{platform.system()} {platform.machine()}"


def digest_of(path: Path) -> str:
    """Return the SHA-256 of the file at *path*."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def write_origin(
    origin: Origin, specification: tuple[str, str], files: Iterable[Path], folder: Path
) -> None:
    """Write `origin.json` into *folder*, and what it was made from into `specification`.

    Args:
        origin: The origin.
        specification: Name and text of the specification.
        files: What else was read; they are copied.
        folder: The folder of the run.
    """
    text = origin.model_dump_json(indent=1)
    (folder / "origin.json").write_text(f"{text}\n", encoding="utf-8")
    copies = folder / "specification"
    copies.mkdir()
    name, declared = specification
    (copies / name).write_text(declared, encoding="utf-8")
    names = {name}
    for number, path in enumerate(files, start=1):
        copy = path.name if path.name not in names else f"{number}-{path.name}"
        names.add(copy)
        shutil.copyfile(path, copies / copy)


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "unknown"
