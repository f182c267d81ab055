"""Where the files that come with the program lie, and how they are called."""

from collections.abc import Callable, Mapping
from pathlib import Path

from dyknow.source_text import did_you_mean, nearest_name

__all__ = ["bundled_or_path", "data_folder"]

_ENDING = ".toml"


def data_folder() -> Path:
    """Return the folder of bundled data: inside the installed package, or in the checkout."""
    package = Path(__file__).parent
    installed = package / "data"
    return installed if installed.is_dir() else package.parent / "data"


def bundled_or_path(
    name: str, bundled: Mapping[str, Path], what: str, error: Callable[[str], Exception]
) -> Path:
    """Return the path of the bundled TOML file of that name, or *name* as a path.

    Args:
        name: Name or path.
        bundled: The files that come with the program, by name.
        what: What people call such a file.
        error: What to raise if there is neither.
    """
    if name in bundled:
        return bundled[name]
    if name.endswith(_ENDING) or Path(name).is_file():
        return Path(name)
    hint = did_you_mean(nearest_name(name, bundled))
    known = ", ".join(bundled)
    raise error(f"no {what} called '{name}'{hint} (there are {known}, or a {_ENDING} file)")
