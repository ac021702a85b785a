"""What a campaign's numbers say, each against a closed form or a textbook's figure."""

import numpy as np
import pytest
import scipy.optimize
import scipy.stats

from tethership.campaign.compliance import judge, least_flights
from tethership.campaign.extremes import _fitted, fit_tail
from tethership.campaign.importance import rank_importance, sobol_importance
from tethership.campaign.paired import paired_limit, paired_metric
from tethership.campaign.probability import clopper_pearson1934, clopper_pearson_ends, estimate, running
from tethership.campaign.sampling import saltelli_design
from tethership.campaign.schema import Requirement


def test_no_event_in_n_flights_has_the_upper_end_of_the_closed_form():
    low, high = clopper_pearson1934(0, 300, 0.95)
    assert low == 0.0
    assert high == pytest.approx(1.0 - 0.025 ** (1 / 300), rel=1e-9)


def test_interval_is_that_of_the_beta_distribution():
    low, high = clopper_pearson1934(7, 100, 0.9)
    assert low == pytest.approx(scipy.stats.beta.ppf(0.05, 7, 94), rel=1e-9)
    assert high == pytest.approx(scipy.stats.beta.ppf(0.95, 8, 93), rel=1e-9)


@pytest.mark.parametrize("confidence", [0.5, 0.9, 0.95, 0.9999])
def test_intervals_in_arrays_are_those_of_the_binomial_tail_by_root_search(confidence):
    flights = np.repeat([1, 2, 10, 213, 1000, 100_000], 6)
    counts = (flights * np.tile([0.0, 0.001, 0.02, 0.3, 0.97, 1.0], 6)).astype(int)
    searched = [scipy.stats.binomtest(k, n).proportion_ci(confidence) for k, n in zip(counts, flights, strict=True)]
    low, high = clopper_pearson_ends(counts, flights, confidence)
    np.testing.assert_allclose(low, [found.low for found in searched], rtol=1e-9, atol=2e-12)  # brentq stops there
    np.testing.assert_allclose(high, [found.high for found in searched], rtol=1e-9, atol=2e-12)  # brentq stops there
    for k, n, *ends in zip(counts, flights, low, high, strict=True):
        assert clopper_pearson1934(int(k), int(n), confidence) == tuple(ends)


def test_interval_covers_the_truth_as_often_as_it_says():
    generator = np.random.default_rng(0)
    inside = 0
    for _ in range(400):
        found = estimate(generator.random(200) < 0.03, "random", np.zeros(200), 0.9)
        inside += found.low <= 0.03 <= found.high
    # Clopper–Pearson is conservative: at least 90 %; 3 σ of 400 trials is 4.5 %
    assert inside / 400 > 0.9 - 0.045


def test_scrambles_never_get_a_binomial_interval():
    flags = np.zeros(800, bool)
    flags[::40] = True
    replicate = np.repeat(np.arange(8), 100)
    flags[0] = False
    found = estimate(flags, "sobol", replicate)
    shares = [flags[replicate == r].mean() for r in range(8)]
    reach = scipy.stats.t.ppf(0.975, 7) * np.std(shares, ddof=1) / np.sqrt(8)
    assert found.method == "scrambled replicates"
    assert found.high - found.probability == pytest.approx(reach)


def test_scrambles_that_all_agree_give_no_interval():
    found = estimate(np.zeros(800, bool), "latin_hypercube", np.repeat(np.arange(8), 100))
    assert found.low is None
    assert found.high is None
    assert "random" in found.method


def test_grid_gives_a_share_without_an_interval():
    assert estimate(np.array([True, False]), "grid", np.zeros(2)).low is None


def test_running_ends_at_the_whole():
    flags = np.random.default_rng(1).random(500) < 0.2
    path = running(flags)
    assert path["probability"][-1] == flags.mean()
    assert np.all(path["low"] <= path["probability"])


@pytest.mark.parametrize("shape", [-0.2, 0.0, 0.2])
def test_tail_of_a_known_distribution_is_found(shape):
    values = scipy.stats.genpareto.rvs(shape, scale=100.0, size=20_000, random_state=3)
    tail = fit_tail(values, draws=60)
    level, low, high = tail.level(1e-4)
    exact = scipy.stats.genpareto.isf(1e-4, shape, scale=100.0)
    # 2 000 excesses: standard deviation of ξ about (1 + ξ)/√2000 = 0.022; 3 σ
    assert tail.shape == pytest.approx(shape, abs=0.08)
    assert low < exact < high or level == pytest.approx(exact, rel=0.15)
    assert (tail.end is None) == (tail.shape >= 0)


def test_censored_peaks_do_not_bend_the_tail():
    generator = np.random.default_rng(5)
    values = generator.exponential(100.0, 20_000)
    end = 300.0  # 5 % of the flights break their cable
    tail = fit_tail(np.minimum(values, end), values > end, draws=40)
    assert tail.censored == np.sum(values > end)
    assert tail.shape == pytest.approx(0.0, abs=0.1)
    assert tail.scale == pytest.approx(100.0, rel=0.1)
    # told nothing of it the fit finds an end that is not there
    assert fit_tail(np.minimum(values, end), share=0.15, draws=2).shape < -0.3


@pytest.mark.parametrize("shape", [-0.3, 0.0, 0.4])
@pytest.mark.parametrize("end", [np.inf, 150.0])
def test_tail_and_its_bootstrap_are_of_largest_likelihood(shape, end):
    """Beside a search from the same place for every bootstrap sample, drawn as it always was."""
    drawn = scipy.stats.genpareto.rvs(shape, scale=100.0, size=1500, random_state=4)
    values, over = np.minimum(drawn, end), drawn > end
    tail = fit_tail(values, over, seed=7, draws=5)
    generator = np.random.default_rng(7)
    places = [np.arange(1500), *(generator.integers(1500, size=1500) for _ in range(5))]
    fitted = zip([tail.shape, *tail.shapes], [tail.scale, *tail.scales], [tail.share, *tail.shares], strict=True)
    for place, (xi, sigma, share) in zip(places, fitted, strict=True):
        whole = values[place][~over[place] & (values[place] > tail.threshold)] - tail.threshold
        broken = np.maximum(values[place][over[place]] - tail.threshold, 0.0)

        def lost(point, whole=whole, broken=broken):
            law = scipy.stats.genpareto(point[0], 0.0, np.exp(point[1]))
            return -law.logpdf(whole).sum() - law.logsf(broken).sum()

        tight = {"xatol": 1e-9, "fatol": 1e-11, "maxiter": 4000}
        best = scipy.optimize.minimize(lost, [xi, np.log(sigma)], method="Nelder-Mead", options=tight)
        assert lost([xi, np.log(sigma)]) <= best.fun + 1e-9
        assert best.x == pytest.approx([xi, np.log(sigma)], abs=2e-6)
        assert share == np.mean((values[place] > tail.threshold) | over[place])


def test_bootstrap_samples_without_enough_excesses_take_the_fit():
    """A sample with fewer than fifteen known excesses has no fit of its own."""
    weights = np.ones((3, 40), np.int16)
    weights[1, 14:], weights[2] = 0, 0
    weights[2, 0] = 40
    shapes, scales, shares = _fitted(np.linspace(1.0, 50.0, 40), np.zeros(40, bool), weights, 400)
    assert list(np.isnan(shapes)) == list(np.isnan(scales)) == [False, True, True]
    assert shares == pytest.approx([0.1, 0.035, 0.1])


def test_a_tail_that_is_none_is_said_to_be():
    generator = np.random.default_rng(2)
    assert fit_tail(generator.exponential(size=20_000), draws=2).adequate
    lumps = np.concatenate([generator.random(18_000), 2.0 + 0.01 * generator.standard_normal(2_000)])
    assert not fit_tail(lumps, share=0.2, draws=2).adequate


def test_level_at_the_threshold_s_own_share_is_the_threshold():
    tail = fit_tail(np.random.default_rng(0).exponential(size=2000), draws=20)
    assert tail.level(tail.share)[0] == pytest.approx(tail.threshold)


def test_too_few_flights_have_no_tail():
    assert fit_tail(np.random.default_rng(0).exponential(size=100)) is None
    assert fit_tail(np.ones(5000)) is None


def test_rank_correlation_sees_what_rises_whatever_its_shape():
    x = np.random.default_rng(0).random((400, 3))
    found = rank_importance(("a", "b", "c"), x, np.exp(5 * x[:, 1]) - 0.01 * x[:, 0])
    assert found[0].name == "b"
    assert found[0].rank_correlation > 0.99
    assert abs(found[2].rank_correlation) < 0.2


def test_sobol_indices_are_those_of_ishigami():
    # Ishigami and Homma (1990), a = 7, b = 0.1: S = 0.3139, 0.4424, 0; S_T = 0.5576, 0.4424, 0.2437
    size = 4096
    x = np.pi * (2.0 * saltelli_design(size * 5, 3, 1) - 1.0)
    output = np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])
    found = {entry.name: entry for entry in sobol_importance(("a", "b", "c"), x, output)}
    for name, first, total in (("a", 0.3139, 0.5576), ("b", 0.4424, 0.4424), ("c", 0.0, 0.2437)):
        assert found[name].first == pytest.approx(first, abs=0.02)
        assert found[name].total == pytest.approx(total, abs=0.02)
        assert found[name].total_low <= found[name].total <= found[name].total_high


def test_pairs_see_a_small_shift_that_the_spread_of_cases_hides():
    generator = np.random.default_rng(0)
    first = generator.normal(100.0, 30.0, 300)
    found = paired_metric("tension_max", first, first - 1.0 + generator.normal(0.0, 1.0, 300))
    assert found.high < 0.0
    assert found.p_value < 1e-6
    assert 0.5 < found.lower < 1.0


def test_pairs_leave_out_what_only_one_has():
    first, second = np.array([1.0, np.nan, 3.0, 4.0]), np.array([2.0, 2.0, np.nan, 5.0])
    assert paired_metric("E", first, second) is None


def test_mcnemar_looks_at_discordant_cases_only():
    first = np.array([True] * 60 + [False] * 40)
    second = np.array([True] * 50 + [False] * 50)
    found = paired_limit("time", first, second)
    assert (found.only_first, found.only_second, found.both) == (10, 0, 50)
    assert found.p_value == pytest.approx(2 * 0.5**10)


def judged(exceeding, flights, allowed, undetermined=0, failed=0, sampling="random", replicates=1):
    """Return a verdict over flights of which the first exceed, the next ended early, the last failed."""
    places = np.arange(flights)
    flags = places < exceeding
    early = (places >= exceeding) & (places < exceeding + undetermined)
    requirement = Requirement(limit="envelope_tear", probability=allowed)
    scramble = np.random.default_rng(0).permutation(places) % replicates
    return judge(requirement, flags, early, places >= flights - failed, sampling, scramble)


@pytest.mark.parametrize(
    ("found", "verdict"),
    [
        (judged(0, 736, 0.005), "met"),
        (judged(0, 735, 0.005), "undecided"),
        (judged(50, 1000, 0.01), "not met"),
        (judged(10, 1000, 0.01), "undecided"),
        (judged(0, 1000, 0.01, undetermined=20), "undecided"),
        (judged(0, 1000, 0.05, undetermined=20), "met"),
        (judged(50, 1000, 0.01, undetermined=900), "not met"),
        (judged(0, 1000, 0.01, failed=51), "no verdict"),
        (judged(0, 9, 0.01, sampling="grid"), "no verdict"),
        (judged(39, 1024, 0.01, sampling="sobol", replicates=8), "no verdict"),
        (judged(400, 1024, 0.01, sampling="sobol", replicates=8), "not met"),
    ],
)
def test_verdicts(found, verdict):
    assert found["verdict"] == verdict
    assert bool(found["reason"]) == (verdict == "no verdict")


@pytest.mark.parametrize(("allowed", "confidence"), [(0.005, 0.95), (0.01, 0.9), (0.1, 0.99)])
def test_least_flights_are_just_enough(allowed, confidence):
    least = least_flights(allowed, confidence)
    assert clopper_pearson1934(0, least, confidence)[1] <= allowed < clopper_pearson1934(0, least - 1, confidence)[1]
