"""Integration of one segment of a flight with diffrax, sampled densely. Depends on: simulation, diffrax.

A flight is flown in segments of a fixed number of samples, so that one compiled program serves flights of any
length, progress can be shown and an interrupted flight keeps what was flown. Diffrax is imported when a program is
traced: where a kept one is flown it is not needed.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from tethership._kept import kept
from tethership.plant import ClosedLoop
from tethership.scenario import SolverConfig
from tethership.simulation.events import StopConditions
from tethership.simulation.record import record

if TYPE_CHECKING:
    import diffrax

SAMPLES = 1600
"""Samples in a segment."""

FIRST_STEP = 0.01
"""First step of every adaptive segment [s]; the controller multiplies it by up to ten a step."""

SEGMENT_STEPS = 512
"""Steps at most in one call; a segment that needs more is continued by another call."""

METHODS = {"tsit5": "Tsit5", "dopri5": "Dopri5", "dopri8": "Dopri8", "kvaerno5": "Kvaerno5"}
"""Solvers of diffrax by the name a solver file gives."""


class Segment(NamedTuple):
    """What one call returns.

    Attributes
    ----------
    time : Float[Array, ""]
        Time reached [s].
    vector : Float[Array, "n"]
        Integrator's vector there.
    stopped : Bool[Array, ""]
        Whether a stop condition was met.
    finite : Bool[Array, ""]
        Whether everything stayed finite.
    margins : Float[Array, "4"]
        Margins at the end, in the order of `events.MARGINS`.
    steps : Int[Array, ""]
        Steps taken, rejected ones included.
    sample_times : Float[Array, "samples"]
        Times of the samples [s]; those beyond `time` are to be dropped.
    samples : dict
        Outputs, first axis the sample.
    last : dict
        Outputs at `time`.
    """

    time: Float[Array, ""]
    vector: Float[Array, "n"]
    stopped: Bool[Array, ""]
    finite: Bool[Array, ""]
    margins: Float[Array, "4"]
    steps: Int[Array, ""]
    sample_times: Float[Array, "samples"]
    samples: dict[str, Array]
    last: dict[str, Array]


class Stepping(eqx.Module):
    """Solver settings as the compiled program sees them.

    Attributes
    ----------
    tolerances : Float[Array, "2"]
        Relative and absolute.
    largest_step, smallest_step : float
        [s]; below the smallest a step is taken as it is, so that a jumping command (χ) is stepped over.
    output_interval : float
        [s].
    method : str
        Key of `METHODS`.
    adaptive : bool
    """

    tolerances: Float[Array, "2"]
    largest_step: Float[Array, ""]
    smallest_step: Float[Array, ""]
    output_interval: Float[Array, ""]
    method: str = eqx.field(static=True)
    adaptive: bool = eqx.field(static=True)

    @classmethod
    def from_config(cls, config: SolverConfig) -> "Stepping":
        """Return the settings of a validated solver file: steps and output interval [s], tolerances as it has them."""
        return cls(
            jnp.array([config.relative_tolerance, config.absolute_tolerance]),
            jnp.asarray(config.largest_step),
            jnp.asarray(config.smallest_step),
            jnp.asarray(config.output_interval),
            config.method,
            config.step == "adaptive",
        )


def _controller(stepping: Stepping, corners: Float[Array, "n"]) -> "diffrax.AbstractStepSizeController":
    """Return the step-size controller, stepping on the corners of gusts."""
    import diffrax

    if not stepping.adaptive:
        return diffrax.ConstantStepSize()
    controller = diffrax.PIDController(
        rtol=stepping.tolerances[0],  # pyright: ignore[reportArgumentType]
        atol=stepping.tolerances[1],  # pyright: ignore[reportArgumentType]
        dtmin=stepping.smallest_step,
        dtmax=stepping.largest_step,
        force_dtmin=True,
    )
    if corners.shape[0] == 0:
        return controller
    return diffrax.ClipStepSizeController(controller, jump_ts=corners)


Field = Callable[[Float[Array, ""], Float[Array, "n"]], Array]
"""A function of time and the integrator's vector."""


def least_traced(loop: ClosedLoop, stop: StopConditions, time: Array, vector: Array) -> tuple[Field, Field]:
    """Return vector field and least margin, traced once (the integrator would trace them at every use).

    Parameters
    ----------
    loop : ClosedLoop
        Its `vector_field` is the first function: all states per second.
    stop : StopConditions
        Its `least` margin [m, -, m, rad] is the second.
    time : Float[Array, ""]
        A time [s] to trace with.
    vector : Float[Array, "n"]
        All states there.

    Notes
    -----
    Each stands in a branch of its own: XLA's CPU runtime runs a sequence of kernels on small arrays one after the
    other without scheduling, but only where no larger array (the integrator's stages) belongs to the sequence. It
    makes a step a quarter cheaper.
    """

    def apart(function: Field, otherwise: Field) -> Field:
        converted = eqx.filter_closure_convert(function, time, vector)

        def traced(t: Array, y: Array) -> Array:  # one function object, so that `cond` traces it once too
            return converted(t, y)

        return lambda t, y: jax.lax.cond(jnp.isfinite(t), traced, otherwise, t, y)

    return (
        apart(loop.vector_field, lambda t, y: jnp.full_like(y, jnp.nan)),
        apart(lambda t, y: stop.least(loop, t, y), lambda t, y: jnp.full_like(t, jnp.nan)),
    )


class Solution(NamedTuple):
    """What the integrator returns for one interval.

    Attributes
    ----------
    reached : Float[Array, ""]
        Time reached [s].
    final : Float[Array, "n"]
        Vector there.
    stopped : Bool[Array, ""]
        Whether a stop condition was met.
    steps : Int[Array, ""]
        Steps taken, rejected ones included.
    evaluate : callable
        The vector at a time between [s].
    """

    reached: Float[Array, ""]
    final: Float[Array, "n"]
    stopped: Bool[Array, ""]
    steps: Int[Array, ""]
    evaluate: Callable[[Array], Array]


def solved(
    field: Field,
    margin: Field,
    stepping: Stepping,
    corners: Float[Array, "n"],
    start: Float[Array, ""],
    vector: Float[Array, "n"],
    end: Float[Array, ""],
) -> Solution:
    """Integrate from one time to another, or until the margin vanishes or the budget of one call is spent.

    Parameters
    ----------
    field, margin : callable
        From `least_traced`.
    stepping : Stepping
        Solver settings; with fixed steps all have `largest_step` [s].
    corners : Float[Array, "n"]
        Times at which a gust begins or ends [s]: adaptive steps end there.
    start, end : Float[Array, ""]
        Times [s].
    vector : Float[Array, "n"]
        All states at the start, SI and radians.
    """
    import diffrax
    import optimistix

    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, _: field(jnp.asarray(t), y)),
        getattr(diffrax, METHODS[stepping.method])(),
        start,
        end,
        jnp.minimum(FIRST_STEP, stepping.largest_step) if stepping.adaptive else stepping.largest_step,
        vector,
        saveat=diffrax.SaveAt(t1=True, dense=True),
        stepsize_controller=_controller(stepping, corners),
        event=diffrax.Event(
            lambda t, y, args, **_: margin(jnp.asarray(t), y),
            optimistix.Bisection(rtol=1e-12, atol=1e-10),
        ),
        max_steps=SEGMENT_STEPS,
        adjoint=diffrax.ForwardMode(),
        throw=False,
    )
    assert solution.ts is not None
    assert solution.ys is not None
    return Solution(
        solution.ts[-1],
        solution.ys[-1],
        solution.result == diffrax.RESULTS.event_occurred,
        jnp.asarray(solution.stats["num_steps"]),
        solution.evaluate,
    )


@kept
def fly_segment(
    loop: ClosedLoop,
    stop: StopConditions,
    stepping: Stepping,
    start: Float[Array, ""],
    vector: Float[Array, "n"],
    end: Float[Array, ""],
    sample_times: Float[Array, "samples"],
) -> Segment:
    """Fly from one time to another, or until a stop condition or the budget of one call.

    Parameters
    ----------
    loop : ClosedLoop
        Plant, law and trimmed command.
    stop : StopConditions
        What ends the flight.
    stepping : Stepping
        Solver settings.
    start, end : Float[Array, ""]
        Times [s].
    vector : Float[Array, "n"]
        Integrator's vector at the start.
    sample_times : Float[Array, "samples"]
        When to sample [s].
    """
    field, margin = least_traced(loop, stop, start, vector)
    solution = solved(field, margin, stepping, loop.plant.environment.corner_times(), start, vector, end)
    reached, final = solution.reached, solution.final
    samples = jax.vmap(lambda t: solution.evaluate(jnp.clip(t, start, reached)))(sample_times)
    samples = jnp.where((sample_times <= start)[:, None], vector, samples)
    outputs = jax.vmap(lambda t, y: record(loop, t, y))(sample_times, samples)
    return Segment(
        time=reached,
        vector=final,
        stopped=solution.stopped,
        finite=jnp.all(jnp.isfinite(final)) & jnp.isfinite(reached),
        margins=stop.margins(loop, reached, final),
        steps=solution.steps,
        sample_times=sample_times,
        samples=outputs,
        last=record(loop, reached, final),
    )
