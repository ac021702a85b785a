"""Which quantities a trim looks for, by name. Depends on: plant.names, errors."""

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from tethership.errors import ConfigError, suggestion
from tethership.plant import ALL_FINS, ALL_THRUSTERS, QUANTITIES

DOWN = QUANTITIES.index("down")
"""Place of the height."""

SCALES = (1.0, 1.0, 1.0, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 1.0, 1.0, 1.0)
"""Unit in which each is looked for [m/s, rad/s, rad, m]."""

LARGEST = {6: np.pi / 2.0, 7: np.deg2rad(80.0)}
"""Largest |φ| and |θ| that a trim looks at [rad]: beyond them Euler angles fail."""


class Unknowns(eqx.Module):
    """A choice among all quantities (12 of the motion, throttles, deflections).

    Attributes
    ----------
    index : tuple of int
        Places of the chosen ones.
    scale : Float[Array, "unknowns"]
        Unit of each, so that a step of 1 is moderate for all: 1 m/s, 0.1 rad/s, 0.1 rad, 1 m; of throttles 1 [-], of
        deflections 1 [rad].
    effort : Float[Array, "unknowns"]
        Weight [-]: 1 for throttles and deflections, whose norm is kept least, 0 for states.
    """

    index: tuple[int, ...] = eqx.field(static=True)
    scale: Float[Array | np.ndarray, "unknowns"]
    effort: Float[Array | np.ndarray, "unknowns"]

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the least and largest value of each in units of its scale: φ within ±π/2, θ within ±80π/180 [rad].

        All others have no bound (±∞). Shapes (unknowns,).
        """
        reach = np.array([LARGEST.get(i, np.inf) for i in self.index]) / np.asarray(self.scale)
        return -reach, reach

    def taken(self, everything: np.ndarray) -> np.ndarray:
        """Return the chosen ones of all quantities [m/s, rad/s, rad, m, -], divided by their scales."""
        return everything[list(self.index)] / np.asarray(self.scale)

    def placed(self, everything: Float[Array, "n"], values: Float[Array, "unknowns"]) -> Float[Array, "n"]:
        """Return all quantities [m/s, rad/s, rad, m, -] with the chosen ones replaced by values times their scales."""
        return everything.at[np.array(self.index, dtype=int)].set(values * self.scale)


def find_unknowns(
    names: tuple[str, ...],
    thrusters: list[str],
    fins: list[str],
) -> Unknowns:
    """Return the choice of what is looked for.

    Parameters
    ----------
    names : tuple of str
        Of `plant.names.QUANTITIES` (looked for in steps of 1 m/s, 0.1 rad/s, 0.1 rad, 1 m), of thrusters (1 [-]) and
        fins (1 [rad]), or `throttle` and `deflection` for all of them.
    thrusters, fins : list of str
        Names of the vehicle's.

    Raises
    ------
    ConfigError
        A name is no quantity, thruster or fin, or nothing is looked for.
    """
    every = [*QUANTITIES, *thrusters, *fins]
    groups = {ALL_THRUSTERS: thrusters, ALL_FINS: fins}
    index: list[int] = []
    for name in names:
        members = groups.get(name, [name])
        index += [_place(member, every, list(groups)) for member in members]
    if not index:
        raise ConfigError("trim: nothing is looked for; name quantities, thrusters or `throttle` as unknowns")
    index = sorted(set(index))
    scales = [*SCALES, *[1.0] * (len(thrusters) + len(fins))]
    efforts = [0.0] * 12 + [1.0] * (len(thrusters) + len(fins))
    return Unknowns(tuple(index), np.asarray([scales[i] for i in index]), np.asarray([efforts[i] for i in index]))


def find_places(names: tuple[str, ...], thrusters: list[str], fins: list[str]) -> tuple[int, ...]:
    """Return the places of quantities by name; raises ConfigError for a name that is none."""
    every = [*QUANTITIES, *thrusters, *fins]
    return tuple(_place(name, every, []) for name in names)


def _place(name: str, every: list[str], groups: list[str]) -> int:
    """Return the place of a name, or raise ConfigError that offers the nearest."""
    if name in every:
        return every.index(name)
    hint = suggestion(name, [*every, *groups])
    raise ConfigError(f"trim: unknown quantity {name!r}{hint} Allowed: {', '.join([*every, *groups])}")
