"""What the paper's spectra say of a fit: growth rates of the free ship, as residuals with exact slopes.

Truth: eigenvalues of `linearize` on the same ship, found by their modes' names; signs that physics demands (large fins
far aft hold the nose, none let it go); difference quotients of the residuals themselves.
If this fails, a fit is drawn to a ship whose spectrum is not the paper's, or its least squares go uphill.
"""

import numpy as np
import pytest

import tethership as ts
from tethership.studies.docking_paper.fit.fit_file import stored_fit
from tethership.studies.docking_paper.fit.space import UNKNOWNS, named_values, to_values
from tethership.studies.docking_paper.fit.spectrum import GROWTH, MILD, NO_OSCILLATION, PARTS, Spectrum, unmet

pytestmark = pytest.mark.slow

NAMES = [unknown.name for unknown in UNKNOWNS]


def vector(**places):
    """Return values [SI] with places between the bounds, ½ where none is given."""
    return to_values(np.array([places.get(name, 0.5) for name in NAMES]))


LARGE_FINS = vector(fin_area=1.3, fin_station=-0.5)
SMALL_FINS = vector(fin_area=-1.0, fin_station=1.0)


@pytest.fixture(scope="module", params=["published", "consistent"])
def spectrum(request):
    return Spectrum(request.param)


def by_name(formulation, values):
    """Return the residuals of PARTS from the modes of the free ship."""
    columns = {name: float(value) for name, value in named_values(values).items()}
    scenario = ts.scenario_at(ts.load_scenario("hover", {"formulation": formulation}), columns)
    modes = ts.linearize(scenario, ts.trim(scenario)).modes()
    slip, vertical, pendulum, roll = (
        modes.find(name).eigenvalue.real for name in ("side-slip", "vertical", "pendulum", "roll oscillation")
    )
    return np.maximum([-slip, -vertical, abs(pendulum) - MILD, roll], 0.0) / GROWTH


def test_residuals_are_those_of_the_named_modes(spectrum):
    formulation = spectrum._scenario.formulation
    for values in (vector(), vector(fin_area=0.3, fin_station=0.7)):
        # two trims that stop at 1e-6 of the weight
        np.testing.assert_allclose(spectrum.residuals(values[None])[0], by_name(formulation, values), atol=1e-4)


@pytest.mark.parametrize("formulation", ["published", "consistent"])
def test_fins_decide_on_side_slip(formulation):
    """Large fins hold the nose: side-slip is stable, which the paper's is not, and the residual says how much."""
    held, middle, loose = Spectrum(formulation).residuals(np.stack([LARGE_FINS, vector(), SMALL_FINS]))
    assert held[0] > 0.5
    assert (middle[0] == 0.0) == (formulation == "published")  # Re λ is 0.079 and −0.164 1/s
    assert loose[0] == 0.0
    assert unmet(held)[0] == "side-slip unstable"
    assert unmet([0.0, 1e-9, 0.0, 2.0]) == [PARTS[1], PARTS[3]]


@pytest.mark.parametrize("formulation", ["published", "consistent"])
def test_the_stored_fits_side_slip_as_claim_1_has_it(formulation):
    """Claim L1 judges the same ship by its modes: the fit must not call unmet what holds there."""
    fit = stored_fit(formulation)
    values = np.array(list(fit["parameters"].values()))
    claimed = by_name(formulation, values)
    found = Spectrum(formulation).residuals(values[None])[0]
    assert (found[0] == 0.0) == (claimed[0] == 0.0)


def test_a_vector_is_judged_alone(spectrum):
    """Whatever else is asked: batches are filled up to 128."""
    several = to_values(np.random.default_rng(1).random((130, len(UNKNOWNS))))
    found = spectrum.residuals(several)
    assert found.shape == (130, 4)
    assert np.isfinite(found).all()
    assert (found >= 0.0).all()
    for i in (0, 129):
        np.testing.assert_allclose(spectrum.residuals(several[i : i + 1])[0], found[i], rtol=1e-9, atol=1e-9)


def quotients(spectrum, values, part):
    """Return central differences of a residual, steps of 1e-4: truncation 1e-8, rounding 1e-9 of the slope."""
    step = 1e-4 * np.abs(values)
    up, down = (spectrum.residuals(values + sign * np.diag(step))[:, part] for sign in (1.0, -1.0))
    return (up - down) / (2.0 * step)


def agree(spectrum, values, part):
    exact = spectrum.slopes(values)[part]
    found = quotients(spectrum, values, part)
    assert np.abs(found).max() > 0.0
    np.testing.assert_allclose(exact, found, rtol=0, atol=1e-6 * np.abs(found).max())


@pytest.fixture(scope="module")
def drawn(spectrum):
    """Vectors in and about the box, and their residuals."""
    values = to_values(np.random.default_rng(0).uniform(-0.4, 1.4, (256, len(UNKNOWNS))))
    return values, spectrum.residuals(values)


@pytest.mark.parametrize("part", [0, 1])
def test_slopes_are_exact(spectrum, drawn, part):
    values, residual = drawn
    middle = np.flatnonzero(residual[:, part] > 0.01)
    assert len(middle) > 5
    agree(spectrum, values[middle[0]], part)


def test_slopes_of_the_pendulum_are_exact(spectrum, drawn):
    """Heavily damped, so too fast: the residual grows as Re λ falls, though vertical grows."""
    values, residual = drawn
    swinging = (residual[:, 2] > 0.1) & (residual[:, 2] != NO_OSCILLATION)
    agree(spectrum, values[np.flatnonzero(swinging & (residual[:, 1] == 0.0))[0]], 2)


@pytest.mark.parametrize("spectrum", ["published"], indirect=True)
def test_what_does_not_swing_costs_a_set_amount(spectrum, drawn):
    """Real roots in the pendulum's place: no single one of them is the pendulum's, so none is judged by its rate."""
    values, residual = drawn
    still = np.flatnonzero(residual[:, 2] == NO_OSCILLATION)
    assert len(still)  # the pendulum of the consistent ship swings everywhere in the box
    np.testing.assert_array_equal(spectrum.slopes(values[still[0]])[2], 0.0)


def test_no_slope_where_nothing_is_to_mend(spectrum, drawn):
    """Zero where a part holds, and nothing of thrust: the trim of a free ship does not ask for it."""
    values, residual = drawn
    one = values[np.flatnonzero(residual[:, 1] == 0.0)[0]]
    slopes = spectrum.slopes(one)
    np.testing.assert_array_equal(slopes[spectrum.residuals(one[None])[0] == 0.0], 0.0)
    thrust = [i for i, name in enumerate(NAMES) if name.startswith("thrust")]
    assert np.abs(slopes[:, thrust]).max() < 1e-9
