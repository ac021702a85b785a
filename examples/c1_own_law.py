"""A control law of one's own in ten lines: rewind on while the cable sags, wait while it is drawn out."""

from pathlib import Path

import jax.numpy as jnp

import tethership as ts


class SagKeeper(ts.AbstractLaw):
    """Slow the winch down as a one-second average of the elongation (its memory) comes near 1.

    It halves the peak of the paper's law in 12 m/s, and pays for it with time: it is not docked after 200 s.
    """

    start: float = 0.80
    end: float = 0.95

    def initial_memory(self, measurement):
        return jnp.linalg.norm(measurement.offset, axis=1) / measurement.length

    def __call__(self, time, measurement, memory):
        elongation = jnp.linalg.norm(measurement.offset, axis=1) / measurement.length
        share = jnp.clip((memory - self.start) / (self.end - self.start), 0.0, 0.95)
        return ts.Correction(rewind_rate=-share * measurement.rewind_rate), (elongation - memory) / 1.0


scenario = ts.load_scenario("docking", {"wind.speed": 12.0})
point = ts.trim(scenario)
theirs = ts.dock(scenario, point, layers=("rewind", "heading"))
ours = ts.dock(scenario, point, layers=("heading",), own_laws={"sag keeper": SagKeeper()})
for name, flight in (("paper", theirs), ("own", ours)):
    end = float(flight.data["time"][-1])
    print(f"{name}: {flight.outcome.name} after {end:.0f} s, largest tension {flight.metrics['tension_max']:.0f} N")
Path("out").mkdir(exist_ok=True)
ts.plot_docking(ours).savefig("out/c1_own_law.png", dpi=120)
