"""Pages in a real browser."""

import shutil
import subprocess
from pathlib import Path

import pytest

__all__ = ["in_browser", "needs_browser"]

_BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("chrome")

needs_browser = pytest.mark.skipif(_BROWSER is None, reason="no Chromium is installed")


def in_browser(page: Path, width: int, place: str = "") -> str:
    """Return what a browser has made of a page, after its scripts, if it complains of nothing.

    Args:
        page: A file in a folder that may be written to.
        width: Of the window, pixels.
        place: What stands behind the # of the address.
    """
    command = [
        str(_BROWSER), "--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr",
        f"--user-data-dir={page.parent / 'profile'}", f"--window-size={width},900", "--dump-dom",
        f"{page.resolve().as_uri()}#{place}",
    ]  # fmt: skip
    shown = subprocess.run(command, capture_output=True, text=True, timeout=180, check=True)
    assert "CONSOLE" not in shown.stderr, shown.stderr
    return shown.stdout
