"""The wheel, built and installed away from the checkout."""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGES = ("anchoring", "chronicles", "dyknow", "networks", "perception", "traffic")
NEEDED = [
    *(path.relative_to(ROOT) for package in PACKAGES for path in (ROOT / package).rglob("*.py")),
    *(path.relative_to(ROOT) for package in PACKAGES for path in (ROOT / package).rglob("*.lark")),
    *(
        Path("traffic") / path.relative_to(ROOT)
        for path in (ROOT / "data").rglob("*")
        if path.is_file()
    ),
]


def pip(*arguments: str) -> None:
    """Run pip without a network."""
    command = [sys.executable, "-m", "pip", *arguments, "--no-deps", "--no-index", "--quiet"]
    subprocess.run([*command, "--disable-pip-version-check"], check=True, capture_output=True)


@pytest.mark.slow
def test_the_wheel_runs_without_the_checkout(tmp_path):
    """It carries every module, grammar and data file, and finds them where it is installed."""
    pip("wheel", str(ROOT), "--no-build-isolation", "--wheel-dir", str(tmp_path))
    (wheel,) = tmp_path.glob("dyknow_traffic-*.whl")
    with zipfile.ZipFile(wheel) as archive:
        carried = set(archive.namelist())
    pip("install", str(wheel), "--target", str(tmp_path / "installed"))

    done = subprocess.run(
        [sys.executable, "-c", _LIST],
        cwd=tmp_path,
        env={"PYTHONPATH": str(tmp_path / "installed")},
        capture_output=True,
        text=True,
        check=False,
    )

    assert not {path.as_posix() for path in NEEDED} - carried
    assert (done.returncode, done.stderr) == (0, "")
    assert "crossing" in done.stdout
    assert str(tmp_path / "installed" / "traffic") in done.stdout


_LIST = """
import sys
import traffic.__main__
import traffic.bundled
import traffic.checking
data = traffic.bundled.data_folder()
print(data)
for path in (*data.rglob("*.kpl"), *data.rglob("*.chronicle")):
    assert not traffic.checking.faults_of_file(path)
sys.argv = ["traffic", "scenarios"]
traffic.__main__.main()
"""
