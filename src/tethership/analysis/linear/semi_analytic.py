"""The paper's semi-analytic route to the linear model: Eqs. 26–39 of Riboldi et al., misprints mended.

Depends on: analysis.linear.right_side, plant, spatial. An independent second route: the left sides and the kinematics
are differentiated by hand, only the loads by JAX, one by one. It holds at an equilibrium, where ẇ = 0.

    M̃ Δṡ + K̃ Δs = W̃ₛ Δs + W̃_δ Δδ,     A = M̃⁻¹(W̃ₛ − K̃),     U = M̃⁻¹ W̃_δ                       (36, 39)

Mended: in Eqs. 27 and 37 the second term is −C(Mⁱw₀) with C(h) = [[0, p×], [p×, H×]] for h = (p, H), not −(Mⁱw₀)×
with the operator of Eq. 4: Δw × Mⁱw₀ = (Δω × p, Δv × p + Δω × H). The sensitivities of Eq. 34 are in body axes.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.linear.right_side import loads
from tethership.plant import State, TetheredAirship, mass_matrix
from tethership.spatial import euler_rate_matrix, rotation_matrix, skew

GROUPS = {
    "apparent_mass": "a",
    "envelope": "a",
    "fins": "a",
    "buoyancy": "b",
    "thrust": "p",
    "gravity": "g",
}
"""The paper's letter of each load: aerodynamics a (Kirchhoff's terms too), buoyancy b, propulsion p, gravity g; every
cable is t."""


class SemiAnalytic(NamedTuple):
    """The matrices of Eqs. 36–38.

    Attributes
    ----------
    mass : Float[Array, "12 12"]
        M̃: Mⁱ + Mᵃ about P, body axes [kg, kg m, kg m²], then ones [-] for the kinematics.
    stiffness : Float[Array, "12 12"]
        K̃: of the motion's rows [N, N m] per unit of each state, of the kinematics' [rad/s, m/s] per unit of each.
    state_sensitivity : dict[str, Float[Array, "6 12"]]
        W_s of each load by the paper's letter a, b, p, g, t: change of its force and moment about P, body axes
        [N, N m], per unit of each state.
    input_sensitivity : dict[str, Float[Array, "6 inputs"]]
        W_δ likewise [N, N m], per unit of each input.
    """

    mass: Float[Array, "12 12"]
    stiffness: Float[Array, "12 12"]
    state_sensitivity: dict[str, Float[Array, "6 12"]]
    input_sensitivity: dict[str, Float[Array, "6 inputs"]]

    def state_matrix(self) -> np.ndarray:
        """Return A = M̃⁻¹(W̃ₛ − K̃), shape (12, 12): [1/s] on the diagonal, else [state unit/s per state unit]."""
        return np.linalg.solve(np.asarray(self.mass), _stacked(self.state_sensitivity) - np.asarray(self.stiffness))

    def input_matrix(self) -> np.ndarray:
        """Return U = M̃⁻¹ W̃_δ [state unit/s per input unit], shape (12, inputs): e.g. [m/s²] over a throttle [-]."""
        return np.linalg.solve(np.asarray(self.mass), _stacked(self.input_sensitivity))


def _stacked(parts: dict[str, Float[Array, "6 n"]]) -> np.ndarray:
    """Return the sum of the loads over six rows of zeros (Eq. 38)."""
    total = sum(np.asarray(part) for part in parts.values())
    return np.vstack([total, np.zeros_like(total)])


def euler_sensitivity(attitude: Float[Array, "3"], rates: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """Return P of Eq. 29: the change of the Euler rates with φ, θ, ψ [1/s] for attitude [rad] and ω [rad/s]."""
    phi, theta, _ = attitude
    _, q, r = rates
    s_phi, c_phi, tangent, secant = jnp.sin(phi), jnp.cos(phi), jnp.tan(theta), 1.0 / jnp.cos(theta)
    across, along = q * s_phi + r * c_phi, q * c_phi - r * s_phi
    zero = jnp.zeros_like(phi)
    return jnp.array(
        [
            [tangent * along, secant**2 * across, zero],
            [-across, zero, zero],
            [secant * along, secant * tangent * across, zero],
        ]
    )


def inertial_stiffness(
    mass: Float[Array, "6 6"], velocity: Float[Array, "3"], rates: Float[Array, "3"]
) -> Float[Array, "6 6"]:
    """Return w₀× Mⁱ − C(Mⁱw₀), the change of w × Mⁱw (Eqs. 26, 27, 37 mended).

    Parameters
    ----------
    mass : Float[Array, "6 6"]
        Mⁱ about P, body axes [kg, kg m, kg m²].
    velocity, rates : Float[Array, "3"]
        v₀ [m/s], ω₀ [rad/s], body axes.
    """
    momentum = mass @ jnp.concatenate([velocity, rates])
    linear, angular = skew(momentum[:3]), skew(momentum[3:])
    zero = jnp.zeros((3, 3))
    turning = jnp.block([[skew(rates), zero], [skew(velocity), skew(rates)]])
    return turning @ mass - jnp.block([[zero, linear], [linear, angular]])


def _stiffness(plant: TetheredAirship, state: State) -> Float[Array, "12 12"]:
    """Return K̃ of Eq. 37."""
    to_euler = euler_rate_matrix(state.attitude)
    from_euler = jnp.linalg.inv(to_euler)
    rotation = rotation_matrix(state.attitude)
    zero = jnp.zeros((3, 3))
    top = inertial_stiffness(plant.ship.body.mass_matrix(), state.velocity, state.rates)
    kinematics = jnp.block(
        [
            [zero, -to_euler, -euler_sensitivity(state.attitude, state.rates), zero],
            [-rotation, zero, rotation @ skew(state.velocity) @ from_euler, zero],
        ]
    )
    return jnp.vstack([jnp.hstack([top, jnp.zeros((6, 6))]), kinematics])


@kept
def semi_analytic(plant: TetheredAirship, state: Float[Array, "12"], inputs: Float[Array, "inputs"]) -> SemiAnalytic:
    """Return mass, stiffness and sensitivity matrices at an equilibrium.

    Parameters
    ----------
    plant : TetheredAirship
    state : Float[Array, "12"]
        Reference state s₀ in the order of `STATE_NAMES` [m/s, rad/s, rad, m].
    inputs : Float[Array, "inputs"]
        Reference inputs, as `input_vector` returns them: throttles [-], deflections [rad], wind [m/s, m/s²], L_t [m].
    """
    here = State.from_vector(state)

    def by_name(together: Float[Array, "n"]) -> dict[str, Float[Array, "6"]]:
        return loads(plant, together[:12], together[12:])

    slopes = jax.jacfwd(by_name)(jnp.concatenate([state, inputs]))
    total = mass_matrix(here, plant.ship, plant.environment)
    mass = jnp.eye(12).at[:6, :6].set(total)
    groups = _grouped(slopes)
    by_state = {letter: slope[:, :12] for letter, slope in groups.items()}
    by_input = {letter: slope[:, 12:] for letter, slope in groups.items()}
    return SemiAnalytic(mass, _stiffness(plant, here), by_state, by_input)


def _grouped(by_load: dict[str, Float[Array, "6 n"]]) -> dict[str, Float[Array, "6 n"]]:
    """Return the loads' sensitivities added up by the paper's letters."""
    groups: dict[str, Float[Array, "6 n"]] = {}
    for name, matrix in by_load.items():
        letter = GROUPS.get(name, "t")
        groups[letter] = groups[letter] + matrix if letter in groups else matrix
    return groups
