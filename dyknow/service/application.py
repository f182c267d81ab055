"""A running application: KPL declarations that come and go, and the service around them.

This is where the parts of the service meet. What the factory makes and what KPL declares are
processes of one network, so that a client may subscribe to what a specification declares, and
add to it what no specification knows.
"""

import inspect
from collections.abc import Callable, Collection, Iterable

from dyknow.kpl.implementations import Implementations
from dyknow.kpl.network import Network
from dyknow.kpl.parser import parse_policy, parse_specification
from dyknow.kpl.policies import policy_from_constraints
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import Constraint, SourceDeclaration, Specification, UnitDeclaration
from dyknow.runtime.clock import Clock, WallClock
from dyknow.runtime.generators import Beat, Label, Receive
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.service.factory import KnowledgeProcessFactory
from dyknow.service.governor import GovernorSettings, LoadGovernor
from dyknow.service.manager import StreamGeneratorManager
from dyknow.service.prototypes import SourcePrototype, UnitPrototype
from dyknow.streams.policy import Policy
from dyknow.time import TimePoint

__all__ = ["DyKnow"]

OnTime = Callable[[TimePoint], None]


class DyKnow:
    """The middleware service of one application.

    Attributes:
        network: The processes, and the specification that declares them.
        factory: Makes processes of prototypes. Sources and units that are declared here, with a
            fixed number of inputs and without settings that must be given, are prototypes.
        manager: Which stream generator a label stands for.
        governor: What lengthens sample periods under load in the last run that had one.
    """

    def __init__(self, network: Network, implementations: Implementations) -> None:
        """Serve *network*, whose symbols stand for *implementations*."""
        self.network = network
        self.factory = KnowledgeProcessFactory(network.kernel)
        self.manager = StreamGeneratorManager(network.kernel)
        self.governor: LoadGovernor | None = None
        self._implementations = implementations
        self._register(network.specification)

    def add(self, declarations: str | Specification) -> None:
        """Declare more, also while the application runs; see `Network.add`."""
        if isinstance(declarations, str):
            declarations = parse_specification(declarations)
        self.network.add(declarations)
        self._register(declarations)

    def remove(self, names: str | Collection[str]) -> None:
        """Take declarations back, also while the application runs; see `Network.remove`."""
        before = _prototypes_in(self.network.specification)
        self.network.remove(names)
        for name in before - _prototypes_in(self.network.specification):
            if name in self.factory.prototypes:
                self.factory.remove_prototype(name)

    def replace_policy(
        self, target: str | tuple[str, int], constraints: str | Iterable[Constraint]
    ) -> None:
        """Let a stream that is declared have another policy; see `Network.replace_policy`."""
        self.network.replace_policy(target, constraints)

    def subscribe(
        self,
        label: str,
        receive: Receive,
        policy: Policy | str = "",
        name: str = "client",
        beat: Beat | None = None,
    ) -> StreamProxy:
        """Hand a stream to *receive*, from any stream generator that has a label.

        Args:
            label: Of a process, or one that the manager has been given.
            receive: Takes the samples.
            policy: What the stream has to keep; a text is what KPL writes after `with`.
            name: What the receiver is called among the streams and in violations.
            beat: Takes the heartbeats.

        Raises:
            NoSuchLabelError: The label stands for nothing.
            PolicyNotSupportedError: The generator cannot keep the policy.
            SpecificationError: The text is no policy.
        """
        if isinstance(policy, str):
            policy = policy_from_constraints(parse_policy(policy))
        generator = self.manager.get_stream_generator(Label(label))
        return self.network.kernel.subscribe(generator.label, receive, policy, Label(name), beat)

    def run(
        self,
        until: TimePoint | None = None,
        on_time: OnTime | None = None,
        clock: Clock | None = None,
        govern: GovernorSettings | None = None,
    ) -> None:
        """Run the network, as `Kernel.run` does; with *govern*, under a load governor.

        Raises:
            ProcessError: A process failed that is to stop the network.
            ValueError: There is something to govern by, but no clock by which it could be late.
        """
        if govern is not None:
            if not isinstance(clock, WallClock):
                raise ValueError("without a wall clock the network is never late")
            lateness = clock  # the clock of this run, whatever comes later
            self.governor = LoadGovernor(
                self.network.kernel, lambda: lateness.last_lateness, govern
            )
            on_time = _both(self.governor.watch, on_time)
        self.network.kernel.run(until, on_time, clock)

    def _register(self, specification: Specification) -> None:
        """Make prototypes of the sources and units that a specification declares."""
        made = self._implementations
        for each in specification.declarations:
            match each:
                case SourceDeclaration(sort, name) if name.text in made.sources:
                    self._register_source(name.text, text_from(sort))
                case UnitDeclaration(sort, name, inputs, False) if name.text in made.units:
                    sorts = tuple(map(text_from, inputs))
                    self._register_unit(name.text, sorts, text_from(sort))
                case _:
                    pass

    def _register_source(self, name: str, sort: str) -> None:
        make = self._implementations.sources[name]
        self.factory.add_prototype(SourcePrototype(lambda _: make()), name, (), sort)

    def _register_unit(self, name: str, input_sorts: tuple[str, ...], sort: str) -> None:
        make = self._implementations.units[name]
        if not _needs_settings(make):
            prototype = UnitPrototype(lambda _: make(), len(input_sorts))
            self.factory.add_prototype(prototype, name, input_sorts, sort)


def _prototypes_in(specification: Specification) -> set[str]:
    declarations = specification.declarations
    kinds = SourceDeclaration | UnitDeclaration
    return {each.name.text for each in declarations if isinstance(each, kinds)}


def _needs_settings(make: Callable[..., object]) -> bool:
    parameters = inspect.signature(make).parameters.values()
    optional = inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD
    return any(p.default is p.empty and p.kind not in optional for p in parameters)


def _both(first: OnTime, second: OnTime | None) -> OnTime:
    def on_time(now: TimePoint) -> None:
        first(now)
        if second is not None:
            second(now)

    return on_time
