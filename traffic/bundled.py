"""Where the files that come with the program lie."""

from pathlib import Path

__all__ = ["data_folder"]


def data_folder() -> Path:
    """Return the folder of bundled data: inside the installed package, or in the checkout."""
    package = Path(__file__).parent
    installed = package / "data"
    return installed if installed.is_dir() else package.parent / "data"
