"""Who does the runs: processes of this machine, or a cluster, by Dask distributed.

The simulator has one state per process, and two threads of one process would disturb each other
without an error. So a worker has one thread, and a cluster whose workers have more is refused.
"""

import asyncio
import os
from collections.abc import Collection, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import dask
from distributed import Client, Future, KilledWorker, LocalCluster, Security, wait
from distributed.client import FuturesCancelledError
from distributed.comm.addressing import resolve_address
from distributed.comm.core import connect
from distributed.core import send_recv

from traffic.bundled import data_folder
from traffic.errors import ExperimentError
from traffic.experiments import preparing
from traffic.experiments.cases import Case, Outcome, run_case
from traffic.experiments.folders import Basis
from traffic.origin import digest_of, versions

__all__ = ["Engine", "cluster_at", "local_workers"]

_WAITING = 4
"""How many cases each worker has in hand, so that it need not wait for the next one."""

_LOOK = 5
"""After so many seconds without a finished run, it is asked whether there are workers."""

_LONGEST_WITHOUT_WORKERS = 60
"""Seconds; workers that have died may be replaced in the meantime."""

_SAFE = "the runs before are safe, --resume does the others"
_SECONDS = 10
_SCHEDULER = "Scheduler"
_SETTINGS = {
    "distributed.comm.timeouts.connect": f"{_SECONDS}s",
    "distributed.scheduler.allowed-failures": 3,
    "distributed.worker.memory.terminate": False,
    "distributed.worker.profile.enabled": False,  # it would keep half a megabyte of each run
    "distributed.admin.tick.limit": "1h",
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

        Raises:
            ExperimentError: The cluster went away, or its workers did and no others came, or
                they have no room left.
        """
        waiting = iter(cases)
        case_by_future: dict[Future[Any], Case] = {}
        while True:
            free = _WAITING * max(1, self.n_workers) - len(case_by_future)
            for _, case in zip(range(free), waiting, strict=False):
                future = self._client.submit(run_case, case, key=case.key, pure=False)
                case_by_future[future] = case
            if not case_by_future:
                return
            for future in self._finished(case_by_future):
                yield _outcome(future, case_by_future.pop(future))
                future.release()

    def _finished(self, futures: Collection["Future[Any]"]) -> set["Future[Any]"]:
        """Return those that are done, at least one; wait for it as long as there are workers."""
        without_workers = 0
        while without_workers < _LONGEST_WITHOUT_WORKERS:
            try:
                with self._client.as_current():
                    done: set[Future[Any]] = wait(
                        list(futures), timeout=_LOOK, return_when="FIRST_COMPLETED"
                    ).done
                    return done
            except TimeoutError:
                without_workers = 0 if self.n_workers else without_workers + _LOOK
            except FuturesCancelledError as error:
                raise ExperimentError(f"the cluster went away; {_SAFE}") from error
        fault = f"there were no workers for {_LONGEST_WITHOUT_WORKERS} s; {_SAFE}"
        raise ExperimentError(fault)


@contextmanager
def local_workers(number: int) -> Iterator[Engine]:
    """Give an engine with so many processes of this machine while the block lasts."""
    with (
        _settings(),
        LocalCluster(
            n_workers=number,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            memory_limit=0,
            preload=[preparing.__name__],
            env={"OPENCV_FOR_THREADS_NUM": "1"},
        ) as cluster,
        Client(cluster) as client,
    ):
        yield Engine(client)


@contextmanager
def cluster_at(address: str, basis: Basis, timeout: float = _SECONDS) -> Iterator[Engine]:
    """Give an engine with the workers of a cluster while the block lasts.

    Args:
        address: Of the cluster's scheduler, such as `tcp://host:8786`.
        basis: What the runs are to depend on.
        timeout: How many seconds to wait for an answer.

    Raises:
        ExperimentError: The cluster does not answer, has no workers, has workers with more than
            one thread, or has other versions of this program or of the files that runs read.
    """
    with _settings():
        try:
            resolve_address(address)
            asyncio.run(_greet(address, timeout))
            client = Client(address, timeout=timeout, set_as_default=False)
        except Exception as error:  # whatever it is that answers may make anything happen
            fault = f"--cluster: no cluster answers at '{address}': {_line_about(error)}"
            raise ExperimentError(fault) from error
        with client:
            _check(client, address, basis)
            yield Engine(client)


async def _greet(address: str, timeout: float) -> None:
    """Ask who is there; a client would wait for ever for one that takes calls and says nothing.

    Raises:
        ExperimentError: It is not the scheduler of a cluster, or says nothing in time.
        OSError: There is nobody.
    """
    try:
        async with asyncio.timeout(timeout):
            kind = await _kind_of(address, timeout / 2)
    except TimeoutError as error:
        fault = f"what is there has not said within {timeout:g} s that it is a Dask scheduler"
        raise ExperimentError(fault) from error
    except OSError:
        raise
    except Exception as error:  # it may say anything
        raise ExperimentError("what is there does not talk as a Dask scheduler does") from error
    if kind != _SCHEDULER:
        raise ExperimentError(f"expected a Dask scheduler, found a {kind}")


async def _kind_of(address: str, timeout: float) -> str:
    """Return what part of a cluster is at an address."""
    how = Security().get_connection_args("client")
    comm = await connect(address, timeout=timeout, **how)
    try:
        answer: dict[str, str] = await send_recv(comm, op="identity")
    finally:
        comm.abort()
    return answer["type"]


def _line_about(error: Exception) -> str:
    text = " ".join(str(error).split())
    return text or type(error).__name__


def _settings() -> AbstractContextManager[object]:
    """Silence the engine; give what sets it up while a block lasts."""
    preparing.silence()
    context: AbstractContextManager[object] = dask.config.set(_SETTINGS)
    return context


def _check(client: Client, address: str, basis: Basis) -> None:
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
    answers = client.run(_basis_here, basis, data_folder(), on_error="return")
    for name, theirs in answers.items():
        if not isinstance(theirs, Basis):
            fault = f"expected this program on all workers, found on worker {name}: {theirs}"
            raise ExperimentError(f"--cluster: {fault}")
        if (different := theirs.difference(basis)) is not None:
            fault = f"worker {name} is not as this program: {different} is not the same"
            raise ExperimentError(f"--cluster: {fault}")


def _basis_here(basis: Basis, bundled: Path) -> Basis:
    """Return what of *basis* there is on this machine; what is *bundled* may lie elsewhere."""
    files = {path: _digest(_here(Path(path), bundled)) for path in basis.files_sha256}
    return basis.model_copy(update={"versions": versions(), "files_sha256": files})


def _here(path: Path, bundled: Path) -> Path:
    return data_folder() / path.relative_to(bundled) if path.is_relative_to(bundled) else path


def _digest(path: Path) -> str:
    try:
        return digest_of(path)
    except OSError as error:
        return f"{error.strerror}"


def _workers(client: Client) -> dict[str, Any]:
    found: dict[str, Any] = client.scheduler_info(n_workers=-1).get("workers", {})
    return found


def _outcome(future: "Future[Any]", case: Case) -> Outcome:
    if future.status == "finished":
        found: Outcome = future.result()
        return found
    error = future.exception()
    if isinstance(error, ExperimentError):
        raise error
    died = isinstance(error, KilledWorker)
    text = "the process that did it died, again and again" if died else f"{error}"
    return Outcome(case.key, case.cell, case.seed, {}, text)
