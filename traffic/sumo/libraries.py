"""What SUMO needs from the system, and how to say what is missing.

The wheel of libsumo links libraries of the X window system and OpenGL although it opens no
window. Run as a program (`python -m traffic.sumo.libraries`) this module tells whether they are
there.
"""

import ctypes
import sys
from importlib import import_module
from types import ModuleType

from traffic.errors import SimulatorError

__all__ = ["check_system_libraries", "load_simulator", "missing_libraries"]

_PACKAGE_BY_LIBRARY = {
    "libX11.so.6": "libx11-6",
    "libXext.so.6": "libxext6",
    "libXrender.so.1": "libxrender1",
    "libGL.so.1": "libgl1",
}


def load_simulator() -> ModuleType:
    """Import libsumo.

    Raises:
        SimulatorError: It is not installed, or libraries of the system are missing.
    """
    try:
        return import_module("libsumo")
    except ImportError as error:
        check_system_libraries()
        raise SimulatorError("the simulator 'libsumo' cannot be imported", [str(error)]) from error


def check_system_libraries() -> None:
    """Do nothing if the system has what libsumo needs.

    Raises:
        SimulatorError: Libraries are missing; the message says how to install them.
    """
    missing = missing_libraries()
    if missing:
        packages = " ".join(_PACKAGE_BY_LIBRARY[name] for name in missing)
        raise SimulatorError(
            f"the simulator SUMO needs system libraries that are missing: {', '.join(missing)}",
            [f"on Debian or Ubuntu: apt-get install {packages}"],
        )


def missing_libraries() -> list[str]:
    """Return the libraries that libsumo links and the system cannot load; Linux only."""
    if not sys.platform.startswith("linux"):
        return []
    return [name for name in _PACKAGE_BY_LIBRARY if not _can_load(name)]


def _can_load(name: str) -> bool:
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True


if __name__ == "__main__":
    try:
        check_system_libraries()
    except SimulatorError as error:
        sys.exit(str(error))
