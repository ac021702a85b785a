"""From a validated scenario to the plant. Depends on: system, physics, scenario.schema, scenario.build_ship.

Everything is written with jax.numpy, so that a plant can be differentiated with respect to its numbers.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.atmosphere import AbstractAtmosphere, ConstantAtmosphere, StandardAtmosphere
from tethership.physics.cable import AbstractTensionLaw, CableLoad, ElasticCatenary, PublishedTension
from tethership.physics.ground_effect import GroundEffect
from tethership.physics.gust import AbstractGust, BareCosine, CosineGust, RepeatedCosine
from tethership.physics.winch import Winch
from tethership.physics.wind import AbstractWind, PowerLawWind, UniformWind
from tethership.scenario.build_ship import build_hull, build_ship, slice_integrals
from tethership.scenario.schema import (
    CableConfig,
    ConstantAir,
    GustConfig,
    PowerLawWindConfig,
    ScenarioConfig,
    UniformWindConfig,
)
from tethership.spatial import STANDARD_GRAVITY
from tethership.system import Cable, Environment, TetheredAirship

__all__ = ["assemble", "build_environment", "build_hull", "build_ship", "build_system", "slice_integrals"]


def direction_from(azimuth: Float[Array, ""], upward: Float[Array, ""] | float = 0.0) -> Float[Array, "3"]:
    """Return the unit vector, ground axes, of air that comes *from* an azimuth [rad] and rises at an angle [rad]."""
    level = jnp.cos(upward)
    return jnp.stack([-level * jnp.cos(azimuth), -level * jnp.sin(azimuth), -jnp.sin(jnp.asarray(upward))])


def _wind(config: UniformWindConfig | PowerLawWindConfig, ground: Float[Array, ""]) -> AbstractWind:
    velocity = config.speed * direction_from(jnp.asarray(config.from_direction))
    if isinstance(config, UniformWindConfig):
        return UniformWind(velocity)
    return PowerLawWind(
        velocity,
        jnp.asarray(config.reference_height),
        jnp.asarray(config.exponent),
        jnp.asarray(config.lowest_height),
        ground,
    )


GUSTS = {"one_minus_cosine": CosineGust, "repeated": RepeatedCosine, "cosine": BareCosine}
"""Gusts by the shape that a file names."""


def _gust(config: GustConfig, wind_speed: float) -> AbstractGust:
    peak = config.speed if config.fraction is None else config.fraction * wind_speed
    direction = direction_from(jnp.asarray(config.from_direction), jnp.asarray(config.upward_angle))
    return GUSTS[config.shape](jnp.asarray(peak) * direction, jnp.asarray(config.start), jnp.asarray(config.period))


def build_environment(config: ScenarioConfig) -> Environment:
    """Return air, wind, gusts and ground."""
    air: AbstractAtmosphere
    if isinstance(config.atmosphere, ConstantAir):
        air = ConstantAtmosphere(jnp.asarray(config.atmosphere.density))
    else:
        air = StandardAtmosphere(
            jnp.asarray(config.atmosphere.origin_altitude), jnp.asarray(config.atmosphere.temperature_offset)
        )
    height = config.ground.anchor_height
    ground = jnp.asarray(0.0 if height is None else height)
    effect = config.ground.effect_coefficient
    return Environment(
        gravity=jnp.array([0.0, 0.0, STANDARD_GRAVITY]),
        atmosphere=air,
        wind=_wind(config.wind, ground),
        gusts=tuple(_gust(gust, config.wind.speed) for gust in config.gusts),
        ground_effect=None if effect is None else GroundEffect(jnp.asarray(effect), ground),
        ground=ground,
    )


def _cable(config: CableConfig, formulation: str, shift: Float[Array, "3"]) -> Cable:
    law: AbstractTensionLaw
    if formulation == "published":
        law = PublishedTension(*map(jnp.asarray, (config.stiffness, config.joint_start, config.joint_end)))
    else:
        law = ElasticCatenary(jnp.asarray(config.stiffness))
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
        law=law,
        winch=Winch(jnp.asarray(config.winch.rewind_rate), jnp.asarray(config.winch.fastest_rate)),
        load_reference=jnp.asarray(config.load_reference),
    )


def build_system(config: ScenarioConfig, reference_point: Float[Array, "3"] | None = None) -> TetheredAirship:
    """Return the plant of a scenario; `reference_point` as in `build_ship`."""
    shift = jnp.zeros(3) if reference_point is None else jnp.asarray(reference_point)
    return TetheredAirship(
        ship=build_ship(config.vehicle, config.formulation, shift),
        environment=build_environment(config),
        cables=tuple(_cable(cable, config.formulation, shift) for cable in config.cables),
    )


@eqx.filter_jit
def _compiled(config: ScenarioConfig, reference_point: Float[Array, "3"]) -> TetheredAirship:
    return build_system(config, reference_point)


def assemble(config: ScenarioConfig, reference_point: Float[Array, "3"] | None = None) -> TetheredAirship:
    """Return the plant of a scenario by one compiled call, the same program for every value of its numbers.

    Parameters
    ----------
    config : ScenarioConfig
        A validated scenario.
    reference_point : Float[Array, "3"], optional
        As in `build_ship`.
    """
    shift = jnp.zeros(3) if reference_point is None else jnp.asarray(reference_point, dtype=float)
    return _compiled(config.as_arrays(), shift)
