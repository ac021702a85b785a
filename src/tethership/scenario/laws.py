"""From validated gains to the laws in force. Depends on: control, scenario.schema."""

from functools import partial

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.control import (
    AbstractLaw,
    AttitudeLaw,
    HeadingLaw,
    LayeredLaw,
    LineHeadingLaw,
    LineOfSightNavigationLaw,
    NavigationLaw,
    RewindLaw,
    SineHeadingLaw,
)
from tethership.scenario.control_schema import Share, Table
from tethership.scenario.schema import ScenarioConfig

HEADING = {"full": HeadingLaw, "sine": SineHeadingLaw, "line": LineHeadingLaw}
"""Heading laws by the angle that a file names."""

NAVIGATION = {"along_nose": NavigationLaw, "line_of_sight": LineOfSightNavigationLaw}
"""Navigation laws by the range that a file names."""


def build_law(config: ScenarioConfig) -> LayeredLaw:
    """Return the layers of a scenario, SAS/attitude first, in their order; their corrections are added."""
    control = config.control
    arguments = partial(_arguments, config)
    laws: dict[str, AbstractLaw] = {}
    if control.sas:
        laws["attitude"] = AttitudeLaw(**arguments(control.attitude))
    makers = {
        "rewind": (RewindLaw, control.rewind),
        "heading": (HEADING[control.heading.angle], control.heading),
        "navigation": (NAVIGATION[control.navigation.range], control.navigation),
    }
    for name in control.layers:
        kind, gains = makers[name]
        laws[name] = kind(**arguments(gains))
    return LayeredLaw(tuple(laws.values()), tuple(laws))


def _arguments(config: ScenarioConfig, gains: Table) -> dict[str, Array]:
    """Return the gains as arrays, shares in the order of the vehicle's thrusters; words are no gains."""
    numbers = {key: value for key, value in gains if not isinstance(value, str)}
    return {
        key: _shares(value, config) if isinstance(value, dict) else jnp.asarray(value) for key, value in numbers.items()
    }


def _shares(shares: Share, config: ScenarioConfig) -> Float[Array, "thrusters"]:
    """Return throttle per unit of demand of every thruster."""
    thrusters = config.vehicle.thrusters
    throttle = jnp.asarray([shares.get(thruster.name, 0.0) for thruster in thrusters], dtype=float)
    unit = config.control.gain_thrust
    if unit is None:
        return throttle
    return throttle * unit / jnp.asarray([thruster.nominal_thrust for thruster in thrusters], dtype=float)
