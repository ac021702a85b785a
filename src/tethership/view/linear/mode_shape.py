"""A mode drawn as motion of the ship. Depends on: matplotlib, analysis (its linear models), view."""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from tethership.analysis.linear import LinearModel
from tethership.analysis.modes import Mode
from tethership.errors import ConfigError
from tethership.scenario import ScenarioConfig, validated
from tethership.spatial import rotation_matrix
from tethership.view import style
from tethership.view.flight.projection import View
from tethership.view.flight.ship import ShipShape, ship_outlines, ship_shape

Array = NDArray[np.float64]

REACH = 0.16
"""Largest displacement of the hull's ends that is drawn, over the hull's length [-]: the model itself has no size."""

LARGEST_ANGLE = 0.5
"""Largest change of an angle that is drawn [rad]: a ship that only rolls hardly moves its ends."""

PHASES = np.linspace(0.0, 2.0 * np.pi, 73)
"""Phases of the paths of nose and tail [rad]; a real mode is drawn from full to none."""

SHIPS = 4
"""Ships drawn: of an oscillation over one half period, of a real mode after 0, 1, 2, 3 half times."""

PANEL = (4.4, 3.6)
"""Width and height of one mode in `plot_all_modes` [inch]."""

EXPLAINED = (
    "From dark green to crimson: half a period, or three half (or double) times of a mode that does not oscillate. "
    "Dashed: at rest. Blue: paths of nose and tail."
)
"""What the lines are."""

ATTITUDE = ("phi", "theta", "psi")
POSITION = ("north", "east", "down")


class Motion(NamedTuple):
    """A mode's motion about the trim.

    Attributes
    ----------
    displacement : Array
        Complex amplitude of P, ground axes [m], shape (3,).
    turning : Array
        Complex amplitude of the Euler angles [rad], shape (3,).
    attitude : Array
        Trim [rad], shape (3,).
    shape : ShipShape
        The ship.
    """

    displacement: NDArray[np.complex128]
    turning: NDArray[np.complex128]
    attitude: Array
    shape: ShipShape

    def pose(self, factor: complex) -> tuple[Array, Array]:
        """Return P from its trim, ground axes [m], and body to ground [-], at a complex factor, e.g. a phase."""
        rotation = np.asarray(rotation_matrix(jnp.asarray(self.attitude + (factor * self.turning).real)))
        return (factor * self.displacement).real, rotation

    def ends(self, factor: complex) -> Array:
        """Return nose, tail, and both sides of the largest section, ground axes from P's trim [m], shape (4, 3)."""
        position, rotation = self.pose(factor)
        return position + _corners(self.shape) @ rotation.T


@style.styled
def plot_modes(model: LinearModel, name: str, axes: Axes | None = None, view: str | None = None) -> Axes:
    """Draw one mode as motion of the ship, as seen from where it moves most.

    Of an oscillation the ship is drawn four times over half a period, decay left out; of a real mode at its full size
    and after one, two and three half times (of a growing one, doubling times before). At rest it is dashed. Lines are
    the paths of nose and tail. The size of a mode is free: the largest displacement is drawn as 16 % of the hull's
    length.

    Parameters
    ----------
    model : LinearModel
        From `linearize`; whole or reduced (held states stay where they are).
    name : str
        A mode's name, as in `model.modes().names`; a part of a coalesced name will do.
    axes : Axes, optional
        Draw there; new ones if not given.
    view : str, optional
        `starboard`, `above` or `behind`.

    Returns
    -------
    Axes
        Equal scales [m], origin where P rests.

    Raises
    ------
    ConfigError
        There is no such mode or view; the model was not made from a scenario, so that the ship's shape is not known.
    """
    mode = model.modes().find(name)
    motion = mode_motion(model, mode)
    seen = _view(motion, view)
    if axes is None:
        axes = Figure(figsize=(6.4, 4.6), layout="constrained").subplots()
    _draw(axes, mode, motion, seen)
    return axes


@style.styled
def plot_all_modes(model: LinearModel) -> Figure:
    """Draw every mode of a model that moves the ship, equal scales [m]; raises ConfigError as `plot_modes`.

    Returns a figure that is not shown and not saved.
    """
    modes = [mode for mode in model.modes().modes if not mode.null and _moves(model, mode)]
    columns = min(3, max(len(modes), 1))
    rows = -(-max(len(modes), 1) // columns)
    drawn = Figure(figsize=(columns * PANEL[0], rows * PANEL[1] + 0.4), layout="constrained")
    drawn.suptitle(EXPLAINED, fontsize=style.SMALL)
    panels = drawn.subplots(rows, columns, squeeze=False).ravel()
    for axes, mode in zip(panels, modes, strict=False):
        motion = mode_motion(model, mode)
        _draw(axes, mode, motion, _view(motion, None))
    for axes in panels[len(modes) :]:
        axes.set_axis_off()
    return drawn


def mode_motion(model: LinearModel, mode: Mode) -> Motion:
    """Return a mode's motion, scaled so that it can be seen.

    Parameters
    ----------
    model : LinearModel
        Made from a scenario.
    mode : Mode
        Of this model; its shape is in comparable units [m/s, m].

    Returns
    -------
    Motion
        Amplitudes of P in ground axes [m] and of φ, θ, ψ [rad].

    Raises
    ------
    ConfigError
        The model was not made from a scenario.
    """
    if "scenario" not in model.attributes:
        raise ConfigError(
            "this model was not made from a scenario, so the shape of its ship is not known; use linearize(scenario)"
        )
    config = validated(ScenarioConfig, model.attributes["scenario"], model.attributes["name"])
    shape = ship_shape(config.vehicle)
    vector = np.linalg.solve(model.comparable, np.array([mode.shape[name] for name in model.states]))
    amplitude = dict(zip(model.states, vector, strict=True))
    value = dict(zip(model.states, model.state_values, strict=True))
    displacement = np.array([amplitude.get(name, 0.0) for name in POSITION], complex)
    turning = np.array([amplitude.get(name, 0.0) for name in ATTITUDE], complex)
    attitude = np.array([value.get(name, 0.0) for name in ATTITUDE])
    return _scaled(Motion(displacement, turning, attitude, shape), config.vehicle.hull.length)


def _moves(model: LinearModel, mode: Mode) -> bool:
    """Return whether positions or angles take part in a mode."""
    return any(abs(mode.shape.get(name, 0.0)) > 1e-6 for name in (*POSITION, *ATTITUDE) if name in model.states)


def _scaled(motion: Motion, length: float) -> Motion:
    """Return a motion of the size that is drawn, at its largest displacement at phase zero."""
    small = 1e-4 / max(np.abs(motion.displacement).max() / length, np.abs(motion.turning).max(), 1e-300)
    slight = motion._replace(displacement=small * motion.displacement, turning=small * motion.turning)
    still = slight.ends(0.0)
    turns = np.exp(1j * PHASES)
    moved = np.array([np.linalg.norm(slight.ends(turn) - still, axis=1).max() for turn in turns])
    largest = int(moved.argmax())
    factor = small * turns[largest] * REACH * length / max(moved[largest], 1e-300)
    angle = np.abs(factor * motion.turning).max()
    factor *= min(1.0, LARGEST_ANGLE / max(angle, 1e-300))
    return motion._replace(displacement=factor * motion.displacement, turning=factor * motion.turning)


def _corners(shape: ShipShape) -> Array:
    """Return nose, tail, starboard and top of the largest section, body axes from P [m], shape (4, 3)."""
    widest = float(shape.radius.max())
    middle = float(shape.station[shape.radius.argmax()])
    return shape.axis + np.array(
        [[shape.station[0], 0.0, 0.0], [shape.station[-1], 0.0, 0.0], [middle, widest, 0.0], [middle, 0.0, -widest]]
    )


def _views(heading: float) -> dict[str, View]:
    """Return the views along and across a heading [rad]."""
    ahead = np.array([np.cos(heading), np.sin(heading), 0.0])
    starboard = np.array([-np.sin(heading), np.cos(heading), 0.0])
    up = np.array([0.0, 0.0, -1.0])
    return {
        "starboard": View("from starboard", ("ahead [m]", "up [m]"), np.stack([ahead, up]), starboard),
        "above": View("from above", ("to starboard [m]", "ahead [m]"), np.stack([starboard, ahead]), up),
        "behind": View("from behind", ("to starboard [m]", "up [m]"), np.stack([starboard, up]), -ahead),
    }


def _view(motion: Motion, name: str | None) -> View:
    """Return the view of a name, or that in which the ship's ends move most."""
    views = _views(float(motion.attitude[2]))
    if name is not None:
        if name not in views:
            raise ConfigError(f"there is no view {name!r}; allowed: {', '.join(views)}")
        return views[name]
    rest = motion.ends(0.0)
    moves = np.array([motion.ends(turn) - rest for turn in np.exp(1j * PHASES)])
    return max(views.values(), key=lambda view: float(np.square(view.project(moves)).sum()))


def _factors(mode: Mode) -> list[complex]:
    """Return the complex factors of the ships that are drawn, the first at full size."""
    if mode.oscillates:
        return [complex(np.exp(1j * np.pi * i / (SHIPS - 1))) for i in range(SHIPS)]
    return [complex(0.5**i) for i in range(SHIPS)]


def _draw(axes: Axes, mode: Mode, motion: Motion, view: View) -> None:
    """Draw ships, paths and words."""
    _ship(axes, motion, 0.0, view, style.INK, "rest", dashed=True)
    factors = _factors(mode)
    for i, factor in enumerate(factors):
        colour = style.START if i == 0 else style.END if i == len(factors) - 1 else style.BETWEEN
        _ship(axes, motion, factor, view, colour, f"ship {i}")
    path = np.exp(1j * PHASES) if mode.oscillates else np.linspace(1.0, 0.0, 25)
    ends = np.array([view.project(motion.ends(factor)[:2]) for factor in path])
    for i, label in enumerate(("nose", "tail")):
        axes.plot(ends[:, i, 0], ends[:, i, 1], color=style.SERIES[0], gid=label, zorder=4)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(f"{view.labels[0]}, seen {view.title}")
    axes.set_ylabel(view.labels[1])
    axes.set_title(f"{mode.name}\n{_words(mode)}")


def _ship(axes: Axes, motion: Motion, factor: complex, view: View, colour: str, gid: str, dashed: bool = False) -> None:
    """Draw the ship's outlines at a complex factor."""
    position, rotation = motion.pose(factor)
    for outline in ship_outlines(motion.shape, position, rotation, view):
        face = "none" if dashed else (colour, 0.08)
        line = (0, (4, 2)) if dashed else "-"
        looks = {"facecolor": face, "edgecolor": colour, "linewidth": style.THIN, "linestyle": line}
        axes.add_patch(Polygon(outline, gid=gid, zorder=3, **looks))


def _words(mode: Mode) -> str:
    """Return what the mode does, in a line."""
    time = mode.half_or_double_time
    change = "amplitude stays" if time is None else f"{'halves' if mode.stable else 'doubles'} in {time:.3g} s"
    return change if mode.period is None else f"period {mode.period:.3g} s, {change}"
