"""Parts with states: actuators, sampled laws, anchors that move; in trim, flight, batch and linear model.

Truths: closed forms of a lag, a ramp and a dead band; a moving anchor against a fixed one in shifted wind; the closed
loop's Jacobian against differences of its rate; a sampled law against the flow over its period, and against the
continuous one as the period goes to zero.
"""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership.analysis.linear.closed import loop_slopes
from tethership.campaign import Cases, fly_cases, layer_switches
from tethership.physics.actuators import Actuators
from tethership.plant.layout import closed_loop, open_loop
from tethership.scenario.build_loop import build_loop

ALL = ("rewind", "heading", "navigation")


def lagged(scenario, seconds, **others):
    """Return a scenario whose thrusters all lag by so much."""
    entry = {"value": seconds, "unit": "s", "source": "a test"}
    names = [thruster.name for thruster in scenario.config.vehicle.thrusters]
    return scenario.changed({f"vehicle.thrusters.{name}.lag": entry for name in names} | others)


@pytest.fixture(scope="module")
def docking():
    return ts.load_scenario("docking")


@pytest.fixture(scope="module")
def slow(docking):
    return lagged(docking, 0.3)


def group(lag, rate_limit=np.inf, dead_band=0.0):
    return Actuators(jnp.array([lag]), jnp.array([rate_limit]), jnp.array([dead_band]), (0,), (0,))


def flown(actuators, asked, start, time, steps=2000):
    """Return what a channel has reached after some time, by Runge-Kutta."""
    own, step = jnp.array([start]), time / steps

    def once(own, _):
        rate = lambda y: actuators.rate(y, jnp.array([asked]))  # noqa: E731
        one = rate(own)
        two = rate(own + 0.5 * step * one)
        three = rate(own + 0.5 * step * two)
        four = rate(own + step * three)
        return own + step / 6.0 * (one + 2.0 * two + 2.0 * three + four), None

    return float(jax.lax.scan(once, own, None, length=steps)[0][0])


def test_a_lag_answers_a_step_by_its_exponential():
    assert flown(group(0.3), 1.0, 0.0, 0.45) == pytest.approx(1.0 - np.exp(-1.5), abs=1e-9)


def test_a_rate_limit_is_a_ramp_until_the_lag_takes_over():
    """ẏ = R until (u − y)/τ = R, at y = u − Rτ, then the exponential."""
    lag, limit = 0.3, 0.5
    corner = (1.0 - limit * lag) / limit
    assert flown(group(lag, limit), 1.0, 0.0, 1.0) == pytest.approx(limit, abs=1e-9)
    after = flown(group(lag, limit), 1.0, 0.0, corner + 0.3, 20_000)
    assert after == pytest.approx(1.0 - limit * lag * np.exp(-1.0), abs=1e-5)


def test_a_dead_band_lets_nothing_through_below_it_and_all_above():
    band = group(0.3, dead_band=0.05)
    asked = jnp.array([0.049]), jnp.array([-0.051]), jnp.array([0.7])
    assert [float(band.effective(a)[0]) for a in asked] == [0.0, -0.051, 0.7]


def test_without_numbers_there_are_no_states(docking):
    plant = docking.system
    assert (plant.thrusters.slow, plant.surfaces.slow, plant.thrusters.banded) == ((), (), ())
    assert len(open_loop(plant).names) == 12
    zero = docking.changed({"vehicle.thrusters.tail_down.lag": {"value": 0.0, "unit": "s", "source": "a test"}})
    assert zero.system.thrusters.slow == ()


def test_trim_does_not_know_of_lags(docking, slow):
    here, there = ts.trim(docking), ts.trim(slow)
    assert np.array_equal(here.state.as_vector(), there.state.as_vector())
    assert np.array_equal(here.command.throttle, there.command.throttle)


@pytest.mark.parametrize(("wind", "lag", "peak"), [(6.0, 0.2, 451.0), (9.0, 0.0, 1067.0), (9.0, 0.3, 3236.0)])
def test_the_peak_tension_of_the_table(docking, wind, lag, peak):
    """Three layers, one gust; cable that does not break; prototype, first-order lag after the clip (5 %)."""
    changes = {"wind.speed": wind, "cables.nose.breaking_force": 1e6, "cables.nose.load_reference": 0.5}
    scenario = lagged(docking, lag, **changes)
    flight = ts.dock(scenario, ts.trim(scenario), ALL)
    assert flight.metrics["tension_max"] == pytest.approx(peak, rel=0.05)


def test_a_batch_flies_lags_as_a_single_flight_does(slow):
    layers = ("rewind", "heading")
    scenario = slow.changed({"control.layers": list(layers)})
    flight = ts.dock(scenario, ts.trim(scenario))
    batch = fly_cases(scenario, Cases.of(layer_switches(scenario, layers), 1))
    assert batch["docking_time"][0] == pytest.approx(flight.docking_time, abs=0.02)
    assert batch["tension_mean"][0] == pytest.approx(flight.metrics["tension_mean"], rel=0.02)


@pytest.mark.parametrize(("period", "delay"), [(0.1, None), (0.05, 0.02), (0.1, 0.1)])
def test_a_batch_flies_sampled_laws_as_a_single_flight_does(docking, period, delay):
    layers = ("rewind", "heading")
    changes = {"control.period": period} | ({} if delay is None else {"control.delay": delay})
    scenario = docking.changed({"control.layers": list(layers)} | changes)
    flight = ts.dock(scenario, ts.trim(scenario))
    batch = fly_cases(scenario, Cases.of(layer_switches(scenario, layers), 1))
    assert flight.outcome is ts.Outcome.docked
    assert batch["docking_time"][0] == pytest.approx(flight.docking_time, abs=1e-3)
    assert batch["tension_max"][0] == pytest.approx(flight.metrics["tension_max"], rel=0.01)
    assert batch["ADC"][0] == pytest.approx(flight.metrics["ADC"], rel=0.05)


def test_a_sampled_law_holds_what_it_asks(docking):
    """Between ticks the throttles stay to the bit; they move at ticks only, a delay after the law has looked."""
    scenario = docking.changed({"control.period": 0.2, "control.delay": 0.05})
    flight = ts.fly(scenario, ts.trim(scenario), stop=2.0, layers=ALL, rewind=True)
    time, throttle = flight.data["time"].values, flight.data["throttle"].values
    moved = np.flatnonzero(np.any(np.diff(throttle, axis=0) != 0, axis=1)) + 1
    assert len(moved) == 10
    assert np.allclose((time[moved] - 0.05) / 0.2, np.round((time[moved] - 0.05) / 0.2), atol=1e-9)


def test_a_fast_sampled_law_is_the_continuous_one(docking):
    layers = ("rewind", "heading")
    point = ts.trim(docking)
    smooth = ts.dock(docking, point, layers)
    fast = ts.dock(docking.changed({"control.period": 0.002}), point, layers)
    assert fast.metrics["tension_max"] == pytest.approx(smooth.metrics["tension_max"], rel=0.01)


def test_an_anchor_under_way_is_a_fixed_one_in_shifted_wind(docking):
    """Galilei: anchor at V in wind W + V is an anchor at rest in wind W, seen from a truck."""
    layers, speed = ("rewind", "heading"), np.array([2.0, 0.0, 0.0])
    still = docking.changed({"gusts": [], "wind.speed": 6.0})
    motion = {"model": "steady", "velocity": {"value": speed.tolist(), "unit": "m/s"}}
    moving = docking.changed({"gusts": [], "wind.speed": 4.0, "cables.nose.anchor_motion": motion})
    assert still.config.wind.from_direction == 0.0  # a wind from the north blows southward: W + V is 4 m/s of it
    here, there = ts.trim(still), ts.trim(moving)
    assert there.outcome is ts.TrimOutcome.converged
    assert np.allclose(there.state.velocity - here.state.velocity, speed, atol=1e-9)
    assert np.allclose(there.command.throttle, here.command.throttle, atol=1e-9)
    first, second = ts.dock(still, here, layers, solver="tight"), ts.dock(moving, there, layers, solver="tight")
    early = first.data["time"].values <= 20.0
    for name in ("tension", "throttle", "attitude", "tether_offset", "cable_length"):
        assert np.allclose(first.data[name].values[early], second.data[name].values[: early.sum()], atol=1e-7), name
    apart = second.data["position"].values[: early.sum()] - first.data["position"].values[early]
    assert np.allclose(apart, first.data["time"].values[early, None] * speed, atol=1e-7)


def test_a_swinging_anchor_moves_as_told_and_its_ship_is_trimmed_on_the_mean(docking):
    motion = {
        "model": "harmonic",
        "amplitude": {"value": [0.0, 0.0, 0.4], "unit": "m"},
        "period": {"value": 5.0, "unit": "s"},
    }
    swinging = docking.changed({"cables.nose.anchor_motion": motion})
    assert np.array_equal(ts.trim(swinging).state.as_vector(), ts.trim(docking).state.as_vector())
    flight = ts.fly(swinging, ts.trim(swinging), stop=6.0)
    anchor = flight.data["cable_curve"].values[:, 0, 0]
    wanted = 0.4 * np.sin(2.0 * np.pi * flight.data["time"].values / 5.0)
    assert np.allclose(anchor[:, 2], wanted, atol=1e-6)


@pytest.fixture(scope="module", params=["ideal", "lagged"])
def closed(request, docking):
    scenario = docking if request.param == "ideal" else lagged(docking, 0.3)
    return scenario.changed({"control.layers": ["heading"]})


def test_the_closed_loop_is_the_slope_of_its_rate(closed):
    point = ts.trim(closed)
    model = ts.linearize(point, loop="closed")
    loop = build_loop(closed.config, closed.system.at_mean(), point.command)
    vector = loop.initial(point.state)
    layout = closed_loop(loop)
    kept = [layout.names.index(name) for name in model.states]
    field = jax.jit(lambda x: loop.vector_field(jnp.zeros(()), x))
    step = 1e-7  # a load with |v|v at rest has a corner: the error of a central difference goes with the step
    columns = [(field(vector.at[i].add(step)) - field(vector.at[i].add(-step))) / (2 * step) for i in kept]
    differences = np.stack([np.asarray(column)[kept] for column in columns], axis=1)
    assert np.abs(model.A - differences).max() < 1e-6 * np.abs(model.A).max()
    ours, theirs = (np.linalg.eigvals(matrix) for matrix in (model.A, differences))
    apart = np.abs(ours[:, None] - theirs[None, :]).min(axis=1)
    slow = np.abs(ours) < 1e-3  # the double zero of position held by nothing: a pair is known to the root of rounding
    assert apart[~slow].max() < 1e-6
    assert apart[slow].max(initial=0.0) < 1e-3


def test_an_ideal_closed_loop_is_the_open_one_with_feedback(docking):
    """A + U K, K by hand from the gains of SAS: yaw rate to the two side thrusters only."""
    scenario = docking.changed({"control.layers": []})
    point = ts.trim(scenario)
    open_, shut = ts.linearize(point), ts.linearize(point, loop="closed")
    gains = scenario.config.control.attitude
    shares = {"p": "roll_share", "q": "pitch_share", "r": "yaw_share"}
    feedback = np.zeros((len(open_.inputs), 12))
    rate = {"p": gains.roll_rate_gain, "q": gains.pitch_rate_gain, "r": gains.yaw_rate_gain}
    angle = {"p": ("phi", gains.roll_gain), "q": ("theta", gains.pitch_gain)}
    for axis, key in shares.items():
        for thruster, share in getattr(gains, key).items():
            row = open_.inputs.index(thruster)
            feedback[row, open_.states.index(axis)] += share * rate[axis]
            if axis in angle:
                feedback[row, open_.states.index(angle[axis][0])] += share * angle[axis][1]
    assert np.allclose(shut.A, open_.A + open_.U @ feedback, atol=1e-9)


def test_lags_are_states_of_the_open_model_too(slow):
    point = ts.trim(slow)
    model = ts.linearize(point)
    assert model.states[12:] == tuple(f"reached_{t.name}" for t in slow.config.vehicle.thrusters)
    assert np.allclose(np.diag(model.A)[12:], -1.0 / 0.3)
    assert np.allclose(model.U[12:, :6], np.eye(6) / 0.3)
    ideal = ts.linearize(ts.trim(slow.changed({f"vehicle.thrusters.{n[8:]}.lag": None for n in model.states[12:]})))
    assert np.allclose(model.A[:12, :12], ideal.A, atol=1e-9)
    assert np.allclose(model.A[:12, 12:], ideal.U[:, :6], atol=1e-9)


@pytest.mark.parametrize("delay", [None, 0.04])
def test_a_sampled_loop_is_the_flow_over_its_period(slow, delay):
    changes = {"control.period": 0.1, "control.layers": ["heading"]} | (
        {} if delay is None else {"control.delay": delay}
    )
    scenario = slow.changed(changes)
    point = ts.trim(scenario)
    model = ts.linearize(point, loop="closed")
    assert model.sample_time == 0.1
    plant = scenario.system.at_mean()
    loop = build_loop(scenario.config, plant, point.command)
    loop = dataclasses.replace(loop, plant=plant.with_winches_held())
    layout = closed_loop(loop)
    lengths = jnp.array([i for i, name in enumerate(layout.names) if name.startswith("length_")])  # held
    kept = jnp.array([layout.names.index(name) for name in model.states])

    def flow(x, time, steps=200):
        h = time / steps

        def once(x, _):
            f = lambda y: loop.vector_field(jnp.zeros(()), y).at[lengths].set(0.0)  # noqa: E731
            one = f(x)
            two = f(x + 0.5 * h * one)
            three = f(x + 0.5 * h * two)
            return x + h / 6.0 * (one + 2 * two + 2 * three + f(x + h * three)), None

        return jax.lax.scan(once, x, None, length=steps)[0]

    def period(x):
        x = loop.look(jnp.zeros(()), x)
        if delay is None:
            return flow(x, 0.1)
        return flow(loop.act(flow(x, delay)), 0.1 - delay)

    start = loop.look(jnp.zeros(()), loop.initial(point.state))
    start = start if delay is None else loop.act(start)
    truth = jax.jit(jax.jacfwd(period))(start)[kept][:, kept]
    assert np.abs(model.A - truth).max() < 1e-6 * np.abs(model.A).max()


def test_a_fast_sampled_loop_has_the_modes_of_the_continuous_one(slow):
    scenario = slow.changed({"control.layers": ["heading"]})
    smooth = ts.linearize(ts.trim(scenario), loop="closed").modes()
    fast = scenario.changed({"control.period": 1e-4})
    sampled = ts.linearize(ts.trim(fast), loop="closed").modes()
    for value in smooth.eigenvalues:
        assert np.abs(sampled.eigenvalues - value).min() < 2e-3 * max(abs(value), 1.0)


def test_slopes_over_the_whole_layout_are_finite(slow):
    scenario = slow.changed({"control.layers": list(ALL), "control.period": 0.1})
    point = ts.trim(scenario)
    loop = build_loop(scenario.config, scenario.system, point.command)
    vector = loop.initial(point.state)
    rate, by_state, by_input = loop_slopes(loop, vector, jnp.zeros(16))
    assert np.isfinite(rate).all()
    assert np.isfinite(by_state).all()
    assert np.isfinite(by_input).all()


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"control.period": 0.0}, "must be above 0"),
        (
            {"control.period": 500.0},
            r"control.period 500 s is longer than the flight, .* give a shorter",
        ),
        ({"control.delay": 0.1}, "delay 0.1 s needs a period"),
        ({"control.period": 0.1, "control.delay": 0.2}, r"delay 0.2 s is beyond control.period 0.1 s"),
        ({"vehicle.thrusters.tail_down.lag": -1.0}, "at least 0"),
        ({"vehicle.thrusters.tail_down.rate_limit": 0.0}, "must be above 0"),
        ({"vehicle.thrusters.tail_down.dead_band": 1.5}, "at most 0.99"),
        ({"cables.nose.anchor_motion": {"model": "circular"}}, "one of 'steady', 'harmonic'"),
        ({"cables.nose.anchor_motion": {"model": "harmonic"}}, "amplitude"),
        (
            {"cables.nose.anchor_motion": {"model": "steady", "velocity": {"value": [1.0, 0.0, 1.0], "unit": "m/s"}}},
            "keeps its height",
        ),
        ({"control.allocation": {"turn": {"tail_dwn": 1.0}}}, "did you mean 'tail_down'"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(docking, changes, said):
    with pytest.raises(ts.ConfigError, match=said) as caught:
        docking.changed(changes)
    assert "\n" not in str(caught.value)


def test_a_batch_refuses_ticks_that_differ_and_lags_too_short_for_its_steps(docking):
    sampled = docking.changed({"control.period": 0.1})
    with pytest.raises(ts.ConfigError, match=r"control\.period cannot differ between the flights of a batch"):
        fly_cases(sampled, Cases.of({"control.period": np.array([0.1, 0.2])}, 2))
    with pytest.raises(ts.ConfigError, match=r"tail_forward\.lag = 0\.001 s is too short .* give at least 0\.0125 s"):
        fly_cases(lagged(docking, 0.001), Cases.of({"wind.speed": 6.0}, 1))


class Asking(ts.AbstractLaw):
    """Asks for a channel and a demand by name."""

    channel: str
    demand: str

    def __call__(self, time, measurement, memory):
        return ts.Request({self.channel: 0.1}, {self.demand: -measurement.rates[2]}), memory


def test_a_law_asks_for_channels_and_demands_by_name(docking):
    scenario = docking.changed({"control.allocation": {"turn": {"port_forward": -1.0, "starboard_forward": 1.0}}})
    point = ts.trim(scenario)
    loop = build_loop(scenario.config, scenario.system, point.command, Asking("tail_forward", "turn"))
    vector = loop.initial(point.state).at[5].set(0.05)
    at = loop.instant(jnp.zeros(()), vector)
    change = np.asarray(at.asked.throttle - point.command.throttle)
    names = scenario.system.part_names.thrusters
    wanted = {"tail_forward": 0.1, "port_forward": 0.05, "starboard_forward": -0.05}
    assert np.allclose(change, [wanted.get(name, 0.0) for name in names], atol=1e-12)
    flight = ts.fly(
        scenario,
        point,
        Asking("fin_1", "turn")
        if "fin_1" in scenario.system.part_names.fins
        else Asking(scenario.system.part_names.fins[0], "turn"),
        stop=0.5,
    )
    assert np.allclose(flight.data["deflection"].values[:, 0], 0.1)


@pytest.mark.parametrize(
    ("channel", "demand", "said"),
    [
        ("tail_forwrd", "turn", "channel 'tail_forwrd'; did you mean 'tail_forward'"),
        ("tail_forward", "trn", "demand 'trn'"),
    ],
)
def test_a_law_that_asks_for_what_is_not_there(docking, channel, demand, said):
    scenario = docking.changed({"control.allocation": {"turn": {"port_forward": -1.0}}})
    with pytest.raises(ts.ConfigError, match=said):
        ts.fly(scenario, ts.trim(scenario), Asking(channel, demand), stop=0.1)


def test_fins_share_in_the_laws_demands(docking):
    fin = docking.config.vehicle.fins[0].name
    shares = dict(docking.config.control.attitude.pitch_share) | {fin: 0.5}
    scenario = docking.changed({"control.attitude.pitch_share": shares, "control.layers": []})
    point = ts.trim(scenario)
    loop = build_loop(scenario.config, scenario.system, point.command)
    at = loop.instant(jnp.zeros(()), loop.initial(point.state).at[4].set(0.1))
    assert float(at.asked.deflection[0]) == pytest.approx(0.5 * docking.config.control.attitude.pitch_rate_gain * 0.1)


def test_flights_with_states_are_flown_again_to_the_bit(slow, tmp_path):
    scenario = slow.changed({"control.period": 0.1, "control.delay": 0.03})
    flight = ts.fly(scenario, ts.trim(scenario), stop=3.0, layers=ALL)
    flight.save(tmp_path / "flight.nc")
    _, again = ts.fly_again(tmp_path / "flight.nc")
    assert np.array_equal(flight.data["velocity"].values, again.data["velocity"].values)
    assert again.outcome is ts.Outcome.time_limit


def test_fly_does_not_dock_and_its_winches_hold(docking):
    flight = ts.fly(docking, ts.trim(docking), stop=3.0)
    assert flight.outcome is ts.Outcome.time_limit
    assert np.ptp(flight.data["cable_length"].values) == 0.0
    assert flight.data["time"].values[-1] == pytest.approx(3.0)


def test_a_point_knows_its_scenario_and_another_ones_is_refused(docking):
    point = ts.trim(docking)
    assert point.scenario is docking
    with pytest.raises(ts.ConfigError, match="no equilibrium of this scenario"):
        ts.fly(docking.changed({"wind.speed": 11.0}), point, stop=1.0)


@pytest.mark.parametrize("stop", [0.0, -1.0, float("nan"), ts.Stop])
def test_a_stop_that_is_none(docking, stop):
    with pytest.raises((ts.ConfigError, TypeError)):
        ts.fly(docking, ts.trim(docking), stop=stop)


def test_a_root_locus_of_a_gain_is_the_closed_loop_at_each_value(docking):
    scenario = docking.changed({"control.layers": ["heading"]})
    locus = ts.sweep(scenario, {"control.heading.gain": [2.0, 6.0]}, loop="closed")
    for place, gain in enumerate((2.0, 6.0)):
        here = scenario.changed({"control.heading.gain": gain})
        wanted = ts.linearize(ts.trim(here), loop="closed").modes().eigenvalues
        apart = np.abs(locus.eigenvalues[place][:, None] - wanted[None, :]).min(axis=1)
        assert apart.max() < 1e-6
    with pytest.raises(ts.ConfigError, match="the laws are sampled"):
        ts.sweep(scenario.changed({"control.period": 0.1}), {"control.heading.gain": [2.0, 6.0]}, loop="closed")
    with pytest.raises(ts.ConfigError, match="did you mean 'closed'"):
        ts.sweep(scenario, {"control.heading.gain": [2.0, 6.0]}, loop="close")


def test_a_channel_at_its_limit_is_told_and_its_loop_is_open(docking):
    weak = {f"vehicle.thrusters.{thruster.name}.nominal_thrust": 8.0 for thruster in docking.config.vehicle.thrusters}
    scenario = docking.changed({"wind.speed": 12.0, "control.layers": []} | weak)
    point = ts.trim(scenario)
    assert point.saturated
    model = ts.linearize(point, loop="closed", require_equilibrium=False)
    assert any(
        point.saturated[0] in line and "so the loop is open there" in line for line in model.attributes["warnings"]
    )


def test_the_commands_fly_and_modes_of_the_closed_loop(tmp_path, capsys, monkeypatch):
    import json

    from tethership.cli import main

    def command(*words):
        monkeypatch.setattr("sys.argv", ["tethership", *words])
        with pytest.raises(SystemExit) as caught:
            main()
        out, err = capsys.readouterr()
        return caught.value.code, out, err

    code, out, _ = command("fly", "hover", "--time", "2", "--json", "--out", str(tmp_path))
    told = json.loads(out)
    assert (code, told["outcome"], told["docking_time"]) == (0, "time_limit", None)
    assert told["flight_time"] == pytest.approx(2.0)
    code, _, err = command("fly", "hover", "--time", "-2", "--out", str(tmp_path))
    assert (code, err.count("\n")) == (2, 1)
    sampled = ("--set", "control.period=0.1s", "--set", "vehicle.thrusters.tail_down.lag=0.3s")
    code, out, _ = command("modes", "--loop", "closed", "--json", *sampled)
    told = json.loads(out)
    assert (code, told["loop"], told["sample_time"]) == (0, "closed", 0.1)
    assert "reached_tail_down" in told["states"]
    code, _, err = command("modes", "--loop", "shut")
    assert (code, err.count("\n")) == (2, 1)
