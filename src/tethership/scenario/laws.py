"""From validated gains to the laws in force. Depends on: control, scenario.schema."""

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.control import (
    AbstractLaw,
    AttitudeLaw,
    HeadingLaw,
    LayeredLaw,
    NavigationLaw,
    RewindLaw,
)
from tethership.scenario.control_schema import Share, Table
from tethership.scenario.schema import ScenarioConfig


def build_law(config: ScenarioConfig) -> LayeredLaw:
    """Return the layers of a scenario, SAS/attitude first, in their order; their corrections are added."""
    thrusters = [thruster.name for thruster in config.vehicle.thrusters]
    control = config.control
    laws: dict[str, AbstractLaw] = {}
    if control.sas:
        laws["attitude"] = AttitudeLaw(**_arguments(control.attitude, thrusters))
    makers = {
        "rewind": (RewindLaw, control.rewind),
        "heading": (HeadingLaw, control.heading),
        "navigation": (NavigationLaw, control.navigation),
    }
    for name in control.layers:
        kind, gains = makers[name]
        laws[name] = kind(**_arguments(gains, thrusters))
    return LayeredLaw(tuple(laws.values()), tuple(laws))


def _arguments(gains: Table, thrusters: list[str]) -> dict[str, Array]:
    """Return the gains as arrays, shares in the order of the vehicle's thrusters."""
    return {key: _shares(value, thrusters) if isinstance(value, dict) else jnp.asarray(value) for key, value in gains}


def _shares(shares: Share, thrusters: list[str]) -> Float[Array, "thrusters"]:
    return jnp.asarray([shares.get(name, 0.0) for name in thrusters], dtype=float)
