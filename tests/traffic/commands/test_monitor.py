"""`traffic monitor` as its users meet it."""

import json
import os
import subprocess
import sys
import threading

import pytest
from typer.testing import CliRunner

from traffic.__main__ import app, main

FORMULA = "always eventually [0, 300] p"
STATES = "t,p\n" + "".join(f"{100 * n},{'true' if n < 2 else 'false'}\n" for n in range(6))


@pytest.fixture
def states(tmp_path):
    """Return a file with states in which the formula is violated at 500 ms."""
    path = tmp_path / "states.csv"
    path.write_text(STATES)
    return str(path)


def run(*arguments, given=None):
    """Run the command and return what it prints."""
    shown = CliRunner(env={"COLUMNS": "200"}).invoke(app, ["monitor", *arguments], input=given)
    assert shown.exit_code == 0, shown.output
    return shown.stdout


def test_the_answer_is_one_document(states):
    """With --json there are three entries; the verdict is that of the earliest state."""
    assert json.loads(run(FORMULA, "--states", states, "--json")) == {
        "verdict": "false",
        "decided_at": 500,
        "residual": "false",
    }


def test_what_is_left_can_be_read(states):
    """Without a verdict, the rest of the formula is told."""
    assert run("always eventually p", "--states", states).splitlines() == [
        "undecided after the last state, at 500 ms",
        "what is left: eventually p and always eventually p",
    ]


def test_reasons_are_told(states):
    """With --explain, what is left after each state, and what decided the formula."""
    printed = run(FORMULA, "--states", states, "--explain").splitlines()

    assert printed[0] == "0 ms: p: always eventually [0, 300] p"
    assert printed[1].startswith("100 ms: as before: ")
    assert printed[2].startswith("200 ms: not p: eventually [0, 300] p and ")
    assert printed[6:] == [
        "false, decided at 500 ms",
        "why, whatever else was the case:",
        "  from 200 ms to 500 ms (4 states): not p",
    ]


def test_reasons_are_part_of_the_document(states):
    """With --explain and --json, steps and reasons are there as well."""
    document = json.loads(run(FORMULA, "--states", states, "--explain", "--json"))

    assert document["verdict"] == "false"
    assert [step["t"] for step in document["steps"]] == [0, 100, 200, 300, 400, 500]
    assert document["steps"][2]["changes"] == {"p": False}
    assert document["steps"][-1]["residual"] == "false"
    assert document["reasons"] == [
        {"atom": "p", "value": False, "from": 200, "to": 500, "states": 4, "values": {}}
    ]


@pytest.mark.parametrize(
    ("formula", "lines"),
    [
        ("always x < 3", ["  at 200 ms: not (x < 3); x = 3.5"]),
        ("eventually (x > 2 and q)", ["  at 200 ms: x > 2; x = 3.5", "  at 200 ms: q"]),
        ("eventually [100, oo] true", ["  nothing but that there was a state"]),
        ("always (q <-> q)", ["why: not to be said by a few observations, or they are too"]),
        ("always [0, 200] x > 0", ["  from 0 ms to 200 ms (3 states): x > 0; at first x = 1.0"]),
    ],
)
def test_reasons_have_values(formula, lines):
    """Where an atom compares numbers, they are told."""
    given = "t,x,q\n0,1,1\n100,2,1\n200,3.5,1\n"
    printed = run(formula, "--states", "-", "--explain", given=given)

    for line in lines:
        assert line in printed


def test_time_models_and_domains_have_effect():
    """Between states, nothing holds in the model of points; quantifiers need domains."""
    given = '{"t": 0, "values": {"p[a]": true, "p[b]": true}}\n'
    given += '{"t": 10, "values": {"p[a]": true, "p[b]": false}}\n'
    formula = "exists x in car always [1, 5] not p[x]"
    options = (formula, "--domain", "car=a,b", "--states", "-")

    assert run(*options, given=given).startswith("false, decided at 10 ms")
    assert run(*options, "--time-model", "points", given=given).startswith("true, decided at 10")


def test_the_verdict_does_not_wait_for_the_end():
    """From standard input a verdict comes as soon as a state decides, and the program ends."""
    command = [sys.executable, "-m", "traffic", "monitor", "always p", "--states", "-", "--json"]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as process:
        watch = threading.Timer(60, process.kill)
        watch.start()
        process.stdin.write(b'{"t": 0, "values": {"p": true}}\n{"t": 1, "values": {"p": false}}\n')
        process.stdin.flush()
        printed = process.stdout.read()
        watch.cancel()
        process.stdin.close()

    assert json.loads(printed)["decided_at"] == 1
    assert process.returncode == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["always", "--states", "{states}"], "<formula>:1:7: expected a formula"),
        (["always [2, 1] p", "--states", "{states}"], "^^^^^^"),
        (["always q", "--states", "{states}"], "has no feature 'q'"),
        (["p and p > 1", "--states", "{states}"], "must be of sort 'boolean', found 'number'"),
        (["forall x in car p[x]", "--states", "{states}"], "no domain called 'car'"),
        (
            ["always p", "--states", "{states}", "--domain", "car="],
            "names of objects after 'car='",
        ),
        (["always p", "--states", "{states}", "--domain", "car=a"], "there is no quantifier"),
        (["always p", "--states", "{states}x"], "No such file or directory"),
        (["missing.mtl", "--states", "{states}"], "No such file or directory"),
        (["always p", "--states", os.devnull], "expected at least one state, found none"),
        (["always x > 1", "--states", "{states}"], "has no feature 'x'"),
        (["always p > 1", "--states", "{states}"], ":2:3: expected a number ('p'), found 'true'"),
    ],
)
def test_faults_are_told(arguments, message, states, monkeypatch, capfd):
    """Exit status 2, a message with what was expected and found, and nothing else."""
    words = [word.format(states=states) for word in arguments]
    monkeypatch.setattr(sys, "argv", ["traffic", "monitor", *words, "--json"])

    with pytest.raises(SystemExit) as stop:
        main()

    printed = capfd.readouterr()
    assert stop.value.code == 2
    assert message in printed.err
    assert printed.out == ""
