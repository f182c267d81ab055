"""Design files: what is said about their faults before anything runs."""

from pathlib import Path

import pytest

from traffic.errors import ExperimentError
from traffic.experiments.cases import cases_of, request_of
from traffic.experiments.reading import bundled_designs, check_design, find_design, read_design
from traffic.system import bundled_specification

GOOD = """
scenario = "rural"
measures = ["overtake.recall"]
[fixed]
view = "truth"
duration = "2 s"
[factors]
position_noise = [0, 4]
"car_relations.gap" = [1, 2]
"""


def faults(text: str, folder: Path) -> list[str]:
    """Return the faults of a text, without folder and excerpt."""
    path = folder / "d.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ExperimentError) as caught:
        check_design(path, read_design(path))
    return [fault.split("\n")[0].removeprefix(f"{folder}/") for fault in caught.value.faults]


def test_the_bundled_designs_are_possible() -> None:
    """Each can be read, says what it is, and every level of it is possible."""
    for path in bundled_designs().values():
        design = read_design(path)
        checked = check_design(path, design)

        assert design.description
        assert checked.simulated_seconds > 0
        assert len(checked.files) >= 3
        assert any(each.parent.name == "scenarios" for each in checked.files)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("view =", "veiw =", ":5:1: --set: expected a parameter of the specification"),
        ("[0, 4]", '[0, "much"]', ":8:1: position_noise: expected a number of metres"),
        ("[0, 4]", "[0, -4]", ":8:1: --position-noise: expected a number of metres, at least 0"),
        ("[0, 4]", "[0, 0]", ":8:1: 'position_noise' has a level twice"),
        ("[0, 4]", "[0, nan]", ":8:1: expected a number, a text, or true or false, found nan"),
        ("[0, 4]", "[[1]]", ":8:1: expected a number, a text, or true or false, found [1]"),
        ("[0, 4]", "4", ":8:1: expected an array, found 4"),
        ('"truth"', '["truth"]', ":5:1: expected a number, a text, or true or false"),
        ("[0, 4]", "[]", ":8:1: expected at least one level, found none"),
        ("[0, 4]", "{ from = 0, to = 4 }", ":8:1: a range of levels needs the table 'sampling'"),
        (".gap", ".gp", ":9:1: no setting of 'CarRelations' called 'gp'"),
        ('"car_relations.gap" = [1', '"overtakes.longst" = ["3 s"', ":9:1: '/"),
        ('car_relations.gap" = [1, 2]', 'overtakes.longest" = [1, "x y"]', ":9:1: expected a dur"),
        (
            'car_relations.gap" = [1, 2]',
            'overtakes.longest" = ["-2 s", 2]',
            ":9:1: chronicle 'ove",
        ),
        ("[1, 2]", '[1, "x"]', ":9:1: the setting 'gap' must be of sort 'number'"),
        ("overtake.recall", "overtak.recall", ":3:1: no run scores 'overtak'; did you mean"),
        (
            "scenario =",
            "scenaro =",
            ":2:1: no key called 'scenaro' here; did you mean 'scenario'?",
        ),
        ('"rural"', '"rurl"', ":4:1: no scenario called 'rurl'; did you mean 'rural'?"),
        ("[fixed]", "[fixed]\nseed = 3", ":5:1: expected 'first_seed' and 'runs_per_cell'"),
        ("[fixed]", "[fixed]\nposition_noise = 1", ":5:1: 'position_noise' cannot be fixed"),
        ("measures", "name = 'x'\nmeasures", ":3:1: a design has no key 'name'"),
        ("[factors]", "[factors", "Expected"),
    ],
)
def test_every_fault_has_its_place(tmp_path: Path, old: str, new: str, said: str) -> None:
    """Line and column, what was expected and what was found."""
    found = faults(GOOD.replace(old, new, 1), tmp_path)

    assert any(said.lower() in fault.lower() for fault in found), found
    assert all(fault.startswith("d.toml:") for fault in found)


def test_a_fault_is_told_once(tmp_path: Path) -> None:
    """However many levels have it, and whatever else could be said about them."""
    found = faults(GOOD.replace("[0, 4]", "[[1], [1]]"), tmp_path)

    assert found == ["d.toml:8:1: expected a number, a text, or true or false, found [1]"]


def test_a_list_with_faults_is_not_called_empty(tmp_path: Path) -> None:
    """A measure that there is not is one fault; a list of none is another one."""
    (unknown,) = faults(GOOD.replace("overtake.recall", "overtake.recal"), tmp_path)
    (empty,) = faults(GOOD.replace('["overtake.recall"]', "[]"), tmp_path)

    assert unknown.startswith("d.toml:3:1: no measure called 'recal'; did you mean 'recall'?")
    assert empty == "d.toml:3:1: expected at least one item for 'measures', found none"


def test_faults_among_many_levels_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of many numbers some networks are tried, but every level's other faults are told."""
    monkeypatch.setattr("traffic.experiments.trials.MOST_NUMBERS", 3)
    noise = [*map(str, range(30))]
    noise[15] = '"much"'
    period = [str(10 * n) for n in range(10, 40)]
    period[7] = "1003"
    text = GOOD.replace("[0, 4]", f"[{', '.join(noise)}]").replace(
        '"car_relations.gap" = [1, 2]', f"sample_period = [{', '.join(period)}]"
    )

    found = faults(text, tmp_path)

    assert len(found) == 2
    assert ":8:1: position_noise: expected a number of metres, found 'much'" in found[0]
    assert ":9:1: --sample-period: expected a multiple of 10 ms" in found[1]


def test_a_parameter_of_chronicles_may_be_a_factor(tmp_path: Path) -> None:
    """Its levels are times, numbers of milliseconds, or a range that is drawn from."""
    text = GOOD.replace('"car_relations.gap" = [1, 2]', '"overtakes.longest" = ["30 s", 60000]')
    drawn = GOOD.replace(
        '"car_relations.gap" = [1, 2]',
        '"overtakes.longest" = { from = 10000, to = 60000, step = 1000 }\n'
        "[sampling]\ncells = 3\nseed = 1",
    )
    cells = []
    for given in (text, drawn):
        path = tmp_path / "d.toml"
        path.write_text(given, encoding="utf-8")
        design = read_design(path)
        check_design(path, design)
        cells.append([cell["overtakes.longest"] for cell in design.combinations()])

    assert cells[0] == ["30 s", 60000] * 2
    assert len(cells[1]) == 3
    assert all(10_000 <= float(level) <= 60_000 for level in cells[1])


def test_a_design_is_found_by_name_or_path() -> None:
    """An unknown name is told with the nearest one."""
    assert find_design("smoke").name == "smoke.toml"
    assert find_design("mine.toml") == Path("mine.toml")
    with pytest.raises(ExperimentError, match="did you mean 'smoke'"):
        find_design("smok")


@pytest.mark.parametrize("where", ["[fixed]", "[factors]"])
@pytest.mark.parametrize("is_absolute", [False, True])
def test_a_specification_lies_beside_the_design(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str, *, is_absolute: bool
) -> None:
    """A relative path is not one from the folder in which the program is called."""
    beside = tmp_path / "mine.kpl"
    beside.write_bytes(bundled_specification().read_bytes())
    named = f'"{beside if is_absolute else beside.name}"'
    value = named if where == "[fixed]" else f"[{named}]"
    (tmp_path / "d.toml").write_text(GOOD.replace(where, f"{where}\nspecification = {value}"))
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    path = Path("..") / "d.toml"

    checked = check_design(path, read_design(path))
    case = next(cases_of(checked.design))
    request = request_of(case, Path("unwritten"))
    beside.unlink()

    assert request.specification is not None
    assert request.specification.resolve() == beside.resolve()
    assert case.folder.is_absolute()
    with pytest.raises(ExperimentError, match=r"d\.toml:\d+:1: --specification: expected a file"):
        check_design(path, read_design(path))
