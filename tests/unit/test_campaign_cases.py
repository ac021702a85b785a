"""Cases of a campaign: distributions, samplings, correlation, seeds, what is refused."""

import numpy as np
import pytest
import scipy.stats

from tethership.campaign.flights import SWITCHES
from tethership.campaign.plan import make_plan
from tethership.errors import ConfigError
from tethership.scenario import list_packaged

HEAD = """
title = "Test"
scenario = "docking_paper"
samples = 256
"""

WIND = """
[vary."wind.speed"]
distribution = "uniform"
low = 4.0
high = 12.0
unit = "m/s"
"""

START = """
[vary."gusts.0.start"]
distribution = "uniform"
low = 5.0
high = 15.0
unit = "s"
"""


@pytest.fixture
def planned(tmp_path):
    """A function that makes the plan of a campaign's text."""

    def make(text, **changes):
        path = tmp_path / "own.toml"
        path.write_text(text, encoding="utf-8")
        return make_plan(str(path), changes)

    return make


def varied(text, name="wind.speed"):
    return f'{HEAD}\n[vary."{name}"]\n{text}\n'


@pytest.mark.parametrize(
    ("text", "exact"),
    [
        ('distribution = "uniform"\nlow = 4.0\nhigh = 12.0\nunit = "m/s"', scipy.stats.uniform(4, 8)),
        ('distribution = "normal"\nmean = 8.0\ndeviation = 1.0\nunit = "m/s"', scipy.stats.norm(8, 1)),
        (
            'distribution = "normal"\nmean = 8.0\ndeviation = 1.0\nlow = 7.0\nhigh = 8.5\nunit = "m/s"',
            scipy.stats.truncnorm(-1, 0.5, 8, 1),
        ),
        ('distribution = "lognormal"\nmedian = 8.0\ndeviation = 0.2\nunit = "m/s"', scipy.stats.lognorm(0.2, 0, 8)),
        ('distribution = "weibull"\nscale = 8.0\nshape = 2.5\nunit = "m/s"', scipy.stats.weibull_min(2.5, scale=8)),
    ],
)
def test_draws_have_their_distribution(planned, text, exact):
    values = planned(varied(text), samples=4000).sample.values[:, 0]
    assert scipy.stats.kstest(values, exact.cdf).pvalue > 1e-3


def test_discrete_values_come_as_often_as_their_weights_say(planned):
    text = varied('distribution = "discrete"\nvalues = [6.0, 9.0]\nweights = [3.0, 1.0]\nunit = "m/s"')
    values = planned(text, samples=4000).sample.values[:, 0]
    assert set(values) == {6.0, 9.0}
    assert np.mean(values == 6.0) == pytest.approx(0.75, abs=0.03)


def test_units_are_turned_to_si_and_relative_numbers_multiply_the_scenario_s(planned):
    text = HEAD + '[vary."start.attitude_offset.0"]\ndistribution = "uniform"\nlow = -9.0\nhigh = 9.0\nunit = "deg"\n'
    text += '[vary."cables.nose.stiffness"]\ndistribution = "uniform"\nlow = 0.9\nhigh = 1.1\nrelative = true\n'
    values = planned(text).sample.values
    assert np.abs(values[:, 0]).max() <= np.radians(9.0)
    assert 0.9 * 69760 <= values[:, 1].min() < values[:, 1].max() <= 1.1 * 69760


@pytest.mark.parametrize("sampling", ["random", "sobol", "latin_hypercube"])
def test_same_seed_same_cases_and_another_seed_others(planned, sampling):
    text = HEAD + WIND + START
    first, again = planned(text, sampling=sampling), planned(text, sampling=sampling)
    assert np.array_equal(first.values, again.values)
    assert first.digest() == again.digest()
    other = planned(text, sampling=sampling, seed=2)
    assert not np.array_equal(first.values, other.values)
    assert first.digest() != other.digest()


def test_batches_of_another_width_are_another_store(planned, monkeypatch):
    plan = planned(HEAD + WIND + START, samples=100)
    before = plan.digest()
    monkeypatch.setattr("tethership.campaign.plan.BATCH", 192)
    assert plan.digest() != before


@pytest.mark.parametrize("sampling", ["sobol", "latin_hypercube"])
def test_spread_samplings_come_in_replicates_that_each_fill_the_box(planned, sampling):
    sample = planned(HEAD + WIND + START, sampling=sampling).sample
    assert set(sample.replicate) == set(range(8))
    for replicate in range(8):
        values = sample.values[sample.replicate == replicate, 0]
        assert len(values) == 32
        assert np.all(np.histogram(values, bins=4, range=(4, 12))[0] == 8)


def test_grid_is_every_combination(planned):
    text = HEAD + WIND + "number = 5\n" + START + "number = 3\n"
    values = planned(text, sampling="grid").sample.values
    assert len(values) == 15
    assert len({tuple(row) for row in values}) == 15
    assert set(values[:, 0]) == {4.0, 6.0, 8.0, 10.0, 12.0}


def test_correlated_groups_have_their_correlation(planned):
    group = '[[correlated]]\nnames = ["wind.speed", "gusts.0.start"]\ncorrelation = [[1.0, 0.8], [0.8, 1.0]]\n'
    values = planned(HEAD + WIND + START + group, samples=4000).sample.values
    # rank correlation of a Gaussian copula: (6/π) asin(ρ/2)
    found = scipy.stats.spearmanr(values[:, 0], values[:, 1]).statistic
    assert found == pytest.approx(6 / np.pi * np.arcsin(0.4), abs=0.03)
    assert scipy.stats.kstest(values[:, 0], scipy.stats.uniform(4, 8).cdf).pvalue > 1e-3


def test_laws_fly_the_same_cases_with_their_own_gains(planned):
    laws = '[[laws]]\nname = "a"\nlayers = ["rewind"]\n[[laws]]\nname = "b"\nlayers = ["rewind", "heading"]\n'
    laws += '[[laws]]\nname = "c"\nlayers = ["rewind"]\nchanges = { "control.rewind.gain" = 0.01 }\n'
    plan = planned(HEAD + WIND + laws)
    place = {name: plan.names.index(name) for names in SWITCHES.values() for name in names}
    assert np.array_equal(plan.values[0, :, 0], plan.values[1, :, 0])
    assert np.all(plan.values[0, :, place["control.heading.gain"]] == 0.0)
    assert np.all(plan.values[1, :, place["control.heading.gain"]] == 5.0)
    assert np.all(plan.values[2, :, place["control.rewind.gain"]] == 0.01)


def test_a_law_may_have_layers_that_the_scenario_leaves_out(planned):
    changes = '[changes]\n"control.layers" = ["rewind"]\n'
    laws = '[[laws]]\nname = "a"\nlayers = ["rewind", "heading"]\n'
    assert planned(HEAD + changes + WIND + laws).scenario.layers == ("rewind", "heading", "navigation")
    own = planned(HEAD + changes + WIND)
    assert own.laws[0].layers == ("rewind",)
    assert np.all(own.values[0, :, own.names.index("control.heading.gain")] == 0.0)


def test_a_gain_that_varies_is_off_where_its_layer_is(planned):
    text = varied('distribution = "uniform"\nlow = 1.0\nhigh = 9.0\nunit = "1/rad"', "control.heading.gain")
    plan = planned(text + '[[laws]]\nname = "a"\nlayers = ["rewind"]\n[[laws]]\nname = "b"\nlayers = ["heading"]\n')
    assert np.all(plan.values[0, :, 0] == 0.0)
    assert plan.values[1, :, 0].min() >= 1.0


def test_batches_hold_every_case_once_and_verify_the_same_ones_each_time(planned):
    plan = planned(HEAD + WIND, samples=500)
    batches = [plan.batch(number) for number in range(plan.batches)]
    assert sum(len(batch.values) for batch in batches) == 500
    assert np.array_equal(np.concatenate([batch.values for batch in batches]), plan.values[0])
    assert batches[1].verified == plan.batch(1).verified


@pytest.mark.parametrize("name", list_packaged()["campaigns"])
def test_packaged_campaigns_can_be_planned(name):
    assert make_plan(name).values.shape[1] >= 500


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (varied('distribution = "uniform"\nlow = 4.0\nhigh = 2.0\nunit = "m/s"'), "low 4 must be below high 2"),
        (varied('distribution = "uniform"\nlow = 4.0\nhigh = 9.0\nunit = "m"'), "give one that converts to it"),
        (varied('distribution = "uniform"\nlow = 4.0\nhigh = 9.0'), "needs a unit"),
        (varied('distribution = "uniform"\nlow = -4.0\nhigh = 9.0\nunit = "m/s"'), "must be at least 0"),
        (varied('distribution = "gauss"\nmean = 4.0\nunit = "m/s"'), "distribution"),
        (varied('distribution = "normal"\nmean = 4.0\ndeviation = -1.0\nunit = "m/s"'), "greater than 0"),
        (
            varied('distribution = "normal"\nmean = 4.0\ndeviation = 0.1\nlow = 9.0\nunit = "m/s"'),
            "nothing of the distribution is left",
        ),
        (varied('distribution = "discrete"\nvalues = [4.0]\nweights = [1.0, 2.0]\nunit = "m/s"'), "as many weights"),
        (varied('distribution = "uniform"\nlow = 4.0\nhigh = 9.0\nunit = "m/s"', "wind.sped"), "wind.speed"),
        (HEAD, "vary"),
        (HEAD + 'sampling = "halton"' + WIND, "sampling"),
        (HEAD.replace("256", "0") + WIND, "greater than or equal to 1"),
        (
            HEAD + WIND + '[[correlated]]\nnames = ["wind.speed", "x"]\ncorrelation = [[1, 0], [0, 1]]',
            "no distribution",
        ),
        (
            HEAD + WIND + START + '[[correlated]]\nnames = ["wind.speed", "gusts.0.start"]\n'
            "correlation = [[1.0, 1.5], [1.5, 1.0]]",
            "positive definite",
        ),
        (HEAD + WIND + '[[requirements]]\nlimit = "tear"\nprobability = 0.1', "allowed: control_threshold"),
        (HEAD + WIND + '[[requirements]]\nlimit = "time"\nprobability = 0.1', "limits.time"),
        (HEAD + WIND + '[[laws]]\nname = "a"\nlayers = ["rewinding"]', "rewind"),
        (
            varied('distribution = "normal"\nmean = 0.3\ndeviation = 0.1\nunit = "1"', "gusts.0.fraction"),
            "reaches -0.2",
        ),
        (
            HEAD + WIND + '[[laws]]\nname = "a"\nlayers = []\nchanges = { wind = 5.0 }',
            "sets wind.speed, which varies too",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(planned, text, said):
    with pytest.raises(ConfigError, match=r"own\.toml") as error:
        planned(text)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_a_number_that_is_set_does_not_vary():
    plan = make_plan("gusts", {"samples": 20}, {"wind.speed": 9.0})
    assert "wind.speed" not in plan.names
    assert plan.scenario.config.wind.speed == 9.0


def test_unknown_campaign_offers_the_nearest():
    with pytest.raises(ConfigError, match="did you mean 'gusts'"):
        make_plan("gust")
