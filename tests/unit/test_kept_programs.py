"""Programs that are kept between processes: the same bits, no second tracing, and never a wrong one.

Truth: the traced function itself. If this fails, a flight has other numbers at its second start than at its first, or
every command takes seconds more.
"""

import json
import os
import subprocess
import sys
import types
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership import _kept, _outline, _programs
from tethership._kept import Kept
from tethership.simulation import segments

pytest.importorskip("flatbuffers")


class Pair(eqx.Module):
    """A structure of this package, for the tests: two numbers and a word."""

    first: jax.Array
    second: jax.Array
    word: str = eqx.field(static=True)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder of kept programs."""
    monkeypatch.setattr(_programs, "folder", lambda: tmp_path / "programs")
    return tmp_path / "programs"


@pytest.fixture
def ours(monkeypatch):
    """Return a function that has something counted as this package's own."""
    module = types.ModuleType("tethership._made_for_a_test")
    monkeypatch.setitem(sys.modules, module.__name__, module)

    def placed(thing, name):
        thing.__module__, thing.__qualname__, thing.__name__ = module.__name__, name, name
        setattr(module, name, thing)
        return thing

    placed(Pair, "Pair")
    return placed


@pytest.fixture
def scaled(ours):
    """A function of a structure, and the list of its tracings."""
    traced = []

    def scale(pair, factor=2.0):
        traced.append(pair.word)
        return Pair(pair.first * factor, jnp.sin(pair.second), pair.word + "!"), (pair.word, None, factor)

    return ours(scale, "scale"), traced


PAIR = Pair(jnp.arange(3.0), jnp.asarray(0.7), "word")


def kept_files(folder):
    """Return the names in the folder."""
    return sorted(path.name for path in folder.glob("*")) if folder.exists() else []


def same(one, other):
    """Return whether two results agree bit by bit, structures included."""
    leaves, others = jax.tree.leaves(one), jax.tree.leaves(other)
    return jax.tree.structure(one) == jax.tree.structure(other) and all(
        np.array_equal(a, b) and type(a) is type(b) for a, b in zip(leaves, others, strict=True)
    )


def test_the_next_process_does_not_trace(folder, scaled):
    function, traced = scaled
    first = Kept(function)(PAIR)
    assert len(kept_files(folder)) == 1
    assert folder.stat().st_mode & 0o777 == 0o700
    traced.clear()
    again = Kept(function)  # as a new process has it
    assert same(again(PAIR), first)
    assert same(again(Pair(PAIR.first + 1, PAIR.second, "word")), function(Pair(PAIR.first + 1, PAIR.second, "word")))
    assert traced == ["word"]  # by the line above, which calls the function itself
    assert same(first, eqx.filter_jit(function)(PAIR))


def test_results_go_where_the_caller_wants_them(folder, scaled):
    result, _ = Kept(scaled[0])(PAIR)
    assert not result.first.committed  # else the next function is compiled a second time


@pytest.mark.parametrize(
    "other",
    [
        lambda f: f(Pair(PAIR.first, PAIR.second, "other")),
        lambda f: f(Pair(jnp.arange(4.0), PAIR.second, "word")),
        lambda f: f(Pair(jnp.arange(3), PAIR.second, "word")),
        lambda f: f(PAIR, 3.0),
        lambda f: f(PAIR, factor=2.0),
        lambda f: f(PAIR, jnp.asarray(2.0)),
        lambda f: f(PAIR, 2),
    ],
)
def test_another_structure_is_another_program(other, folder, scaled):
    Kept(scaled[0])(PAIR, 2.0)
    assert same(other(Kept(scaled[0])), other(eqx.filter_jit(scaled[0])))
    assert len(kept_files(folder)) == 2


@pytest.mark.parametrize("what", ["source", "version", "setting", "checks"])
def test_another_world_is_another_program(what, folder, scaled, monkeypatch):
    Kept(scaled[0])(PAIR)
    if what == "source":
        monkeypatch.setattr(_kept, "_SOURCE", "other")
        monkeypatch.setattr(_kept, "source_digest", lambda: "other")
    elif what == "version":
        monkeypatch.setattr(_kept, "_versions", lambda: {"jax": "0.0"})
    elif what == "checks":
        monkeypatch.setattr(sys.modules["equinox._errors"], "EQX_ON_ERROR", "off")
    with jax.default_matmul_precision("highest" if what == "setting" else None):
        Kept(scaled[0])(PAIR)
    assert len(kept_files(folder)) == 2


def test_files_changed_since_the_start_keep_nothing(folder, scaled, monkeypatch):
    monkeypatch.setattr(_kept, "_SOURCE", "as it was")
    assert same(Kept(scaled[0])(PAIR), scaled[0](PAIR))
    assert kept_files(folder) == []


DAMAGES = {
    "flipped": lambda content: content[:-9] + bytes([content[-9] ^ 1]) + content[-8:],
    "half": lambda content: content[: len(content) // 2],
    "empty": lambda content: b"",
    "other": lambda content: b"something else\n" * 20,
    "magic": lambda content: content.replace(b"program 1", b"program 0"),
    "foreign": lambda content: _sealed(b"[]\n" + content[60:]),
    "unreadable": lambda content: _sealed(b"\xff" * 100),
}


def _sealed(content):
    """Return a file whose digest is right, and whose content is not."""
    import hashlib

    return _programs.MAGIC + hashlib.sha256(content).digest() + content


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_entry_is_made_anew(damage, folder, scaled):
    function, traced = scaled
    first = Kept(function)(PAIR)
    [name] = kept_files(folder)
    whole = (folder / name).read_bytes()
    (folder / name).write_bytes(DAMAGES[damage](whole))
    traced.clear()
    assert same(Kept(function)(PAIR), first)
    assert traced == ["word"]
    assert kept_files(folder) == [name]
    traced.clear()
    Kept(function)(PAIR)
    assert traced == []


def test_what_was_tampered_with_is_not_read(folder, scaled, monkeypatch):
    Kept(scaled[0])(PAIR)
    [name] = kept_files(folder)
    content = (folder / name).read_bytes()
    (folder / name).write_bytes(DAMAGES["flipped"](content))
    assert _programs.load(name) is None
    assert kept_files(folder) == []


def test_a_folder_that_others_may_write_into_is_not_used(folder, scaled):
    Kept(scaled[0])(PAIR)
    folder.chmod(0o777)
    scaled[1].clear()
    Kept(scaled[0])(PAIR)
    assert scaled[1] == ["word"]
    folder.chmod(0o700)


def test_where_nothing_can_be_written_all_goes_on(tmp_path, scaled, monkeypatch, capfd):
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setattr(_programs, "folder", lambda: tmp_path / "file" / "programs")
    assert same(Kept(scaled[0])(PAIR), scaled[0](PAIR))
    assert capfd.readouterr() == ("", "")


def test_a_full_disk_leaves_nothing_behind(folder, scaled, monkeypatch, capfd):
    def full(self, content):
        with self.open("wb") as file:
            file.write(content[:10])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    assert same(Kept(scaled[0])(PAIR), scaled[0](PAIR))
    assert kept_files(folder) == []
    assert capfd.readouterr() == ("", "")


def test_what_was_used_longest_ago_goes_first(folder, monkeypatch):
    for i, name in enumerate("abcd"):
        _programs.store(name, bytes(1000))
        os.utime(folder / name, (i + 1, i + 1))
    _programs.load("a")  # is used now
    (folder / "left.part").write_bytes(bytes(1000))
    os.utime(folder / "left.part", (0, 0))
    monkeypatch.setattr(_programs, "MOST", 3500)
    _programs.store("e", bytes(1000))
    assert kept_files(folder) == ["a", "d", "e"]


@pytest.mark.parametrize("place", ["", "gs://bucket/cache"])
def test_no_cache_no_programs(place, scaled, request):
    before = jax.config.values["jax_compilation_cache_dir"]
    request.addfinalizer(lambda: jax.config.update("jax_compilation_cache_dir", before))
    jax.config.update("jax_compilation_cache_dir", place)
    assert _programs.folder() is None
    assert Kept(scaled[0])._found(*jax.tree.flatten(((PAIR,), {}))) is None


def test_without_a_writer_nothing_is_traced_twice(folder, scaled, monkeypatch):
    monkeypatch.setattr(_kept, "_can_write", lambda: False)
    Kept(scaled[0])(PAIR)
    assert scaled[1] == ["word"]
    assert kept_files(folder) == []


def test_transformations_trace(folder, scaled):
    function = Kept(scaled[0])
    many = jax.vmap(lambda x: function(Pair(x, PAIR.second, "word"))[0].first)(jnp.ones((4, 3)))
    slope = jax.jacfwd(lambda x: function(Pair(PAIR.first, x, "word"))[0].second)(PAIR.second)
    back = jax.grad(lambda x: function(Pair(PAIR.first, x, "word"))[0].second)(PAIR.second)
    assert np.array_equal(many, np.full((4, 3), 2.0))
    assert slope == back == jnp.cos(0.7)
    assert kept_files(folder) == []


def test_a_program_that_calls_back_is_not_kept(folder, ours):
    def told(x):
        return jax.pure_callback(lambda y: np.asarray(y) * 2, jax.ShapeDtypeStruct((), float), x)

    assert Kept(ours(told, "told"))(jnp.asarray(1.5)) == 3.0
    assert kept_files(folder) == []


def test_linear_algebra_is_kept(folder, ours):
    def solved(matrix):
        return jnp.linalg.eig(matrix)[0], jnp.linalg.svd(matrix)[1], jnp.linalg.qr(matrix)[1], jnp.linalg.inv(matrix)

    matrix = jnp.asarray([[2.0, 1.0], [0.5, 3.0]])
    assert same(Kept(ours(solved, "solved"))(matrix), jax.jit(solved)(matrix))
    assert len(kept_files(folder)) == 1


def test_a_mistake_in_a_function_is_told_as_ever(folder, ours):
    def wrong(x):
        raise ts.ConfigError("a line that says what to do")

    with pytest.raises(ts.ConfigError, match="a line that says what to do"):
        Kept(ours(wrong, "wrong"))(jnp.asarray(1.0))


def own_law(offset):
    """Return a law of one's own; another offset is another code under the same name."""

    class Own(ts.AbstractLaw):
        gain: float = 1.0

        def __call__(self, time, measurement, memory):
            return ts.Request(), jnp.zeros(1)

        def initial_memory(self, measurement):
            return jnp.full(1, offset)

    return Own()


def test_code_of_ones_own_is_never_kept(folder, docking, point):
    from tethership.scenario import build_loop
    from tethership.simulation.events import Stop
    from tethership.simulation.start import begin

    conditions = Stop.docking(docking).conditions()
    for offset in (1.0, 2.0):
        loop = build_loop(docking.config, docking.system, point.command, own_law(offset))
        assert begin(loop, conditions, point.state)[0][-1] == offset
    assert kept_files(folder) == []


@pytest.mark.parametrize("thing", [own_law(1.0), lambda: 0, Pair(1, 2, "x"), object(), {"a": object()}, 1j])
def test_unknown_code_has_no_outline(thing):
    with pytest.raises(_outline.UnknownCodeError):
        _outline.outline(thing)


@pytest.mark.parametrize("name", ["docking", "hover", "aerostat", "three_lines"])
def test_structures_come_back_from_json(name):
    scenario = ts.load_scenario(name)
    for thing in (scenario.system, scenario.config, scenario.law(switched=True)):
        structure = jax.tree.structure(thing)
        text = json.dumps(_outline.structure_outline(structure))
        assert _outline.restored_structure(json.loads(text)) == structure


@pytest.mark.parametrize(
    "value", [None, (), [], {}, 1, True, 0.1, float("inf"), "x", (1, [2.5, {"b": None, "a": "é"}])]
)
def test_values_come_back_from_json(value):
    assert _outline.restored(json.loads(json.dumps(_outline.outline(value)))) == value


def test_a_flight_has_the_same_bits_without(docking, point, monkeypatch):
    kept = ts.fly(docking, point, stop=2.0)
    monkeypatch.setattr(segments, "fly_segment", segments.fly_segment._traced)
    traced = ts.fly(docking, point, stop=2.0)
    for name in kept.data.variables:
        assert np.array_equal(kept.data[name], traced.data[name], equal_nan=kept.data[name].dtype.kind == "f"), name


PROGRAM = """
import importlib, jax, tethership as ts
from tethership.plant import State
start = importlib.import_module("tethership.simulation.start")
traced, whole = [], start.rotation_matrix
start.rotation_matrix = lambda angles: traced.append(1) or whole(angles)
scenario = ts.load_scenario("hover", {"start.attitude_offset": [0.1, 0.2, 0.3]})
state = start.start_state(scenario, State.at_rest(jax.numpy.asarray([1.0, 2.0, -50.0])))
print(bool(traced), [float(x).hex() for x in state.as_vector()])
"""


def test_two_processes(tmp_path):
    place = {key: value for key, value in os.environ.items() if not key.startswith(("JAX_", "EQX_"))}
    place["JAX_COMPILATION_CACHE_DIR"] = str(tmp_path)
    place["JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS"] = "0"

    def run():
        done = subprocess.run([sys.executable, "-c", PROGRAM], env=place, capture_output=True, text=True, check=True)
        assert done.stderr == ""
        return done.stdout.split(" ", 1)

    first, second = run(), run()
    assert first[0] == "True"
    assert second[0] == "False"
    assert first[1] == second[1]
