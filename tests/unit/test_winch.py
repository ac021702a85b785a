"""The winch: default rate plus correction, within its limits.

Truth: the maker's data as the paper prints them (30 m/min, default 0.3 m/s) and the time they imply, 61.67 s
for 18.5 m of cable (claim D11). If this fails, docking times are wrong, or a law can drive the winch past its
motor.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership import load_scenario
from tethership.physics.winch import Winch

WINCH = Winch(jnp.asarray(0.3), jnp.asarray(0.5))


@pytest.mark.parametrize(
    ("correction", "rate"),
    [
        (0.0, 0.3),
        (-0.29, 0.01),  # the slowest that the rewind law of Table A.2 leaves
        (-0.5, -0.2),  # paying out
        (0.2, 0.5),
        (9.0, 0.5),
        (-9.0, -0.5),
    ],
)
def test_rate_is_clipped_both_ways(correction, rate):
    np.testing.assert_allclose(WINCH.rate(jnp.asarray(correction)), rate, rtol=1e-14)


@pytest.mark.parametrize(("correction", "slope"), [(0.0, 1.0), (-0.7, 1.0), (0.3, 0.0), (-0.9, 0.0)])
def test_slope_is_one_inside_and_nothing_outside(correction, slope):
    assert float(jax.grad(WINCH.rate)(jnp.asarray(correction))) == slope


def test_the_papers_winch():
    cable = load_scenario("docking").system.cables[0]
    winch = cable.winch
    assert float(winch.fastest_rate) == pytest.approx(30.0 / 60.0)  # South Pacific 900E, 30 m/min
    rate = float(winch.rate(jnp.asarray(0.0)))
    assert (float(cable.length) - 1.5) / rate == pytest.approx(61.67, abs=5e-3)  # D11, two decimals
