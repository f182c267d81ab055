"""The system libraries that SUMO needs."""

import ctypes

import pytest

from traffic.errors import SimulatorError
from traffic.sumo.libraries import check_system_libraries, load_simulator, missing_libraries


@pytest.mark.sumo
def test_where_the_simulator_can_be_imported_nothing_is_missing() -> None:
    """The libraries that are looked for are those that libsumo links."""
    load_simulator()

    assert missing_libraries() == []


def test_missing_libraries_are_told_with_their_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    """The message says how to install what is missing, and no more."""

    def without_x11(name: str) -> object:
        if name == "libX11.so.6":
            raise OSError(name)
        return object()

    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setattr(ctypes, "CDLL", without_x11)

    with pytest.raises(SimulatorError) as caught:
        check_system_libraries()

    assert "libX11.so.6" in str(caught.value)
    assert "apt-get install libx11-6" in str(caught.value)
    assert "libgl1" not in str(caught.value)
