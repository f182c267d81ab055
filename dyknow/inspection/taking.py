"""Taking a snapshot of a network, before it runs, after it has run, or while it runs.

To look at a network while it runs, take snapshots between two runs or at the beginning of an
instant, with the hook of the kernel:

    def look(now: TimePoint) -> None:
        if now % SECOND == 0:
            show(snapshot(network))

    network.kernel.run(on_time=look)
"""

from dyknow.inspection.snapshot import Kind, ProcessFigures, Snapshot, StreamFigures
from dyknow.kpl.description import GeneratorDescription, NetworkDescription
from dyknow.kpl.network import Network
from dyknow.kpl.policies import text_from_policy
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.names import OUTPUT
from dyknow.runtime.processes import RunningProcess
from dyknow.runtime.subscriptions import StreamProxy

__all__ = ["snapshot"]

_NOTHING: NetworkDescription = {"generators": [], "outputs": []}


def snapshot(of: Network | Kernel) -> Snapshot:
    """Return what the network, or the kernel that runs it, looks like now.

    A kernel alone does not know how its processes are written: what is not a source is a unit
    there, and has no text. So is a process that was added to the kernel of a network directly.
    """
    kernel, described = (of, _NOTHING) if isinstance(of, Kernel) else (of.kernel, of.description)
    generators = {each["label"]: each for each in described["generators"]}
    outputs = _Outputs(described)
    return Snapshot(
        now=kernel.now,
        processes=tuple(
            _process(process, generators.get(label)) for label, process in kernel.processes.items()
        ),
        streams=tuple(_stream(proxy, outputs) for proxy in kernel.streams),
        outputs=tuple(output["name"] for output in described["outputs"]),
    )


class _Outputs:
    """What the subscriptions of a network are called.

    The kernel knows them all as `output`. Of outputs that differ in nothing but their names, the
    first subscription gets the first name, the second one the second, and so on.
    """

    def __init__(self, described: NetworkDescription) -> None:
        self._names: dict[tuple[str, str], list[str]] = {}
        for output in described["outputs"]:
            ends = (output["provider"], output["policy"])
            self._names.setdefault(ends, []).append(output["name"])

    def name_of(self, proxy: StreamProxy, policy: str) -> str:
        """Return the name of the next subscription with the ends and the policy of *proxy*."""
        names = self._names.get((proxy.provider, policy))
        if proxy.number or proxy.receiver != OUTPUT or not names:
            return proxy.receiver
        names.append(names.pop(0))
        return names[-1]


def _process(process: RunningProcess, described: GeneratorDescription | None) -> ProcessFigures:
    account, generator = process.account, process.generator
    return ProcessFigures(
        label=process.label,
        kind=Kind(process.kind.value if described is None else described["kind"]),
        text="" if described is None else described["process"],
        depth=process.depth,
        policy=(
            text_from_policy(process.output_policy)
            if described is None
            else described["output_policy"]
        ),
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


def _stream(proxy: StreamProxy, outputs: _Outputs) -> StreamFigures:
    policy = text_from_policy(proxy.policy)
    receiver = outputs.name_of(proxy, policy)
    return StreamFigures.of(proxy.provider, receiver, proxy.number, policy, proxy.statistics)
