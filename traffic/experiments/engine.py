"""Who does the runs: processes of this machine, or a cluster, by Dask distributed.

The simulator has one state per process, and two threads of one process would disturb each other
without an error. So a worker has one thread, and a cluster whose workers have more is refused.
"""

import logging
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

import dask
from distributed import Client, Future, KilledWorker, LocalCluster, as_completed

from traffic.errors import ExperimentError
from traffic.experiments.cases import Case, Outcome, run_case
from traffic.origin import versions

__all__ = ["Engine", "cluster_at", "local_workers"]

_WAITING = 4
"""How many cases each worker has in hand, so that it need not wait for the next one."""

_SECONDS = "10s"
_SETTINGS = {
    "distributed.comm.timeouts.connect": _SECONDS,
    "distributed.scheduler.allowed-failures": 3,
    "distributed.worker.memory.terminate": False,
    "distributed.admin.tick.limit": "1h",
    "logging.distributed": "error",
}


class Engine:
    """Workers that do cases.

    Args:
        client: Of the scheduler of the workers.
    """

    def __init__(self, client: Client) -> None:
        self._client = client

    @property
    def n_workers(self) -> int:
        """How many workers there are now."""
        return len(_workers(self._client))

    def process_ids(self) -> list[int]:
        """Return the process of each worker, by the number that its own machine has for it."""
        return list(self._client.run(os.getpid).values())

    def outcomes(self, cases: Iterable[Case]) -> Iterator[Outcome]:
        """Do all *cases*; yield what became of each, in the order in which they finish.

        A worker that dies is replaced, and its cases are done again; a case with which several
        workers have died has failed.
        """
        waiting = iter(cases)
        case_by_key: dict[str, Case] = {}
        finished = as_completed(with_results=False)
        for _, case in zip(range(_WAITING * max(1, self.n_workers)), waiting, strict=False):
            finished.add(self._submit(case, case_by_key))
        for future in finished:
            case = case_by_key.pop(future.key)
            following = next(waiting, None)
            if following is not None:
                finished.add(self._submit(following, case_by_key))
            yield _outcome(future, case)
            future.release()

    def _submit(self, case: Case, case_by_key: dict[str, Case]) -> "Future[Any]":
        case_by_key[case.key] = case
        return self._client.submit(run_case, case, key=case.key, pure=False)


@contextmanager
def local_workers(number: int) -> Iterator[Engine]:
    """Give an engine with so many processes of this machine while the block lasts."""
    with (
        _quiet(),
        LocalCluster(
            n_workers=number,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            memory_limit=0,
            env={"OPENCV_FOR_THREADS_NUM": "1"},
        ) as cluster,
        Client(cluster) as client,
    ):
        yield Engine(client)


@contextmanager
def cluster_at(address: str, timeout: str = _SECONDS) -> Iterator[Engine]:
    """Give an engine with the workers of a cluster while the block lasts.

    Args:
        address: Of the cluster's scheduler, such as `tcp://host:8786`.
        timeout: How long to wait for an answer.

    Raises:
        ExperimentError: The cluster does not answer, has no workers, has workers with more than
            one thread, or has another version of this program.
    """
    with _quiet():
        try:
            client = Client(address, timeout=timeout, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            fault = f"--cluster: no cluster answers at '{address}': {error}"
            raise ExperimentError(fault) from error
        with client:
            _check(client, address)
            yield Engine(client)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep the engine's own reports from the screen while the block lasts."""
    logger = logging.getLogger("distributed")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        with dask.config.set(_SETTINGS):
            yield
    finally:
        logger.setLevel(level)


def _check(client: Client, address: str) -> None:
    workers = _workers(client)
    if not workers:
        raise ExperimentError(f"--cluster: the cluster at '{address}' has no workers")
    crowded = [name for name, worker in workers.items() if worker["nthreads"] > 1]
    if crowded:
        fault = (
            f"--cluster: expected workers with one thread, found {len(crowded)} of {len(workers)} "
            f"with more, such as {crowded[0]}; the simulator has one state per process, which "
            "threads would change under each other's feet; start them with --nthreads 1"
        )
        raise ExperimentError(fault)
    ours = versions()
    for name, theirs in client.run(versions).items():
        if different := [each for each in ours if theirs.get(each) != ours[each]]:
            each = different[0]
            fault = f"worker {name} has {each} {theirs.get(each)}, this program {ours[each]}"
            raise ExperimentError(f"--cluster: {fault}")


def _workers(client: Client) -> dict[str, Any]:
    found: dict[str, Any] = client.scheduler_info(n_workers=-1)["workers"]
    return found


def _outcome(future: "Future[Any]", case: Case) -> Outcome:
    if future.status == "finished":
        found: Outcome = future.result()
        return found
    error = future.exception()
    died = isinstance(error, KilledWorker)
    text = "the process that did it died, again and again" if died else f"{error}"
    return Outcome(case.key, case.cell, case.seed, {}, text)
