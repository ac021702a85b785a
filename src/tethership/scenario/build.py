"""From a validated scenario to the plant. Depends on: plant, physics, scenario.schema, scenario.build_ship.

Everything is written with jax.numpy, so that a plant can be differentiated with respect to its numbers.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.physics import AbstractAnchorMotion, HarmonicMotion, SteadyMotion, Winch
from tethership.physics.cable import AbstractTensionLaw, CableLoad, ElasticCatenary, PublishedTension
from tethership.plant import Cable, PartNames, TetheredAirship
from tethership.scenario.build_air import build_environment
from tethership.scenario.build_ship import build_actuators, build_hull, build_ship, slice_integrals
from tethership.scenario.own_code import make_line, make_part
from tethership.scenario.own_schema import OwnLine
from tethership.scenario.schema import (
    AnchorMotionConfig,
    CableConfig,
    HarmonicMotionConfig,
    ScenarioConfig,
    SteadyMotionConfig,
)

__all__ = ["assemble", "build_environment", "build_hull", "build_ship", "build_system", "slice_integrals"]


def _cable(config: CableConfig, formulation: str, shift: Float[Array, "3"]) -> Cable:
    return Cable(
        tether_point=jnp.asarray(config.tether_point) - shift,
        anchor=jnp.asarray(config.anchor),
        length=jnp.asarray(config.length),
        breaking_force=jnp.asarray(config.breaking_force),
        load=CableLoad(
            jnp.asarray(config.diameter),
            jnp.asarray(config.linear_density),
            jnp.asarray(config.cross_flow_drag_coefficient),
            jnp.asarray(config.longitudinal_drag_coefficient),
        ),
        law=_line(config, formulation),
        winch=Winch(jnp.asarray(config.winch.rewind_rate), jnp.asarray(config.winch.fastest_rate)),
        load_reference=jnp.asarray(config.load_reference),
        motion=_motion(config.anchor_motion),
    )


def _line(config: CableConfig, formulation: str) -> AbstractTensionLaw:
    """Return the model of a cable's line."""
    if isinstance(config.line, OwnLine):
        return make_line(config.line, config)
    if config.line_model(formulation) == "published":
        return PublishedTension(*map(jnp.asarray, (config.stiffness, config.joint_start, config.joint_end)))
    return ElasticCatenary(jnp.asarray(config.stiffness))


def build_system(config: ScenarioConfig, reference_point: Float[Array, "3"] | None = None) -> TetheredAirship:
    """Return the plant of a scenario, SI and radians; can be traced.

    Parameters
    ----------
    config : ScenarioConfig
        A validated scenario.
    reference_point : Float[Array, "3"], optional
        P from the origin of the vehicle's body axes [m]; the origin itself if not given. All points of the ship are
        then counted from P, and the origin from there is the plant's `origin`.
    """
    shift = jnp.zeros(3) if reference_point is None else jnp.asarray(reference_point)
    return TetheredAirship(
        ship=build_ship(config.vehicle, config.formulation, shift),
        environment=build_environment(config),
        cables=tuple(_cable(cable, config.formulation, shift) for cable in config.cables),
        thrusters=build_actuators(config.vehicle.thrusters),
        surfaces=build_actuators(config.vehicle.fins),
        parts=tuple(make_part(part, len(config.cables)) for part in config.vehicle.parts),
        origin=-shift,
        names=part_names(config),
    )


def part_names(config: ScenarioConfig) -> PartNames:
    """Return the names of thrusters, fins, cables and parts."""
    parts = (config.vehicle.thrusters, config.vehicle.fins, config.cables, config.vehicle.parts)
    return PartNames(*(tuple(part.name for part in group) for group in parts))


def _motion(config: AnchorMotionConfig | None) -> AbstractAnchorMotion | None:
    """Return how an anchor moves; None where it stands still."""
    match config:
        case None:
            return None
        case SteadyMotionConfig():
            return SteadyMotion(jnp.asarray(config.velocity))
        case HarmonicMotionConfig():
            return HarmonicMotion(*map(jnp.asarray, (config.amplitude, config.period, config.phase)))


@kept
def _compiled(config: ScenarioConfig, reference_point: Float[Array, "3"]) -> TetheredAirship:
    return build_system(config, reference_point)


def assemble(config: ScenarioConfig, reference_point: Float[Array, "3"] | None = None) -> TetheredAirship:
    """Return the plant of a scenario by one compiled call, the same program for every value of its numbers.

    Parameters
    ----------
    config : ScenarioConfig
        A validated scenario.
    reference_point : Float[Array, "3"], optional
        P from the origin of the vehicle's body axes [m]; the origin itself if not given.
    """
    shift = jnp.zeros(3) if reference_point is None else jnp.asarray(reference_point, dtype=float)
    return _compiled(config.as_arrays(), shift)
