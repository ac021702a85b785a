"""What of a graph is needed for its results. Depends on: scalars."""

from collections.abc import Iterable, Iterator

from tethership.lanes.scalars import Block, Branch, Graph, Loop, Scalar


def needed(graph: Graph, results: Iterable[Scalar]) -> set[int]:
    """Return the `id` of every scalar that the results need, through loops and branches too."""
    changing = {
        id(now): (statement, i)
        for block in graph.blocks
        for statement in _closed(block)
        for i, now in enumerate(statement.carried)
    }
    found: set[int] = set()
    waiting = list(results)
    while waiting:
        scalar = waiting.pop()
        if id(scalar) in found:
            continue
        found.add(id(scalar))
        waiting += scalar.arguments
        if id(scalar) in changing:
            statement, place = changing[id(scalar)]
            mask = statement.condition if isinstance(statement, Loop) else statement.taken
            waiting += [mask, statement.first[place], statement.following[place]]
    return found


def _closed(block: Block) -> Iterator[Loop | Branch]:
    """Yield the loops and branches of a block, and of those."""
    for statement in block.statements:
        if not isinstance(statement, Scalar):
            yield statement
            yield from _closed(statement.block)
