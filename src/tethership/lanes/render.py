"""A graph as a C++ program over lanes of flights. Depends on: scalars, liveness, not JAX.

Every flight's number becomes a vector of so many flights; what all flights share stays a plain number. The program has
one function, `PREFIX_run`, that takes groups of flights from a common counter until none is left, so that any number of
threads may call it at once.
"""

import math
from collections.abc import Iterable, Sequence
from functools import cache
from importlib import resources

from tethership.lanes.liveness import needed
from tethership.lanes.scalars import MASK, Branch, Graph, Loop, Scalar

OPERATORS = {"add": "+", "sub": "-", "mul": "*", "div": "/", "gt": ">", "lt": "<", "ge": ">=", "le": "<=", "eq": "=="}
OPERATORS |= {"ne": "!=", "and": "&", "or": "|", "xor": "^"}

_PROGRAM = """{header}
static void shared_part(const double* shared, const double* const* tables, double* kept) {{
{shared}
}}
static __attribute__((noinline)) void group(const double* shared, const double* const* tables, const double* kept,
                                            const double* own, double* results, long flights, long first) {{
{own}
}}
extern "C" __attribute__((visibility("default"))) void tethership_lanes_run(
    const double* shared, const double* const* tables, const double* own, double* results, long flights,
    long* next) {{
  double kept[{kept}];
  shared_part(shared, tables, kept);
  for (;;) {{
    const long first = LANES * __atomic_fetch_add(next, 1, __ATOMIC_RELAXED);
    if (first >= flights) break;
    group(shared, tables, kept, own, results, flights, first);
  }}
}}
"""


def program(graph: Graph, results: Sequence[Scalar], lanes: int) -> str:
    """Return the source of a graph's program.

    Parameters
    ----------
    graph : Graph
    results : sequence of Scalar
        One for each row of results; masks are stored as 0 and 1.
    lanes : int
        Flights in a vector: 8 with AVX-512, 4 with AVX2.
    """
    writer = _Writer(needed(graph, results))
    writer.statements(graph.blocks[1].statements, shared=True)
    shared, writer.lines = writer.lines, []
    writer.statements(graph.blocks[2].statements)
    for row, scalar in enumerate(results):
        value = writer.vector(scalar)
        value = f"choose({value},K(1.0),K(0.0))" if scalar.kind == MASK else value
        writer.lines.append(f"STORE({row},{value});")
    kept = list(writer.shared_used)
    shared += [f"kept[{place}]={name};" for place, name in enumerate(kept)]
    opened = [f"const {writer.shared_used[name]} {name}=kept[{place}];" for place, name in enumerate(kept)]
    header = f"#define LANES {lanes}\n{_header()}"
    lines = "\n".join
    return _PROGRAM.format(
        header=header, shared=lines(shared), own=lines([*opened, *writer.lines]), kept=max(len(kept), 1)
    )


@cache
def _header() -> str:
    return resources.files("tethership.lanes").joinpath("vectors.h").read_text(encoding="utf-8")


class _Writer:
    """Names scalars and writes the statements of blocks; only what is needed is written."""

    def __init__(self, needed: set[int]) -> None:
        self.needed = needed
        self.names: dict[int, str] = {}
        self.lines: list[str] = []
        self.shared_used: dict[str, str] = {}

    def statements(self, statements: Iterable[Scalar | Loop | Branch], shared: bool = False) -> None:
        for statement in statements:
            if isinstance(statement, Scalar):
                if id(statement) in self.needed:
                    self.expression(statement, shared)
            elif isinstance(statement, Loop):
                self.loop(statement)
            else:
                self.branch(statement)

    def named(self, scalar: Scalar, letter: str) -> str:
        self.names[id(scalar)] = name = f"{letter}{len(self.names)}"
        return name

    def expression(self, scalar: Scalar, shared: bool) -> None:
        spread = self.plain if shared else self.vector
        text = _written(scalar, [spread(argument) for argument in scalar.arguments])
        kind = ("bool" if shared else "vl") if scalar.kind == MASK else ("double" if shared else "vd")
        self.lines.append(f"const {kind} {self.named(scalar, 'u' if shared else 'v')}={text};")

    def plain(self, scalar: Scalar) -> str:
        """Return a number that all flights share."""
        return _literal(scalar) if scalar.operation == "const" else self.names[id(scalar)]

    def vector(self, scalar: Scalar) -> str:
        """Return a number of each flight; one that all share is spread over them."""
        if scalar.depth >= 2:
            return self.names[id(scalar)]
        mask = scalar.kind == MASK
        if scalar.operation != "const":
            self.shared_used[self.names[id(scalar)]] = "bool" if mask else "double"
        return f"{'M' if mask else 'K'}({self.plain(scalar)})"

    def _moving(self, statement: Loop | Branch) -> list[tuple[str, str, Scalar]]:
        """Declare what a loop or branch changes, and return name, type and next value of each that is needed."""
        moving = []
        for now, first, following in zip(statement.carried, statement.first, statement.following, strict=True):
            if id(now) in self.needed:
                kind = "vl" if now.kind == MASK else "vd"
                start = self.vector(first)
                self.lines.append(f"{kind} {self.named(now, 'm')}={start};")
                moving.append((self.names[id(now)], kind, following))
        return moving

    def loop(self, loop: Loop) -> None:
        moving = self._moving(loop)
        if not moving:
            return
        self.lines.append("for(;;){")
        self.statements(loop.block.statements[: loop.split])
        mask = self.vector(loop.condition)
        self.lines.append(f"if(none({mask})) break;")
        self.statements(loop.block.statements[loop.split :])
        self._assign(moving, mask)

    def branch(self, branch: Branch) -> None:
        moving = self._moving(branch)
        if not moving:
            return
        mask = self.vector(branch.taken)
        self.lines.append(f"if(!none({mask})){{")
        self.statements(branch.block.statements)
        self._assign(moving, mask)

    def _assign(self, moving: list[tuple[str, str, Scalar]], mask: str) -> None:
        """Give what changes its next value where a mask is true, all at once, and end the block."""
        for name, kind, following in moving:
            self.lines.append(f"const {kind} n{name}=choose({mask},{self.vector(following)},{name});")
        self.lines += [f"{name}=n{name};" for name, _, _ in moving]
        self.lines.append("}")


def _written(scalar: Scalar, arguments: list[str]) -> str:
    """Return the text of an expression of arguments that are written already."""
    operation = scalar.operation
    if operation in OPERATORS:
        return f"({arguments[0]}{OPERATORS[operation]}{arguments[1]})"
    if operation == "neg":
        return f"(-{arguments[0]})"
    if operation in ("shared", "own"):
        return f"{operation.upper()}({scalar.detail})"
    if operation == "at":
        number, shared = scalar.detail  # pyright: ignore[reportGeneralTypeIssues]
        return f"{'AT' if shared else 'AT_OWN'}({number},{arguments[0]})"
    name = {"select": "choose", "not": "invert"}.get(operation, f"V{operation}")
    return f"{name}({','.join(arguments)})"


def _literal(scalar: Scalar) -> str:
    value = scalar.value
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None or math.isnan(value):
        return "NAN"
    if math.isinf(value):
        return "INFINITY" if value > 0 else "(-INFINITY)"
    text = float(value).hex()
    return f"({text})" if text.startswith("-") else text
