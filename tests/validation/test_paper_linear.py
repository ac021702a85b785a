"""Figures 6-11 and claims L1-L9 of the paper: computed, judged, and able to fail.

Whether a claim of the paper holds is reported (docs/validation/linear.md), not asserted. Asserted is what physics
demands, and that each verdict follows the numbers: a ship made to break a claim breaks it. Source: Riboldi et al.,
section 3. If one failed, the validation page would say what was not computed.
"""

import numpy as np
import pytest

import tethership as ts
from tethership.studies.docking_paper import CLAIMS, FIGURES, check_claims, linear_figure
from tethership.studies.docking_paper.linear_claims import CLAIMS as CLAIM_FUNCTIONS
from tethership.studies.docking_paper.linear_claims import claim_9, fins

pytestmark = pytest.mark.slow

BOTH = ("consistent", "published")


@pytest.fixture(scope="module")
def claims():
    """All claims at the literature's fins, and those that tell fins apart at 5 and 12 m² in `published`."""
    found = {form: check_claims(form) for form in BOTH}
    found["small"] = check_claims("published", 5.0, ["L1", "L2", "L4", "L6", "L7"])
    found["large"] = check_claims("published", 12.0, ["L1", "L2", "L4", "L6", "L7"])
    return found


def numbers_of(value):
    """Yield every number of a nested result."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            yield from numbers_of(item)
    elif isinstance(value, float):
        yield value


@pytest.mark.parametrize("form", BOTH)
def test_every_claim_says_what_it_found(claims, form):
    assert list(claims[form]) == list(CLAIMS) == [f"L{i}" for i in range(1, 10)]
    for claim in claims[form].values():
        assert claim.parts
        assert claim.numbers
        assert claim.holds == all(claim.parts.values())
        assert claim.verdict == ("holds" if claim.holds else "does not hold")
        assert np.isfinite(list(numbers_of(claim.numbers))).all(), claim.name


@pytest.mark.parametrize("kind", ["consistent", "published", "small", "large"])
def test_what_physics_demands(claims, kind):
    """Free in a uniform wind: heading, north and east null; vertical null where density is constant."""
    second = claims[kind]["L2"].parts
    assert second["north and east are null"]
    assert second["it is ρ(altitude) that does it: null in air of constant density"]
    assert not claims[kind]["L1"].parts["the directional mode is real, slow and not null"]


def test_verdicts_follow_the_ship(claims):
    """Each of these parts holds for one ship and does not for another: no verdict is fixed."""
    assert claims["small"]["L2"].holds
    assert not claims["large"]["L2"].holds  # large fins: vertical becomes stable
    side_slip = "side-slip is real and mildly unstable"
    assert claims["published"]["L1"].parts[side_slip]
    assert not claims["large"]["L1"].parts[side_slip]
    merging = "they coalesce between 5.37 and 3.77 m ahead of B"
    assert claims["small"]["L6"].parts[merging]
    assert not claims["large"]["L6"].parts[merging]
    split = "it splits into two real modes"
    assert claims["small"]["L7"].parts[split]
    assert not claims["published"]["L7"].parts[split]


def test_the_joint_is_what_sets_the_limit_of_trim(claims):
    """In `published` max |δ| is 0.14 at 0.95, 0.21 at 0.99, 1.68 at 0.995; the exact catenary is slack."""
    assert claims["published"]["L9"].holds
    assert not claims["consistent"]["L9"].holds
    throttle = dict(
        zip(*(claims["published"]["L9"].numbers[k] for k in ("elongation", "largest |throttle|")), strict=True)
    )
    assert throttle[0.95] == pytest.approx(0.142, abs=1e-3)
    assert throttle[0.99] == pytest.approx(0.205, abs=1e-3)
    assert throttle[0.995] == pytest.approx(1.682, abs=1e-3)
    # With twenty times the thrust every elongation up to 1.02 could be held: the claim is about thrust.
    strong = {f"vehicle.thrusters.{name}.nominal_thrust": 2400.0 for name in THRUSTERS}
    assert not claim_9({"formulation": "published", **strong}).holds


THRUSTERS = ("tail_forward", "tail_down", "port_up", "starboard_up", "port_forward", "starboard_forward")


def test_the_fin_range_is_the_papers(claims):
    """6.6 m² is lotte.toml: the changes that give it are the file's own values."""
    scenario = ts.load_scenario("docking")
    changed = ts.load_scenario("docking", fins(2.88 * 5.73 * 0.4))
    for own, other in zip(scenario.config.vehicle.fins, changed.config.vehicle.fins, strict=True):
        assert own.efficiency == pytest.approx(other.efficiency, rel=1e-12)
    assert set(CLAIM_FUNCTIONS) == set(CLAIMS)


@pytest.mark.parametrize("form", BOTH)
def test_figures_have_their_panels(form):
    """The points named in print are among the points computed, and the reference is the reference."""
    panels = {number: linear_figure(number, form).panels for number in FIGURES}
    assert {number: len(found) for number, found in panels.items()} == {6: 1, 7: 2, 8: 2, 9: 1, 10: 2, 11: 2}
    assert len(panels[6][0].free.eigenvalues) == 9
    assert panels[6][0].sweep.eigenvalues.shape == (1, 12)
    heavy = panels[7][1].sweep
    assert heavy.values["cables.nose.diameter"][[0, -1]] == pytest.approx([2.5e-3, 14e-3])
    assert heavy.values["cables.nose.linear_density"][[0, -1]] == pytest.approx([6e-3, 140e-3])
    star = panels[7][1].star
    assert heavy.values["cables.nose.linear_density"][star] == pytest.approx(80e-3, rel=1e-9)
    forward = panels[9][0].sweep.values["cables.nose.tether_point.0"]
    assert {6.97, 5.37, 3.77} <= set(forward.tolist())
    # On the hull's surface at the paper's own station: radius 1.5977 m at 3.77 m ahead of B (fit: 1.4 mm).
    down = panels[9][0].sweep.values["cables.nose.tether_point.2"]
    assert down[list(forward).index(3.77)] == pytest.approx(1.5977, abs=2e-3)
    # Figs. 7, 9, 10 and 11 have one ship in common, starred: the same spectrum, to the trims' rounding.
    stars = [panels[7][1], panels[10][0], panels[11][0]]
    spectra = [np.sort_complex(panel.sweep.eigenvalues[panel.star]) for panel in stars]
    for other in spectra[1:]:
        np.testing.assert_allclose(other, spectra[0], rtol=0, atol=1e-7)
    # Fig. 8: each side cable has the tension that the one nose cable has ("exactly the same shape and load").
    np.testing.assert_allclose(
        panels[8][1].sweep.tension, np.repeat(heavy.tension, 2, axis=1), rtol=1e-3, err_msg="density of altitude only"
    )


def test_a_figure_the_paper_does_not_have():
    with pytest.raises(ts.ConfigError, match=r"no root locus in figure 12; give one of 6, 7, 8, 9, 10, 11"):
        linear_figure(12)
