"""From a campaign's distributions to its cases. Depends on: scipy, campaign.schema, scenario.

The same seed gives the same cases, on any number of workers: they are all drawn before the first is flown.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np
import scipy.stats

from tethership.campaign.schema import MOST_CASES, CampaignConfig
from tethership.errors import ConfigError
from tethership.scenario import Parameter, Scenario, check_values, find_parameter, list_parameters

NEVER = 1e-9
"""Probability of values beyond which a distribution is not looked at: six standard deviations of a normal one."""


class Sample(NamedTuple):
    """What varies, case by case.

    Attributes
    ----------
    names : tuple of str
        Dotted names.
    values : ndarray
        In SI, e.g. `wind.speed` [m/s], shape (cases, names).
    replicate : ndarray
        Which independent scramble each case belongs to; all 0 where the draws are independent.
    """

    names: tuple[str, ...]
    values: np.ndarray
    replicate: np.ndarray


def draw(campaign: CampaignConfig, scenario: Scenario, origin: str) -> Sample:
    """Return the cases of a campaign.

    Parameters
    ----------
    campaign : CampaignConfig
        Validated.
    scenario : Scenario
        What it varies.
    origin : str
        For messages.

    Returns
    -------
    Sample
        Values in SI, whatever unit the file gives them in: [m/s], [rad], [m], …

    Raises
    ------
    ConfigError
        A quantity does not exist, its unit does not fit, or the scenario forbids a value that was drawn.
    """
    known = list_parameters(scenario.config)
    try:
        parameters = [find_parameter(known, name, scenario.name) for name in campaign.vary]
    except ConfigError as error:
        raise ConfigError(f"{origin}: vary: {error}") from error
    names = tuple(parameter.name for parameter in parameters)
    if len(set(names)) != len(names):
        raise ConfigError(f"{origin}: two names of vary are the same number; name each once")
    if campaign.sampling == "grid":
        values = _grid(campaign, parameters, origin)
        replicate = np.zeros(len(values), int)
    else:
        probability, replicate = _probabilities(campaign)
        columns = [
            _in_si(campaign, parameter, spread.quantile(probability[:, i]), name, origin)
            for i, (parameter, (name, spread)) in enumerate(zip(parameters, campaign.vary.items(), strict=True))
        ]
        values = np.stack(columns, axis=1)
    _check_bounds(scenario, parameters, _reached(campaign, parameters, values, origin), origin)
    return Sample(names, values, replicate)


def _in_si(campaign: CampaignConfig, parameter: Parameter, values: np.ndarray, name: str, origin: str) -> np.ndarray:
    """Return values of a file in SI, or raise ConfigError where the unit does not fit."""
    try:
        return campaign.vary[name].in_si(values, parameter.value, parameter.unit)
    except ValueError as error:
        raise ConfigError(f"{origin}: vary.{name}: {error}") from error


def _grid(campaign: CampaignConfig, parameters: list[Parameter], origin: str) -> np.ndarray:
    """Return every combination of levels [SI]."""
    axes = []
    for parameter, (name, spread) in zip(parameters, campaign.vary.items(), strict=True):
        try:
            levels = spread.levels()
        except ValueError as error:
            raise ConfigError(f"{origin}: vary.{name}: {error}") from error
        axes.append(_in_si(campaign, parameter, levels, name, origin))
    cases = math.prod(map(len, axes))
    if cases > MOST_CASES:
        raise ConfigError(f"{origin}: a grid of {cases} cases is too large (at most {MOST_CASES}); take fewer levels")
    return np.array(list(itertools.product(*axes)))


def _probabilities(campaign: CampaignConfig) -> tuple[np.ndarray, np.ndarray]:
    """Return probabilities of shape (cases, names), correlated where asked for, and the replicate of each case."""
    count, size = campaign.samples, len(campaign.vary)
    generator = np.random.default_rng(campaign.seed)
    replicate = np.zeros(count, int)
    if campaign.sampling == "random":
        found = generator.random((count, size))
    elif campaign.sampling == "saltelli":
        found = saltelli_design(count, size, campaign.seed)
        replicate = np.zeros(len(found), int)
    else:
        ends = np.linspace(0, count, campaign.replicates + 1).round().astype(int)
        seeds = generator.spawn(campaign.replicates)
        blocks = [
            _spread(campaign.sampling, b - a, size, rng) for a, b, rng in zip(ends, ends[1:], seeds, strict=False)
        ]
        found = np.concatenate(blocks)
        replicate = np.repeat(np.arange(campaign.replicates), np.diff(ends))
    return _correlated(campaign, np.clip(found, 1e-12, 1.0 - 1e-12)), replicate


def _spread(kind: str, count: int, size: int, generator: np.random.Generator) -> np.ndarray:
    """Return evenly spread points, one scramble."""
    if kind == "latin_hypercube":
        return scipy.stats.qmc.LatinHypercube(size, rng=generator).random(count)
    engine = scipy.stats.qmc.Sobol(size, rng=generator)
    return engine.random_base2(int(np.ceil(np.log2(max(count, 1)))))[:count]


def saltelli_design(samples: int, size: int, seed: int) -> np.ndarray:
    """Return the points of Sobol's indices: A, B, then A with one column of B after the other, n(d + 2) in all.

    Parameters
    ----------
    samples : int
        Points in all, at most; n is the largest power of two with n(d + 2) within it.
    size : int
        Quantities d.
    seed : int
        Of the scramble.

    Returns
    -------
    ndarray
        Probabilities [-] between 0 and 1, shape (n(d + 2), d).

    Raises
    ------
    ConfigError
        Fewer than two points a block.
    """
    blocks = size + 2
    if samples < 2 * blocks:
        raise ConfigError(
            f"sampling 'saltelli' of {size} quantities needs at least {2 * blocks} samples, not {samples}"
        )
    count = 2 ** int(np.log2(samples // blocks))
    points = scipy.stats.qmc.Sobol(2 * size, rng=np.random.default_rng(seed)).random(count)
    first, second = points[:, :size], points[:, size:]
    mixed = [np.where(np.arange(size) == i, second, first) for i in range(size)]
    return np.concatenate([first, second, *mixed])


def _correlated(campaign: CampaignConfig, probability: np.ndarray) -> np.ndarray:
    """Return probabilities correlated through a Gaussian copula, in each group."""
    names = list(campaign.vary)
    for group in campaign.correlated:
        places = [names.index(name) for name in group.names]
        factor = np.linalg.cholesky(np.array(group.correlation))
        normal = scipy.stats.norm.ppf(probability[:, places]) @ factor.T
        probability[:, places] = scipy.stats.norm.cdf(normal)
    return probability


def _reached(campaign: CampaignConfig, parameters: list[Parameter], values: np.ndarray, origin: str) -> np.ndarray:
    """Return the least and the largest values, two rows: of a grid its own, else what is all but never passed.

    Bounds are checked against these and not against the draws, so that a file is right or wrong whatever its seed.
    """
    if campaign.sampling == "grid":
        return np.stack([values.min(axis=0), values.max(axis=0)])
    ends = np.array([NEVER, 1.0 - NEVER])
    columns = [
        _in_si(campaign, parameter, spread.quantile(ends), name, origin)
        for parameter, (name, spread) in zip(parameters, campaign.vary.items(), strict=True)
    ]
    return np.stack(columns, axis=1)


def _check_bounds(scenario: Scenario, parameters: list[Parameter], values: np.ndarray, origin: str) -> None:
    """Raise ConfigError where the scenario's own bounds forbid the least or the largest value of a quantity."""
    for i, parameter in enumerate(parameters):
        for extreme in (values[:, i].min(), values[:, i].max()):
            if not np.isfinite(extreme):
                raise ConfigError(
                    f"{origin}: vary.{parameter.name}: a value drawn is {extreme}; check its distribution"
                )
            try:
                check_values(scenario, [parameter], [float(extreme)])
            except ConfigError as error:
                raise ConfigError(
                    f"{origin}: vary.{parameter.name} reaches {extreme:g} {parameter.unit}: {error}"
                ) from error
