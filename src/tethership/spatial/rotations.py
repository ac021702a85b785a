"""Rotations by 3-2-1 Euler angles, and norms whose gradient stays finite at zero. Depends on nothing."""

import jax.numpy as jnp
from jaxtyping import Array, Float


def rotation_matrix(attitude: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """Return the matrix R that takes body components to ground components.

    Parameters
    ----------
    attitude : Float[Array, "3"]
        Roll φ, pitch θ, yaw ψ [rad], 3-2-1 sequence.

    Returns
    -------
    Float[Array, "3 3"]
        R of Eq. 7 of Riboldi et al.: a_ground = R a_body, a_body = Rᵀ a_ground [-].
    """
    sine, cosine = jnp.sin(attitude), jnp.cos(attitude)
    s_phi, s_theta, s_psi = sine
    c_phi, c_theta, c_psi = cosine
    return jnp.array(
        [
            [
                c_theta * c_psi,
                s_phi * s_theta * c_psi - c_phi * s_psi,
                c_phi * s_theta * c_psi + s_phi * s_psi,
            ],
            [
                c_theta * s_psi,
                s_phi * s_theta * s_psi + c_phi * c_psi,
                c_phi * s_theta * s_psi - s_phi * c_psi,
            ],
            [-s_theta, s_phi * c_theta, c_phi * c_theta],
        ]
    )


def euler_rate_matrix(attitude: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """Return S⁻¹ of Eq. 6: Euler-angle rates from body rates, singular at θ = ±90°.

    Parameters
    ----------
    attitude : Float[Array, "3"]
        Roll φ, pitch θ, yaw ψ [rad].
    """
    phi, theta, _ = attitude
    s_phi, c_phi = jnp.sin(phi), jnp.cos(phi)
    return jnp.array(
        [
            [1.0, jnp.tan(theta) * s_phi, jnp.tan(theta) * c_phi],
            [0.0, c_phi, -s_phi],
            [0.0, s_phi / jnp.cos(theta), c_phi / jnp.cos(theta)],
        ]
    )


def euler_rates(attitude: Float[Array, "3"], rates: Float[Array, "3"]) -> Float[Array, "3"]:
    """Return the rates of φ, θ, ψ [rad/s] for body rates ω = (p, q, r) [rad/s] (Eq. 6)."""
    return euler_rate_matrix(attitude) @ rates


def body_rates(attitude: Float[Array, "3"], euler: Float[Array, "3"]) -> Float[Array, "3"]:
    """Return ω = (p, q, r) [rad/s] for rates of φ, θ, ψ [rad/s]: Eq. 6 the other way, regular everywhere."""
    phi, theta, _ = attitude
    s_phi, c_phi, s_theta, c_theta = jnp.sin(phi), jnp.cos(phi), jnp.sin(theta), jnp.cos(theta)
    roll, pitch, yaw = euler
    return jnp.stack(
        [
            roll - yaw * s_theta,
            pitch * c_phi + yaw * s_phi * c_theta,
            -pitch * s_phi + yaw * c_phi * c_theta,
        ]
    )


def skew(vector: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """Return the matrix of the cross product: skew(a) b = a × b, in the units and axes of a."""
    x, y, z = vector
    zero = jnp.zeros_like(x)
    return jnp.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]])


def safe_norm(vector: Float[Array, "n"]) -> Float[Array, ""]:
    """Return |a| with gradient zero, not NaN, at a = 0; same unit as a."""
    square = jnp.dot(vector, vector)
    nonzero = square > 0
    return jnp.where(nonzero, jnp.sqrt(jnp.where(nonzero, square, 1.0)), 0.0)


def horizontal_unit(rotation: Float[Array, "3 3"]) -> Float[Array, "2"]:
    """Return the unit vector (north, east) of the nose direction seen from above [-].

    Parameters
    ----------
    rotation : Float[Array, "3 3"]
        R, body to ground. A nose straight up or down gives the zero vector.
    """
    nose = rotation[:2, 0]
    length = safe_norm(nose)
    return nose / jnp.where(length > 0, length, 1.0)
