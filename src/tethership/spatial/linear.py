"""Small dense linear algebra that stays inside one compiled kernel. Depends on nothing."""

from functools import partial

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float


@partial(jax.jit, inline=True)
def solve_symmetric(matrix: Float[Array, "n n"], right: Float[Array, "n"]) -> Float[Array, "n"]:
    """Return x with M x = b for a symmetric positive definite M; units follow from M and b.

    Parameters
    ----------
    matrix : Float[Array, "n n"]
        M; only its lower triangle is read.
    right : Float[Array, "n"]
        b.

    Notes
    -----
    LDLᵀ written out for the few rows of a rigid body: no pivoting is needed, and unlike a LAPACK call it fuses
    with its surroundings and vectorises over a batch.
    """
    size = right.shape[0]
    lower: list[list[Array]] = [[] for _ in range(size)]
    pivots: list[Array] = []
    forward: list[Array] = []
    for i in range(size):
        row: list[Array] = []
        for j in range(i):
            rest = matrix[i, j] - sum(row[k] * lower[j][k] for k in range(j))
            row.append(rest)
        lower[i] = [row[k] / pivots[k] for k in range(i)]
        pivots.append(matrix[i, i] - sum(row[k] * lower[i][k] for k in range(i)))
        forward.append(right[i] - sum(lower[i][k] * forward[k] for k in range(i)))
    solution: list[Array] = [jnp.zeros(())] * size
    for i in reversed(range(size)):
        back = sum(lower[k][i] * solution[k] for k in range(i + 1, size))
        solution[i] = forward[i] / pivots[i] - back
    return jnp.stack(solution)
