"""From validated gains to the laws in force. Depends on: control, scenario.schema."""

from typing import Any

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
    Sampling,
    SineHeadingLaw,
)
from tethership.plant import Command
from tethership.scenario.control_schema import Share, Table
from tethership.scenario.own_code import make_law
from tethership.scenario.schema import ScenarioConfig

HEADING = {"full": HeadingLaw, "sine": SineHeadingLaw, "line": LineHeadingLaw}
"""Heading laws by the angle that a file names."""

NAVIGATION = {"along_nose": NavigationLaw, "line_of_sight": LineOfSightNavigationLaw}
"""Navigation laws by the range that a file names."""


LAWS = ("attitude", "rewind", "heading", "navigation")
"""The package's own laws, in the order in which their corrections are added."""


def build_law(config: ScenarioConfig, switched: bool = False) -> LayeredLaw:
    """Return the layers of a scenario, SAS/attitude first, in their order; their corrections are added.

    Parameters
    ----------
    config : ScenarioConfig
        A validated scenario.
    switched : bool
        All laws that the scenario could have, with a switch for each: one structure for every set of layers.
    """
    control = config.control
    acting = (("attitude",) if control.sas else ()) + control.layers
    names = LAWS if switched and config.cables else (("attitude",) if switched else acting)
    laws = tuple(_law(config, name) for name in names)
    switches = jnp.asarray([float(name in acting) for name in names]) if switched else None
    return LayeredLaw(laws, names, switches).joined({law.name: make_law(law) for law in control.laws})


def _law(config: ScenarioConfig, name: str) -> AbstractLaw:
    """Return one of the package's laws with a scenario's gains."""
    control = config.control
    kind, gains = {
        "attitude": (AttitudeLaw, control.attitude),
        "rewind": (RewindLaw, control.rewind),
        "heading": (HEADING[control.heading.angle], control.heading),
        "navigation": (NAVIGATION[control.navigation.range], control.navigation),
    }[name]
    return kind(**_arguments(config, gains))


def build_allocation(config: ScenarioConfig) -> dict[str, Command]:
    """Return the shares of all channels in the demands that laws of one's own may make, by the demand's name.

    A share is a throttle of each thruster [-] and a deflection of each fin [rad] per unit of demand. With `gain_thrust`
    F [N] given, throttles are times F over the thruster's own nominal thrust.
    """
    return {
        demand: Command(_shares(share, config), _fin_shares(share, config))
        for demand, share in config.control.allocation.items()
    }


def build_sampling(config: ScenarioConfig) -> Sampling | None:
    """Return the period T [s] at which the laws look and the delay d [s] until they act; None if continuous."""
    control = config.control
    if control.period is None:
        return None
    return Sampling(jnp.asarray(control.period), None if control.delay is None else jnp.asarray(control.delay))


def _arguments(config: ScenarioConfig, gains: Table) -> dict[str, Any]:
    """Return the gains as arrays, shares in the order of the vehicle's thrusters and fins; words are no gains."""
    numbers = {key: value for key, value in gains if not isinstance(value, str)}
    shares = {key: value for key, value in numbers.items() if isinstance(value, dict)}
    found: dict[str, Any] = {key: jnp.asarray(value) for key, value in numbers.items() if key not in shares}
    found |= {key: _shares(share, config) for key, share in shares.items()}
    fins = {fin.name for fin in config.vehicle.fins}
    turned = {key: _fin_shares(share, config) for key, share in shares.items() if fins & set(share)}
    return found | ({"fin_shares": turned} if turned else {})


def _fin_shares(shares: Share, config: ScenarioConfig) -> Float[Array, "fins"]:
    """Return deflection per unit of demand of every fin [rad]."""
    return jnp.asarray([shares.get(fin.name, 0.0) for fin in config.vehicle.fins], dtype=float)


def _shares(shares: Share, config: ScenarioConfig) -> Float[Array, "thrusters"]:
    """Return throttle per unit of demand of every thruster."""
    thrusters = config.vehicle.thrusters
    throttle = jnp.asarray([shares.get(thruster.name, 0.0) for thruster in thrusters], dtype=float)
    unit = config.control.gain_thrust
    if unit is None:
        return throttle
    return throttle * unit / jnp.asarray([thruster.nominal_thrust for thruster in thrusters], dtype=float)
