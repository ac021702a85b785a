"""Random input: whatever is typed or written, the answer is one line, exit 2 or 3, or a result; never a traceback.

The kinds of `test_hostile_input.py` were found by hand; these look for those that nobody thought of.
"""

import copy
import json
import tomllib

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as some

from tethership.campaign.plan import make_plan
from tethership.campaign.schema import CampaignConfig
from tethership.errors import MOST_OF_MESSAGE, ConfigError
from tethership.scenario.changes import change
from tethership.scenario.load import packaged_text, read_solver, validated
from tethership.scenario.names import check_part, check_title, check_word
from tethership.scenario.quantity import converted
from tethership.scenario.reading import parse_json, parse_toml
from tethership.scenario.schema import ScenarioConfig
from tethership.scenario.solver import SolverConfig
from tethership.scenario.vehicle_schema import VehicleConfig

LIMITED = settings(
    max_examples=150,
    deadline=2000,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)

NUMBERS = some.one_of(
    some.floats(),
    some.integers(),
    some.sampled_from([0, -1, 1e308, 5e-324, 10**19, 10**400, 2**63 - 1, float("inf"), float("nan"), True]),
)
UNITS = some.one_of(
    some.sampled_from(["", "1", "m", "deg", "SI", "m/s*9**9**9", "kg m^2", "degC"]),
    some.text("ms/*^ ()19.-", max_size=30),
    some.text(max_size=10),
)
VALUES = some.recursive(
    some.one_of(NUMBERS, some.text(max_size=20), some.none(), some.dates(), some.booleans()),
    lambda inner: some.one_of(
        some.lists(inner, max_size=4),
        some.dictionaries(some.one_of(some.sampled_from(["value", "unit", "name", "model"]), some.text()), inner),
        some.fixed_dictionaries({"value": inner, "unit": UNITS}),
        some.fixed_dictionaries({"value": inner, "unit": UNITS, "source": some.just("fuzz")}),
    ),
    max_leaves=6,
)


def document(folder, name):
    return tomllib.loads(packaged_text(folder, name))


DOCKING = document("scenarios", "docking") | {"vehicle": document("vehicles", "lotte")}
MODELS = {
    "scenario": (ScenarioConfig, DOCKING),
    "three lines": (ScenarioConfig, document("scenarios", "three_lines")),
    "vehicle": (VehicleConfig, DOCKING["vehicle"]),
    "solver": (SolverConfig, document("solvers", "adaptive")),
    "campaign": (CampaignConfig, document("campaigns", "layers")),
}
MODELS["three lines"][1]["vehicle"] = document("vehicles", MODELS["three lines"][1]["vehicle"])


def places(value, path=()):
    """Yield the path of every value of a document."""
    yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from places(item, (*path, key))


def put(whole, path, value):
    """Return a document with one value in another's place."""
    if not path:
        return value
    copied = copy.deepcopy(whole)
    here = copied
    for key in path[:-1]:
        here = here[key]
    here[path[-1]] = value
    return copied


def one_line(error):
    """Assert that a message can be printed as one line."""
    message = str(error.value if hasattr(error, "value") else error)
    assert message
    assert "\n" not in message
    assert message.isprintable()
    assert len(message) < MOST_OF_MESSAGE + 100


@pytest.mark.parametrize("kind", MODELS)
@LIMITED
@given(data=some.data(), value=VALUES)
def test_any_value_at_any_key(kind, data, value):
    """What is accepted holds numbers that are finite."""
    model, whole = MODELS[kind]
    path = data.draw(some.sampled_from(list(places(whole))))
    try:
        found = validated(model, put(whole, path, value), "fuzz.toml")
    except ConfigError as error:
        one_line(error)
    else:
        json.dumps(found.model_dump(mode="json", exclude={"vary"}), allow_nan=False)


@pytest.mark.parametrize("kind", ["scenario", "campaign"])
@LIMITED
@given(data=some.data(), key=some.text(max_size=20), value=VALUES)
def test_any_key_anywhere(kind, data, key, value):
    model, whole = MODELS[kind]
    tables = [path for path in places(whole) if isinstance(at(whole, path), dict)]
    path = data.draw(some.sampled_from(tables))
    try:
        validated(model, put(whole, (*path, key), value), "fuzz.toml")
    except ConfigError as error:
        one_line(error)


def at(whole, path):
    """Return the value at a path."""
    for key in path:
        whole = whole[key]
    return whole


STEPS = some.one_of(
    some.sampled_from(["wind", "speed", "cables", "nose", "0", "²", "length", "vehicle", "control", "*", "-1"]),
    some.text(max_size=8),
)


@LIMITED
@given(
    name=some.lists(STEPS, max_size=6).map(".".join),
    text=some.one_of(some.text(max_size=40), VALUES.map(lambda value: json.dumps(value, default=str))),
)
@example(name="cables.nose.length", text="[" * 100_000)
@example(name="cables.nose.length", text="9" * 5000)
def test_any_change(name, text):
    changed = copy.deepcopy(DOCKING)
    try:
        change(changed, name, parse_json(text, "--set"), "fuzz")
        validated(ScenarioConfig, changed, "fuzz")
    except ConfigError as error:
        one_line(error)


WORDS = some.one_of(
    some.sampled_from(
        ["wind=6:12:3", "wind=", "=", "wind=[1,2", "wind=1e400:2", "wind.speed=1 m/s*9**9", "cables.²=1", "--out", "-1"]
    ),
    some.text(some.characters(exclude_characters="\0"), max_size=30),
)


@LIMITED
@given(option=some.sampled_from(["--set", "--over", "--figure", "--wind", "--formulation"]), word=WORDS, other=WORDS)
def test_any_words(refusal_or_sweep, option, word, other):
    """`sweep` takes more kinds of words than any other command; what is right for it is not computed."""
    refusal_or_sweep("sweep", option, word, "--over", other)


@pytest.fixture
def refusal_or_sweep(command, monkeypatch, tmp_path):
    """Return a function that runs `sweep` without computing anything, and checks how it was refused."""
    from tethership.cli import sweep as module
    from tethership.errors import SolveError

    def nothing(*_):
        raise SolveError("taken")

    monkeypatch.setattr("tethership.studies.docking_paper.cli.figures.linear_figure", nothing)
    monkeypatch.setattr(module, "_swept", nothing)

    def call(*words):
        code, out, err = command(*words)
        assert code in (2, 3)
        assert out == ""
        assert err.count("\n") == 1, err
        assert len(err) < MOST_OF_MESSAGE + 500
        assert not list(tmp_path.iterdir())

    return call


@LIMITED
@given(value=NUMBERS, unit=UNITS, si_unit=some.sampled_from(["m", "1", "rad", "m/s", "kg m^2", "1/rad"]))
def test_any_unit(value, unit, si_unit):
    try:
        found = converted(value, unit, si_unit)
    except ValueError:
        return
    assert abs(found) <= 1e18


@LIMITED
@given(name=some.one_of(some.text(max_size=80), some.from_regex(r"[\w .-]{0,70}", fullmatch=True)))
@pytest.mark.parametrize("check", [check_word, check_part, check_title])
def test_any_name(check, name, tmp_path):
    """A name that is accepted is one part of a path, of printable letters."""
    try:
        check(name)
    except ValueError:
        return
    assert name.isprintable()
    assert name == name.strip()
    path = tmp_path / name
    assert path.parent == tmp_path
    assert not set(name) & set('/\\"<>&=,:*')


@LIMITED
@given(text=some.one_of(some.text(max_size=60), some.lists(some.sampled_from("[]{}=\"'.,\n a1#-")).map("".join)))
def test_any_text_as_toml(text):
    try:
        parse_toml(text, "fuzz.toml")
    except ConfigError as error:
        one_line(error)


@settings(LIMITED, max_examples=60)
@given(data=some.data(), value=VALUES)
def test_any_value_in_a_campaign_that_is_planned(monkeypatch, data, value):
    """Beyond the file: its cases are drawn, its laws' gains looked up."""
    whole = MODELS["campaign"][1] | {"samples": 20}
    path = data.draw(some.sampled_from([path for path in places(whole) if path]))
    changed = put(whole, path, value)
    monkeypatch.setattr("tethership.campaign.plan.read_document", lambda *_: changed)
    try:
        assert np.isfinite(make_plan("fuzz.toml").values).all()
    except ConfigError as error:
        one_line(error)


@LIMITED
@given(name=some.text(max_size=20))
def test_any_file_name(name):
    try:
        read_solver(f"{name}.toml")
    except ConfigError as error:
        one_line(error)
