"""The machine that a benchmark runs on."""

import platform
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import psutil

from traffic.benchmarks.results import Machine

__all__ = ["missing_distributions", "this_machine", "version_of"]

_OURS = ("dyknow-traffic", "lark", "mcap", "numpy", "protobuf", "scipy")
_PROCESSORS = Path("/proc/cpuinfo")


def this_machine(peers: Sequence[str] = ()) -> Machine:
    """Return the machine, and the versions of what runs on it, with those of *peers*."""
    installed = {name: version_of(name) for name in (*_OURS, *peers)}
    return Machine(
        processor=_processor(),
        cores=len(psutil.Process().cpu_affinity() or ()) or psutil.cpu_count() or 1,
        memory=psutil.virtual_memory().total,
        system=f"{platform.system()} {platform.machine()}",
        versions={
            "python": platform.python_version(),
            **{name: found for name, found in installed.items() if found is not None},
        },
    )


def version_of(distribution: str) -> str | None:
    """Return the version of an installed distribution, or None if it is not installed."""
    try:
        return version(distribution)
    except PackageNotFoundError:
        return None


def missing_distributions(names: Sequence[str]) -> list[str]:
    """Return a sentence for each distribution to compare with that is not installed."""
    return [
        f"No comparison with {name}, which is not installed ('pip install {name}' brings it)."
        for name in names
        if version_of(name) is None
    ]


def _processor() -> str:
    if _PROCESSORS.exists():
        for line in _PROCESSORS.read_text(encoding="utf-8").splitlines():
            name, _, value = line.partition(":")
            if name.strip() == "model name":
                return value.strip()
    return platform.processor() or "unknown"
