"""Rewind law: the three pieces of Eq. 41 by hand.

Truth: Ψ = Ψ̄ up to F′, falling by κ_Ψ per newton beyond it, never below Ψ_min (Table A.2). If this failed, the winch
would go on pulling a taut cable, or stand still for a slack one.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tethership as ts
from tethership.control import Measurement

# Table A.2; the docking's default rate is 0.3 m/s.
GAIN, THRESHOLD, SLOWEST, DEFAULT = 0.005, 144.3, 0.01, 0.3


@pytest.fixture(scope="module")
def law():
    return ts.load_scenario("docking").law(layers=("rewind",), sas=False).laws[0]


@jax.jit
def rate_of(law, tension, default):
    """Return Ψ of every cable."""
    cables = tension.shape[0]
    nothing = jnp.zeros(3)
    measurement = Measurement(
        velocity=nothing,
        rates=nothing,
        attitude=nothing,
        rate_of_climb=jnp.zeros(()),
        offset=jnp.zeros((cables, 3)),
        tension=tension,
        length=jnp.full(cables, 20.0),
        rewind_rate=default,
    )
    correction, memory = law(jnp.zeros(()), measurement, ())
    assert memory == ()
    assert correction.throttle == 0.0
    assert correction.deflection == 0.0
    return default + correction.rewind_rate


def rate(law, tension, default=DEFAULT):
    return float(rate_of(law, np.array([float(tension)]), np.array([default]))[0])


@pytest.mark.parametrize("tension", [0.0, 14.18, 100.0, 144.2999, 144.3])
def test_below_the_threshold_the_default_rate_stays(law, tension):
    assert rate(law, tension) == DEFAULT


@pytest.mark.parametrize(("tension", "expected"), [(154.3, 0.25), (174.3, 0.15), (194.3, 0.05)])
def test_above_the_threshold_it_falls_by_the_gain(law, tension, expected):
    assert rate(law, tension) == pytest.approx(expected, rel=1e-12)  # worked by hand: 0.3 − 0.005·(F − 144.3)


@pytest.mark.parametrize("tension", [202.3001, 300.0, 3040.0, 1e6])
def test_it_never_falls_below_the_slowest_rate(law, tension):
    assert rate(law, tension) == pytest.approx(SLOWEST, rel=1e-12)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(tension=st.floats(0.0, 5000.0), default=st.floats(0.02, 0.5))
def test_law_is_equation_41(law, tension, default):
    expected = max(default - GAIN * (tension - THRESHOLD), SLOWEST) if tension > THRESHOLD else default
    # ΔΨ is added back to Ψ̄: rounding of 0.5.
    assert rate(law, tension, default) == pytest.approx(expected, abs=1e-15)


def test_pieces_join_without_a_step(law):
    corner = THRESHOLD + (DEFAULT - SLOWEST) / GAIN
    for tension in (THRESHOLD, corner):
        # One millinewton either side changes Ψ by at most 2·κ·1e-3 = 1e-5 m/s.
        assert abs(rate(law, tension + 1e-3) - rate(law, tension - 1e-3)) < 1.01e-5


def test_every_winch_minds_its_own_cable(law):
    tensions, defaults = np.array([10.0, 164.3, 900.0]), np.array([0.3, 0.4, 0.2])
    found = np.asarray(rate_of(law, tensions, defaults))
    np.testing.assert_allclose(found, [0.3, 0.3, 0.01], rtol=1e-12)  # 0.4 − 0.005·20


def test_the_third_of_the_text_is_a_matter_of_one_number():
    """The text's F′ is ⅓ of the tear force, 160.3 N, at which 156 N (Table 4, 6 m/s) does not slow the winch."""
    printed = ts.load_scenario("docking").law(layers=("rewind",), sas=False).laws[0]
    text = ts.load_scenario("docking", {"control.rewind.threshold": 160.3})
    assert rate(printed, 156.0) < DEFAULT
    assert rate(text.law(layers=("rewind",), sas=False).laws[0], 156.0) == DEFAULT
