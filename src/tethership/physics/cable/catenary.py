"""The catenary under a uniform load, extensible or not, as one scalar equation. Depends on: nothing.

With w = |l|, c₃ = −l/w, y₃ = d·c₃, d_⊥ = d − y₃c₃, and the dimensionless a = |d_⊥|/L, b = y₃/L, ε = wL/EA, the
classical pair for the end forces (Irvine, *Cable Structures*, 1981, section 1.3)

    |d_⊥| = HL/EA + (H/w)[asinh(V/H) − asinh((V−wL)/H)]
    y₃    = (L/EA)(V − wL/2) + (H/w)[√(1+(V/H)²) − √(1+((V−wL)/H)²)]

becomes, with 2z the bracket of the first (so wL/H = 2 cosh m sinh z, tanh m = b/s, s = 1 + ½ε coth z),

    A² + (b/s)² = 1,      A = a sinh z/(z + ½ε)                                                  (*)

one equation for z > 0 whose left side rises from 0 to ∞: exactly one root, slack or taut. The forces are

    F_TP = −w/(2z + ε) d_⊥ + ½ (L + y₃/(tanh z + ½ε)) l,       F_AP = L l − F_TP

For ε = 0 (*) is sinh z / z = √(L² − y₃²)/|d_⊥| and this is Eqs. 20–24 of Riboldi et al., misprints mended.
The root is differentiated by the implicit function theorem, never through the iterations.
"""

from functools import partial

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.cable.law import SPAN_FLOOR, CableForce

ITERATIONS = 4
"""Newton steps that are always taken: enough for a cable that hangs; the rest go on until they converge."""

MOST_ITERATIONS = 30
"""Newton steps at most; seven are enough but for a line all but plumb and all but straight."""

CONVERGED = 1e-9
"""Relative step below which the next Newton step, being quadratic, would be rounding."""

LARGE = 5.0
"""z [-] above which 1 − tanh z and 1 − coth²z are written without cancellation; an almost plumb cable has up to 30."""

_TINY = 1e-300


def _guess(across: Float[Array, ""], along: Float[Array, ""], stretch: Float[Array, ""]) -> Float[Array, ""]:
    """Return a starting z, within 10 % for a cable that hangs.

    Notes
    -----
    ln(sinh z/z) = c has the root √(6c + c²) to a few per cent for all c > 0; near e = 1 it is the cubic
    z³ − 6cz = 3εe²/a² with c of either sign. Both are joined, and capped where the cable hangs plumb.
    """
    squared = across + along**2
    excess = 0.5 * jnp.log(jnp.maximum(1.0 + (1.0 - squared) / across, 1.0))
    cubic = 3.0 * stretch * squared / across
    cube_root_squared = jnp.exp(2.0 / 3.0 * jnp.log(cubic + _TINY))
    slack = jnp.sqrt(6.0 * excess + excess**2 + cube_root_squared)
    taut = 3.0 * stretch * squared / (3.0 * jnp.maximum(squared - 1.0, 0.0) + across * cube_root_squared + _TINY)
    limit = 0.5 * jnp.log1p((jnp.abs(1.0 - along**2) + stretch) / across)
    start = jnp.minimum(jnp.where(squared < 1.0, slack, taut), jnp.sqrt(limit**2 + 6.0 * limit))
    return jnp.maximum(start, _TINY)


@partial(jax.jit, inline=True)
def _newton_step(
    z: Float[Array, ""],
    hanging: Float[Array, ""],
    half_log_across: Float[Array, ""],
    height: Float[Array, ""],
    stretch: Float[Array, ""],
) -> Float[Array, ""]:
    """Return the next z: Newton in ln z on the logarithm of (*), in one of two forms.

    Notes
    -----
    ln A − ½ ln(1 − (b/s)²) = 0 is nearly straight where the cable hangs, ½ ln(A² + (b/s)²) = 0 where it is taut.
    Everything is written with exp(−2z), so that nothing overflows.
    """
    half = 0.5 * stretch
    decay = jnp.expm1(-2.0 * z)
    coth = -(2.0 + decay) / decay
    shape = 1.0 + half * coth
    shape_slope = half * (1.0 - coth**2)
    log_a = half_log_across + z + jnp.log(-0.5 * decay / (z + half))
    log_a_slope = coth - 1.0 / (z + half)
    gap = (shape - height) * (shape + height)
    use_gap = hanging & (gap > 0)
    safe_gap = jnp.where(use_gap, gap, 1.0)
    ratio = (height / shape) ** 2
    square = jnp.where(use_gap, 1.0, jnp.exp(2.0 * jnp.minimum(log_a, 300.0)))
    total = square + ratio
    value = jnp.where(
        use_gap,
        log_a - 0.5 * jnp.log(safe_gap) + jnp.log(shape),
        0.5 * jnp.log(jnp.where(use_gap, 1.0, total)),
    )
    slope = jnp.where(
        use_gap,
        log_a_slope - shape * shape_slope / safe_gap + shape_slope / shape,
        (square * log_a_slope - ratio * shape_slope / shape) / total,
    )
    return z * jnp.exp(jnp.clip(-value / (slope * z), -2.0, 2.0))


@jax.custom_jvp
@partial(jax.jit, inline=True)
def root(across: Float[Array, ""], along: Float[Array, ""], stretch: Float[Array, ""]) -> Float[Array, ""]:
    """Return the root z of (*) [-], with exact derivatives.

    Parameters
    ----------
    across : Float[Array, ""]
        a², squared distance of the ends across the load over L² [-], above 0.
    along : Float[Array, ""]
        b, distance of the ends against the load over L [-].
    stretch : Float[Array, ""]
        ε = wL/EA [-], 0 for an inextensible cable (then e = √(a² + b²) must be below 1).
    """
    height = jnp.abs(along)
    hanging = (across + along**2 < 1.0) | ((height < 1.0 + 0.5 * stretch) & (across < stretch))
    half_log_across = 0.5 * jnp.log(across)
    z = _guess(across, along, stretch)

    def step(z: Float[Array, ""]) -> Float[Array, ""]:
        return _newton_step(z, hanging, half_log_across, height, stretch)

    def unconverged(state: tuple[Array, Array, Array]) -> Array:
        count, before, now = state
        return (jnp.abs(now - before) > CONVERGED * now) & (count < MOST_ITERATIONS)

    for _ in range(ITERATIONS - 1):
        z = step(z)
    start = (jnp.asarray(ITERATIONS), z, step(z))
    _, _, z = jax.lax.while_loop(unconverged, lambda s: (s[0] + 1, s[2], step(s[2])), start)
    return z


def _langevin(z: Float[Array, ""]) -> Float[Array, ""]:
    """Return coth z − 1/z without cancellation; z > 0."""
    small = z < 0.05
    safe = jnp.where(small, 1.0, z)
    series = z / 3.0 * (1.0 - z**2 / 15.0 * (1.0 - 2.0 * z**2 / 21.0 * (1.0 - z**2 / 10.0)))
    return jnp.where(small, series, 1.0 / jnp.tanh(safe) - 1.0 / safe)


@jax.custom_jvp
def _tanh(z: Float[Array, ""]) -> Float[Array, ""]:
    """Return tanh z with a slope that is accurate for a large z too."""
    return jnp.tanh(z)


@_tanh.defjvp
def _tanh_jvp(
    primals: tuple[Float[Array, ""]], tangents: tuple[Float[Array, ""]]
) -> tuple[Float[Array, ""], Float[Array, ""]]:
    (z,), (z_dot,) = primals, tangents
    tanh, decay = jnp.tanh(z), jnp.exp(-2.0 * z)
    return tanh, (z_dot + z_dot * tanh) * jnp.where(z < LARGE, 1.0 - tanh, 2.0 * decay / (1.0 + decay))


@root.defjvp
def _root_jvp(
    primals: tuple[Float[Array, ""], ...], tangents: tuple[Float[Array, ""], ...]
) -> tuple[Float[Array, ""], Float[Array, ""]]:
    """Return z and dz by the implicit function theorem on (*)."""
    across, along, stretch = primals
    across_dot, along_dot, stretch_dot = tangents
    z = root(across, along, stretch)
    half = 0.5 * stretch
    coth = 1.0 / jnp.tanh(z)
    shape = 1.0 + half * coth
    ratio = along / shape
    sinh = jnp.sinh(jnp.minimum(z, 300.0))
    square = across * (sinh / (z + half)) ** 2
    log_a_slope = _langevin(z) + half / (z * (z + half))
    shape_slope = half * jnp.where(z < LARGE, 1.0 - coth**2, -1.0 / sinh**2)
    denominator = 2.0 * square * log_a_slope - 2.0 * ratio**2 * shape_slope / shape
    numerator = (
        square * across_dot / across
        + 2.0 * ratio * along_dot / shape
        - (square / (z + half) + ratio**2 * coth / shape) * stretch_dot
    )
    return z, -numerator / denominator


def split(
    span: Float[Array, "3"], length: Float[Array, ""], load: Float[Array, "3"]
) -> tuple[Float[Array, ""], Float[Array, "3"], Float[Array, ""], Float[Array, ""]]:
    """Return y₃/L [-], d_⊥ [m], a² [-] and w [N/m] of a cable; arguments as in `end_forces`."""
    weight = jnp.sqrt(jnp.dot(load, load))
    upward = -load / weight
    along = jnp.dot(span, upward)
    across = span - along * upward
    squared = jnp.dot(across, across) / length**2 + SPAN_FLOOR**2
    return along / length, across, squared, weight


def end_forces(
    span: Float[Array, "3"],
    length: Float[Array, ""],
    load: Float[Array, "3"],
    compliance: Float[Array, ""],
) -> CableForce:
    """Return the forces at both ends of a cable [N], axes of the arguments.

    Parameters
    ----------
    span : Float[Array, "3"]
        d = x_TP − x_AP [m].
    length : Float[Array, ""]
        Unstretched length L [m].
    load : Float[Array, "3"]
        Uniform load l per unstretched length [N/m], not zero (see `regularised`).
    compliance : Float[Array, ""]
        1/EA [1/N]; 0 for an inextensible cable.
    """
    along, across, squared, weight = split(span, length, load)
    stretch = weight * length * compliance
    z = root(squared, along, stretch)
    ship = -weight / (2.0 * z + stretch) * across + 0.5 * length * (1.0 + along / (_tanh(z) + 0.5 * stretch)) * load
    return CableForce(ship, length * load - ship)


def points(
    anchor_force: Float[Array, "3"],
    load: Float[Array, "3"],
    compliance: Float[Array, ""],
    arc: Float[Array, "n"],
) -> Float[Array, "n 3"]:
    """Return the cable's points from the anchor [m], exact.

    Parameters
    ----------
    anchor_force : Float[Array, "3"]
        Force of the cable on the anchor F_AP [N]: its tension vector there.
    load : Float[Array, "3"]
        l [N/m].
    compliance : Float[Array, ""]
        1/EA [1/N].
    arc : Float[Array, "n"]
        Unstretched distance from the anchor s [m].

    Notes
    -----
    t(s) = F_AP − l s; x(s) = ∫ t/|t| + t/EA ds. With T = |t|, V its part against the load, T̄ = T₀ + T_s:
    ∫V/T ds = s (V₀ + V_s)/T̄ and ∫ds/T = (1/w) ln((T̄ + ws)/(T̄ − ws)). T̄ − ws = (T₀ + V₀) + (T_s − V_s), whose terms
    are taken as H²/(T ∓ V) where they would cancel: the curve meets its end to 1e-11 L, slack, plumb or taut.
    """
    weight = jnp.sqrt(jnp.dot(load, load))
    upward = -load / weight
    rise = jnp.dot(anchor_force, upward)
    across = anchor_force - rise * upward
    lateral = jnp.dot(across, across)
    tension_start = jnp.sqrt(lateral + rise**2 + _TINY)
    rise_here = rise + weight * arc
    tension_here = jnp.sqrt(lateral + rise_here**2 + _TINY)
    total = tension_start + tension_here
    fraction = weight * arc / total
    small = fraction < 1e-4
    low = jnp.where(rise < 0, lateral / (tension_start + jnp.abs(rise)), tension_start + rise)
    high = jnp.where(rise_here > 0, lateral / (tension_here + jnp.abs(rise_here)), tension_here - rise_here)
    rest = jnp.where(small, 1.0, low + high + _TINY)
    logarithm = 0.5 * jnp.log((total + weight * arc) / rest)
    quotient = jnp.where(small, 1.0 + fraction**2 / 3.0, logarithm / jnp.where(small, 1.0, fraction))
    straight = 2.0 * arc / total * quotient
    along = arc * (rise + rise_here) / total
    elastic = compliance * (arc[:, None] * anchor_force - 0.5 * arc[:, None] ** 2 * load)
    return straight[:, None] * across + along[:, None] * upward + elastic
