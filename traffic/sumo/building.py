"""Compiles road networks from SUMO's plain XML with netconvert.

netconvert comes with SUMO; the extra `build` of this distribution brings it.
"""

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from traffic.errors import NetworkBuildError

__all__ = ["build_network", "find_netconvert"]

_OPTION_BY_SUFFIX = {
    ".nod.xml": "--node-files",
    ".edg.xml": "--edge-files",
    ".con.xml": "--connection-files",
    ".tll.xml": "--tllogic-files",
    ".typ.xml": "--type-files",
}
_NEEDED = (".nod.xml", ".edg.xml")
_DRAWN = re.compile(r"""\s+shape\s*=\s*("[^"]*"|'[^']*')""")
_GENERATED = re.compile(r"<!-- generated on .*?-->\s*", re.DOTALL)


def build_network(folder: Path, output: Path, *, left_hand: bool = False) -> None:
    """Compile the plain XML files in *folder* into the network file *output*.

    The folder holds `*.nod.xml` and `*.edg.xml`, and maybe `*.con.xml`, `*.tll.xml`, `*.typ.xml`
    and a `*.netccfg` with further options. Coordinates stay as they are. The same files give the
    same bytes: the date that netconvert writes is left out.

    Args:
        folder: Where the plain XML lies.
        output: Path of the network file, ending in `.net.xml`; replaced if it exists.
        left_hand: Whether one drives on the left. Drawn shapes of connections are then replaced
            by computed ones, as netconvert cannot place them in such a network.

    Raises:
        NetworkBuildError: Files are missing, netconvert is missing or refuses, or *output* cannot
            be written.
    """
    arguments = list(_arguments(folder))
    with tempfile.TemporaryDirectory() as scratch:
        built = Path(scratch) / "built.net.xml"
        if left_hand:
            arguments = [_undrawn(argument, Path(scratch)) for argument in arguments]
            arguments += ["--lefthand", "true"]
        _run(folder, [*arguments, "--output-file", str(built)], built)
        text = built.read_text(encoding="utf-8")
    try:
        output.write_text(_GENERATED.sub("", text, count=1), encoding="utf-8")
    except OSError as error:
        raise NetworkBuildError(f"cannot write '{output}': {error.strerror}") from error


def find_netconvert() -> Path:
    """Return the path of netconvert: of the package `sumo`, of SUMO_HOME, or on the PATH.

    Raises:
        NetworkBuildError: There is none.
    """
    for folder in _folders_of_sumo():
        for name in ("netconvert", "netconvert.exe"):
            if (folder / "bin" / name).is_file():
                return folder / "bin" / name
    found = shutil.which("netconvert")
    if found is None:
        raise NetworkBuildError(
            "netconvert, which compiles networks, is not installed",
            ["install it with: pip install 'dyknow-traffic[build]'"],
        )
    return Path(found)


def _folders_of_sumo() -> Iterator[Path]:
    package = find_spec("sumo")
    if package is not None and package.submodule_search_locations:
        yield Path(package.submodule_search_locations[0])
    if "SUMO_HOME" in os.environ:
        yield Path(os.environ["SUMO_HOME"])


def _arguments(folder: Path) -> Iterator[str]:
    if not folder.is_dir():
        raise NetworkBuildError(f"no folder '{folder}'")
    for suffix, option in _OPTION_BY_SUFFIX.items():
        files = sorted(folder.glob(f"*{suffix}"))
        if files:
            yield option
            yield ",".join(str(file) for file in files)
        elif suffix in _NEEDED:
            raise NetworkBuildError(f"no file ending in '{suffix}' in '{folder}'")
    for configuration in sorted(folder.glob("*.netccfg"))[:1]:
        yield "--configuration-file"
        yield str(configuration)
    yield from ("--offset.disable-normalization", "true", "--precision", "2")


def _undrawn(argument: str, scratch: Path) -> str:
    """Return the argument, or copies of the connection files that it lists, without shapes."""
    if not argument.endswith(".con.xml"):
        return argument
    copies = []
    for name in argument.split(","):
        copy = scratch / Path(name).name
        text = Path(name).read_text(encoding="utf-8")
        copy.write_text(_DRAWN.sub("", text), encoding="utf-8")
        copies.append(str(copy))
    return ",".join(copies)


def _run(folder: Path, arguments: list[str], built: Path) -> None:
    program = find_netconvert()
    home = os.environ.get("SUMO_HOME", str(program.parent.parent))
    done = subprocess.run(
        [str(program), *arguments],
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
        env={**os.environ, "SUMO_HOME": home},
        stdin=subprocess.DEVNULL,
    )
    if done.returncode != 0 or not built.is_file():
        said = [line.strip() for line in (done.stderr + done.stdout).splitlines() if line.strip()]
        raise NetworkBuildError(f"netconvert cannot build the network in '{folder}'", said)
