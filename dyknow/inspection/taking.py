"""Taking a snapshot of a network, before it runs, after it has run, or while it runs.

To look at a network while it runs, take snapshots between two runs or at the beginning of an
instant, with the hook of the kernel:

    def look(now: TimePoint) -> None:
        if now % SECOND == 0:
            show(snapshot(network))

    network.kernel.run(on_time=look)
"""

from dyknow.inspection.snapshot import Kind, ProcessFigures, Snapshot, StreamFigures
from dyknow.kpl.plan import Network
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.processes import RunningProcess
from dyknow.runtime.subscriptions import StreamProxy

__all__ = ["snapshot"]


def snapshot(of: Network | Kernel) -> Snapshot:
    """Return what the network, or the kernel that runs it, looks like now.

    A kernel alone does not know how its processes are written, so that all of them but sources
    are units without a text.
    """
    kernel = of if isinstance(of, Kernel) else of.kernel
    return Snapshot(
        now=kernel.now,
        processes=tuple(_process(process) for process in kernel.processes.values()),
        streams=tuple(_stream(proxy) for proxy in kernel.streams),
        outputs=() if isinstance(of, Kernel) else of.outputs,
    )


def _process(process: RunningProcess) -> ProcessFigures:
    account, generator = process.account, process.generator
    return ProcessFigures(
        label=process.label,
        kind=Kind(process.kind.value),
        depth=process.depth,
        on_failure=process.on_failure.value,
        calls=account.calls,
        seconds=account.seconds,
        samples=account.samples,
        heartbeats=generator.statistics.heartbeats,
        violations=account.violations,
        failures=account.failures,
        cached=generator.size,
        cache_limit=generator.capacity,
    )


def _stream(proxy: StreamProxy) -> StreamFigures:
    figures = proxy.statistics
    has_delays = figures.samples > 0
    return StreamFigures(
        provider=proxy.provider,
        receiver=proxy.receiver,
        number=proxy.number,
        is_output=proxy.number == 0,
        samples=figures.samples,
        rate=figures.rate if figures.samples > 1 else None,
        mean_delay=figures.mean_delay if has_delays else None,
        delay_99=figures.delay_99 if has_delays else None,
        violations=figures.violations,
        late=figures.late,
    )
