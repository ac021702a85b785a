"""Laws of one's own named in a file: they run only when told so; in flights, batches, files and linear models."""

import sys

import numpy as np
import pytest

import tethership as ts
from tethership.campaign import Cases, fly_cases, layer_switches

CODE = """
import jax.numpy as jnp
import tethership as ts


class Soft(ts.AbstractLaw):
    reference: jnp.ndarray

    def __call__(self, time, measurement, memory):
        share = jnp.clip((measurement.tension / self.reference) ** 2, 0.0, 0.95)
        return ts.Correction(rewind_rate=-share * measurement.rewind_rate), memory


class Nothing:
    pass
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("own")
    (folder / "my_own_laws.py").write_text(CODE)
    sys.path.append(str(folder))
    yield folder
    sys.path.remove(str(folder))


def entry(**changes):
    return {"control.laws": [{"name": "soft", "model": "my_own_laws:Soft", "numbers": {"reference": 100.0}} | changes]}


def test_code_of_ones_own_runs_only_when_told_so(folder):
    scenario = ts.load_scenario("docking", entry())
    assert ts.trim(scenario).outcome.is_start  # a trim runs no law
    with pytest.raises(ts.ConfigError, match="my_own_laws:Soft, which runs only when told so: --trust"):
        ts.dock(scenario, ts.trim(scenario))
    with pytest.raises(ts.ConfigError, match="runs only when told so"):
        fly_cases(scenario, Cases.of(layer_switches(scenario, ()), 1))
    assert "my_own_laws" not in sys.modules


def test_a_law_in_a_file_is_the_same_law_given_in_python(folder, tmp_path):
    import my_own_laws

    named = ts.load_scenario("docking", entry(), trust=True)
    plain = ts.load_scenario("docking")
    point = ts.trim(named)
    first = ts.dock(named, point, ("heading",))
    second = ts.dock(plain, point, ("heading",), own_laws={"soft": my_own_laws.Soft(np.asarray(100.0))})
    assert np.array_equal(first.data["cable_length"].values, second.data["cable_length"].values)
    layered = named.changed({"control.layers": ["heading"]})
    batch = fly_cases(layered, Cases.of(layer_switches(layered, ("heading",)), 1))
    assert batch["docking_time"][0] == pytest.approx(first.docking_time, abs=0.1)
    first.save(tmp_path / "flight.nc")
    with pytest.raises(ts.ConfigError, match="runs only when told so"):
        ts.fly_again(tmp_path / "flight.nc")
    _, again = ts.fly_again(tmp_path / "flight.nc", trust=True)
    assert np.array_equal(first.data["cable_length"].values, again.data["cable_length"].values)
    assert "soft" in ts.linearize(point, loop="closed").attributes["layers"]


def test_its_numbers_are_parameters(folder):
    scenario = ts.load_scenario("docking", entry() | {"control.laws.soft.numbers.reference": 50.0}, trust=True)
    assert scenario.config.control.laws[0].numbers == {"reference": 50.0}
    assert "control.laws.soft.numbers.reference" in ts.list_parameters(scenario.config)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"model": "no_such_module:Soft"}, "no_such_module cannot be imported"),
        ({"model": "my_own_laws:Sof"}, "did you mean 'Soft'"),
        ({"model": "my_own_laws:Nothing"}, "is no law; make it a subclass"),
        ({"model": "os.system"}, "model"),
        ({"numbers": {}}, "does not take these numbers: .*reference"),
        ({"numbers": {"reference": 1.0, "other": 2.0}}, "does not take these numbers: .*other"),
        ({"name": "heading"}, "two laws are named 'heading'"),
    ],
)
def test_what_is_no_law_is_told_in_one_line(folder, changes, said):
    with pytest.raises(ts.ConfigError, match=said) as caught:
        ts.load_scenario("docking", entry(**changes), trust=True).law()
    assert "\n" not in str(caught.value)
