"""The folder of an experiment: what may be there before, and who may write."""

from pathlib import Path

import pytest

from traffic.errors import ExperimentError
from traffic.experiments import folders
from traffic.experiments.folders import Basis, ExperimentFolder

BASIS = Basis(design="d", design_sha256="d", versions={"dyknow-traffic": "1"}, files_sha256={})


@pytest.fixture
def design(tmp_path: Path) -> Path:
    """Return the file of a design; what it says does not matter here."""
    path = tmp_path / "d.toml"
    path.write_text("x = 1\n", encoding="utf-8")
    return path


def test_an_experiment_begins_in_an_empty_folder(design: Path, tmp_path: Path) -> None:
    """One that was made before is as good as a new one."""
    (tmp_path / "e").mkdir()
    folder = ExperimentFolder(tmp_path / "e")

    folder.begin(design, BASIS)

    assert folder.is_there
    assert folder.basis() == BASIS


def test_a_folder_in_which_nothing_was_begun_for_want_of_room_will_do(
    design: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The disk was full at the start; with room it can be begun as if nothing had happened."""
    folder = ExperimentFolder(tmp_path / "e")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(folders, "write_whole", full)
        with pytest.raises(ExperimentError, match=r"cannot write to '.*e': No space left"):
            folder.begin(design, BASIS)
    folder.begin(design, BASIS)

    assert folder.is_there


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda p: p.write_text(""), "expected a folder, found the file"),
        (lambda p: (p.mkdir(), (p / "letters").mkdir()), "new or empty folder, found .*'letters'"),
        (lambda p: (p.mkdir(), (p / "experiment.json").touch()), "--resume goes on"),
    ],
)
def test_nothing_else_is_written_over(tmp_path: Path, make: object, said: str) -> None:
    """A file, a folder with something in it, another experiment: each is told as what it is."""
    assert callable(make)
    make(tmp_path / "e")

    with pytest.raises(ExperimentError, match=said):
        ExperimentFolder(tmp_path / "e").forbid_another()


def test_only_one_program_works_in_a_folder(design: Path, tmp_path: Path) -> None:
    """A second one is told so; when the first one has stopped, it may."""
    one, other = ExperimentFolder(tmp_path / "e"), ExperimentFolder(tmp_path / "e")
    one.begin(design, BASIS)

    with one.locked(), pytest.raises(ExperimentError, match="another program is at work"):
        other.locked().__enter__()
    with other.locked():
        pass


def test_a_damaged_basis_is_told_in_one_line(design: Path, tmp_path: Path) -> None:
    """Which file, and what is wrong."""
    folder = ExperimentFolder(tmp_path / "e")
    folder.begin(design, BASIS)
    (folder.path / "experiment.json").write_text("{", encoding="utf-8")

    with pytest.raises(ExperimentError, match=r"experiment\.json' is damaged: ") as caught:
        folder.basis()
    assert "\n" not in str(caught.value)
