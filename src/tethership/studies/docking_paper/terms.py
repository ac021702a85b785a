"""Which terms matter: loads over a flight, and its peak tension with each term of the model switched off.

Depends on: simulation, analysis, campaign, scenario, physics. A term goes by numbers of the scenario set to zero, and
where no number does it by a weight in the plant (`PARTS`), so that one compiled program flies them all.
"""

import dataclasses
from collections.abc import Collection, Sequence
from fnmatch import fnmatchcase
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership.analysis import TrimOutcome, trim
from tethership.campaign import SWITCHES, layer_switches
from tethership.errors import ConfigError, SolveError, suggestion
from tethership.physics import AbstractApparentMass, AbstractAtmosphere, AbstractEnvelope
from tethership.results import mean
from tethership.scenario import Scenario, check_layers, list_parameters, scenario_at
from tethership.simulation import Flight, dock
from tethership.spatial import Wrench

PARTS = {
    "inertia": "−Mᵃ ẇ and, in `consistent`, what the air's own motion adds to it",
    "kirchhoff_translation": "−v_a × (M₁₁ v_a) of Kirchhoff's equations; `consistent` only",
    "kirchhoff_rotation": "Kirchhoff's quadratic terms with ω; `consistent` only",
    "pressure": "the pressure gradient of accelerating air, ρ𝒱 Dv_w/Dt; `consistent` only",
    "slices_translation": "the envelope's potential load at ω = 0",
    "slices_rotation": "what ω adds to the envelope's potential load",
    "density_change": "the departure of the density from that at the height of the ground frame's origin",
}
"""Parts of the plant that have a weight: 1 acts, 0 does not."""

TERMS: dict[str, tuple[str, ...]] = {
    "apparent_mass_inertia": ("parts.inertia",),
    "apparent_mass_quadratic": ("parts.kirchhoff_translation", "parts.kirchhoff_rotation"),
    "hull_potential": tuple(f"parts.{name}" for name in PARTS if name.startswith(("kirchhoff", "slices"))),
    "hull_munk_moment": ("parts.kirchhoff_translation", "parts.slices_translation"),
    "hull_potential_rotation": ("parts.kirchhoff_rotation", "parts.slices_rotation"),
    "air_pressure_gradient": ("parts.pressure",),
    "hull_cross_flow_drag": ("vehicle.envelope.cross_flow_drag_coefficient",),
    "hull_axial_drag": ("vehicle.envelope.axial_drag_coefficient",),
    "fin_lift": ("vehicle.fins.*.lift_slope",),
    "fin_cross_flow_drag": ("vehicle.fins.*.cross_flow_drag_coefficient",),
    "fin_friction": ("vehicle.fins.*.axial_drag_coefficient",),
    "cable_drag": ("cables.*.cross_flow_drag_coefficient", "cables.*.longitudinal_drag_coefficient"),
    "cable_weight": ("cables.*.linear_density",),
    "density_change": ("parts.density_change",),
    "net_weight": ("vehicle.body.mass",),
    "gust": ("gusts.*.fraction", "gusts.*.speed"),
    "sas": ("control.attitude.*_gain",),
}
"""What can be switched off: patterns of the parameters set to zero, `parts.` of `PARTS`.

`hull_potential` is the hull's quasi-steady ideal-flow load by either formulation: the slices, and in `consistent` with
Kirchhoff's quadratic terms, which the slices correct; `hull_munk_moment` is what is left of it without rotation.
`apparent_mass_quadratic` takes Kirchhoff's alone, so that the slices correct what is not there. `cable_drag` leaves a
cable of weight alone, `cable_weight` one of drag alone. `net_weight` is not zero mass, but that of the displaced air.
"""

NUDGES = {"+1 %": 1.01, "-1 %": 0.99}
"""Factors of the start's attitude offset for the flights that show how sensitive the full one is [-]."""


class WeightedApparentMass(eqx.Module):
    """An apparent mass with its parts weighted.

    Attributes
    ----------
    base : AbstractApparentMass
    weights : dict of str to Float[Array, ""]
        Weight of each of `PARTS` [-]: 1 acts, 0 does not.
    """

    base: AbstractApparentMass
    weights: dict[str, Float[Array, ""]]

    def matrix(self) -> Float[Array, "6 6"]:
        """Return the weighted Mᵃ/ρ about P, body axes [m³, m⁴, m⁵]."""
        return self.weights["inertia"] * self.base.matrix()

    def wrench(self, density: Array, air_velocity: Array, rates: Array, *air: Array) -> Wrench:
        """Return the weighted wrench about P [N, N m]; arguments as in `AbstractApparentMass.wrench`.

        The load is a sum of terms in (v_a, ω), in the wind and its rate, and in the air's acceleration: each is the
        load itself with the other arguments zero.
        """
        none = jnp.zeros(3)
        whole = self.base.wrench(density, air_velocity, rates, *air)
        still = self.base.wrench(density, air_velocity, none, none, none, none).as_vector()
        quadratic = self.base.wrench(density, air_velocity, rates, none, none, none).as_vector()
        pressure = self.base.wrench(density, none, none, none, none, air[-1]).as_vector()
        parts = {
            "inertia": whole.as_vector() - quadratic - pressure,
            "kirchhoff_translation": still,
            "kirchhoff_rotation": quadratic - still,
            "pressure": pressure,
        }
        return _weighed(whole, parts, self.weights)


class WeightedEnvelope(eqx.Module):
    """An envelope with its potential load weighted.

    Attributes
    ----------
    base : AbstractEnvelope
    weights : dict of str to Float[Array, ""]
        Weight of each of `PARTS` [-]: 1 acts, 0 does not.
    """

    base: AbstractEnvelope
    weights: dict[str, Float[Array, ""]]

    def wrench(self, density: Array, air_velocity: Array, rates: Array) -> Wrench:
        """Return the weighted wrench about P [N, N m]; arguments as in `AbstractEnvelope.wrench`."""
        ideal = density * self.base.munk_factor
        still = ideal * self.base.potential(air_velocity, jnp.zeros(3)).moved(self.base.centre).as_vector()
        turning = ideal * self.base.potential(air_velocity, rates).moved(self.base.centre).as_vector()
        parts = {"slices_translation": still, "slices_rotation": turning - still}
        return _weighed(self.base.wrench(density, air_velocity, rates), parts, self.weights)


class WeightedAtmosphere(AbstractAtmosphere):
    """Air with its change of density weighted.

    Attributes
    ----------
    base : AbstractAtmosphere
    weights : dict of str to Float[Array, ""]
        Weight of each of `PARTS` [-]: 1 acts, 0 does not.
    """

    base: AbstractAtmosphere
    weights: dict[str, Float[Array, ""]]

    def density(self, altitude: Float[Array, ""]) -> Float[Array, ""]:
        """Return ρ [kg/m³] at an altitude [m]."""
        there, origin = self.base.density(altitude), self.base.density(jnp.zeros_like(altitude))
        return there - (1.0 - self.weights["density_change"]) * (there - origin)


def _weighed(whole: Wrench, parts: dict[str, Array], weights: dict[str, Array]) -> Wrench:
    """Return a load less what the weights take from its parts, (f, m) each [N, N m]."""
    left = whole.as_vector() - sum((1.0 - weights[name]) * part for name, part in parts.items())
    return Wrench(left[:3], left[3:])


def weighted(scenario: Scenario, without: Collection[str] = ()) -> Scenario:
    """Return the scenario with some of `PARTS` taken out of its plant, weight 0 [-]; without none it flies as before.

    Its document still says the whole scenario: such a flight cannot be flown again from a file.
    """
    weights = {name: jnp.asarray(float(name not in without)) for name in PARTS}
    kinds = (WeightedApparentMass, WeightedEnvelope, WeightedAtmosphere)
    where = lambda plant: (plant.ship.apparent_mass, plant.ship.envelope, plant.environment.atmosphere)  # noqa: E731
    parts = tuple(kind(base, weights) for kind, base in zip(kinds, where(scenario.system), strict=True))
    return dataclasses.replace(scenario, system=eqx.tree_at(where, scenario.system, parts))


def switched_off(scenario: Scenario, term: str) -> Scenario | None:
    """Return the scenario without one of `TERMS`, None where it has no such term.

    Numbers are set to zero, but for `net_weight`, whose mass is that of the displaced air at the origin, ρ𝒱 [kg].

    Raises
    ------
    ConfigError
        There is no such term.
    """
    if term not in TERMS:
        raise ConfigError(f"no term {term!r}{suggestion(term, TERMS)} Known: {', '.join(TERMS)}")
    parts = {name for name in PARTS if f"parts.{name}" in TERMS[term]}
    if scenario.formulation == "published":
        parts -= {"kirchhoff_translation", "kirchhoff_rotation", "pressure"}
    plant = scenario.system
    floating = float(plant.environment.density_at(jnp.zeros(3)) * plant.ship.buoyancy.volume)
    changes = {
        name: floating if term == "net_weight" else 0.0
        for name, parameter in list_parameters(scenario.config).items()
        if "*" not in name and parameter.value != 0.0 and any(fnmatchcase(name, pattern) for pattern in TERMS[term])
    }
    return weighted(scenario_at(scenario, changes), parts) if parts or changes else None


def switch_off(
    scenario: Scenario, layers: Sequence[str], terms: Collection[str] = tuple(TERMS), unbreakable: bool = False
) -> list[dict[str, Any]]:
    """Return the full flight, the flight without each of `terms`, and two that show how sensitive the full one is.

    Parameters
    ----------
    scenario : Scenario
        With at least one cable.
    layers : sequence of str
        Control layers that act, besides SAS.
    terms : collection of str
        Of `TERMS`.
    unbreakable : bool
        Let a flight go on beyond the cable's breaking force; else its peak is only a lower bound (`cable_broken`).

    Notes
    -----
    Every flight is trimmed anew. A row has `term`, `outcome`, `peak_tension` [N] at the tether point and its `ratio` to
    the full flight's, `docking_time` [s], `theta_rms` [deg], `trim_tension` [N]; numbers are None where there are none.
    Besides a flight's outcomes there are `absent` (the scenario has no such term), `no_equilibrium` and `saturated` (of
    the trim) and `no_start`. The last rows, `chaos floor`, are the whole model from an attitude moved by `NUDGES`: a
    smaller change of the peak says nothing of a term.
    """
    strong = {f"cables.{cable.name}.breaking_force": 1e12 for cable in scenario.config.cables if unbreakable}
    acting = scenario.changed({"control.layers": list(SWITCHES), **strong})
    flown = scenario_at(acting, layer_switches(acting, check_layers(layers)))
    variants = {"full": weighted(flown), **{term: switched_off(flown, term) for term in terms}}
    for name, factor in NUDGES.items():
        offset = [factor * angle for angle in flown.config.start.attitude_offset]
        variants[f"chaos floor {name}"] = weighted(flown.changed({"start.attitude_offset": offset}))
    rows = [{"term": name, **_flown(variant)} for name, variant in variants.items()]
    full = rows[0]["peak_tension"]
    return [{**row, "ratio": row["peak_tension"] / full if full and row["peak_tension"] else None} for row in rows]


def _flown(scenario: Scenario | None) -> dict[str, Any]:
    """Return outcome and numbers of a scenario's flight from its trim."""
    row: dict[str, Any] = dict.fromkeys(("outcome", "peak_tension", "docking_time", "theta_rms", "trim_tension"))
    if scenario is None:
        return {**row, "outcome": "absent"}
    point = trim(scenario)
    if point.outcome is not TrimOutcome.converged:
        return {**row, "outcome": point.outcome.name}
    row["trim_tension"] = float(point.tension.max())
    try:
        flight = dock(scenario, point)
    except ConfigError:  # over before it begins
        return {**row, "outcome": "no_start"}
    if flight.outcome.is_answer:
        row |= {"peak_tension": flight.metrics["tension_max"], "theta_rms": flight.metrics["theta_rms"]}
        row["docking_time"] = flight.docking_time
    return {**row, "outcome": flight.outcome.name}


def load_breakdown(flight: Flight) -> dict[str, Any]:
    """Return how large each load is over a flight, as plain numbers; raises SolveError if it has no sample.

    `time_of_peak` [s] and `peak_tension` [N] are those of the samples (the first, and zero, without a cable). Under
    `force` [N] and `moment` [N m] (about P) stand the `rms` and `peak` of each load, its `share` of the summed rms [-]
    and its components `at_peak_tension`, body axes. Gravity and buoyancy nearly cancel: in the sum `net_weight`, which
    is both, stands for them, and they have no share of their own.
    """
    time = flight.data["time"].to_numpy()
    if not len(time):
        raise SolveError("the flight has no sample to break down: it diverged at its start")
    pull = flight.data["tension"].to_numpy().max(axis=1, initial=0.0)
    peak = int(pull.argmax())
    names = [str(name) for name in flight.data["load"].values]
    found: dict[str, Any] = {"time_of_peak": float(time[peak]), "peak_tension": float(pull[peak])}
    for kind in ("force", "moment"):
        loads = {name: flight.data[f"load_{kind}"].sel(load=name).to_numpy() for name in names}
        loads["net_weight"] = loads["gravity"] + loads["buoyancy"]
        size = {name: np.linalg.norm(load, axis=1) for name, load in loads.items()}
        rms = {name: float(np.sqrt(mean(time, value**2))) for name, value in size.items()}
        alone = {name: value for name, value in rms.items() if name not in ("gravity", "buoyancy")}
        found[kind] = {
            name: {
                "rms": rms[name],
                "peak": float(size[name].max()),
                "share": rms[name] / sum(alone.values()) if name in alone else None,
                "at_peak_tension": load[peak].tolist(),
            }
            for name, load in loads.items()
        }
    return found
