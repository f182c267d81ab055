"""Describing a network as it is."""

from dyknow.kpl.assembly import Assembly, Part, name_of, policy_of
from dyknow.kpl.description import (
    GeneratorDescription,
    InputDescription,
    NetworkDescription,
    OutputDescription,
)
from dyknow.kpl.names import EVERYWHERE, Declarations
from dyknow.kpl.outputs import Outputs
from dyknow.kpl.policies import text_from_policy
from dyknow.kpl.printer import text_from
from dyknow.kpl.sorts import Sorts
from dyknow.kpl.syntax import (
    Label,
    Link,
    Mediation,
    Merging,
    Process,
    Selection,
    SourceInstance,
    Synchronisation,
    UnitInstance,
)
from dyknow.runtime.subscriptions import StreamProxy

__all__ = ["describe"]

_KINDS: dict[type[Process | Label], str] = {
    SourceInstance: "source",
    UnitInstance: "unit",
    Link: "link",
    Synchronisation: "synchronisation",
    Merging: "merging",
    Mediation: "mediation",
    Selection: "selection",
    Label: "view",
}


def describe(assembly: Assembly, outputs: Outputs, declared: Declarations) -> NetworkDescription:
    """Return what has been built, as plain data."""
    inputs: dict[str, list[StreamProxy]] = {}
    for proxy in assembly.kernel.streams:
        if proxy.number:
            inputs.setdefault(proxy.receiver, []).append(proxy)
    sorts = Sorts(declared)
    generators = [
        _generator(part, inputs.get(name, []), sorts) for name, part in assembly.parts.items()
    ]
    return {"generators": generators, "outputs": [_output(name, outputs) for name in outputs]}


def _generator(part: Part, inputs: list[StreamProxy], sorts: Sorts) -> GeneratorDescription:
    assert part.process is not None  # since it has been built
    on_failure = "stop" if part.declaration is None else part.declaration.on_failure.value
    return {
        "label": part.label,
        "kind": _KINDS[type(part.process)],
        "process": text_from(part.process),
        "sort": text_from(sorts.of(part.process, EVERYWHERE)),
        "inputs": [_input(each) for each in sorted(inputs, key=lambda proxy: proxy.number)],
        "output_policy": ", ".join(map(text_from, part.constraints)),
        "on_failure": on_failure,
    }


def _input(proxy: StreamProxy) -> InputDescription:
    return {
        "number": proxy.number,
        "provider": proxy.provider,
        "policy": text_from_policy(proxy.policy),
    }


def _output(name: str, outputs: Outputs) -> OutputDescription:
    stream = outputs[name].stream
    return {
        "name": name,
        "provider": name_of(stream),
        "policy": text_from_policy(policy_of(stream)),
    }
