"""Taking a snapshot of a network, before it runs, after it has run, or while it runs.

To look at a network while it runs, take snapshots between two runs or at the beginning of an
instant, with the hook of the kernel:

    def look(now: TimePoint) -> None:
        if now % SECOND == 0:
            show(snapshot(network))

    network.kernel.run(on_time=look)
"""

from dyknow.inspection.snapshot import Kind, ProcessFigures, Snapshot
from dyknow.kpl.plan import Network
from dyknow.runtime.kernel import Kernel

__all__ = ["snapshot"]


def snapshot(of: Network | Kernel) -> Snapshot:
    """Return what the network, or the kernel that runs it, looks like now.

    A kernel alone does not know how its processes are written, so that all of them but sources
    are plain processes without a text.
    """
    kernel = of if isinstance(of, Kernel) else of.kernel
    processes = [
        ProcessFigures(
            label=label,
            kind=Kind.PROCESS,
            calls=account.calls,
            seconds=account.seconds,
            samples=account.samples,
            violations=account.violations,
        )
        for label, account in kernel.accounts.items()
    ]
    outputs = () if isinstance(of, Kernel) else of.outputs
    return Snapshot(now=kernel.now, processes=tuple(processes), outputs=outputs)
