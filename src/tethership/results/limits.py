"""Limits of tension that are watched, by name, and which of them are passed. Depends on nothing."""

from collections.abc import Mapping

LIMITS = ("control_threshold", "envelope_tear", "envelope_tensile", "cable_break")
"""Names of the tensions that are watched, in the order in which results list them."""

HARMFUL = LIMITS[1:]
"""Limits that are not to be passed: beyond the first of all the winch only slows down."""


def ratios_passed(limits: Mapping[str, float], reached: Mapping[str, float]) -> dict[str, float]:
    """Return name → tension over limit [-] of every limit that is passed.

    Parameters
    ----------
    limits : mapping
        Tension of each limit [N].
    reached : mapping
        Largest tension that each is held against [N].

    Examples
    --------
    >>> from tethership.results.limits import ratios_passed
    >>> ratios_passed({"envelope_tear": 481.0, "cable_break": 3040.0}, {"envelope_tear": 962.0, "cable_break": 1000.0})
    {'envelope_tear': 2.0}
    """
    return {name: reached[name] / limit for name, limit in limits.items() if reached[name] >= limit}
