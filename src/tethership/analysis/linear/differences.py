"""Central differences of the right-hand side: the third route to the linear model, blind to how it is written.

Depends on: analysis.linear.right_side. Fourth order; where a load has a corner in its second derivative (|v|v at rest)
the result is off by about the step.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.linear.right_side import right_side
from tethership.plant import TetheredAirship

STEP = 1e-4
"""Step [m, m/s, rad, rad/s, -]: truncation step⁴ f⁽⁵⁾/30, rounding 1e-15/step."""


@kept
def central_differences(
    plant: TetheredAirship, state: Float[Array, "12"], inputs: Float[Array, "inputs"]
) -> tuple[Float[Array, "12 12"], Float[Array, "12 inputs"]]:
    """Return A and U by differences; arguments as in `semi_analytic`.

    Notes
    -----
    (8 [f(h) − f(−h)] − [f(2h) − f(−2h)])/(12 h) along every state and input, h = `STEP` in the unit of each: A [state
    unit/s per state unit], e.g. [1/s] of a velocity over itself; U [state unit/s per input unit].
    """
    together = jnp.concatenate([state, inputs])

    def rates(vector: Float[Array, "n"]) -> Float[Array, "12"]:
        return right_side(plant, vector[: len(state)], vector[len(state) :])

    def slope(direction: Float[Array, "n"]) -> Float[Array, "12"]:
        near = rates(together + STEP * direction) - rates(together - STEP * direction)
        far = rates(together + 2.0 * STEP * direction) - rates(together - 2.0 * STEP * direction)
        return (8.0 * near - far) / (12.0 * STEP)

    slopes = jax.vmap(slope, out_axes=1)(jnp.eye(together.shape[0]))
    return slopes[:, : len(state)], slopes[:, len(state) :]
