"""Small dense linear algebra that stays inside a few compiled kernels. Depends on nothing."""

from functools import partial

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float


def inverse3(matrix: Float[Array, "3 3"]) -> Float[Array, "3 3"]:
    """Return the inverse of a 3×3 matrix by cross products of its rows; unit is the reciprocal of the matrix's.

    Notes
    -----
    The columns of the adjugate are the cross products of the rows; one division by the determinant.
    """
    first, second, third = matrix
    adjugate = jnp.stack([jnp.cross(second, third), jnp.cross(third, first), jnp.cross(first, second)], axis=1)
    return adjugate / jnp.sum(first * adjugate[:, 0])


@partial(jax.jit, inline=True)
def solve_symmetric(matrix: Float[Array, "6 6"], right: Float[Array, "6"]) -> Float[Array, "6"]:
    """Return x with M x = b for a symmetric positive definite mass matrix; units follow from M and b.

    Parameters
    ----------
    matrix : Float[Array, "6 6"]
        M = [[A, Bᵀ], [B, C]]; its upper right block is not read.
    right : Float[Array, "6"]
        b = (f, m).

    Notes
    -----
    Block elimination: with the Schur complement S = C − B A⁻¹ Bᵀ, ω̇ = S⁻¹ (m − B A⁻¹ f), v̇ = A⁻¹ (f − Bᵀ ω̇). It
    needs two divisions where a factorisation element by element needs twenty, and unlike a LAPACK call it fuses
    with its surroundings and vectorises over a batch. Like every closed-form inverse it loses digits as the square
    of the condition number; that of a ship's 3×3 blocks, in SI, is below 100.
    """
    lower = matrix[3:, :3]
    inverse = inverse3(matrix[:3, :3])
    coupling = lower @ inverse
    schur = matrix[3:, 3:] - coupling @ lower.T
    angular = inverse3(schur) @ (right[3:] - coupling @ right[:3])
    linear = inverse @ (right[:3] - lower.T @ angular)
    return jnp.concatenate([linear, angular])
