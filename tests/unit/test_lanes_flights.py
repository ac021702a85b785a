"""Flights by lanes: derivatives of random plants and states as by XLA, batches, and what a campaign says of it."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership.campaign import Cases, engine, fly_cases
from tethership.campaign.engine import engine_name
from tethership.campaign.flights import Flyer
from tethership.campaign.plan import make_plan
from tethership.campaign.store import CampaignStore
from tethership.campaign.work import fly_batch
from tethership.errors import ConfigError, TethershipWarning
from tethership.lanes import Program

COUNT = 24

PLANTS = {
    "docking": {},
    "turbulent": {"turbulence.intensity": 0.1, "turbulence.seed": 3},
    "lagging": {"vehicle.thrusters.*.lag": 0.3, "vehicle.fins.*.lag": 0.1},
    "sampled": {"control.period": 0.2, "control.delay": 0.05},
    "three_lines": {},
    "hover": {},
    "aerostat": {},
}
"""Scenarios by name, and `docking` with changes."""


def plant(name):
    """Return a scenario, and names and values of random plants near it."""
    scenario = ts.load_scenario(name if not PLANTS[name] and name != "docking" else "docking", PLANTS[name])
    names = ["wind.speed", "vehicle.envelope.axial_drag_coefficient", "start.attitude_offset.1"]
    known = ts.scenario.list_parameters(scenario.config)
    names = [n for n in names if n in known]
    middle = np.array([known[n].value for n in names])
    spread = np.random.default_rng(5).uniform(-0.03, 0.03, (COUNT, len(names)))
    return scenario, names, middle * (1.0 + spread) + np.where(middle == 0.0, spread, 0.0)


@pytest.mark.parametrize("name", ["docking", *(pytest.param(n, marks=pytest.mark.slow) for n in list(PLANTS)[1:])])
def test_derivatives_of_random_plants_and_states(name):
    scenario, names, values = plant(name)
    flyer = Flyer(scenario, names, values[0], COUNT)
    loops, vectors, _ = flyer.prepare(values)
    moved = vectors + 0.01 * np.random.default_rng(6).normal(size=vectors.shape)
    arrays, rest = eqx.partition(loops, eqx.is_array)
    leaves, structure = jax.tree.flatten(arrays)

    def rate(_, own):
        loop = eqx.combine(structure.unflatten(own[0]), rest)
        return loop.vector_field(jnp.asarray(7.3), own[1])

    own = (leaves, moved)
    found = Program(rate, None, jax.tree.map(lambda leaf: leaf[..., 0], own))(None, own)
    reference = np.asarray(jax.jit(jax.vmap(lambda mine: rate(None, mine), in_axes=-1, out_axes=-1))(own))
    np.testing.assert_allclose(found, reference, rtol=1e-12, atol=1e-12 * np.abs(reference).max())


def test_a_flight_does_not_depend_on_its_batch(docking):
    short = docking.changed({"stop.time_limit": 5.0})
    scenario_names, values = ("wind.speed",), np.linspace(5.0, 9.0, COUNT)[:, None]
    flyer = Flyer(short, scenario_names, values[0], COUNT)
    loops, vectors, _ = flyer.prepare(values)
    few = jax.tree.map(lambda leaf: leaf[..., 3:8] if eqx.is_array(leaf) else leaf, loops)
    whole = flyer._engine(loops, vectors, 2)
    part = flyer._engine(few, vectors[:, 3:8], 1)
    for one, other in zip(jax.tree.leaves(part), jax.tree.leaves(whole), strict=True):
        np.testing.assert_array_equal(one, other[..., 3:8])


def test_another_set_of_names_compiles_no_other_flight(docking):
    short = docking.changed({"stop.time_limit": 1.0})
    before = len(engine._programs)
    fly_cases(short, Cases(("wind.speed",), np.array([[6.0]])))
    after = len(engine._programs)
    fly_cases(short, Cases(("cables.nose.stiffness", "wind.from_direction"), np.array([[3e4, 0.1]])))
    assert len(engine._programs) == after <= before + 1


def test_without_a_compiler_xla_flies_and_one_line_says_so(monkeypatch):
    monkeypatch.setenv("CXX", "/no/such/compiler")
    monkeypatch.setattr(engine, "_programs", {})
    flown = []
    monkeypatch.setattr(engine, "by_xla", lambda differ, terms: lambda *given: flown.append(given))
    scenario, names, values = plant("docking")
    with pytest.warns(
        TethershipWarning, match="by XLA, some ten times slower: the compiler '/no/such/compiler' does not"
    ):
        flyer = Flyer(scenario, names, values[0], COUNT)
    loops, vectors, _ = flyer.prepare(values)
    flyer._engine(loops, vectors, 1)
    assert len(flown) == 1
    assert engine.find_lanes(loops, vectors, flyer._fine) is None
    assert engine_name() == "xla"


def test_any_number_of_flights_is_one_program(docking):
    short = docking.changed({"stop.time_limit": 1.0})
    Flyer(short, ("wind.speed",), np.array([6.0]), 8)
    before = len(engine._programs)
    Flyer(short, ("wind.speed",), np.array([6.0]), 16)
    assert len(engine._programs) == before


def test_an_unknown_engine_is_refused(monkeypatch):
    monkeypatch.setenv("TETHERSHIP_ENGINE", "gpu")
    with pytest.raises(ConfigError, match="TETHERSHIP_ENGINE is 'gpu'; set lanes or xla, or leave it out"):
        engine_name()


def test_two_engines_do_not_mix_in_a_campaign(tmp_path, monkeypatch):
    plan = make_plan("layers", {"samples": 24})
    CampaignStore(tmp_path / "x", plan)
    work = plan.work()
    monkeypatch.setenv("TETHERSHIP_ENGINE", "xla")
    with pytest.raises(ConfigError, match=r"was flown by lanes of \d, [0-9a-f]{12}, here it would be xla"):
        CampaignStore(tmp_path / "x", plan)
    with pytest.raises(ConfigError, match="a worker would fly by xla, the campaign is flown by lanes"):
        fly_batch(work, plan.batch(0))
