"""Where the network of a run is kept, and where pictures of it go.

A run keeps the last snapshot of its network in its folder. A recording has no snapshot, but most
of what would be in one can be found out from it.
"""

from pathlib import Path

from dyknow.inspection.dot import dot_from
from dyknow.inspection.drawing import svg_from
from dyknow.inspection.snapshot import Snapshot
from traffic.errors import RequestError, ResultError
from traffic.inspecting.recorded import network_from_recording

__all__ = ["NETWORK_FILE", "check_picture", "read_network", "write_dot", "write_svg"]

NETWORK_FILE = "network.json"
"""What the snapshot is called in the folder of a run."""

_RESULT_FILE = "result.json"
_RECORDING = b"\x89MCAP"


def read_network(run: Path) -> tuple[Snapshot, str | None]:
    """Return the network of a run, and what is missing of it, if anything is.

    Args:
        run: The folder of the run, a recording, or a snapshot that was kept by itself.

    Raises:
        ResultError: There is none, or its file was damaged.
        RecordingError: The recording is damaged, or of another format.
    """
    path = run / NETWORK_FILE if run.is_dir() else run
    try:
        with path.open("rb") as file:
            is_recording = file.read(len(_RECORDING)) == _RECORDING
        content = b"" if is_recording else path.read_bytes()
    except FileNotFoundError as error:
        raise ResultError(_missing(run)) from error
    except OSError as error:
        raise ResultError(f"cannot read '{path}': {error.strerror}") from error
    if is_recording:
        return network_from_recording(path)
    try:
        return Snapshot.from_json(content), None
    except ValueError as error:
        raise ResultError(f"'{path}': {error}") from error


def check_picture(path: Path | None, option: str, ending: str) -> None:
    """Raise a RequestError if *path* is not a new file with the right *ending*."""
    if path is None:
        return
    if path.suffix != ending:
        raise RequestError(option, f"a file that ends in {ending}", path)
    if path.exists():
        raise RequestError(option, "a file that does not exist yet", path)
    if not path.parent.is_dir():
        raise RequestError(option, "a file in a folder that exists", path)


def write_dot(network: Snapshot, path: Path, title: str) -> None:
    """Write the network for Graphviz."""
    path.write_text(dot_from(network, title), encoding="utf-8")


def write_svg(network: Snapshot, path: Path, title: str) -> None:
    """Write the network as a picture."""
    path.write_text(svg_from(network, title), encoding="utf-8")


def _missing(run: Path) -> str:
    if (run / _RESULT_FILE).exists():
        return (
            f"'{run}' is a run without '{NETWORK_FILE}': an older version of this program has "
            "made it, which kept no figures of the network; make the run again"
        )
    if run.is_dir():
        return f"'{run}' holds no finished run: there is no '{NETWORK_FILE}' in it"
    return f"'{run}' does not exist; expected the folder of a run, or a recording"
