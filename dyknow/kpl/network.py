"""A network of knowledge processes that can be changed while it runs."""

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import replace

from dyknow.errors import LabelAlreadyExistsError, LabelInUseError, UnknownNameError
from dyknow.kpl.assembly import Assembly, Part
from dyknow.kpl.check import check, raise_faults
from dyknow.kpl.configuration import Configurations
from dyknow.kpl.describing import describe
from dyknow.kpl.description import NetworkChange, NetworkDescription
from dyknow.kpl.implementations import Implementations
from dyknow.kpl.names import Declarations
from dyknow.kpl.outputs import Outputs
from dyknow.kpl.parameters import bind_parameters
from dyknow.kpl.parser import parse_policy, parse_specification
from dyknow.kpl.printer import text_from
from dyknow.kpl.removing import declarations_called, forbid_use
from dyknow.kpl.replacing import Target, replace_constraints
from dyknow.kpl.syntax import (
    Configuration,
    Constraint,
    Declaration,
    GeneratorDeclaration,
    Specification,
    StreamDeclaration,
    StreamTerm,
    Value,
)
from dyknow.kpl.unused import Needs
from dyknow.runtime.generators import Receive
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.source_text import MADE_IN_PYTHON, nearest_name

__all__ = ["Network"]


class Network:
    """A kernel with the processes of a specification, and the outputs it declares.

    What is declared outside of configuration blocks is built when an output may need it, and stays
    until it is removed by name. Changes that are asked for while an instant is being worked on
    have their effect when that work is done.

    Attributes:
        kernel: Runs the network: `kernel.run(until, on_time)`; keeps `kernel.accounts`.
    """

    def __init__(
        self, implementations: Implementations, values: Mapping[str, Value] | None = None
    ) -> None:
        """Make an empty network; *values* are for parameters, in place of their defaults."""
        self.kernel = Kernel()
        self._values = dict(values or {})
        self._specification = Specification(())
        self._wanted: set[str] = set()
        self._assembly = Assembly(self.kernel, implementations)
        self._outputs = Outputs(self._assembly)
        self._configurations = Configurations(self._assembly, self._outputs, self._tell)
        self._blocks: dict[str, Configuration] = {}
        self._change_receivers: list[Callable[[NetworkChange], object]] = []

    @property
    def outputs(self) -> tuple[str, ...]:
        """The names of the output streams that there are now, in the order they came."""
        return tuple(self._outputs)

    @property
    def specification(self) -> Specification:
        """What is declared now."""
        return self._specification

    @property
    def declarations(self) -> Declarations:
        """What is declared now, by name, with the values that the parameters have."""
        return Declarations(bind_parameters(self._specification, self._values)[0])

    @property
    def description(self) -> NetworkDescription:
        """What has been built and not been removed, as plain data."""
        return describe(self._assembly, self._outputs, self.declarations)

    @property
    def waiting(self) -> Mapping[str, list[str]]:
        """The members of sets for which nothing could be built, and the labels they wait for."""
        return self._configurations.waiting

    def subscribe(self, output: str, receive: Receive) -> StreamProxy:
        """Hand the samples of an output stream to *receive*, under its declared policy.

        Raises:
            ServiceError: There is no output of this name now.
        """
        return self._outputs.subscribe(output, receive)

    def subscribe_changes(self, receive: Callable[[NetworkChange], object]) -> Callable[[], None]:
        """Tell *receive* of each change of processes and outputs; return what ends that.

        It is told between two instants, when the change has been made.
        """
        self._change_receivers.append(receive)
        return lambda: self._change_receivers.remove(receive)

    def provide(self, implementations: Implementations) -> None:
        """Let more symbols stand for something; what has been built already stays as it is."""
        self._assembly.implementations = self._assembly.implementations.joined(implementations)

    def add(
        self,
        added: str | Specification,
        outputs: Collection[str] | None = None,
        name: str = "<specification>",
    ) -> None:
        """Declare more, and build what the *outputs* declared there need; all of them if None.

        Args:
            added: KPL text, or declarations.
            outputs: The names of the output streams that are wanted.
            name: What messages call the text.

        Raises:
            SpecificationErrors: Every fault of the specification that comes of it, or that shows
                when things are built; the network is as it was.
            LabelAlreadyExistsError: A label or an output belongs to a member of a set already.
        """
        if isinstance(added, str):
            added = parse_specification(added, name)
        old = self._specification.declarations
        specification = Specification((*old, *added.declarations))
        bound = check(specification, self._values, self._assembly.implementations.units)
        declared = Declarations(bound)
        new = _outputs_in(Specification(bound.declarations[len(old) :]))
        wanted = list(new) if outputs is None else list(outputs)
        raise_faults([_unknown_output(each, new) for each in wanted if each not in new])
        self._build(declared, {*self._wanted, *wanted})
        self._specification = specification
        self._tell()

    def remove(self, names: str | Collection[str]) -> None:
        """Take declarations back, and what was built of them out of the network.

        A declaration is called as it begins: `strmgen cars`, `stream cars`, `compunit Car`,
        `source vehicles`, `parameter p`, `for each car in cars`; its name alone will do where it
        is clear. What is removed together may depend on each other.

        Raises:
            ServiceError: There is no such declaration, or more than one.
            LabelInUseError: Others need it; they are named.
            SpecificationErrors: What would remain has faults.
        """
        given = (names,) if isinstance(names, str) else tuple(names)
        chosen = declarations_called(given, self._specification)
        bound = check(self._specification, self._values)
        forbid_use(chosen, self._specification, bound)
        removed = [bound.declarations[at] for at in chosen]
        self._forbid_use_at_work(removed)
        old = enumerate(self._specification.declarations)
        remaining = Specification(tuple(each for at, each in old if at not in chosen))
        check(remaining, self._values)
        self._take_out(removed)
        self._specification = remaining
        self._wanted -= set(_outputs_in(Specification(tuple(removed))))
        self._configurations.settle()

    def replace_policy(self, target: Target, constraints: str | Iterable[Constraint]) -> None:
        """Let an output or an input have another policy, in the specification and at work.

        Args:
            target: The name of an output, or a label and the number of an input, from 1 on.
            constraints: The whole policy, as written after `with`; empty to restrict nothing.

        Raises:
            ServiceError: There is no such stream, or it has no policy of its own.
            KPLSyntaxError: The text is no policy.
            SpecificationErrors: The policy cannot be kept.
            PolicyNotSupportedError: The process that runs cannot keep it.
        """
        given = parse_policy(constraints) if isinstance(constraints, str) else tuple(constraints)
        specification = replace_constraints(self._specification, target, given)
        bound = check(specification, self._values, self._assembly.implementations.units)
        self._redeclare(bound)
        self._specification = specification

    def _forbid_use_at_work(self, removed: Iterable[Declaration]) -> None:
        """Raise an error if what goes on working takes streams of what is to be removed."""
        labels = {each.label.text for each in removed if isinstance(each, GeneratorDeclaration)}
        closing = {each.name.text for each in removed if isinstance(each, StreamDeclaration)}
        blocks = [self._blocks.get(text_from(e)) for e in removed if isinstance(e, Configuration)]
        for block in blocks:
            closing |= set() if block is None else self._configurations.outputs_of(block)
        outputs = {each: self._outputs[each].stream for each in self._outputs}
        staying = [stream for name, stream in outputs.items() if name not in closing]
        staying += [block.members for block in self._blocks.values() if block not in blocks]
        own = self._outputs.proxies | self._configurations.proxies
        for label, users in self._assembly.users_of(labels, staying, own).items():
            raise LabelInUseError(label, users)

    def _build(self, declared: Declarations, wanted: set[str]) -> None:
        """Build what is wanted and not there yet, or change nothing."""
        outputs = [
            each
            for each, _ in declared.scoped()
            if isinstance(each, StreamDeclaration) and each.name.text in wanted
        ]
        needs = Needs(declared, outputs)
        blocks = {
            text_from(block): block
            for block in needs.blocks.values()
            if any(block is each for each in declared.all)
        }
        new_blocks = {text: b for text, b in blocks.items() if text not in self._blocks}
        new_outputs = [
            each
            for each in declared.streams.values()
            if each.name.text in wanted and each.name.text not in self._wanted
        ]
        taken = [each for each in declared.generators if self._is_of_member(each)]
        taken += [each.name.text for each in new_outputs if each.name.text in self._outputs]
        if taken:
            raise LabelAlreadyExistsError(taken[0])
        old = self._assembly.known, self._assembly.lasting
        self._assembly.known = {**self._assembly.known, **declared.generators}
        self._assembly.lasting = {*self._assembly.lasting, *declared.generators}
        terms = [each.stream for each in new_outputs] + [b.members for b in new_blocks.values()]
        terms += [StreamTerm(each.label) for each in needs.outside]
        try:
            parts = self._assembly.build(terms)
        except BaseException:
            self._assembly.known, self._assembly.lasting = old
            raise
        self._adopt(parts, new_outputs, new_blocks, wanted)

    def _is_of_member(self, label: str) -> bool:
        return label in self._assembly.known and label not in self._assembly.lasting

    def _adopt(
        self,
        parts: Iterable[Part],
        outputs: Iterable[StreamDeclaration],
        blocks: Mapping[str, Configuration],
        wanted: set[str],
    ) -> None:
        """Take note of what has been built."""
        self._wanted = wanted
        self._configurations.built(parts)
        for output in outputs:
            self._outputs.open(output)
        for text, block in blocks.items():
            self._blocks[text] = _pruned(block, wanted)
            self._configurations.enter(self._blocks[text])
        self._configurations.ask()

    def _take_out(self, declarations: Iterable[Declaration]) -> None:
        """Take what was built of some declarations out, those first that use the others."""
        labels = []
        for declaration in declarations:
            match declaration:
                case StreamDeclaration(name) if name.text in self._outputs:
                    self._configurations.gone(self._outputs.close(name.text))
                case Configuration():
                    block = self._blocks.pop(text_from(declaration), None)
                    if block is not None:
                        self._configurations.leave(block)
                case GeneratorDeclaration(label):
                    labels.append(label.text)
                    self._assembly.known.pop(label.text, None)
                    self._assembly.lasting.discard(label.text)
                case _:
                    pass
        self._configurations.drop()
        while any(self._sweep(label) for label in labels):
            pass

    def _sweep(self, label: str) -> bool:
        if label not in self._assembly.parts:
            return False
        gone = self._assembly.sweep(label, anyway=True)
        self._configurations.gone(gone)
        return bool(gone)

    def _redeclare(self, bound: Specification) -> None:
        """Let policies be those of a specification that differs in nothing else."""
        declared = Declarations(bound)
        for label, declaration in declared.generators.items():
            self._assembly.redeclare(label, declaration)
            self._configurations.redeclare_mediation(label, declaration)
        for name, output in declared.streams.items():
            if name in self._outputs:
                self._outputs.replace(name, output.stream)
        old = check(self._specification, self._values)
        for before, after in zip(old.declarations, bound.declarations, strict=True):
            if isinstance(after, Configuration) and text_from(before) in self._blocks:
                block = self._blocks.pop(text_from(before))
                self._blocks[text_from(after)] = _pruned(after, self._wanted)
                self._configurations.redeclare(block, self._blocks[text_from(after)])

    def _tell(self) -> None:
        change, self._assembly.journal = self._assembly.journal, NetworkChange()
        if change:
            for receive in self._change_receivers:
                receive(change)


def _outputs_in(specification: Specification) -> list[str]:
    found = Declarations(specification).scoped()
    return [each.name.text for each, _ in found if isinstance(each, StreamDeclaration)]


def _unknown_output(name: str, known: Iterable[str]) -> UnknownNameError:
    return UnknownNameError("output stream", name, MADE_IN_PYTHON, nearest_name(name, known))


def _pruned(block: Configuration, wanted: Collection[str]) -> Configuration:
    """Return a block without the outputs that are not wanted."""
    kept: list[GeneratorDeclaration | StreamDeclaration | Configuration] = []
    for each in block.declarations:
        if isinstance(each, Configuration):
            kept.append(_pruned(each, wanted))
        elif not isinstance(each, StreamDeclaration) or each.name.text in wanted:
            kept.append(each)
    return replace(block, declarations=tuple(kept))
