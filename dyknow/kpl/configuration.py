"""What changes in a network by itself: configuration blocks and mediations at work.

Both follow a stream of sets, and begin with the newest set there is. When a new one has come,
the network is changed at the end of the instant: first leaves what belongs to members that have
left, then what belongs to new members is built, then mediations take the streams of the members
they have now. A member whose processes need a label that does not exist waits until it does.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from dyknow.errors import LabelAlreadyExistsError, PolicyNotSupportedError, ProcessError
from dyknow.kpl.assembly import Assembly, Part, name_of, policy_of
from dyknow.kpl.members import Mediator, label_from, members_in, objects_in
from dyknow.kpl.names import OUTSIDE, labels_of
from dyknow.kpl.outputs import Outputs
from dyknow.kpl.parameters import bind_label, bind_members
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    Configuration,
    GeneratorDeclaration,
    Mediation,
    StreamDeclaration,
    StreamTerm,
)
from dyknow.runtime.generators import Label as GeneratorLabel
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.streams.sample import Sample

__all__ = ["Configurations"]


@dataclass(eq=False)
class _Block:
    """A configuration block at work.

    Attributes:
        declaration: The block, outer members bound.
        members: What exists for each member.
        newest: The newest set, until it has been dealt with.
        proxy: The stream of sets.
    """

    declaration: Configuration
    members: dict[str, "_Member"] = field(default_factory=dict)
    newest: tuple[str, ...] | None = None
    proxy: StreamProxy | None = None


@dataclass(eq=False)
class _Member:
    """What exists for one member of a block.

    Attributes:
        name: The member.
        generators: The declarations of its generators.
        outputs: The declarations of its output streams.
        blocks: The blocks inside it.
        is_built: Whether it has been built; it may have to wait for a label.
    """

    name: str
    generators: list[GeneratorDeclaration]
    outputs: list[StreamDeclaration]
    blocks: list[_Block]
    is_built: bool = False

    @property
    def needs(self) -> list[StreamTerm]:
        """The streams that must be there for it to be built."""
        outputs = [each.stream for each in self.outputs]
        return outputs + [block.declaration.members for block in self.blocks]


@dataclass(eq=False)
class _Merged:
    """One of the streams that a mediation takes now."""

    stream: StreamTerm
    proxy: StreamProxy


@dataclass(eq=False)
class _Mediation:
    """A mediation at work.

    Attributes:
        part: Its process.
        declaration: The mediation.
        newest: The newest set.
        merged: The streams that it takes now, by member.
    """

    part: Part
    declaration: Mediation
    newest: tuple[str, ...] = ()
    merged: dict[str, _Merged] = field(default_factory=dict)


class Configurations:
    """The blocks and mediations of a network."""

    def __init__(
        self, assembly: Assembly, outputs: Outputs, on_settled: Callable[[], object]
    ) -> None:
        """Change *assembly* and *outputs*; call *on_settled* when that has been done."""
        self._on_settled = on_settled
        self._assembly = assembly
        self._kernel = assembly.kernel
        self._outputs = outputs
        self._blocks: list[_Block] = []
        self._mediations: dict[str, _Mediation] = {}
        self._is_asked = False
        self._is_settling = False

    @property
    def waiting(self) -> dict[str, list[str]]:
        """What waits for labels: a member of a block, or a mediation and one of its members."""
        found = {}
        for block in self._blocks:
            for member in block.members.values():
                if not member.is_built:
                    found[_text_of(block, member)] = self._assembly.missing(member.needs)
        for mediation in self._mediations.values():
            for name in mediation.newest:
                if name not in mediation.merged:
                    stream = _stream_for(mediation.declaration, name)
                    key = f"{mediation.part.label} for {name}"
                    found[key] = self._assembly.missing([stream])
        return found

    @property
    def proxies(self) -> set[StreamProxy]:
        """The streams of sets of all blocks."""
        return {block.proxy for block in self._blocks if block.proxy is not None}

    def enter(self, declaration: Configuration) -> None:
        """Let a block work whose stream of sets has been built."""
        self._enter(_Block(declaration))

    def leave(self, declaration: Configuration) -> None:
        """Take out a block and all that exists for its members."""
        block = self._block(declaration)
        leaving = list(block.members.values())
        self._forget(leaving)
        self.drop()
        self._leave(block)

    def outputs_of(self, declaration: Configuration) -> set[str]:
        """Return the names of the outputs that a block has now, those of inner blocks too."""
        return set(_outputs_of(self._block(declaration)))

    def redeclare(self, old: Configuration, new: Configuration) -> None:
        """Let a block have the policies of another declaration of it."""
        self._redeclare(self._block(old), new)

    def redeclare_mediation(self, label: str, declaration: GeneratorDeclaration) -> None:
        """Let the streams that a mediation takes have the policy of another declaration of it."""
        mediation, process = self._mediations.get(label), declaration.process
        if mediation is None or not isinstance(process, Mediation):
            return
        mediation.declaration = process
        for name, merged in mediation.merged.items():
            stream = _stream_for(process, name)
            if stream.constraints != merged.stream.constraints:
                merged.stream = stream
                merged.proxy.replace_policy(policy_of(stream))

    def built(self, parts: Iterable[Part]) -> None:
        """Take note of parts that have been built: mediations begin to work."""
        for part in parts:
            if isinstance(part.process, Mediation) and isinstance(part.unit, Mediator):
                mediation = _Mediation(part, part.process)
                self._mediations[part.label] = mediation
                part.unit.on_members = self._told(mediation)
                newest = self._newest(part.process.members)
                if newest is not None:
                    part.unit.on_members(newest.value)

    def gone(self, parts: Iterable[Part]) -> None:
        """Take note of parts that have been taken out: mediations let go of what they took."""
        for part in parts:
            mediation = self._mediations.pop(part.label, None)
            for merged in () if mediation is None else mediation.merged.values():
                self.gone(self._assembly.release(name_of(merged.stream)))

    def ask(self) -> None:
        """See to it that `settle` is called when the work of the instant is done."""
        if not self._is_asked:
            self._is_asked = True
            self._kernel.change(self.settle)

    def settle(self) -> None:
        """Make the network fit the newest sets and the labels that there are.

        What is built for it may begin with a set of its own, so that there is more to do.
        """
        self._is_asked = True
        if self._is_settling:
            return
        self._is_settling = True
        try:
            while self._is_asked:
                self._is_asked = False
                self._settle_once()
        finally:
            self._is_settling = False
        self._on_settled()

    def _settle_once(self) -> None:
        leaving = [member for block in self._blocks for member in _leaving(block)]
        self._forget(leaving)
        self.drop()
        for member in leaving:
            self._take_out(member)
        for block in self._blocks:
            self._let_join(block)
        for block in self._blocks:  # which grows meanwhile by the blocks inside new members
            for member in block.members.values():
                self._build(member)
        for mediation in list(self._mediations.values()):
            self._merge(mediation)

    def _block(self, declaration: Configuration) -> _Block:
        return next(each for each in self._blocks if each.declaration is declaration)

    def _redeclare(self, block: _Block, new: Configuration) -> None:
        if block.proxy is not None and block.declaration.members != new.members:
            block.proxy.replace_policy(policy_of(new.members))
        block.declaration = new
        for member in block.members.values():
            other = self._bound(block, member.name)
            for each in other.generators:
                self._assembly.redeclare(each.label.text, each)
                self.redeclare_mediation(each.label.text, each)
            for output in other.outputs if member.is_built else ():
                self._outputs.replace(output.name.text, output.stream)
            for inner, found in zip(member.blocks, other.blocks, strict=True):
                self._redeclare(inner, found.declaration)
            member.generators, member.outputs = other.generators, other.outputs

    def _enter(self, block: _Block) -> None:
        term = block.declaration.members
        label = self._assembly.hold(term)
        name = GeneratorLabel(_name_of(block))

        def receive(sample: Sample[Any]) -> None:
            try:
                newest = objects_in(sample.value)
            except ValueError as fault:
                raise ProcessError(name, sample.available_time, str(fault)) from fault
            if block.newest is not None or newest != tuple(block.members):
                block.newest = newest
                self.ask()

        self._blocks.append(block)
        block.proxy = self._kernel.subscribe(label, receive, policy_of(term), name)
        newest = self._newest(term)
        if newest is not None:
            receive(newest)

    def _newest(self, term: StreamTerm) -> Sample[Any] | None:
        """Return the newest set that has come before anybody asked."""
        last = self._kernel.generator(GeneratorLabel(name_of(term))).last
        is_wanted = last is not None and policy_of(term).covers(last.valid_time)
        return last if is_wanted else None

    def _leave(self, block: _Block) -> None:
        for member in block.members.values():
            self._take_out(member)
        if block in self._blocks:
            self._blocks.remove(block)
            assert block.proxy is not None  # since it has been entered
            block.proxy.end()
            self.gone(self._assembly.release(name_of(block.declaration.members)))

    def _let_join(self, block: _Block) -> None:
        """Adopt the newest set of a block, if there is one."""
        newest, block.newest = block.newest, None
        if newest is not None:
            old = block.members
            block.members = {name: old.get(name) or self._new(block, name) for name in newest}

    def _new(self, block: _Block, name: str) -> _Member:
        member = self._bound(block, name)
        labels = [each.label.text for each in member.generators]
        names = [each.name.text for each in member.outputs]
        taken = [label for label in labels if label in self._assembly.known]
        taken += [name for name in names if name in self._outputs]
        if taken:
            fault = LabelAlreadyExistsError(taken[0])
            raise ProcessError(_name_of(block), self._kernel.now, str(fault)) from fault
        self._assembly.known.update(zip(labels, member.generators, strict=True))
        return member

    def _bound(self, block: _Block, name: str) -> _Member:
        """Return what a block declares for one member."""
        found = bind_members(block.declaration.declarations, {block.declaration.member.text: name})
        return _Member(
            name,
            [each for each in found if isinstance(each, GeneratorDeclaration)],
            [each for each in found if isinstance(each, StreamDeclaration)],
            [_Block(each) for each in found if isinstance(each, Configuration)],
        )

    def _forget(self, leaving: Iterable[_Member]) -> None:
        """Let nothing more be built of the declarations of members."""
        for member in leaving:
            for each in member.generators:
                del self._assembly.known[each.label.text]
            for block in member.blocks:
                self._forget(block.members.values())

    def drop(self) -> None:
        """Let mediations take no more streams of members that have left, or of lost labels."""
        for mediation in list(self._mediations.values()):
            staying = set(mediation.newest)
            for name, merged in list(mediation.merged.items()):
                if name not in staying or self._is_lost(merged.stream):
                    del mediation.merged[name]
                    self._kernel.remove_input(merged.proxy)
                    self.gone(self._assembly.release(name_of(merged.stream)))

    def _is_lost(self, stream: StreamTerm) -> bool:
        known = self._assembly.known
        return any(
            label.text not in known and label.feature.text not in known
            for label, _ in labels_of(stream.provider, OUTSIDE)
        )

    def _take_out(self, member: _Member) -> None:
        for block in member.blocks:
            self._leave(block)
        if member.is_built:
            for output in member.outputs:
                self.gone(self._outputs.close(output.name.text))

    def _build(self, member: _Member) -> None:
        if member.is_built or self._assembly.missing(member.needs):
            return
        self.built(self._assembly.build(member.needs))
        for output in member.outputs:
            self._outputs.open(output)
        for block in member.blocks:
            self._enter(block)
        member.is_built = True

    def _merge(self, mediation: _Mediation) -> None:
        """Let a mediation take the streams of the members that it does not take yet."""
        label = mediation.part.label
        for name in mediation.newest:
            if name in mediation.merged:
                continue
            stream = _stream_for(mediation.declaration, name)
            if self._assembly.missing([stream]):
                continue
            self.built(self._assembly.build([stream]))
            provider = self._assembly.hold(stream)
            try:
                proxy = self._kernel.add_input(label, provider, policy_of(stream))
            except (PolicyNotSupportedError, ValueError) as fault:
                raise ProcessError(label, self._kernel.now, str(fault)) from fault
            mediation.merged[name] = _Merged(stream, proxy)

    def _told(self, mediation: _Mediation) -> Any:
        def told(value: Any) -> None:
            newest = members_in(value)
            if newest == mediation.newest:
                return
            for name in newest:
                if name not in mediation.merged:
                    _stream_for(mediation.declaration, name)  # to find out what is wrong with it
            mediation.newest = newest
            self.ask()

        return told


def _stream_for(mediation: Mediation, name: str) -> StreamTerm:
    """Return the stream that a mediation merges for one member, an object or a label.

    Raises:
        ValueError: An object is expected, or a label, and the member is none.
    """
    member, stream = mediation.member.text, mediation.stream
    labels = [label for label, _ in labels_of(stream.provider, OUTSIDE)]
    if any(member == each.text for label in labels for each in label.objects):
        objects_in(name)
        stream = bind_members(stream, {member: name})
    if any(label.text == member for label in labels):
        stream = bind_label(stream, member, label_from(name))
    return stream


def _leaving(block: _Block) -> list[_Member]:
    """Return the members that are not in the newest set, and are members no more."""
    if block.newest is None:
        return []
    staying = set(block.newest)
    return [block.members.pop(name) for name in list(block.members) if name not in staying]


def _name_of(block: _Block) -> str:
    return f"for each {block.declaration.member.text} in {text_from(block.declaration.members)}"


def _text_of(block: _Block, member: _Member) -> str:
    return (
        f"{block.declaration.member.text} {member.name} of {text_from(block.declaration.members)}"
    )


def _outputs_of(block: _Block) -> Iterator[str]:
    for member in block.members.values():
        yield from (output.name.text for output in member.outputs if member.is_built)
        for inner in member.blocks:
            yield from _outputs_of(inner)
