"""The house keeps its promises: names resolve, parameters have units, data files have sources, versions agree.

If one of these failed, a stranger could not say from one file which unit and which axes, or the README would lie.
"""

import ast
import importlib
import inspect
import pkgutil
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import equinox as eqx
import pytest
import typer

import tethership as ts
from tethership.cli import app
from tethership.results import OWN_VARIABLES, VARIABLES
from tethership.scenario.load import list_packaged, packaged_text

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "tethership"


def modules(package):
    """Return all modules of a package."""
    top = importlib.import_module(package)
    found = pkgutil.walk_packages(top.__path__, f"{package}.")
    return [importlib.import_module(info.name) for info in found]


MODULES = modules("tethership")


def public_functions():
    """Return the functions and methods that physics offers."""
    for module in MODULES:
        if ".physics." not in module.__name__:
            continue
        for name, thing in vars(module).items():
            if getattr(thing, "__module__", "") != module.__name__ or name.startswith("_"):
                continue
            if inspect.isfunction(thing):
                yield f"{module.__name__}.{name}", thing
            elif inspect.isclass(thing):
                for inner, method in vars(thing).items():
                    if inspect.isfunction(method) and not inner.startswith("_"):
                        yield f"{module.__name__}.{name}.{inner}", method


UNITS = {"-", "m", "s", "kg", "N", "rad", "K", "Pa"}


def names_unit(text):
    """Return whether a text has a unit in brackets: [m/s], [kg, kg m²], [their unit]; not Array[3] or [0, 1]."""
    return any(is_unit(inside) for inside in re.findall(r"(?<!\w)\[([^\]\n]+)\]", text or ""))


def is_unit(text):
    """Return whether all words between powers, products and quotients are units."""
    if re.fullmatch(r"(their|channel's|its own) unit( per second)?", text):
        return True
    words = [word for word in re.split(r"[ ,/·()…]+|\bper\b", re.sub(r"\^\([^)]*\)|[²³⁴⁵]", "", text)) if word]
    return bool(words) and all(word in UNITS or word == "1" for word in words) and words != ["1"]


def says_its_unit(function):
    """Return whether a function's docstring has a unit, or refers to one that exists and has."""
    text = function.__doc__ or ""
    named = re.search(r"arguments (?:are|as)(?: those)? (?:in|of) `(\w+)\.(\w+)`", text)
    if not named:
        return names_unit(text)
    kind = function.__globals__.get(named[1])
    return names_unit(getattr(getattr(kind, named[2], None), "__doc__", ""))


@pytest.mark.parametrize(
    "text", ["T [N]", "ω [rad/s]", "[m³, m⁴, m⁵]", "m^(3+n) [m^(3+n)]", "λ [-]", "[m³/s² per rad]"]
)
def test_a_unit_is_found(text):
    assert names_unit(text)


@pytest.mark.parametrize("text", ["", None, 'Float[Array, "3"]', "[0, I]", "[1]", "[see above]", "in metres", "x[m]"])
def test_no_unit_is_found_where_none_is(text):
    assert not names_unit(text)


def test_public_names_resolve():
    for name in ts.__all__:
        assert getattr(ts, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'dok'"):
        _ = ts.dok


@pytest.mark.parametrize("module", MODULES, ids=lambda module: module.__name__)
def test_module_says_what_it_is(module):
    first = (module.__doc__ or "").strip().splitlines()[:1]
    assert first, "no docstring"
    assert len(first[0].split()) >= 4, first
    assert re.search(r"[.:;,]( |$)", first[0]), first


def test_every_parameter_of_physics_has_a_unit():
    """Each field of each module of physics is described, with a unit in brackets or a type that has its own."""
    missing = []
    for module in MODULES:
        if ".physics." not in module.__name__:
            continue
        for name, thing in vars(module).items():
            if not (inspect.isclass(thing) and issubclass(thing, eqx.Module)) or thing.__module__ != module.__name__:
                continue
            text = "".join(base.__doc__ or "" for base in thing.__mro__ if issubclass(base, eqx.Module))
            for field in getattr(thing, "__dataclass_fields__", {}):
                described = re.search(
                    rf"\n    (?:\w+, )*{field}(?:, \w+)* : [^\n]*\n(.*?)(?=\n    \w[\w, ]* : |\Z)", text, re.DOTALL
                )
                of_its_own = re.search(r"SliceIntegrals|tuple\[int|bool", str(thing.__dataclass_fields__[field].type))
                if not described or not (names_unit(described.group(1)) or of_its_own):
                    missing.append(f"{module.__name__}.{name}.{field}")
    assert missing == []


def test_every_function_of_physics_names_a_unit():
    """What it returns or takes is a quantity: a docstring without any bracketed unit or reference to one is wrong."""
    functions = dict(public_functions())
    assert len(functions) > 50
    assert [name for name, thing in functions.items() if not says_its_unit(thing)] == []


def test_every_output_has_a_unit():
    assert {"tension", "attitude", "throttle"} <= set(VARIABLES)
    for name, entry in (VARIABLES | OWN_VARIABLES).items():
        assert entry.unit == "1" or is_unit(entry.unit.replace("m3", "m³")), name
        assert len(entry.meaning.split()) >= 2, name


def quantities(table, path=""):
    """Return every quantity of a document with its path."""
    if isinstance(table, dict):
        if "value" in table:
            yield path, table
            return
        for key, value in table.items():
            yield from quantities(value, f"{path}.{key}")
    if isinstance(table, list):
        for index, value in enumerate(table):
            yield from quantities(value, f"{path}.{index}")


@pytest.mark.parametrize("name", list_packaged()["vehicles"])
def test_vehicles_have_sources(name):
    found = list(quantities(tomllib.loads(packaged_text("vehicles", name))))
    assert len(found) > 20
    for path, datum in found:
        assert len(datum["source"]) > 5, path


@pytest.mark.parametrize("name", list_packaged()["scenarios"])
def test_scenarios_are_valid_and_trim(name):
    point = ts.trim(ts.load_scenario(name))
    assert point.outcome is ts.TrimOutcome.converged


def test_versions_agree():
    assert f"version: {ts.__version__}" in (ROOT / "CITATION.cff").read_text()
    assert f"## {ts.__version__}" in (ROOT / "CHANGELOG.md").read_text()


def test_readme_commands_exist():
    text = (ROOT / "README.md").read_text()
    used = set(re.findall(r"^(?:tethership|make) (\w+)", text, re.MULTILINE))
    assert used >= {"dock", "trim", "tension", "new", "list", "test"}
    assert set(re.findall(r"^tethership (\w+)", text, re.MULTILINE)) <= set(typer.main.get_command(app).commands)
    targets = re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert set(re.findall(r"^make ([\w-]+)", text, re.MULTILINE)) <= set(targets)
    links = re.findall(r"\]\((?!http)([^)]+)\)", text)
    assert len(links) > 5
    for path in links:
        assert (ROOT / path).exists(), path


def test_starting_does_not_import_plotting():
    """The command line starts without matplotlib; it comes when something is drawn."""
    code = "import sys, tethership.cli; print([m for m in sys.modules if m == 'matplotlib'])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "matplotlib" not in done.stdout


def past_a_face(tree, room):
    """Yield imports of a file that lies in another room; rooms are entered through their faces (`__init__`)."""
    for node in ast.walk(tree):
        if not (isinstance(node, ast.ImportFrom) and (node.module or "").startswith("tethership.")):
            continue
        path = SOURCE.joinpath(*node.module.split(".")[1:])
        entered = node.module.split(".")[1]
        if entered not in (room, "cli") and not path.is_dir() and (SOURCE / entered).is_dir():
            yield node.module


def test_rooms_are_entered_through_their_faces():
    """A room's face lists what others may use of it; commands of a study take the command line's own pieces."""
    found = {}
    for file in SOURCE.rglob("*.py"):
        room = file.relative_to(SOURCE).parts[0]
        if past := sorted(set(past_a_face(ast.parse(file.read_text(encoding="utf-8")), room))):
            found[str(file.relative_to(SOURCE))] = past
    assert found == {}


def test_an_import_past_a_face_is_seen():
    tree = ast.parse("from tethership.plant.loop import ClosedLoop\nfrom tethership.plant import State")
    assert list(past_a_face(tree, "analysis")) == ["tethership.plant.loop"]
    assert list(past_a_face(tree, "plant")) == []


@pytest.mark.parametrize("face", sorted(SOURCE.rglob("__init__.pyi")), ids=lambda p: str(p.parent.relative_to(SOURCE)))
def test_what_a_face_lists_is_there(face):
    name = ".".join(("tethership", *face.parent.relative_to(SOURCE).parts))
    room = importlib.import_module(name)
    for listed in re.findall(r"^from \.\S* import (\w+) as", face.read_text(encoding="utf-8"), re.MULTILINE):
        assert getattr(room, listed) is not None, listed
