"""Functions compiled over lanes of flights, held against XLA's `vmap` of the same function."""

import re
import sys

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership.lanes import NotCompiled, Program, Taken
from tethership.lanes.compiler import widest

WIDTHS = sorted({4, widest()})
FLIGHTS = 19


def numbers(*shape, seed=0):
    return np.random.default_rng(seed).normal(size=(*shape, FLIGHTS))


def both(function, own, shared=None, **options):
    """Return results of lanes and of XLA."""
    own, shared = jax.tree.map(jnp.asarray, own), jax.tree.map(jnp.asarray, shared)
    program = Program(function, shared, jax.tree.map(lambda leaf: leaf[..., 0], own), **options)
    reference = jax.vmap(lambda mine: function(shared, mine), in_axes=-1, out_axes=-1)(own)
    return program(shared, own), jax.tree.map(np.asarray, reference)


def agree(function, own, shared=None, tolerance=1e-13, **options):
    found, reference = both(function, own, shared, **options)
    assert jax.tree.structure(found) == jax.tree.structure(reference)
    for one, other in zip(jax.tree.leaves(found), jax.tree.leaves(reference), strict=True):
        assert one.dtype == other.dtype
        np.testing.assert_allclose(one, other, rtol=tolerance, atol=tolerance)


MATHEMATICS = {
    "sums": lambda _, x: x[0] + x[1] - 2.0 * x[2] / x[3],
    "trigonometry": lambda _, x: [jnp.sin(x), jnp.cos(x), jnp.tan(x), jnp.arctan2(x[0], x[1]), jnp.arctan(x)],
    "hyperbolic": lambda _, x: [jnp.sinh(x), jnp.cosh(x), jnp.tanh(x), jnp.arcsinh(x), jnp.arctanh(jnp.tanh(x))],
    "exponentials": lambda _, x: [jnp.exp(x), jnp.expm1(x), jnp.log(jnp.abs(x)), jnp.log1p(x**2), jnp.sqrt(x**2)],
    "powers": lambda _, x: [x**5, x**-3, jnp.abs(x) ** 1.7, 2.0**x, 1.0 / jnp.sqrt(x**2), jax.lax.rsqrt(x**2)],
    "rounding": lambda _, x: [jnp.floor(9 * x), jnp.ceil(9 * x), jnp.sign(x), (9 * x).astype(int), jnp.trunc(9 * x)],
    "remainders": lambda _, x: [jnp.mod(99 * x, 2 * jnp.pi), jnp.fmod(99 * x, -0.7), (99 * x).astype(int) % 7],
    "whole numbers": lambda _, x: [(99 * x).astype(int) // 4, jnp.floor(99 * x).astype(int) - 3],
    "choices": lambda _, x: [jnp.where(x > 0.3, x, -1.0), jnp.maximum(x, 0.2), jnp.clip(x, -0.5, 0.5), x != x[0]],
    "logic": lambda _, x: [(x > 0) & (x < 1), (x > 0) | ~(x < 1), (x > 0) ^ (x < 1), jnp.any(x > 1), jnp.all(x > -1)],
    "reductions": lambda _, x: [x.sum(), x.max(), x.min(), x.prod(), jnp.sum(x[:0]), jnp.max(x[:0], initial=-1.0)],
    "products": lambda _, x: [x @ x, jnp.outer(x, x) @ x, jnp.einsum("i,j,k->ki", x, x, x), jnp.cross(x[:3], x[1:])],
    "places": lambda _, x: [jnp.argmin(x), jnp.argmax(x), x[jnp.argmin(x)], x[jnp.array([2, 0])], jnp.cumsum(x)],
    "movement": lambda _, x: [
        x[::-1],
        jnp.stack([x, 2 * x]).T,
        jnp.pad(x, (1, 2)),
        jnp.roll(x, 1),
        jnp.tile(x, (2, 3)),
    ],
    "indices": lambda _, x: [x[(9 * x[0]).astype(int) % 4], jnp.outer(x, x)[(9 * x[:2]).astype(int) % 4]],
    "writing": lambda _, x: [x.at[1].set(x[0]), x.at[jnp.array([3, 0])].add(x[:2]), x.at[1:3].multiply(2.0)],
    "writing at indices": lambda _, x: [
        x.at[(9 * x[0]).astype(int) % 4].set(7.0),
        jnp.outer(x, x).at[(9 * x[1]).astype(int) % 4, 1].add(x[2]),
        x.at[(9 * x[0]).astype(int)].max(0.1),
        jax.lax.dynamic_update_slice(x, x[:2] + 1.0, ((9 * x[3]).astype(int),)),
    ],
    "linear systems": lambda _, x: [
        jnp.linalg.solve(jnp.outer(x, x[::-1]) + jnp.diag(x + 3.0), x),
        jnp.linalg.inv(jnp.outer(x, x) - 0.3 * jnp.eye(4)[::-1]),
        jax.jacfwd(lambda y: jnp.linalg.solve(jnp.outer(y, y) + jnp.eye(4), y))(x),
        jnp.linalg.det(jnp.outer(x, x[::-1]) + jnp.diag(x + 3.0)),
    ],
    "derivatives": lambda _, x: jax.jacfwd(lambda y: jnp.sin(y) * jnp.linalg.norm(y))(x),
    "gradients": lambda _, x: jax.grad(lambda y: jnp.sum(jnp.cos(y) ** 2) / (1.0 + y @ y))(x),
    "written-out loop": lambda _, x: jax.lax.scan(lambda c, y: (c * y + 1.0, c), x[0], x),
    "counted loop": lambda _, x: jax.lax.fori_loop(0, 5, lambda i, c: c + i * x, x),
}


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("function", MATHEMATICS.values(), ids=list(MATHEMATICS))
def test_mathematics_as_xla(function, width):
    agree(function, numbers(4), width=width)


def test_a_loop_ends_for_each_flight_by_itself():
    def collatz(_, x):
        start = jnp.floor(jnp.abs(100.0 * x)) + 1.0
        follow = lambda s: (s[0] + 1, jnp.where(s[1] % 2 == 0, s[1] / 2, 3 * s[1] + 1))  # noqa: E731
        return jax.lax.while_loop(lambda s: s[1] > 1, follow, (0, start))

    agree(collatz, numbers(), tolerance=0)


def test_a_loop_in_a_loop():
    def nested(_, x):
        def outer(state):
            count, y = state
            inner = jax.lax.while_loop(lambda z: jnp.abs(z) > 0.1 * count + 0.1, lambda z: 0.7 * z * jnp.cos(y), x + y)
            return count + 1, y + inner

        return jax.lax.while_loop(lambda s: (s[0] < 5) & (s[1] < 3.0), outer, (0, x))

    agree(nested, numbers())


def test_newton_by_the_implicit_function_theorem():
    from tethership.physics.cable.catenary import root

    def slopes(_, x):
        arguments = jnp.abs(x[0]) + 0.01, x[1], 0.1 * jnp.abs(x[2])
        return root(*arguments), jax.jacfwd(root, argnums=(0, 1, 2))(*arguments)

    agree(slopes, numbers(3), tolerance=1e-9)


def test_branches_of_some_flights_and_of_none():
    def branched(_, x):
        swapped = jax.lax.cond(x[0] > 0, lambda y: (y[::-1], True), lambda y: (2.0 * y, False), x)
        return swapped, jax.lax.switch((3 * x[1]).astype(int), [jnp.sin, jnp.cos, jnp.exp], x)

    agree(branched, numbers(4))
    agree(branched, numbers(4) * 0 + 1.0)


def test_a_loop_within_a_branch_runs_for_those_alone_who_take_it():
    """With the numbers of the others it would never end (`vmap` runs it for all)."""

    def halved(_, x):
        loop = lambda y: jax.lax.while_loop(lambda z: z > 0.01, lambda z: z * y, 1.0)  # noqa: E731
        return jax.lax.cond(x < 0, lambda y: 0.5 * y, lambda y: loop(1.0 / (1.5 + y)), x)

    x = numbers() * 5.0
    assert (1.0 / (1.5 + x) > 1.0).any()
    one_by_one = np.array([float(halved(None, jnp.asarray(number))) for number in x])
    np.testing.assert_allclose(Program(halved, None, x[0])(None, x), one_by_one, rtol=1e-13)


def test_tables_are_read_at_places_that_are_worked_out():
    """Records of 3 000 numbers, one that all share and one of each flight, read beyond their ends too."""
    shared, own = np.random.default_rng(1).normal(size=(1000, 3)), (numbers(1000, 3, seed=2), numbers(2))

    def read(table, mine):
        record, x = mine
        first = jnp.floor(1e3 * x[0] + 100).astype(int)
        near = jax.lax.dynamic_slice_in_dim(record, first, 4)
        return near.sum(0), jax.lax.dynamic_slice_in_dim(table, first, 2), record[7], table[first]

    agree(read, own, shared)


def test_what_is_shared_is_given_once():
    shared = {"matrix": np.random.default_rng(3).normal(size=(4, 4)), "number": 2.0}
    agree(lambda s, x: jnp.sin(s["number"]) * s["matrix"] @ s["matrix"] @ x, numbers(4), shared)


@pytest.mark.parametrize("flights", [1, 3, 8, 17])
def test_any_number_of_flights_and_of_threads(flights):
    function = lambda _, x: jnp.sin(x) * x[0]  # noqa: E731
    x = numbers(4)
    program = Program(function, None, x[:, 0])
    whole = program(None, x, threads=3)
    np.testing.assert_array_equal(program(None, x[:, :flights], threads=1), whole[:, :flights])


def test_not_a_number_is_seen():
    x = numbers(4)
    x[:, 5], x[0, 6], x[1, 7] = np.nan, np.inf, np.nan
    function = lambda _, x: [x.max(), jnp.minimum(x[0], x[1]), jnp.isfinite(x), x[0] - x[0], jnp.argmin(x), x[0] > x[1]]  # noqa: E731
    found, reference = both(function, x)
    for one, other in zip(found, reference, strict=True):
        np.testing.assert_array_equal(one, other)


def test_stopped_between_groups():
    taken = Taken()
    taken.stop()
    found = Program(lambda _, x: 2.0 * x, None, 0.0)(None, numbers(), taken=taken)
    assert np.isnan(found).all()


def test_what_is_not_known_is_named():
    with pytest.raises(NotCompiled, match="the primitive 'sort' is not known"):
        Program(lambda _, x: jnp.sort(x), None, np.zeros(4))
    with pytest.raises(NotCompiled, match="a loop of 500 rounds is too long"):
        Program(lambda _, x: jax.lax.fori_loop(0, 500, lambda i, c: c + x, x), None, 0.0)


def test_wrong_arguments_are_told():
    program = Program(lambda s, x: s + x, 1.0, np.zeros(4))
    with pytest.raises(ValueError, match=re.escape("has shape (3, 19); it must be (4, 19)")):
        program(1.0, numbers(3))
    with pytest.raises(ValueError, match="arguments are built as"):
        program({}, numbers(4))


# The compiler and what it has made


def test_no_compiler_or_one_that_fails(tmp_path):
    with pytest.raises(NotCompiled, match="the compiler '/no/such/c\\+\\+' does not run"):
        Program(lambda _, x: x + 1, None, 0.0, compiler="/no/such/c++")
    failing = tmp_path / "c++"
    failing.write_text(
        '#!/bin/sh\n[ "$1" = --version ] && echo broken && exit 0\necho "error: out of ink" >&2\nexit 1\n'
    )
    failing.chmod(0o700)
    with pytest.raises(NotCompiled, match=r"failed: error: out of ink"):
        Program(lambda _, x: x + 1, None, 0.0, compiler=str(failing))


@pytest.fixture
def counted(monkeypatch):
    """How often a library was made."""
    from tethership.lanes import compiler

    made, before = [], compiler._made
    monkeypatch.setattr(compiler, "_made", lambda *given: made.append(1) or before(*given))
    return made


def test_libraries_are_kept(tmp_path, counted):
    function = lambda _, x: jnp.sin(x) + 1.0  # noqa: E731
    for _ in range(3):
        Program(function, None, 0.0, folder=tmp_path / "kept")
    assert len(counted) == 1
    assert (tmp_path / "kept").stat().st_mode & 0o777 == 0o700
    Program(lambda _, x: jnp.sin(x) + 2.0, None, 0.0, folder=tmp_path / "kept")
    Program(function, None, 0.0, folder=tmp_path / "kept", width=2)
    assert len(counted) == 3


@pytest.mark.parametrize("damage", ["cut", "changed", "digest", "empty", "another"])
def test_a_damaged_library_is_made_again(tmp_path, counted, damage):
    function = lambda _, x: jnp.cos(x) + 1.0  # noqa: E731
    Program(function, None, 0.0, folder=tmp_path)
    (library,) = tmp_path.glob("*.so")
    data, digest = library.read_bytes(), library.with_suffix(".sha256")
    library.unlink()  # the loaded one stays as it is
    if damage != "digest":
        other = bytes([data[0] ^ 1]) + data[1:]
        library.write_bytes({"cut": data[:-100], "changed": other, "empty": b"", "another": b"\x7fELF"}[damage])
    else:
        library.write_bytes(data)
        digest.write_bytes(b"\xff\xfe")
    x = numbers()
    np.testing.assert_allclose(Program(function, None, 0.0, folder=tmp_path)(None, x), np.cos(x) + 1.0, rtol=1e-14)
    assert len(counted) == 2


def test_a_folder_that_others_may_write_to_is_not_used(tmp_path, counted):
    tmp_path.chmod(0o777)
    for _ in range(2):
        Program(lambda _, x: x * 3.0, None, 0.0, folder=tmp_path)
    assert len(counted) == 2
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_made_is_done_without(tmp_path):
    (tmp_path / "file").write_text("")
    found = Program(lambda _, x: x * 3.0, None, 0.0, folder=tmp_path / "file" / "kept")(None, numbers())
    np.testing.assert_array_equal(found, 3.0 * numbers())


def test_the_same_source_every_time():
    """Sources are the keys of kept libraries: nothing in them may depend on where objects lie in memory."""
    from tethership.lanes import program

    sources, before = [], program.library
    for _ in range(2):
        program.library = lambda source, *rest: sources.append(source) or before(source, *rest)
        try:
            Program(lambda _, x: jnp.linalg.norm(jnp.outer(x, x) @ x) * x[::-1] + x, None, np.zeros(4))
        finally:
            program.library = before
    assert sources[0] == sources[1]


def test_the_compiler_of_a_wheel_gives_the_same_to_rounding():
    """Where the extra `fast` is installed."""
    pytest.importorskip("ziglang")
    function = lambda _, x: jnp.exp(jnp.sin(x)) / x[0]  # noqa: E731
    wheel, system = (
        Program(function, None, np.zeros(4), compiler=c) for c in (f"{sys.executable} -m ziglang c++", None)
    )
    np.testing.assert_allclose(wheel(None, numbers(4)), system(None, numbers(4)), rtol=1e-13)
