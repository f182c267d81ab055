"""Stream generators that depend on themselves.

A generator depends on what its process takes, and one in a configuration block also on the
stream whose members decide whether it exists. A mediation depends on every generator that may be
merged; where whole labels come in a stream, that is known only when the network runs.
"""

from collections.abc import Iterator

from dyknow.errors import CircularDefinitionError
from dyknow.kpl.names import Declarations, Placed, labels_of

__all__ = ["cycles"]


def cycles(declared: Declarations) -> Iterator[CircularDefinitionError]:
    """Yield one fault for each place where following the inputs leads back."""
    done: set[int] = set()
    told: set[str] = set()
    for start in declared.placed:
        for fault in () if id(start.declaration) in done else _from(start, done, declared):
            if fault.message not in told:
                told.add(fault.message)
                yield fault


def _from(
    start: Placed, done: set[int], declared: Declarations
) -> Iterator[CircularDefinitionError]:
    """Follow the inputs of *start*, in depth; not by recursion, as the way may be long."""
    path = [start]
    on_path = {id(start.declaration): 0}
    ahead = [_inputs(start, declared)]
    while path:
        following = next(ahead[-1], None)
        if following is None:
            ahead.pop()
            last = id(path.pop().declaration)
            del on_path[last]
            done.add(last)
            continue
        key = id(following.declaration)
        if key in on_path:
            circle = [each.label.text for each in path[on_path[key] :]]
            yield CircularDefinitionError([*circle, circle[0]], following.label.span)
        elif key not in done:
            on_path[key] = len(path)
            path.append(following)
            ahead.append(_inputs(following, declared))


def _inputs(placed: Placed, declared: Declarations) -> Iterator[Placed]:
    around = (block.members.provider for block in placed.scope.blocks)
    for node in (placed.declaration.process, *around):
        for label, scope in labels_of(node, placed.scope):
            if not scope.is_merged(label):
                yield from declared.meaning(label, scope).all
