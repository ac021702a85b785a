"""The closed loop as a linear model: laws, actuators and ship together. Depends on: analysis.linear, plant, scenario.

A continuous law: one Jacobian of the loop's rate over the layout of all its states. A sampled law: between ticks the
states follow the matrix exponential of that Jacobian, at a tick they jump by the Jacobian of the jump, so the model of
one period, from just before a look to the next, is their product: exact, and discrete.
"""

import dataclasses
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import scipy.linalg
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.linear.model import LinearModel
from tethership.control import AbstractLaw
from tethership.physics import WindChange
from tethership.plant import HELD, LENGTH, NEXT, ClosedLoop, Command, State, TetheredAirship, closed_loop
from tethership.scenario import Scenario, build_loop

MOVING = 1e-6
"""Rate of a ship's state [SI per second] from which its laws are told not to let it rest at the point."""


def with_inputs(loop: ClosedLoop, inputs: Float[Array, "inputs"]) -> ClosedLoop:
    """Return a loop with something added to what its channels are asked [-, rad], and to the wind [m/s, m/s²]."""
    thrusters, fins = loop.plant.ship.thrusters.count, loop.plant.ship.fins.count
    after = thrusters + fins
    trimmed = Command(loop.trimmed.throttle + inputs[:thrusters], loop.trimmed.deflection + inputs[thrusters:after])
    change = WindChange(inputs[after : after + 3], inputs[after + 3 : after + 6])
    environment = dataclasses.replace(loop.plant.environment, gusts=(*loop.plant.environment.gusts, change))
    return dataclasses.replace(loop, trimmed=trimmed, plant=dataclasses.replace(loop.plant, environment=environment))


@kept
def loop_slopes(
    loop: ClosedLoop, vector: Float[Array, "n"], inputs: Float[Array, "inputs"]
) -> tuple[Float[Array, "n"], Float[Array, "n n"], Float[Array, "n inputs"]]:
    """Return the rate of all states at a point and t = 0, and its slopes over states and inputs.

    Parameters
    ----------
    loop : ClosedLoop
    vector : Float[Array, "n"]
        All states, in the order and the SI units of `plant.layout.closed_loop`.
    inputs : Float[Array, "inputs"]
        What `with_inputs` adds: throttles [-], deflections [rad], the wind's change [m/s] and its rate [m/s²], the last
        two in ground axes.

    Returns
    -------
    tuple
        The rate [state unit/s], shape (n,); A [state unit/s per state unit], shape (n, n); U [state unit/s per input
        unit], shape (n, inputs).
    """

    def rate(together: Float[Array, "m"]) -> Float[Array, "n"]:
        return with_inputs(loop, together[len(vector) :]).vector_field(jnp.zeros(()), together[: len(vector)])

    together = jnp.concatenate([vector, inputs])
    slopes = jax.jacfwd(rate)(together)
    return rate(together), slopes[:, : len(vector)], slopes[:, len(vector) :]


@kept
def _jumps(loop: ClosedLoop, vector: Float[Array, "n"]) -> tuple[Float[Array, "n n"], Float[Array, "n n"]]:
    """Return the slopes of what a sampled law does when it looks, and when it acts."""
    look = jax.jacfwd(lambda x: loop.look(jnp.zeros(()), x))(vector)
    delayed = loop.sampling is not None and loop.sampling.delay is not None
    return look, jax.jacfwd(loop.act)(vector) if delayed else jnp.eye(len(vector))


@kept
def _settled(loop: ClosedLoop, state: State) -> Float[Array, "n"]:
    """Return all states at a point; a sampled law has looked and acted."""
    vector = loop.initial(state)
    if loop.sampling is None:
        return vector
    looked = loop.look(jnp.zeros(()), vector)
    return looked if loop.sampling.delay is None else loop.act(looked)


def period_map(
    A: np.ndarray, U: np.ndarray, look: np.ndarray, act: np.ndarray, period: float, delay: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the matrices over one period, from just before a look to just before the next.

    Parameters
    ----------
    A, U : ndarray
        Slopes of the rate between ticks, shapes (n, n) and (n, inputs); inputs are held over the period.
    look, act : ndarray
        Slopes of the jumps, shape (n, n).
    period, delay : float
        T and d [s].

    Notes
    -----
    x⁺ = e^{A(T−d)} J_act e^{Ad} J_look x, and the inputs' part by the exponential of the augmented matrix.
    """
    count, width = U.shape
    together = np.zeros((count + width, count + width))
    together[:count, :count], together[:count, count:] = A, U

    def flow(time: float) -> Any:
        return scipy.linalg.expm(together * time)

    def jump(matrix: np.ndarray) -> Any:
        return scipy.linalg.block_diag(matrix, np.eye(width))

    whole = flow(period - delay) @ jump(act) @ flow(delay) @ jump(look)
    return whole[:count, :count], whole[:count, count:]


def closed_model(
    scenario: Scenario, model: LinearModel, state: State, command: Command, law: AbstractLaw | None, lengths: bool
) -> LinearModel:
    """Return the closed loop's model about the point of an open one.

    Parameters
    ----------
    scenario : Scenario
        Says laws, sampling and allocation.
    model : LinearModel
        Of the open loop there: its inputs, outputs and comparable coordinates.
    state, command
        The point; throttles [-] and deflections [rad] of the command are those to which the laws' corrections are
        added.
    law : AbstractLaw, optional
        Instead of the scenario's layers.
    lengths : bool
        Let the cables' lengths L_t [m] be states; else they are held, and inputs.

    Returns
    -------
    LinearModel
        With a sampled law the discrete model over its period T [s], which is `LinearModel.sample_time`; its
        attribute `warnings` names channels at their ends or in their dead band, and a state that changes by more than
        `MOVING` a second in its SI unit.
    """
    plant: TetheredAirship = scenario.system.at_mean()
    loop = build_loop(scenario.config, plant.with_winches_held(), command, scenario.law() if law is None else law)
    layout, vector = closed_loop(loop), _settled(loop, state)
    free = [name for name in model.inputs if not name.startswith(LENGTH)]
    rate, A, U = map(np.asarray, loop_slopes(loop, vector, jnp.zeros(len(free))))
    sampling = loop.sampling
    dropped: tuple[str, ...] = () if lengths else (LENGTH,)
    attributes: dict[str, Any] = {"loop": "closed", "layers": list(getattr(loop.law, "names", ("law",)))}
    if sampling is not None:
        delay = 0.0 if sampling.delay is None else float(sampling.delay)
        look, act = map(np.asarray, _jumps(loop, vector))
        moves = np.array([lengths or not name.startswith(LENGTH) for name in layout.names])[:, None]
        A, U = np.where(moves, A, 0.0), np.where(moves, U, 0.0)  # a length that is held does not move within a period
        A, U = period_map(A, U, look, act, float(sampling.period), delay)
        attributes["sample_time"] = float(sampling.period)
        # Overwritten at every look, so no state of a period.
        dropped = (*dropped, HELD if sampling.delay is None else NEXT)
    names = layout.names
    kept = [i for i, name in enumerate(names) if not name.startswith(dropped)]
    held = [names.index(name) for name in model.inputs if name.startswith(LENGTH)] if not lengths else []
    attributes["warnings"] = _warnings(loop, np.asarray(rate)[kept], [names[i] for i in kept], vector)
    inputs = (*free, *(names[i] for i in held))
    units = dict(zip(model.inputs, model.input_units, strict=True))
    return LinearModel(
        A[np.ix_(kept, kept)],
        np.hstack([U[kept], A[np.ix_(kept, held)]]),
        tuple(names[i] for i in kept),
        inputs,
        tuple(layout.units[i] for i in kept),
        tuple(units[name] for name in inputs),
        np.asarray(vector)[kept],
        np.concatenate([np.zeros(len(free)), np.asarray(vector)[held]]),
        _comparable(model, [names[i] for i in kept]),
        {**model.attributes, **attributes},
        tuple(name for name in model.controls if name in free),
        model.outputs,
        model.output_units,
        model.output_values,
        _columns(model, [names[i] for i in kept]),
        _columns(model, list(inputs), channels=False),
    )


def states_kept(loop: ClosedLoop) -> list[int]:
    """Return the places of the states of a continuous closed loop without the cables' lengths, which are held."""
    return [i for i, name in enumerate(closed_loop(loop).names) if not name.startswith(LENGTH)]


def state_matrix(loop: ClosedLoop, state: State) -> Float[Array, "n n"]:
    """Return A of a continuous closed loop at a point, the cables' lengths [m] held; can be traced.

    Parameters
    ----------
    loop : ClosedLoop
        Its laws are continuous.
    state : State
        Of the ship; cables, actuators and laws are at their rest about it.

    Returns
    -------
    Float[Array, "n n"]
        Slope of the rate at t = 0 [state unit/s per state unit], over the states that `states_kept` gives.
    """
    kept = jnp.asarray(states_kept(loop))
    vector = loop.initial(state)
    slopes = jax.jacfwd(lambda x: loop.vector_field(jnp.zeros(()), x))(vector)
    return slopes[kept][:, kept]


def _comparable(model: LinearModel, names: list[str]) -> np.ndarray:
    """Return the matrix to comparable coordinates of these states; those of laws stay in their own units."""
    found = np.eye(len(names))
    known = [name for name in names if name in model.states]
    here, there = [names.index(name) for name in known], [model.states.index(name) for name in known]
    found[np.ix_(here, here)] = model.comparable[np.ix_(there, there)]
    return found


def _columns(model: LinearModel, names: list[str], channels: bool = True) -> np.ndarray:
    """Return the outputs' slopes over states and inputs of the open model by these names, zero for others."""
    slopes = {name: model.C[:, i] for i, name in enumerate(model.states)}
    slopes |= {name: model.D[:, i] for i, name in enumerate(model.inputs) if channels or name not in model.controls}
    none = np.zeros(len(model.outputs))
    return np.stack([slopes.get(name, none) for name in names], axis=1) if names else np.zeros((len(none), 0))


def _warnings(loop: ClosedLoop, rate: np.ndarray, names: list[str], vector: Float[Array, "n"]) -> list[str]:
    """Return what must be known of a closed loop's model: channels at their ends, a law that moves the ship."""
    at = loop.instant(jnp.zeros(()), vector)
    part = loop.plant.part_names
    over = [name for name, is_so in zip(part.thrusters, np.asarray(at.saturated), strict=True) if is_so]
    over += [name for name, is_so in zip(part.fins, np.asarray(at.fins_saturated), strict=True) if is_so]
    said = []
    if over:
        said.append(f"{', '.join(over)}: asked for more than there is at this point, so the loop is open there")
    bands = loop.plant.thrusters
    quiet = [
        part.thrusters[i]
        for i, band in zip(bands.banded, np.asarray(bands.dead_band), strict=True)
        if abs(float(at.asked.throttle[i])) < band
    ]
    if quiet:
        said.append(f"{', '.join(quiet)}: inside the dead band at this point, so the loop is open there")
    moving = [(name, value) for name, value in zip(names, rate, strict=True) if abs(value) > MOVING]
    if moving:
        name, value = max(moving, key=lambda pair: abs(pair[1]))
        said.append(
            f"the laws do not let the ship rest at its trim ({name} changes at {value:.3g} a second): the model "
            "holds about the trim, not about where they would take it"
        )
    return said
