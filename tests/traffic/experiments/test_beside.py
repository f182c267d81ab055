"""Experiments side by side: which cells belong together, against a naive search."""

import itertools

from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.experiments.beside import put_beside, remarks_about
from traffic.experiments.designs import Level
from traffic.experiments.findings import Findings
from traffic.experiments.levels import key_of
from traffic.experiments.measures import Share
from traffic.experiments.tables import CellMeasures

MEASURE = "overtake.detection"
LEVELS = (0, 0.0, 100, "100 ms", "0.1 s", "a", True)
"""Some of them mean the same."""

levels = st.sampled_from(LEVELS)


@st.composite
def sides(draw: st.DrawFn, name: str) -> Findings:
    """Return findings that vary in some settings and tell of others at what they are fixed."""
    names = draw(st.permutations(["x", "y", "z"]))
    n_varying = draw(st.integers(0, 2))
    varying = tuple(names[:n_varying])
    fixed = {each: draw(levels) for each in names[n_varying:] if draw(st.booleans())}
    cells = draw(st.lists(st.tuples(*[levels] * n_varying), min_size=1, max_size=5))
    measured = [
        CellMeasures(dict(zip(varying, cell, strict=True)), i + 1, 0, {MEASURE: Share(i, i + 1)})
        for i, cell in enumerate(cells)
    ]
    return Findings(name, "", varying, fixed, (MEASURE,), tuple(measured))


def naive(one: Findings, other: Findings) -> set[tuple[int | None, int | None]]:
    """Return the pairs of numbers of cells that belong together, by trying all of them."""
    names = sorted({*one.varying, *other.varying})
    shared = [n for n in names if one.knows(n) and other.knows(n)]

    def looked_at(side: Findings, mate: Findings) -> list[int]:
        found: list[int] = []
        for number, cell in enumerate(side.cells):
            at_base = True
            for name in side.varying:
                if name in shared:
                    continue
                base: Level = side.cells[0].cell[name]
                at_base &= key_of(cell.cell[name]) == key_of(base)
            is_new = all(
                any(same(side, cell, side, side.cells[k], n) is False for n in shared)
                for k in found
            )
            if at_base and is_new:
                found.append(number)
        return found

    def same(a: Findings, p: CellMeasures, b: Findings, q: CellMeasures, name: str) -> bool:
        return key_of(a.level(p.cell, name)) == key_of(b.level(q.cell, name))

    ours, theirs = looked_at(one, other), looked_at(other, one)
    pairs = {
        (i, j)
        for i, j in itertools.product(ours, theirs)
        if all(same(one, one.cells[i], other, other.cells[j], n) for n in shared)
    }
    alone = {(i, None) for i in ours if i not in {p[0] for p in pairs}}
    return pairs | alone | {(None, j) for j in theirs if j not in {p[1] for p in pairs}}


@settings(derandomize=True, deadline=None, max_examples=300)
@given(sides("a"), sides("b"))
def test_cells_belong_together_that_a_naive_search_finds(one: Findings, other: Findings) -> None:
    """Cells with the same levels in all settings that both know; each cell is in one row."""
    beside = put_beside((one, other))

    found = [
        tuple(
            next((i for i, c in enumerate(side.cells) if c is cell), None)
            for side, cell in zip((one, other), row.found, strict=True)
        )
        for row in beside.rows
    ]
    assert len(found) == len(set(found))
    assert set(found) == naive(one, other)
    assert len(beside.common) == sum(None not in pair for pair in found)
    assert all(tuple(row.cell) == beside.factors for row in beside.rows)


def test_a_setting_of_one_alone_is_held_where_others_have_it() -> None:
    """Of dropouts that a third one has fixed, that level is shown; otherwise the first one."""
    shares = {MEASURE: Share(1, 2)}
    cells = tuple(
        CellMeasures({"n": n, "dropout": d}, 2, 0, shares) for d in (0.5, 0) for n in (1, 2)
    )
    varies = Findings("ours", "", ("n", "dropout"), {}, (MEASURE,), cells)
    silent = Findings(
        "theirs", "", ("n",), {}, (MEASURE,), (CellMeasures({"n": 1}, 2, 0, shares),)
    )
    fixed = Findings("third", "", ("n",), {"dropout": 0}, (MEASURE,), silent.cells)

    two, three = put_beside((varies, silent)), put_beside((varies, silent, fixed))

    assert two.held == ({"dropout": 0.5}, {})
    assert three.held == ({"dropout": 0}, {}, {})
    assert [len(beside.common) for beside in (two, three)] == [1, 1]
    assert "ours also varies dropout: shown at 0.5, not at 0" in remarks_about(two)
    assert "ours has 1 cell that not all have (n 2)" in remarks_about(two)


def test_settings_that_differ_are_told() -> None:
    """What is fixed at different levels, or by one experiment only; nothing is said of tables."""
    cells = (CellMeasures({"n": 1}, 2, 0, {MEASURE: Share(1, 2)}),)
    one = Findings("a", "", ("n",), {"view": "truth", "gap": 2}, (MEASURE,), cells)
    other = Findings("b", "", ("n",), {"view": "vision"}, (MEASURE, "overtake.recall"), cells)
    table = Findings("c", "", ("n",), {}, (MEASURE,), cells)

    assert remarks_about(put_beside((one, table, other))) == [
        "view is truth in a, vision in b",
        "gap is 2 in a, as by default in b",
        "only b measures overtake.recall",
    ]
