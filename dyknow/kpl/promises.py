"""What generators promise about their samples, and whether the policies of streams can be kept."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TypeVar

from dyknow.errors import PolicyError
from dyknow.kpl.names import Declarations, Placed, Scope
from dyknow.kpl.policies import policy_from_constraints
from dyknow.kpl.printer import text_from
from dyknow.kpl.states import policy_of_states, synchroniser
from dyknow.kpl.syntax import (
    Constraint,
    GeneratorDeclaration,
    Label,
    StreamTerm,
    Synchronisation,
)
from dyknow.source_text import Span
from dyknow.streams.policy import Approximation, Order, Policy
from dyknow.streams.refusal import refusal

__all__ = ["Promises", "policy_of_input", "promise_of"]

T = TypeVar("T")
_STRENGTHS = (Order.ANY, Order.MONOTONE, Order.STRICT)


def promise_of(declaration: GeneratorDeclaration) -> Policy:
    """Return what the samples of a generator keep, as far as its declaration says.

    Raises:
        ValueError: The constraints of the declaration are at fault.
    """
    if isinstance(declaration.process, Synchronisation):
        return policy_of_states(declaration.constraints)
    return policy_from_constraints(declaration.constraints)


def policy_of_input(stream: StreamTerm, providers: Sequence[GeneratorDeclaration]) -> Policy:
    """Return what the samples of a stream keep: its policy, and what the generator promises.

    Args:
        stream: The stream.
        providers: What its label stands for, as far as that is one generator.

    Raises:
        ValueError: The constraints of the stream are at fault.
    """
    if isinstance(stream.provider, Synchronisation):
        return policy_of_states(stream.constraints)
    wanted = policy_from_constraints(stream.constraints)
    if len(providers) != 1 or wanted.approximation is Approximation.MOST_RECENT:
        return wanted
    offered = promise_of(providers[0])
    delays = [d for d in (offered.max_delay, wanted.max_delay) if d is not None]
    return replace(
        wanted,
        change=wanted.change if wanted.period is not None else offered.change,
        max_delay=min(delays, default=None),
        order=max(wanted.order, offered.order, key=_STRENGTHS.index),
    )


class Promises:
    """Finds policies that no stream can keep."""

    def __init__(self, declared: Declarations) -> None:
        self._declared = declared

    def faults_of_generator(self, placed: Placed) -> Iterator[PolicyError]:
        """Yield what is wrong with the policy of the declaration of a generator."""
        declaration = placed.declaration
        process, constraints = declaration.process, declaration.constraints
        if isinstance(process, Synchronisation):
            span = declaration.span
            yield from self._faults_of_states(process, constraints, placed.scope, span)
        else:
            yield from _faults(lambda: policy_from_constraints(constraints), declaration.span)

    def faults_of_stream(self, stream: StreamTerm, scope: Scope) -> Iterator[PolicyError]:
        """Yield what is wrong with the policy of a stream, given who provides it."""
        provider, constraints = stream.provider, stream.constraints
        if isinstance(provider, Synchronisation):
            yield from self._faults_of_states(provider, constraints, scope, stream.span)
            return
        yield from _faults(lambda: policy_from_constraints(constraints), stream.span)
        wanted = _policy_or_none(lambda: policy_from_constraints(constraints))
        if isinstance(provider, Label) and wanted is not None and not scope.is_merged(provider):
            yield from self._refusals(provider, wanted, stream, scope)

    def _refusals(
        self, label: Label, wanted: Policy, stream: StreamTerm, scope: Scope
    ) -> Iterator[PolicyError]:
        for placed in self._declared.meaning(label, scope).all:
            offered = _policy_or_none(lambda: promise_of(placed.declaration))  # noqa: B023
            reason = None if offered is None else refusal(offered, wanted)
            if reason is not None:
                name = placed.label.text
                yield PolicyError(f"'{name}' cannot keep this policy: {reason}", stream.span)

    def _faults_of_states(
        self,
        process: Synchronisation,
        constraints: tuple[Constraint, ...],
        scope: Scope,
        span: Span,
    ) -> Iterator[PolicyError]:
        def made() -> object:
            names = [text_from(stream.provider) for stream in process.streams]
            inputs = [self._input(stream, scope) for stream in process.streams]
            return synchroniser(names, constraints, inputs)

        yield from _faults(made, span)

    def _input(self, stream: StreamTerm, scope: Scope) -> Policy:
        """Return what an input keeps; without constraints that are at fault themselves."""
        declarations: list[GeneratorDeclaration] = []
        if isinstance(stream.provider, Label):
            declarations = [
                placed.declaration for placed in self._declared.meaning(stream.provider, scope).all
            ]
        found = _policy_or_none(lambda: policy_of_input(stream, declarations))
        return Policy() if found is None else found


def _faults(make: Callable[[], object], span: Span) -> Iterator[PolicyError]:
    try:
        make()
    except ValueError as fault:
        yield PolicyError(str(fault), span)
    except TypeError:  # a parameter is not bound, which is reported already
        return


def _policy_or_none(make: Callable[[], T]) -> T | None:
    try:
        return make()
    except (ValueError, TypeError):  # which is reported where the policy is declared
        return None
