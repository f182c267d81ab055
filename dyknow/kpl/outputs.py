"""The output streams of a network, and who has subscribed to them."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from dyknow.errors import ServiceError
from dyknow.kpl.assembly import Assembly, Part, name_of, policy_of
from dyknow.kpl.syntax import StreamDeclaration, StreamTerm
from dyknow.runtime.generators import Receive
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.source_text import did_you_mean, nearest_name

__all__ = ["Output", "Outputs"]


@dataclass
class Output:
    """An output stream.

    Attributes:
        stream: What it is.
        proxies: The ends of those who have subscribed.
    """

    stream: StreamTerm
    proxies: list[StreamProxy] = field(default_factory=list)


class Outputs:
    """The output streams that there are now, by name."""

    def __init__(self, assembly: Assembly) -> None:
        self._assembly = assembly
        self._outputs: dict[str, Output] = {}

    def __iter__(self) -> Iterator[str]:
        return iter(self._outputs)

    def __getitem__(self, name: str) -> Output:
        return self._outputs[name]

    def __contains__(self, name: str) -> bool:
        return name in self._outputs

    @property
    def proxies(self) -> set[StreamProxy]:
        """The ends of all who have subscribed."""
        return {proxy for output in self._outputs.values() for proxy in output.proxies}

    def open(self, declaration: StreamDeclaration) -> None:
        """Let there be an output whose provider has been built."""
        self._assembly.hold(declaration.stream)
        self._outputs[declaration.name.text] = Output(declaration.stream)
        self._assembly.journal.opened.append(declaration.name.text)

    def close(self, name: str) -> list[Part]:
        """End an output and all subscriptions to it; return what is taken out for that."""
        output = self._outputs.pop(name)
        self._assembly.journal.closed.append(name)
        for proxy in output.proxies:
            proxy.end()
        return self._assembly.release(name_of(output.stream))

    def subscribe(self, name: str, receive: Receive) -> StreamProxy:
        """Hand the samples of an output to *receive*, under its declared policy.

        Raises:
            ServiceError: There is no such output now.
        """
        if name not in self._outputs:
            hint = did_you_mean(nearest_name(name, self._outputs))
            raise ServiceError(f"no output stream called '{name}'{hint}")
        output = self._outputs[name]
        label = self._assembly.parts[name_of(output.stream)].label
        proxy = self._assembly.kernel.subscribe(label, receive, policy_of(output.stream))
        output.proxies = [*(each for each in output.proxies if not each.has_ended), proxy]
        return proxy

    def replace(self, name: str, stream: StreamTerm) -> None:
        """Let an output, and those who have subscribed to it, have the policy of *stream*."""
        output = self._outputs[name]
        has_changed = output.stream.constraints != stream.constraints
        output.stream = stream
        for proxy in output.proxies if has_changed else ():
            if not proxy.has_ended:
                proxy.replace_policy(policy_of(stream))
