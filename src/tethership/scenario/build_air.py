"""From a validated scenario to the air around the ship. Depends on: plant, physics, scenario's tables.

Written with jax.numpy, as `scenario.build` is.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics import (
    AbstractAtmosphere,
    AbstractGust,
    AbstractWind,
    BareCosine,
    ConstantAtmosphere,
    CosineGust,
    GroundEffect,
    LogarithmicWind,
    PowerLawWind,
    RepeatedCosine,
    StandardAtmosphere,
    UniformWind,
)
from tethership.physics.turbulence import (
    REFERENCE_HEIGHT,
    SPECTRA,
    AbstractFluctuation,
    Scales,
    low_altitude_scales,
    make_turbulence,
)
from tethership.plant import Environment
from tethership.scenario.schema import ConstantAir, ScenarioConfig
from tethership.scenario.wind_schema import (
    AnyWindConfig,
    GustConfig,
    LogarithmicWindConfig,
    MeasuredWindConfig,
    PowerLawWindConfig,
    TurbulenceConfig,
)
from tethership.spatial import STANDARD_GRAVITY, safe_norm


def direction_from(azimuth: Float[Array, ""], upward: Float[Array, ""] | float = 0.0) -> Float[Array, "3"]:
    """Return the unit vector, ground axes, of air that comes *from* an azimuth [rad] and rises at an angle [rad]."""
    level = jnp.cos(upward)
    return jnp.stack([-level * jnp.cos(azimuth), -level * jnp.sin(azimuth), -jnp.sin(jnp.asarray(upward))])


def build_wind(config: AnyWindConfig, ground: Float[Array, ""]) -> AbstractWind:
    """Return the mean wind; `ground` is the down coordinate of the ground [m]. A measured history has one mean."""
    velocity = config.speed * direction_from(jnp.asarray(config.from_direction))
    if isinstance(config, PowerLawWindConfig):
        reference, exponent, lowest = map(jnp.asarray, (config.reference_height, config.exponent, config.lowest_height))
        return PowerLawWind(velocity, reference, exponent, lowest, ground)
    if isinstance(config, LogarithmicWindConfig):
        return LogarithmicWind(velocity, jnp.asarray(config.reference_height), jnp.asarray(config.roughness), ground)
    return UniformWind(velocity)


def _gust(config: GustConfig, wind_speed: float) -> AbstractGust:
    peak = config.speed if config.fraction is None else config.fraction * wind_speed
    direction = direction_from(jnp.asarray(config.from_direction), jnp.asarray(config.upward_angle))
    vector, start, period = jnp.asarray(peak) * direction, jnp.asarray(config.start), jnp.asarray(config.period)
    if config.shape == "repeated":
        return RepeatedCosine(vector, start, period)
    if config.shape == "cosine":
        return BareCosine(vector, start, period)
    return CosineGust(vector, start, period, jnp.asarray(config.turn))


def _turbulence(
    config: TurbulenceConfig, wind: AbstractWind, ground: Float[Array, ""], hull_length: Float[Array, ""]
) -> AbstractFluctuation:
    """Return a record for the mean wind at 20 ft and at the height whose scales are used."""
    here, at_20_ft = (
        wind.velocity(jnp.stack([jnp.zeros(()), jnp.zeros(()), ground - height]))
        for height in (jnp.asarray(config.height), REFERENCE_HEIGHT)
    )
    scales = low_altitude_scales(jnp.asarray(config.height), safe_norm(at_20_ft))
    if config.lengths is not None and config.deviations is not None:
        scales = Scales(jnp.asarray(config.lengths), jnp.asarray(config.deviations))
    scales = scales._replace(deviation=jnp.asarray(config.intensity) * scales.deviation)
    averaged = hull_length if config.averaged else jnp.zeros(())
    return make_turbulence(SPECTRA[config.spectrum], scales, here, jnp.asarray(config.seed), averaged, config.gradients)


def _fluctuations(
    config: ScenarioConfig, wind: AbstractWind, ground: Float[Array, ""]
) -> tuple[AbstractFluctuation, ...]:
    """Return what the wind does about its mean."""
    found: list[AbstractFluctuation] = []
    if isinstance(config.wind, MeasuredWindConfig):
        from tethership.physics.turbulence import MeasuredHistory  # diffrax takes a quarter of a second to import

        velocities = jnp.asarray(config.wind.velocities) - wind.velocity(jnp.zeros(3))
        found.append(MeasuredHistory.through(jnp.asarray(config.wind.times), velocities))
    if config.turbulence is not None:
        length = jnp.asarray(config.vehicle.hull.length)
        found.append(_turbulence(config.turbulence, wind, ground, length))
    return tuple(found)


def _atmosphere(config: ScenarioConfig) -> AbstractAtmosphere:
    air = config.atmosphere
    if isinstance(air, ConstantAir):
        return ConstantAtmosphere(jnp.asarray(air.density))
    return StandardAtmosphere(jnp.asarray(air.origin_altitude), jnp.asarray(air.temperature_offset))


def ground_level(config: ScenarioConfig) -> Float[Array, ""]:
    """Return the down coordinate of the ground [m]: as the scenario gives it, else that of the lowest anchor."""
    if config.ground.anchor_height is not None:
        return jnp.asarray(config.ground.anchor_height)
    if not config.cables:
        return jnp.asarray(0.0)
    return jnp.max(jnp.stack([jnp.asarray(cable.anchor[2]) for cable in config.cables]))


def build_environment(config: ScenarioConfig) -> Environment:
    """Return air, wind, gusts, fluctuations and ground.

    Gravity is the standard one down [m/s²], the ground's down coordinate that of `ground_level` [m]; a gust given as a
    fraction [-] has that part of `wind.speed` [m/s] as its peak.
    """
    ground = ground_level(config)
    effect = config.ground.effect_coefficient
    wind = build_wind(config.wind, ground)
    return Environment(
        gravity=jnp.array([0.0, 0.0, STANDARD_GRAVITY]),
        atmosphere=_atmosphere(config),
        wind=wind,
        gusts=tuple(_gust(gust, config.wind.speed) for gust in config.gusts),
        fluctuations=_fluctuations(config, wind, ground),
        ground_effect=None if effect is None else GroundEffect(jnp.asarray(effect), ground),
        ground=ground,
    )
