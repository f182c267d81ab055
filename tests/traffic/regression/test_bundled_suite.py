"""The recordings that come with the program, and what they are able to catch."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import GeneratorDeclaration, UnitInstance
from traffic.recognising.library import bundled_families, path_of
from traffic.regression.expectations import tally_of
from traffic.regression.manifest import read_manifest
from traffic.regression.regressing import System, regress
from traffic.regression.suite import Entry, bundled_suite, entries
from traffic.system import read_specification

_SUITE = entries(bundled_suite())

_BROKEN = [
    ("turns", "links.left[?l1, ?x, ?l2]:(?, true)", "links.left[?l1, ?x, ?l2]:(?, false)"),
    ("overtakes", "in_front[?car1, ?car2]:(false, true)", "in_front[?car1, ?car2]:(true, false)"),
    ("reckless_overtakes", "facing[?car1, ?car3]:(?, true)", "facing[?car3, ?car1]:(?, true)"),
    ("following", "parameter tailgating_for = 4 s", "parameter tailgating_for = 1 s"),
    ("weaving", "(no_swing, ?first), t1", "(?, ?first), t1"),
    ("parking", "parameter standing = 20 s", "parameter standing = 60 s"),
    ("near_collision", "    noevent(", "    event("),
    ("signals", "signals.state[?s]:(?, red), t0", "signals.state[?s]:(?, green), t0"),
    ("crossings", "parameter standing = 5 s", "parameter standing = 2 s"),
    ("wrong_way", "    noevent(car_relations.behind", "    event(car_relations.behind"),
]
"""A family of chronicles, something that it says, and what it says in a broken copy."""

_CATCHING = {
    "turns": "turns",
    "overtakes": "overtake-left-and-right",
    "reckless_overtakes": "overtake-facing-traffic",
    "following": "tailgating",
    "weaving": "weaving",
    "parking": "parking",
    "near_collision": "near-collision",
    "signals": "red-light",
    "crossings": "stop-in-crossing",
    "wrong_way": "wrong-way",
}
"""Which recording catches the broken copy of a family."""

_WITHOUT = {"turn_uturn_predicted"}
"""Chronicles of which there is no recording: no bundled network has a U-turn between two links."""


@pytest.mark.golden
@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.parametrize("entry", _SUITE, ids=lambda entry: entry.name)
def test_recorded_scenarios_are_recognised_as_expected(entry: Entry) -> None:
    """With the specification and the chronicles as they are now."""
    (found,) = regress([entry])

    assert found.fault == ""
    assert found.difference == ()


def test_every_chronicle_of_the_library_is_recognised_in_some_recording() -> None:
    """At least once, and the truth agrees."""
    known = {each.name for family in bundled_families() for each in family.entries}
    found = {name for entry in _SUITE for name in tally_of(entry.read_expected()).names("true")}

    assert known - found == _WITHOUT


def test_the_suite_says_of_every_recording_what_it_shows_and_how_it_is_made() -> None:
    """So that each can be made anew; and nothing else lies there."""
    makings = read_manifest(bundled_suite()).makings

    assert sorted(makings) == [entry.name for entry in _SUITE]
    assert all(making.shows and making.scenario for making in makings.values())
    files = {path for entry in _SUITE for path in (entry.recording, entry.expected)}
    assert set(bundled_suite().iterdir()) - files == {bundled_suite() / "suite.toml"}


@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.parametrize(("family", "old", "new"), _BROKEN, ids=[each[0] for each in _BROKEN])
def test_a_broken_chronicle_is_caught(family: str, old: str, new: str, tmp_path: Path) -> None:
    """One condition turned around, or one bound changed, in a copy of each file."""
    text = path_of(family).read_text("utf-8")
    assert old in text

    found = _difference(family, text.replace(old, new, 1), _CATCHING[family], tmp_path)

    assert found


def test_a_chronicle_of_every_family_is_broken() -> None:
    """None is left out."""
    families = [family.name for family in bundled_families()]
    assert sorted(family for family, _, _ in _BROKEN) == sorted(families) == sorted(_CATCHING)


@pytest.mark.exhaustive
@pytest.mark.parametrize("family", sorted(_CATCHING))
def test_most_conditions_are_missed_when_they_are_left_out(family: str, tmp_path: Path) -> None:
    """Every condition of every chronicle, one by one; what is left still follows the grammar.

    Those that no recording misses are bounds that nothing in it exceeds.
    """
    text = path_of(family).read_text("utf-8")
    lines = text.splitlines(keepends=True)
    caught, kept = 0, []
    for chronicle, number in _conditions(lines):
        names = [
            entry.name
            for entry in _SUITE
            if chronicle in tally_of(entry.read_expected()).names("true")
        ]
        without = "".join(lines[:number] + lines[number + 1 :])
        if any(_difference(family, without, name, tmp_path) for name in names):
            caught += 1
        else:
            kept.append(f"{chronicle}: {lines[number].strip()}")

    assert caught > len(kept), kept


def _difference(family: str, text: str, name: str, folder: Path) -> tuple[str, ...]:
    """Return what a recording shows with a changed copy of a family; a fault if it has one."""
    copy = folder / f"{family}.chronicle"
    copy.write_text(text, encoding="utf-8")
    system = System.changed({f"{_label_of(family)}.file": str(copy)})
    try:
        (found,) = regress([Entry(bundled_suite(), name)], system)
    except ExceptionGroup as error:  # the chronicle makes no sense any more
        return (str(error),)
    assert found.fault == ""
    return found.difference


def _label_of(family: str) -> str:
    """Return the label of the recogniser of a family."""
    for each in read_specification().declarations:
        match each:
            case GeneratorDeclaration(label, UnitInstance(settings=settings)):
                if any(s.name == "file" and text_from(s.value) == family for s in settings):
                    return text_from(label)
            case _:
                pass
    raise LookupError(family)


def _conditions(lines: list[str]) -> Iterator[tuple[str, int]]:
    """Yield the name of the chronicle and the number of each line that is a condition."""
    name = ""
    for number, line in enumerate(lines):
        if found := re.match(r"chronicle (\w+)", line):
            name = found[1]
        elif line.startswith("    ") and not line.strip().startswith(("report", "#")):
            yield name, number
