"""How a docking flight may differ from its plan: attitude at the start, instant of the gust, wind.

Depends on: scipy, scenario.
"""

from typing import NamedTuple

import numpy as np
import scipy.stats

from tethership.errors import ConfigError
from tethership.scenario import Scenario


class Spread(NamedTuple):
    """Half widths of uniform distributions about the scenario's own values.

    Attributes
    ----------
    attitude : float
        Of each angle at the start [rad].
    gust_start : float
        Of the first gust's beginning [s].
    wind : float
        Of the wind's speed, as a share of it [-]; the gust, a fraction of the wind, moves along.
    """

    attitude: float = np.radians(2.0)
    gust_start: float = 1.0
    wind: float = 0.03


def perturbed(scenario: Scenario, count: int, seed: int, spread: Spread | None = None) -> dict[str, np.ndarray]:
    """Return columns of parameters (`Cases.with_columns`) for many flights beside a scenario's own.

    Parameters
    ----------
    scenario : Scenario
        With a gust.
    count : int
        Flights.
    seed : int
        The same seed gives the same flights; they are a scrambled Sobol sequence, so evenly spread.
    spread : Spread, optional
        How far.

    Returns
    -------
    dict[str, ndarray]
        `start.attitude_offset` of φ, θ, ψ [rad], `gusts.0.start` [s], not below 0, and `wind.speed` [m/s], each of
        shape (count,).

    Raises
    ------
    ConfigError
        The scenario has no gust.
    """
    spread = spread or Spread()
    config = scenario.config
    if not config.gusts:
        raise ConfigError(f"scenario {scenario.name} has no gust whose start could be moved; add [[gusts]]")
    generator = scipy.stats.qmc.Sobol(5, rng=np.random.default_rng(seed))
    points = 2.0 * generator.random_base2(int(np.ceil(np.log2(max(count, 2)))))[:count] - 1.0
    angles = {
        f"start.attitude_offset.{i}": config.start.attitude_offset[i] + spread.attitude * points[:, i] for i in range(3)
    }
    return {
        **angles,
        "gusts.0.start": np.maximum(config.gusts[0].start + spread.gust_start * points[:, 3], 0.0),
        "wind.speed": config.wind.speed * (1.0 + spread.wind * points[:, 4]),
    }
