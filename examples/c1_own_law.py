"""A control law of one's own in ten lines: rewind faster while the cable sags, and let go when it snaps."""

from pathlib import Path

import jax.numpy as jnp

import tethership as ts


class SagKeeper(ts.AbstractLaw):
    """Hold the elongation near a target by the winch alone; remembers its running mean tension."""

    target: float = 0.9
    gain: float = 2.0

    def initial_memory(self, measurement):
        return measurement.tension

    def __call__(self, time, measurement, memory):
        elongation = jnp.linalg.norm(measurement.offset, axis=1) / measurement.length
        rate = jnp.clip(self.gain * (self.target - elongation), -0.5, 0.15)
        return ts.Correction(rewind_rate=rate), (measurement.tension - memory) / 5.0


scenario = ts.load_scenario("docking", {"wind.speed": 12.0})
point = ts.trim(scenario)
theirs = ts.dock(scenario, point, layers=("rewind", "heading"))
ours = ts.dock(scenario, point, layers=("heading",), own_laws={"sag keeper": SagKeeper()})
for name, flight in (("paper", theirs), ("own", ours)):
    print(f"{name}: {flight.outcome.name}, largest tension {flight.metrics['tension_max']:.0f} N")
Path("out").mkdir(exist_ok=True)
ts.plot_docking(ours).savefig("out/c1_own_law.png", dpi=120)
