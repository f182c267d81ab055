"""Who does the runs: processes of this machine, and clusters that may be used."""

import os
import signal
import socket
from pathlib import Path
from threading import Thread

import pytest
from distributed import LocalCluster

from traffic.errors import ExperimentError
from traffic.experiments.cases import Case
from traffic.experiments.engine import cluster_at, local_workers
from traffic.experiments.folders import Basis
from traffic.origin import versions

pytestmark = pytest.mark.slow

SHORT = {"view": "truth", "duration": "1 s", "scenario.warm_up": "0 s"}
BASIS = Basis(design="d", design_sha256="d", versions=versions(), files_sha256={})


def case(seed: int, **settings: object) -> Case:
    """Return a short run."""
    return Case(0, seed, "rural", {**SHORT, **settings}, Path())


def someones_cluster(threads: int = 1) -> LocalCluster:
    """Return a cluster of one worker that was not made for experiments."""
    return LocalCluster(
        n_workers=1,
        threads_per_worker=threads,
        processes=False,
        protocol="tcp",
        host="127.0.0.1",
        dashboard_address="127.0.0.1:0",
    )


@pytest.mark.sumo
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
def test_processes_do_runs_and_one_that_dies_is_replaced() -> None:
    """All cases are done though a worker is killed; one that fails says why."""
    cases = [case(1), case(2), case(3, **{"scenario.sumo": {"no-such-option": 1}}), case(4)]
    with local_workers(1) as engine:
        workers = engine.process_ids()
        outcomes = {}
        for outcome in engine.outcomes(cases):
            if not outcomes:
                os.kill(workers[0], signal.SIGKILL)
            outcomes[outcome.seed] = outcome

    assert sorted(outcomes) == [1, 2, 3, 4]
    assert [seed for seed, each in outcomes.items() if each.error] == [3]
    assert "no-such-option" in str(outcomes[3].error)
    assert all(set(outcomes[seed].counts) >= {"turn", "overtake"} for seed in (1, 2, 4))


def test_a_cluster_that_does_not_answer_is_told() -> None:
    """Nobody listens at the address, or it is none."""
    with (
        pytest.raises(ExperimentError, match="no cluster answers at"),
        cluster_at("tcp://127.0.0.1:9", BASIS, timeout=1.0),
    ):
        pass


@pytest.mark.parametrize(
    ("greeting", "said"),
    [
        (b"", r"has not said within 0\.5 s that it is a Dask scheduler"),
        (b"SSH-2.0-OpenSSH_9.2\r\n", "does not talk as a Dask scheduler does"),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", "does not talk as a Dask scheduler does"),
    ],
)
def test_something_else_that_answers_is_told(greeting: bytes, said: str) -> None:
    """It may wait for a line that never comes, or speak first; the message has one line."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        host, port = server.getsockname()
        address = f"tcp://{host}:{port}"
        calls: list[socket.socket] = []
        answering = Thread(target=_answer_once, args=(server, greeting, calls))
        answering.start()
        with (
            pytest.raises(ExperimentError, match=said) as caught,
            cluster_at(address, BASIS, timeout=0.5),
        ):
            pass
        answering.join()
        calls[0].close()

    assert str(caught.value).startswith(f"--cluster: no cluster answers at '{address}': ")
    assert "\n" not in str(caught.value)


def _answer_once(server: socket.socket, greeting: bytes, calls: list[socket.socket]) -> None:
    """Take a call, say *greeting*, and leave the line open."""
    call, _ = server.accept()
    calls.append(call)
    call.sendall(greeting)


@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
def test_a_worker_is_no_cluster() -> None:
    """Its address is told with the others of a cluster, and easily taken for the scheduler's."""
    with (
        someones_cluster() as cluster,
        pytest.raises(ExperimentError, match="expected a Dask scheduler, found a Worker"),
        cluster_at(cluster.workers[0].address, BASIS),
    ):
        pass


@pytest.mark.parametrize("address", ["127.0.0.1", "foo://bar"])
def test_an_address_that_is_none_is_told_at_once(address: str) -> None:
    """Nothing is waited for."""
    with pytest.raises(ExperimentError, match="no cluster answers at"), cluster_at(address, BASIS):
        pass


@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"versions": {**versions(), "numpy": "0.1"}}, r"the version of numpy \(.*, here 0\.1\)"),
        ({"files_sha256": {"/nowhere/x.toml": "0"}}, r"the file '/nowhere/x\.toml'"),
    ],
)
def test_a_cluster_with_other_versions_or_files_is_refused(
    changed: dict[str, object], said: str
) -> None:
    """Its runs would not be those of this machine."""
    with (
        someones_cluster() as cluster,
        pytest.raises(ExperimentError, match=said),
        cluster_at(cluster.scheduler_address, BASIS.model_copy(update=changed)),
    ):
        pass


@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
def test_a_cluster_whose_workers_have_threads_is_refused() -> None:
    """The simulator has one state per process; the message says so."""
    with (
        someones_cluster(threads=2) as cluster,
        pytest.raises(ExperimentError, match="one state per process"),
        cluster_at(cluster.scheduler_address, BASIS),
    ):
        pass
