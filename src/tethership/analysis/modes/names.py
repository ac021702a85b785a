"""Names of modes from what takes part in them, never from their order. Depends on: numpy, scipy.

Every state has a mode that it rules in a free ship. Eigenvalues are assigned to these by the largest total
participation; an oscillation that is assigned to two of them is the two coalesced, e.g. surge–north.

The words are those of section 3.1 of Riboldi et al.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy.optimize


class Slot(NamedTuple):
    """A mode that may be there.

    Attributes
    ----------
    name : str
        As in the paper.
    short : str
        In the name of a coalesced mode.
    signature : dict
        Weight of each state's participation [-].
    """

    name: str
    short: str
    signature: dict[str, float]


_PENDULUM = Slot("pendulum", "pendulum", {"theta": 1.0, "q": 0.3, "w": 0.3})
_ROLL = Slot("roll oscillation", "roll", {"phi": 1.0, "p": 1.0})

SLOTS: dict[str, Slot] = {
    "q": Slot("pitch subsidence", "pitch", {"q": 1.0, "w": 0.7}),
    "r": Slot("yaw subsidence", "yaw", {"r": 1.0, "v": 0.4}),
    "u": Slot("surge", "surge", {"u": 1.0}),
    "v": Slot("side-slip", "side-slip", {"v": 1.0, "r": 0.3}),
    "theta": _PENDULUM,
    "w": _PENDULUM,
    "phi": _ROLL,
    "p": _ROLL,
    "psi": Slot("heading", "heading", {"psi": 1.0}),
    "north": Slot("north", "north", {"north": 1.0}),
    "east": Slot("east", "east", {"east": 1.0}),
    "down": Slot("vertical", "vertical", {"down": 1.0}),
}
"""The mode that each state rules. Velocities are meant relative to the air (comparable coordinates)."""


def slots_of(states: Sequence[str]) -> list[Slot]:
    """Return a slot for every state; a cable's length has one of its own."""
    return [
        SLOTS.get(state, Slot(state.replace("_", " "), state.replace("_", " "), {state: 1.0}))
        for state in _in_order(states)
    ]


def _in_order(states: Sequence[str]) -> list[str]:
    """Return the states in the order in which their modes are told."""
    known = [state for state in SLOTS if state in states]
    return known + [state for state in states if state not in SLOTS]


def unique(names: Sequence[str]) -> list[str]:
    """Return the names with ' 2', ' 3' behind those that come again."""
    seen: dict[str, int] = {}
    result = []
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        result.append(name if seen[name] == 1 else f"{name} {seen[name]}")
    return result


def track_names(states: Sequence[str]) -> list[str]:
    """Return one name for every eigenvalue, in the order of `slots_of`.

    An oscillation has two, e.g. pendulum and pendulum 2.
    """
    return unique([slot.name for slot in slots_of(states)])


def assign(participation: np.ndarray, states: Sequence[str], pairs: np.ndarray) -> np.ndarray:
    """Return the slot of every eigenvalue.

    Parameters
    ----------
    participation : ndarray
        |share| of each state (rows) in each eigenvalue (columns) [-], shape (n, n).
    states : sequence of str
        Names of the rows.
    pairs : ndarray of int
        Place of each eigenvalue's conjugate, its own where it is real, shape (n,).

    Returns
    -------
    ndarray of int
        Place of each eigenvalue's slot in `slots_of(states)`, shape (n,).
    """
    slots = slots_of(states)
    weights = np.array([[slot.signature.get(state, 0.0) for state in states] for slot in slots])
    both = 0.5 * (participation + participation[:, pairs])
    # Participations near a coalescence grow without bound: shares of each mode are compared, not sizes.
    share = both / np.maximum(both.sum(axis=0), 1e-300)
    slot, column = scipy.optimize.linear_sum_assignment(weights @ share, maximize=True)
    result = np.empty(len(states), dtype=int)
    result[column] = slot
    return result


def mode_name(first: Slot, second: Slot | None, share: dict[str, float]) -> str:
    """Return the name of a real mode (one slot) or of an oscillation (two).

    Parameters
    ----------
    first, second : Slot
        What it is assigned to.
    share : dict
        Participation of each state [-].
    """
    if second is None or first.name == second.name:
        return first.name
    return "–".join(_short(slot, share) for slot in (first, second))


def _short(slot: Slot, share: dict[str, float]) -> str:
    """Return a slot's word in a coalesced name: a pitch mode that is mostly vertical motion is heave."""
    heaves = slot.short == "pitch" and share.get("w", 0.0) > 2.0 * share.get("q", 0.0)
    return "heave" if heaves else slot.short
