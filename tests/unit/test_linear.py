"""The small symmetric solver against numpy's LU.

Truth: an independent algorithm (LAPACK with pivoting) on the same systems, and the textbook derivative of a
solution.
If this fails, the accelerations of the ship are wrong whatever the loads are.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership.spatial import solve_symmetric

BATCH = 500


def _systems(decades, seed=0, size=6):
    """Return positive definite matrices of a condition number of up to 10^decades, and right-hand sides."""
    rng = np.random.default_rng(seed)
    basis, _ = np.linalg.qr(rng.normal(size=(BATCH, size, size)))
    values = 10.0 ** rng.uniform(0.0, decades, (BATCH, size))
    matrices = np.einsum("bij,bj,bkj->bik", basis, values, basis)
    return 0.5 * (matrices + matrices.transpose(0, 2, 1)), rng.normal(size=(BATCH, size))


@pytest.mark.parametrize("decades", [1, 4])
def test_equals_numpy(decades):
    matrices, rights = _systems(decades)
    found = jax.jit(jax.vmap(solve_symmetric))(matrices, rights)
    expected = np.linalg.solve(matrices, rights[..., None])[..., 0]
    error = np.linalg.norm(found - expected, axis=1) / np.linalg.norm(expected, axis=1)
    # forward error of a stable solver: condition number times rounding, times the size
    assert error.max() < 10.0**decades * 1e-14


def test_solves_a_ship_sized_system():
    # Masses of 140 kg beside inertias of 3 000 kg m2 and static moments of 60 kg m, as in Table 2 of the
    # paper.
    mass, z_g = 136.8, 0.455
    matrix = np.diag([145.0, 250.0, 250.0, 214.0, 4570.0, 4470.0])
    matrix[0, 4] = matrix[4, 0] = mass * z_g
    matrix[1, 3] = matrix[3, 1] = -mass * z_g
    matrix[3, 5] = matrix[5, 3] = -88.0
    right = np.array([10.0, -3.0, 17.0, 1.0, 80.0, -5.0])
    np.testing.assert_allclose(
        matrix @ np.asarray(solve_symmetric(jnp.array(matrix), jnp.array(right))), right, rtol=1e-13
    )  # condition number 50


def test_does_not_read_the_upper_right_block():
    # A mass matrix is given by its lower half; the coupling of force and rates is not asked for twice.
    matrices, rights = _systems(2)
    spoiled = matrices.copy()
    spoiled[:, :3, 3:] = 1e6
    np.testing.assert_array_equal(
        jax.vmap(solve_symmetric)(spoiled, rights), jax.vmap(solve_symmetric)(matrices, rights)
    )


def test_derivative_is_the_textbooks():
    # dx = M^-1 (db - dM x)
    matrices, rights = _systems(2)
    rng = np.random.default_rng(1)
    change = rng.normal(size=matrices.shape)
    change = change + change.transpose(0, 2, 1)
    right_change = rng.normal(size=rights.shape)
    solution, tangent = jax.vmap(lambda m, b, dm, db: jax.jvp(solve_symmetric, (m, b), (dm, db)))(
        matrices, rights, change, right_change
    )
    moved = right_change - np.einsum("bij,bj->bi", change, solution)
    expected = np.linalg.solve(matrices, moved[..., None])[..., 0]
    error = np.linalg.norm(tangent - expected, axis=1) / np.linalg.norm(expected, axis=1)
    assert error.max() < 1e-11  # the condition number (100) twice, times rounding
