"""What a run was made from, written into its folder so that it can be understood later."""

import hashlib
import platform
import shutil
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from traffic.bundled import data_folder
from traffic.request import RunRequest
from traffic.scenarios import Scenario
from traffic.sumo.opening import network_of

__all__ = ["Origin", "origin_of", "write_origin"]

_DISTRIBUTION = "dyknow-traffic"
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
    """

    model_config = ConfigDict(frozen=True)

    versions: dict[str, str]
    system: str
    request: dict[str, str | int | float | None]
    scenario: Scenario
    network: Path
    network_sha256: str


def origin_of(request: RunRequest) -> Origin:
    """Return what a run of *request* is made from."""
    network = network_of(request.scenario)
    return Origin(
        versions={
            _DISTRIBUTION: _version(_DISTRIBUTION),
            "python": platform.python_version(),
            **{name: _version(name) for name in _OTHERS},
        },
        system=f"{platform.system()} {platform.machine()}",
        request={
            "view": str(request.view),
            "sample_period_ns": request.sample_period,
            "position_noise": request.position_noise,
            "seed": request.seed,
        },
        scenario=request.scenario,
        network=network,
        network_sha256=hashlib.sha256(network.read_bytes()).hexdigest(),
    )


def write_origin(request: RunRequest, folder: Path) -> None:
    """Write `origin.json` into *folder*, and copies of the specification and the chronicles."""
    text = origin_of(request).model_dump_json(indent=1)
    (folder / "origin.json").write_text(f"{text}\n", encoding="utf-8")
    copies = folder / "specification"
    copies.mkdir()
    for kind in ("specifications", "chronicles"):
        for path in sorted((data_folder() / kind).iterdir()):
            shutil.copyfile(path, copies / path.name)


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "unknown"
