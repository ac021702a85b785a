"""What is identified, between which bounds, and why there. Depends on: scenario.

Bounds are those of the literature for an airship of this size where there are any; thrust is bounded by what the
trim needs and by what the sums of Table 6 allow. Every parameter is a dotted name of a scenario (`list_parameters`).
"""

from typing import NamedTuple

import numpy as np

THRUSTERS = ("tail_forward", "tail_down", "port_up", "starboard_up", "port_forward", "starboard_forward")
LIFT_PER_AREA = 5.73 * 0.40
"""C_Nα η_f of `lotte.toml` [1/rad]: 2.88 m² of fin are 6.6 m² of lift area."""


class Unknown(NamedTuple):
    """One unpublished number.

    Attributes
    ----------
    name : str
        Short name.
    parameters : tuple of str
        Dotted names of the numbers that it sets, all to the same value.
    unit : str
        SI unit.
    low, high : float
        Bounds, in that unit: [m²], [m], [-] or [N].
    logarithmic : bool
        Searched in its logarithm.
    source : str
        Where the bounds come from.
    """

    name: str
    parameters: tuple[str, ...]
    unit: str
    low: float
    high: float
    logarithmic: bool
    source: str


def _thrust(name: str, *thrusters: str) -> Unknown:
    keys = tuple(f"vehicle.thrusters.{thruster}.nominal_thrust" for thruster in thrusters)
    return Unknown(name, keys, "N", 40.0, 500.0, True, "from what trim needs at 12 m/s to four times Lotte's 120 N")


UNKNOWNS = (
    Unknown(
        "fin_area",
        ("vehicle.fins.*.area",),
        "m^2",
        2.1,
        5.3,
        True,
        "S C_Nα η_f of 4.8 to 12.1 m² per fin puts the spectrum where Fig. 6 has it",
    ),
    Unknown(
        "fin_station",
        ("vehicle.fins.*.aerodynamic_station",),
        "m",
        -6.9,
        -5.2,
        False,
        "on a tail that ends 9.03 m aft of the centre of buoyancy, its root from l_h on",
    ),
    Unknown(
        "fin_cross_flow",
        ("vehicle.fins.*.cross_flow_drag_coefficient",),
        "1",
        1.0,
        2.0,
        False,
        "flat plate across the flow, low to high aspect ratio",
    ),
    Unknown(
        "hull_cross_flow",
        ("vehicle.envelope.cross_flow_drag_coefficient",),
        "1",
        0.30,
        0.60,
        False,
        "0.3 to 0.5 in use for hulls (Jones and DeLaurier 1983), 0.6 for a rough cylinder beyond its drag crisis",
    ),
    Unknown(
        "slice_efficiency",
        ("vehicle.envelope.slice_efficiency",),
        "1",
        1.0,
        1.19,
        False,
        "1.0 to 1.19 in use (Jones and DeLaurier 1983)",
    ),
    Unknown(
        "potential_length",
        ("vehicle.envelope.potential_length",),
        "m",
        11.0,
        14.0,
        False,
        "the leading edge of the fins' root, 4 to 7 m aft of the centre of buoyancy",
    ),
    Unknown(
        "axial_drag",
        ("vehicle.envelope.axial_drag_coefficient",),
        "1",
        0.020,
        0.045,
        False,
        "0.023 to 0.026 for the bare hull (Hoerner), up to 0.045 with fins, gondola and rigging",
    ),
    _thrust("thrust_tail_forward", "tail_forward"),
    _thrust("thrust_tail_down", "tail_down"),
    _thrust("thrust_up", "port_up", "starboard_up"),
    _thrust("thrust_forward", "port_forward", "starboard_forward"),
)
"""The search space."""


def to_values(shares: np.ndarray, unknowns: tuple[Unknown, ...] = UNKNOWNS) -> np.ndarray:
    """Return values for places between the bounds, 0 … 1 [-], last axis the unknown.

    They are in the unknowns' SI units, of `UNKNOWNS` [m², m, -, N]: low + p (high − low), or low (high/low)^p of one
    that is searched in its logarithm.
    """
    low = np.array([u.low for u in unknowns])
    high = np.array([u.high for u in unknowns])
    logarithmic = np.array([u.logarithmic for u in unknowns])
    safe_low, safe_high = np.where(logarithmic, low, 1.0), np.where(logarithmic, high, 1.0)
    return np.where(logarithmic, safe_low * (safe_high / safe_low) ** shares, low + shares * (high - low))


def to_shares(values: np.ndarray, unknowns: tuple[Unknown, ...] = UNKNOWNS) -> np.ndarray:
    """Return the places between the bounds, 0 … 1 [-], of values [m², m, -, N]: the inverse of `to_values`."""
    low = np.array([u.low for u in unknowns])
    high = np.array([u.high for u in unknowns])
    logarithmic = np.array([u.logarithmic for u in unknowns])
    safe = np.where(logarithmic, values, 1.0), np.where(logarithmic, low, 1.0), np.where(logarithmic, high, 2.0)
    in_logarithm = np.log(safe[0] / safe[1]) / np.log(safe[2] / safe[1])
    return np.where(logarithmic, in_logarithm, (values - low) / (high - low))


def named_values(values: np.ndarray, unknowns: tuple[Unknown, ...] = UNKNOWNS) -> dict[str, np.ndarray]:
    """Return columns by dotted name for values [m², m, -, N] of shape (vectors, unknowns).

    They are what `Cases.with_columns` takes, shape (vectors,) each; an unknown that sets several numbers has as many.
    """
    return {key: values[..., i] for i, unknown in enumerate(unknowns) for key in unknown.parameters}
