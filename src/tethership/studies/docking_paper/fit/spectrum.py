"""What the paper's spectra say about the unpublished numbers, differentiable. Depends on: analysis, scenario, JAX.

Claims L1 and L2 (free ship, 6 m/s): side-slip and vertical are real and mildly unstable, pendulum is mild, roll is
stable. The tables of section 4 and the spectra of section 3 are of one ship: a fit has to weigh both.
"""

import itertools
from collections.abc import Callable, Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership.analysis.linear import comparable_coordinates, input_vector, linearize, right_side
from tethership.analysis.loci import matrix_slopes, nearby_equilibrium
from tethership.analysis.trim import Question, ask, pose, trim
from tethership.scenario import ScenarioConfig, build_system, list_parameters, load_scenario, scenario_at, with_values
from tethership.studies.docking_paper.fit.space import UNKNOWNS, named_values

LATERAL = np.array([1, 3, 5, 6])
"""Places of v, p, r, φ among the states. In comparable coordinates v is that through the air, on which heading and
east, null for a free ship, do not act; over the ground ψ acts on v by the wind, and the block alone is no ship's."""

LONGITUDINAL = np.array([0, 2, 4, 7, 11])
"""Places of U, W, q, θ, D: north is null."""

GROWTH = 0.02
"""Growth rate that counts as one tolerance [1/s]: half a minute to double."""

MILD = 0.15
"""Largest |Re λ| of a pendulum called mild [1/s]."""

NO_OSCILLATION = 10.0
"""Residual of a pendulum, or of a roll, that does not oscillate [tolerances]; no slope leads out of there."""

PARTS = ("side-slip unstable", "vertical unstable", "pendulum mild", "roll stable")
"""What each residual stands for: zero where it holds."""


def _through_air(matrix: Any, comparable: Any) -> Any:
    """Return A, or its slopes, in comparable coordinates; last two axes the states."""
    return comparable @ matrix @ jnp.linalg.inv(comparable)


def _growths(config: ScenarioConfig, places: tuple, question: Question, value: Array) -> Float[Array, "6"]:
    """Return Re λ of side-slip, vertical, pendulum and roll, and Im λ of pendulum and roll [1/s]."""
    here = with_values(config, places, value)
    plant = build_system(here)
    problem = pose(here, plant, question)
    found = nearby_equilibrium(problem, jnp.zeros(len(question.unknowns.effort)))
    state, command = problem.unpack(found)
    inputs = input_vector(plant, command)
    vector = state.as_vector()
    own = jax.jacfwd(lambda s: right_side(plant, s, inputs))(vector)
    matrix = _through_air(own, comparable_coordinates(plant, vector))
    lateral = jnp.linalg.eigvals(matrix[np.ix_(LATERAL, LATERAL)])
    longitudinal = jnp.linalg.eigvals(matrix[np.ix_(LONGITUDINAL, LONGITUDINAL)])
    slow = jnp.argmin(jnp.abs(longitudinal))
    return jnp.stack(
        [
            jnp.max(lateral.real),
            longitudinal.real[slow],
            longitudinal.real[jnp.argmax(longitudinal.imag)],
            lateral.real[jnp.argmax(lateral.imag)],
            jnp.max(longitudinal.imag),
            jnp.max(lateral.imag),
        ]
    )


def _hinged(growth: Float[Array, "6"]) -> Float[Array, "4"]:
    """Return the residuals [tolerances] of growth rates [1/s]: zero where the claim's part holds."""
    slip, vertical, pendulum, roll, swinging, rolling = growth
    over = jnp.stack([-slip, -vertical, jnp.abs(pendulum) - MILD, roll])
    real = jnp.stack([jnp.zeros(()), jnp.zeros(()), swinging, rolling]) == 0.0
    unlike = real & np.array([False, False, True, True])
    return jnp.where(unlike, NO_OSCILLATION, jnp.maximum(over, 0.0) / GROWTH)


@eqx.filter_jit
def _residuals(config: ScenarioConfig, places: tuple, question: Question, values: Array) -> Float[Array, "vectors 4"]:
    return jax.vmap(lambda value: _hinged(_growths(config, places, question, value)))(values)


def _eigenvalue_slope(
    matrix: np.ndarray, slopes: np.ndarray, block: np.ndarray, choose: Callable[[np.ndarray], np.intp]
) -> tuple[complex, np.ndarray]:
    """Return one eigenvalue of a block of A and d Re λ/dp for dA/dp of shape (parameters, 12, 12): wᴴ dA v / wᴴ v."""
    values, right = np.linalg.eig(matrix[np.ix_(block, block)])
    which = choose(values)
    w, v = np.linalg.inv(right)[which], right[:, which]  # rows of the inverse are left eigenvectors with w v = 1
    slope = np.einsum("i,kij,j->k", w, slopes[:, block[:, None], block], v)
    return complex(values[which]), np.real(slope)


class Spectrum:
    """The free ship at 6 m/s as a function of the unknowns: growth rates [1/s] against what L1 and L2 say of them.

    Parameters
    ----------
    formulation : str
        consistent or published.
    """

    def __init__(self, formulation: str) -> None:
        scenario = load_scenario("hover", {"formulation": formulation})
        self._scenario = scenario
        known = list_parameters(scenario.config)
        self.names = tuple(name for unknown in UNKNOWNS for name in unknown.parameters)
        self._places = tuple(known[name].places for name in self.names)
        self._config, self._question = scenario.config.as_arrays(), ask(scenario)

    def _expanded(self, values: np.ndarray) -> np.ndarray:
        """Return one column per dotted name for values of the unknowns [SI]."""
        columns = named_values(values)
        return np.stack([columns[name] for name in self.names], axis=-1)

    def residuals(self, values: np.ndarray) -> np.ndarray:
        """Return the residuals of `PARTS` in tolerances of `GROWTH` [-], shape (vectors, 4).

        Parameters
        ----------
        values : ndarray
            Unknowns in SI [m², m, -, N], shape (vectors, unknowns).
        """
        size = -(-len(values) // 128) * 128
        padded = np.concatenate([values, np.repeat(values[-1:], size - len(values), axis=0)])
        found = [
            _residuals(self._config, self._places, self._question, jnp.asarray(self._expanded(padded[i : i + 128])))
            for i in range(0, size, 128)
        ]
        return np.concatenate([np.asarray(part) for part in found])[: len(values)]

    def slopes(self, values: np.ndarray) -> np.ndarray:
        """Return the exact derivative of the residuals with respect to the unknowns, shape (4, unknowns).

        It is in tolerances per unit of each unknown: [1/m²], [1/m], [-] or [1/N]; zero where a residual is.

        Parameters
        ----------
        values : ndarray
            Unknowns in SI [m², m, -, N], shape (unknowns,).
        """
        columns = named_values(values)
        scenario = scenario_at(self._scenario, {name: float(value) for name, value in columns.items()})
        known = list_parameters(scenario.config)
        parameters = [known[name] for name in self.names]
        point = trim(scenario)
        model = linearize(scenario, point)
        own, _, _ = matrix_slopes(scenario, point, parameters, np.full(len(parameters), 1e-2))
        # The coordinates depend on wind and attitude only, which no unknown moves.
        matrix, slopes = (np.asarray(_through_air(part, model.comparable)) for part in (model.A, own))
        _, slip = _eigenvalue_slope(matrix, slopes, LATERAL, lambda v: np.argmax(np.real(v)))
        _, vertical = _eigenvalue_slope(matrix, slopes, LONGITUDINAL, lambda v: np.argmin(np.abs(v)))
        swing, pendulum = _eigenvalue_slope(matrix, slopes, LONGITUDINAL, lambda v: np.argmax(np.imag(v)))
        turn, roll = _eigenvalue_slope(matrix, slopes, LATERAL, lambda v: np.argmax(np.imag(v)))
        pendulum = pendulum * (np.sign(swing.real) if swing.imag else 0.0)
        each = np.stack([-slip, -vertical, pendulum, roll if turn.imag else 0.0 * roll]) / GROWTH
        each = np.where(self.residuals(values[None])[0][:, None] > 0, each, 0.0)
        starts = np.cumsum([0, *(len(unknown.parameters) for unknown in UNKNOWNS)])
        return np.stack([each[:, a:b].sum(axis=1) for a, b in itertools.pairwise(starts)], axis=-1)


def unmet(residual: Sequence[float]) -> list[str]:
    """Return the parts of L1 and L2 that do not hold, from one vector's residuals in tolerances [-], shape (4,)."""
    return [part for part, value in zip(PARTS, residual, strict=True) if value > 0]
