"""Parts of one's own: loads, states, readings and lines, in everything that a plant goes through.

Truths are closed forms (a constant force, a first-order lag driven by a sine), independence of the reference point,
and the package's own line under another name.
"""

import sys

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership.campaign import Cases, fly_cases, layer_switches
from tethership.plant import ClosedLoop, Command, State
from tethership.scenario.build import build_system
from tethership.scenario.load import packaged_text

CODE = """
import jax.numpy as jnp
import tethership as ts
from tethership.physics.cable import ElasticCatenary


class Push(ts.AbstractPart):
    # a force in body axes at a point
    position: jnp.ndarray
    force: jnp.ndarray

    def wrench(self, time, own, seen):
        return ts.Wrench.at(self.position, self.force)


class Drogue(ts.AbstractPart):
    position: jnp.ndarray
    drag_area: jnp.ndarray

    def wrench(self, time, own, seen):
        local = seen.air_velocity + jnp.cross(seen.air_rates, self.position)
        return ts.Wrench.at(self.position, -0.5 * seen.density * self.drag_area * jnp.linalg.norm(local) * local)


class Driven(ts.AbstractPart):
    # a lag driven by a sine, which pushes upwards
    lag: jnp.ndarray
    strength: jnp.ndarray

    def states(self):
        return (("level", "1"),)

    def rest(self, seen):
        return jnp.zeros(1)

    def rate(self, time, own, seen):
        return (jnp.sin(time) - own) / self.lag

    def wrench(self, time, own, seen):
        return ts.Wrench(self.strength * own[0] * jnp.array([0.0, 0.0, -1.0]), jnp.zeros(3))


class Altimeter(ts.AbstractPart):
    lag: jnp.ndarray

    def states(self):
        return (("shown", "m"),)

    def rest(self, seen):
        return seen.height[None]

    def rate(self, time, own, seen):
        return (seen.height - own) / self.lag

    def reading(self, time, own, seen):
        return own[0]


class Keeper(ts.AbstractLaw):
    height: jnp.ndarray
    gain: jnp.ndarray

    def __call__(self, time, measurement, memory):
        lift = jnp.clip(self.gain * (self.height - measurement.readings["altimeter"]), -0.2, 0.2)
        return ts.Request(channels={"tail_down": -lift}), memory


class Line(ElasticCatenary):
    pass


class Restless(Driven):
    def rest(self, seen):
        return jnp.ones(1)


class Stateful(ts.AbstractPart):
    def states(self):
        return (("level", "1"),)


class Misspelt(Push):
    def wrench(self, time, own, seen):
        return ts.Wrench.at(self.place, self.force)


class Choosing(Push):
    def wrench(self, time, own, seen):
        return ts.Wrench(self.force if seen.density > 1 else -self.force, jnp.zeros(3))


class Flat(Push):
    def wrench(self, time, own, seen):
        return self.force


class Pair(Altimeter):
    def reading(self, time, own, seen):
        return seen.velocity


class Short(Altimeter):
    def rate(self, time, own, seen):
        return jnp.zeros(2)


class Listener(ts.AbstractLaw):
    def __call__(self, time, measurement, memory):
        return ts.Correction(throttle=measurement.readings["altimetr"]), memory


class Silent(ts.AbstractLaw):
    def __call__(self, time, measurement, memory):
        return {"throttle": 0.1}


class Nameless(ts.AbstractPart):
    def states(self):
        return "level"
"""


@pytest.fixture(scope="module")
def code(tmp_path_factory):
    folder = tmp_path_factory.mktemp("parts")
    (folder / "my_own_parts.py").write_text(CODE)
    sys.path.append(str(folder))
    import my_own_parts

    yield my_own_parts
    sys.path.remove(str(folder))


def entry(model, name="extra", **numbers):
    return {"vehicle.parts": [{"name": name, "model": f"my_own_parts:{model}", "numbers": numbers}]}


def test_a_constant_force_is_carried_by_the_thrust_that_balances_it(code):
    plain = ts.trim(ts.load_scenario("docking"))
    pushed = ts.trim(
        ts.load_scenario("docking", own_parts={"push": code.Push(np.array([0.0, 0.0, 0.0]), np.array([30.0, 0, 0]))})
    )
    forces = [total_load(point, "thrust") for point in (plain, pushed)]
    assert forces[1][0] - forces[0][0] == pytest.approx(-30.0, abs=1e-5)
    assert total_load(pushed, "push")[:3] == pytest.approx([30.0, 0.0, 0.0])


def total_load(point, name):
    plant = point.scenario.system.at_mean()
    now = jnp.zeros(())
    cables = plant.cable_states(now, point.state, plant.initial_lengths())
    return np.asarray(plant.wrenches(now, point.state, point.command, cables)[name].as_vector())


def test_loads_do_not_depend_on_the_reference_point(code):
    config = ts.load_scenario("docking", entry("Drogue", position=[-9.0, 1.0, 0.5], drag_area=0.4), trust=True).config
    shift = jnp.array([1.5, -0.4, 0.8])
    rates = jnp.array([0.1, -0.2, 0.3])
    velocity = jnp.array([2.0, 0.5, -0.3])
    attitude = jnp.array([0.1, 0.2, 2.0])
    found, seen = [], []
    for point in (jnp.zeros(3), shift):
        plant = build_system(config, point)
        rotation = ts.spatial.rotation_matrix(attitude)
        state = State(
            velocity + jnp.cross(rates, point), rates, attitude, jnp.array([-9.0, 2.0, -12.0]) + rotation @ point
        )
        ship = plant.ship
        command = Command(jnp.zeros(ship.thrusters.count), jnp.zeros(ship.fins.count))
        change = plant.derivative(jnp.asarray(1.0), state, command, plant.initial_lengths())
        found.append((change.rates, change.velocity - jnp.cross(change.rates, point)))
        load = plant.wrenches(jnp.zeros(()), state, command, plant.cable_states(jnp.zeros(()), state, jnp.ones(1) * 20))
        assert float(jnp.linalg.norm(load["extra"].force)) > 1.0
        seen.append(plant.seen(jnp.zeros(()), state, plant.cable_states(jnp.zeros(()), state, jnp.ones(1) * 20)))
    # of the body v_P = v_O + ω × q, and q is fixed in its axes
    assert np.allclose(found[0][0], found[1][0], rtol=1e-9, atol=1e-12)
    assert np.allclose(found[0][1], found[1][1], rtol=1e-9, atol=1e-12)
    for one, other in zip(jax.tree.leaves(seen[0]), jax.tree.leaves(seen[1]), strict=True):
        assert np.allclose(one, other, rtol=1e-9, atol=1e-12)


def test_a_state_follows_its_closed_form_in_flight(code):
    lag = 0.7
    scenario = ts.load_scenario("docking", entry("Driven", lag=lag, strength=2.0), trust=True)
    flight = ts.fly(scenario, ts.trim(scenario), stop=8.0)
    time = flight.data["time"].values
    # τẏ + y = sin t, y(0) = 0
    wanted = (np.sin(time) - lag * np.cos(time) + lag * np.exp(-time / lag)) / (1 + lag**2)
    assert flight.data["part_state"].values.tolist() == ["extra.level"]
    assert np.abs(flight.data["part_states"].values[:, 0] - wanted).max() < 1e-6
    load = flight.data["load_force"].sel(load="extra").values
    assert np.abs(load[:, 2] + 2.0 * wanted).max() < 1e-5


def test_a_state_is_a_row_of_the_linear_models(code):
    scenario = ts.load_scenario("docking", entry("Driven", lag=0.7, strength=2.0), trust=True)
    point = ts.trim(scenario)
    for loop in ("open", "closed"):
        model = ts.linearize(point, loop=loop)
        assert model.states[-1] == "extra.level"
        assert model.state_units[-1] == "1"
        assert np.abs(np.linalg.eigvals(model.A) + 1 / 0.7).min() < 1e-9  # nothing drives it but time
        plain = ts.linearize(ts.trim(ts.load_scenario("docking")), loop=loop)
        assert np.allclose(model.A[:-1, :-1], plain.A, atol=1e-7)
    swept = ts.sweep(scenario, {"wind.speed": np.array([6.0, 7.0])})
    assert np.abs(swept.eigenvalues + 1 / 0.7).min(axis=1).max() < 1e-9


def test_a_sensor_reaches_the_laws_and_the_closed_loop(code):
    changes = entry("Altimeter", "altimeter", lag=0.4) | {
        "control.laws": [{"name": "keep", "model": "my_own_parts:Keeper", "numbers": {"height": 10.0, "gain": 0.03}}]
    }
    scenario = ts.load_scenario("docking", changes, trust=True)
    point = ts.trim(scenario)
    flight = ts.fly(scenario, point, stop=10.0)
    shown = flight.data["readings"].sel(reading="altimeter").values
    height = -flight.data["position"].values[:, 2]
    time = flight.data["time"].values
    slope = np.gradient(shown, time)
    assert np.abs(slope - (height - shown) / 0.4)[5:-5].max() < 2e-2 * np.abs(slope).max()
    asked = flight.data["throttle_asked"].sel(thruster="tail_down").values
    other = ts.fly(scenario.changed({"control.laws": []}), point, stop=10.0)
    assert np.abs(asked[0] - other.data["throttle_asked"].sel(thruster="tail_down").values[0]) == pytest.approx(
        min(0.03 * abs(10.0 - shown[0]), 0.2), abs=1e-9
    )
    model = ts.linearize(point, loop="closed")
    assert "altimeter.shown" in model.states
    assert "altimeter" in model.outputs
    row = model.C[model.outputs.index("altimeter")]
    assert row[model.states.index("altimeter.shown")] == pytest.approx(1.0)


def test_closed_loop_slopes_against_finite_differences(code):
    scenario = ts.load_scenario("docking", entry("Altimeter", "altimeter", lag=0.4), trust=True)
    point = ts.trim(scenario)
    plant = scenario.system.at_mean().with_winches_held()
    loop = ClosedLoop(plant, scenario.law(()), point.command)
    vector = loop.initial(point.state)
    exact = jax.jacfwd(lambda x: loop.vector_field(jnp.zeros(()), x))(vector)
    step = 1e-6
    rows = [
        (loop.vector_field(jnp.zeros(()), vector + step * e) - loop.vector_field(jnp.zeros(()), vector - step * e))
        / (2 * step)
        for e in jnp.eye(len(vector))
    ]
    assert np.abs(np.stack(rows, axis=1) - exact).max() < 1e-6 * np.abs(exact).max()
    assert np.isfinite(exact).all()


def test_a_batch_flies_parts_as_a_single_flight_does_and_varies_their_numbers(code):
    scenario = ts.load_scenario(
        "docking",
        entry("Drogue", position=[-9.0, 0.0, 0.0], drag_area=0.4) | {"control.layers": ["rewind", "heading"]},
        trust=True,
    )
    name = "vehicle.parts.extra.numbers.drag_area"
    switches = layer_switches(scenario, ("rewind", "heading"))
    batch = fly_cases(scenario, Cases.of({**switches, name: np.array([0.4, 0.8])}, 2))
    single = ts.dock(scenario, ts.trim(scenario))
    assert batch["tension_mean"][0] == pytest.approx(single.metrics["tension_mean"], rel=2e-3)
    assert batch["tension_mean"][1] != pytest.approx(batch["tension_mean"][0], rel=1e-3)
    for changed in (f"{name}=0.8", "vehicle.parts.extra.numbers.position.0=-8"):
        key, value = changed.split("=")
        other = scenario.changed({key: float(value)})
        assert other.config.vehicle.parts[0].numbers != scenario.config.vehicle.parts[0].numbers


def test_python_and_file_are_the_same_part_to_the_bit_and_flown_again(code, tmp_path):
    named = ts.load_scenario("docking", entry("Drogue", position=[-9.0, 0.0, 0.0], drag_area=0.4), trust=True)
    given = ts.load_scenario("docking").with_parts({"extra": code.Drogue(np.array([-9.0, 0.0, 0.0]), 0.4)})
    assert given.config == named.config
    flight = ts.fly(given, ts.trim(given), stop=5.0)
    flight.save(tmp_path / "flight.nc")
    with pytest.raises(ts.ConfigError, match="my_own_parts:Drogue, which runs only when told so"):
        ts.fly_again(tmp_path / "flight.nc")
    _, again = ts.fly_again(tmp_path / "flight.nc", trust=True)
    assert np.array_equal(flight.data["position"], again.data["position"])
    page = ts.write_replay(again, tmp_path / "replay.html").read_text(encoding="utf-8")
    assert "extra" in page


def test_a_line_of_ones_own_is_the_packages_to_the_bit(code):
    plain = ts.load_scenario("docking")
    own = ts.load_scenario("docking", {"cables.nose.line": {"model": "my_own_parts:Line"}}, trust=True)
    assert type(own.system.cables[0].law) is code.Line
    assert own.config.line_models() == {"nose": {"model": "my_own_parts:Line"}}
    flights = [ts.dock(scenario, ts.trim(scenario), ("rewind", "heading")) for scenario in (plain, own)]
    assert np.array_equal(*(flight.data["tension"].values for flight in flights))
    with pytest.raises(ts.ConfigError, match="my_own_parts:Line, which runs only when told so"):
        ts.load_scenario("docking", {"cables.nose.line": {"model": "my_own_parts:Line"}})


def test_parts_given_do_not_make_code_of_the_file_trusted(code):
    law = {"control.laws": [{"name": "x", "model": "my_own_parts:Silent"}]}
    push = code.Push(np.zeros(3), np.zeros(3))
    with pytest.raises(ts.ConfigError, match="my_own_parts:Silent, which runs only when told so"):
        ts.load_scenario("docking", law, own_parts={"push": push})
    with pytest.raises(ts.ConfigError, match="my_own_parts:Silent, which runs only when told so"):
        ts.load_scenario("docking", law).with_parts({"push": push})
    twice = ts.load_scenario("docking", own_parts={"push": push}).with_parts({"more": push})
    assert [part.name for part in twice.config.vehicle.parts] == ["push", "more"]


def test_the_packages_own_classes_need_no_trust():
    line = "tethership.physics.cable:ElasticCatenary"
    scenario = ts.load_scenario("docking", {"cables.nose.line.model": line})
    assert scenario.config.own_code() == []
    assert ts.trim(scenario).outcome.is_start


PUSH = {"position": [0.0, 0.0, 0.0], "force": [1.0, 0.0, 0.0]}


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (entry("Drogue", drag_area=0.3), "does not take these numbers: .*position"),
        (entry("Drogue", position=[0.0, 0, 0], drag_area=0.3, mass=1.0), "does not take these numbers: .*mass"),
        (entry("Drouge", drag_area=0.3), "did you mean 'Drogue'"),
        (entry("Keeper", height=1.0, gain=1.0), "is no part; make it a subclass of tethership.AbstractPart"),
        (entry("Stateful"), "has states and no rest and no rate"),
        (entry("Nameless"), "give names with SI units"),
        (entry("Push", "theta", position=[0.0, 0, 0], force=[0.0, 0, 0]), "that of a state"),
        (
            entry("Push", "bottom_fin", position=[0, 0, 0], force=[0, 0, 0]) | {"vehicle.fins.0.name": "bottom_fin"},
            "two",
        ),
        ({"vehicle.parts": [{"name": "x", "model": "os.system"}]}, "vehicle.parts.x.model"),
        (entry("Misspelt", **PUSH), r"Misspelt.wrench fails: AttributeError.*place"),
        (entry("Choosing", **PUSH), r"Choosing.wrench fails: .*choose with jnp.where in place of `if`"),
        (entry("Flat", **PUSH), "Flat.wrench gives no Wrench of three and three components"),
        (entry("Push", **PUSH | {"position": [1.0, 2.0]}), r"have shapes \(2,\) and \(3,\); give three each"),
        (entry("Pair", lag=1.0), r"Pair.reading gives shape \(3,\); give one number"),
        (entry("Short", lag=1.0), r"Short.rate gives shape \(2,\); give \(1,\), one a state"),
        (entry("Altimeter"), "it lacks lag; its fields: lag"),
        (entry("Altimeter", lga=1.0, lag=1.0), "it has no 'lga'; did you mean 'lag'"),
        (entry("Altimeter", lag={"value": 1.0, "unit": "s"}), "lag is given with a unit; own code takes bare numbers"),
        ({"vehicle.parts": [{"name": "x", "model": "my_own_parts:Push", "numbers": {"force": "up"}}]}, "force"),
        ({"cables.nose.line": {"model": "my_own_parts:Push"}}, "is no line; make it a subclass"),
        ({"cables.nose.line": {"model": "my_own_parts:Line", "numbers": {"knots": 2.0}}}, "knots"),
    ],
)
def test_what_is_no_part_is_told_in_one_line(code, changes, said):
    with pytest.raises(ts.ConfigError, match=said) as caught:
        ts.load_scenario("docking", changes, trust=True)
    assert "\n" not in str(caught.value)


def test_a_part_named_as_a_load_and_one_that_does_not_rest(code):
    twice = ts.load_scenario("docking", entry("Push", "gravity", position=[0.0, 0, 0], force=[1.0, 0, 0]), trust=True)
    with pytest.raises(ts.ConfigError, match="'gravity', as another load on the ship"):
        ts.trim(twice)
    restless = ts.load_scenario("docking", entry("Restless", lag=0.5, strength=0.0), trust=True)
    with pytest.raises(ts.ConfigError, match=r"extra\.level changes at -2 a second where rest\(\) puts it"):
        ts.trim(restless)


@pytest.mark.parametrize(
    ("model", "said"),
    [
        ("Listener", "law 'x' fails: KeyError: 'altimetr'"),
        ("Silent", "law 'x' returns a dict; let it return a Correction"),
    ],
)
def test_a_law_that_fails_is_told_by_its_name_in_one_line(code, model, said):
    scenario = ts.load_scenario(
        "docking", {"control.laws": [{"name": "x", "model": f"my_own_parts:{model}"}]}, trust=True
    )
    with pytest.raises(ts.ConfigError, match=said) as caught:
        ts.fly(scenario, ts.trim(scenario), stop=1.0)
    assert "\n" not in str(caught.value)


def test_a_trim_asks_for_a_scenario_and_things_say_what_they_are(code):
    with pytest.raises(ts.ConfigError, match="'docking' is no scenario; give load_scenario"):
        ts.trim("docking")
    scenario = ts.load_scenario("docking")
    assert repr(scenario) == "<Scenario: docking, Docking with a rewinding cable>"
    assert repr(ts.fly(scenario, ts.trim(scenario), stop=0.5)) == "<Flight: time_limit after 0.5 s>"


def test_a_period_longer_than_what_is_flown_is_refused():
    scenario = ts.load_scenario("docking", {"control.period": 10.0})
    with pytest.raises(ts.ConfigError, match=r"control\.period 10 s is longer than the flight, 3 s"):
        ts.fly(scenario, ts.trim(scenario), stop=3.0)
    with pytest.raises(ts.ConfigError, match=r"control\.period: it is 1e-06 s; it must be at least 0\.0001"):
        ts.load_scenario("docking", {"control.period": 1e-6})


def test_what_cannot_be_given_in_python(code):
    class Inside(ts.AbstractPart):
        pass

    scenario = ts.load_scenario("docking")
    with pytest.raises(ts.ConfigError, match="stands inside something else"):
        scenario.with_parts({"x": Inside()})
    with pytest.raises(ts.ConfigError, match="is no part"):
        scenario.with_parts({"x": 3.0})
    with pytest.raises(ts.ConfigError, match="'force' is no finite number"):
        scenario.with_parts({"x": code.Push(np.zeros(3), np.full(3, np.nan))})
    with pytest.raises(ts.ConfigError, match="'force' is no finite number"):
        scenario.with_parts({"x": code.Push(np.zeros(3), jax.nn.relu)})


def test_a_class_of_a_console_or_notebook_is_found():
    space = {"ts": ts, "jnp": jnp}
    text = "class Lift(ts.AbstractPart):\n    force: jnp.ndarray\n"
    text += "    def wrench(self, time, own, seen):\n        return ts.Wrench(self.force, jnp.zeros(3))\n"
    exec(text, space)
    scenario = ts.load_scenario("docking", own_parts={"lift": space["Lift"](np.array([0.0, 0.0, -10.0]))})
    assert total_load(ts.trim(scenario), "lift")[2] == pytest.approx(-10.0)
    with pytest.raises(ts.ConfigError, match="is no law"):
        scenario.changed({"control.laws": [{"name": "x", "model": "builtins:Lift"}]}).law()


def test_a_file_that_stands_on_another_names_a_part_and_is_not_run_untold(code, tmp_path, command):
    (tmp_path / "base.toml").write_text('base = "docking"\n[changes]\n"wind.speed" = 7.0\n"stop.time_limit" = 90.0\n')
    part = '{name = "drogue", model = "my_own_parts:Drogue", numbers = {position = [-9.0, 0.0, 0.0], drag_area = 0.3}}'
    file = tmp_path / "mine.toml"
    file.write_text(f'base = "base.toml"\ntitle = "Mine"\n[changes]\n"wind.speed" = 8.0\n"vehicle.parts" = [{part}]\n')
    assert command("validate", str(file))[0] == 0
    code_, out, err = command("dock", str(file), "--json", "--out", str(tmp_path))
    assert (code_, out) == (2, "")
    assert "runs only when told so: --trust" in err
    scenario = ts.load_scenario(str(file), trust=True)
    assert (scenario.config.wind.speed, scenario.config.stop.time_limit) == (8.0, 90.0)
    assert scenario.config.title == "Mine"
    assert command("dock", str(file), "--json", "--trust", "--out", str(tmp_path))[0] == 0
    data = ts.Flight.load(tmp_path / "flight.nc").data
    assert "drogue" in data["load"].values


def test_a_base_that_stands_on_itself_or_is_not_there(tmp_path):
    file = tmp_path / "round.toml"
    file.write_text('base = "round.toml"\n')
    with pytest.raises(ts.ConfigError, match="stands on itself"):
        ts.load_scenario(str(file))
    file.write_text('base = "Docking"\n')
    with pytest.raises(ts.ConfigError, match="did you mean 'docking'"):
        ts.load_scenario(str(file))
    file.write_text("base = 3\n")
    with pytest.raises(ts.ConfigError, match="give a packaged scenario"):
        ts.load_scenario(str(file))


def test_files_of_a_base_in_another_folder_are_found(tmp_path):
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "ship.toml").write_text(packaged_text("vehicles", "lotte"))
    text = packaged_text("scenarios", "docking").replace('vehicle = "lotte" ', 'vehicle = "ship.toml" ')
    assert "ship.toml" in text
    (tmp_path / "deep" / "base.toml").write_text(text)
    (tmp_path / "mine.toml").write_text('base = "deep/base.toml"\n')
    assert ts.load_scenario(str(tmp_path / "mine.toml")).config == ts.load_scenario("docking").config
