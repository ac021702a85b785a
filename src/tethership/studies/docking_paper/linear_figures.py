"""Figures 6–11 of the paper: root loci of section 3. Depends on: analysis, scenario.

Where the print lists no values between the ones it names, the values here say what was taken.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from tethership.analysis.linear import linearize
from tethership.analysis.loci import sweep
from tethership.analysis.modes import Modes
from tethership.analysis.trim import trim
from tethership.errors import ConfigError
from tethership.scenario import Scenario, build_hull, load_scenario
from tethership.view.linear import Panel

TETHER_POINT = 0.8 * 20.0 * np.array([-np.sqrt(0.5), 0.0, -np.sqrt(0.5)])
"""Where the tether point is trimmed, ground axes [m] (section 3)."""

NOSE = 6.97
"""The nose, forward of B [m] (section 3)."""

LIGHTEST = 0.02e-3
"""Diameter of the cable taken as infinitely thin [m]."""

LIGHT = (2.5e-3, 6e-3)
REFERENCE = (10e-3, 80e-3)
HEAVY = (14e-3, 140e-3)
"""Cables named in section 3.1: diameter [m], linear density [kg/m]."""

STATIONS = (6.97, 6.92, 6.8, 6.6, 6.3, 5.9, 5.37, 4.57, 3.77, 2.17, 0.57, -1.03, -2.63, -4.23, -5.83, -7.43, -9.03)
"""Tether points along the bottom line, forward of B [m]: 5.37 and 3.77 are in print, finer towards the nose."""

ELONGATIONS = (0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.92, 0.935, 0.95)
"""Elongations e₀ [-]: 0.5 to 0.95, the last three finer, as the text says."""


class LinearFigure(NamedTuple):
    """One figure of the paper, computed.

    Attributes
    ----------
    number : int
        In the paper.
    title : str
        What it shows.
    formulation : str
        consistent or published.
    panels : tuple of Panel
    """

    number: int
    title: str
    formulation: str
    panels: tuple[Panel, ...]


Changes = Mapping[str, Any]
"""Dotted name → value, as `load_scenario` takes."""


def free_ship(changes: Changes) -> Scenario:
    """Return the untethered ship where it would be on the cable: at `TETHER_POINT` less `NOSE`, along north [m]."""
    place = TETHER_POINT - np.array([NOSE, 0.0, 0.0])
    return load_scenario("hover", {"trim.position": place.tolist(), **changes})


def free_modes(changes: Changes, nine_states: bool = False) -> Modes:
    """Return the modes of the untethered ship, λ [1/s], of twelve states or of nine."""
    scenario = free_ship(changes)
    model = linearize(scenario, trim(scenario))
    return (model.without_position() if nine_states else model).modes()


def light_cables(count: int = 11) -> tuple[np.ndarray, np.ndarray]:
    """Return diameters [m] and linear densities [kg/m] up to 2.5 mm and 6 g/m: density as diameter squared."""
    diameter = np.linspace(LIGHTEST, LIGHT[0], count)
    return diameter, LIGHT[1] * (diameter / LIGHT[0]) ** 2


def heavy_cables(count: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """Return diameters [m] and linear densities [kg/m] from there to 14 mm and 140 g/m.

    They pass through the reference, density interpolated in logarithms.
    """
    diameter = np.linspace(LIGHT[0], HEAVY[0], count)
    corners = np.log(np.array([LIGHT, REFERENCE, HEAVY]))
    return diameter, np.exp(np.interp(np.log(diameter), corners[:, 0], corners[:, 1]))


def bottom_line(scenario: Scenario) -> tuple[np.ndarray, np.ndarray]:
    """Return forward and down coordinates [m] of tether points along the bottom line, nose to tail."""
    hull = build_hull(scenario.config.vehicle.hull)
    forward = np.array(STATIONS)
    station = np.clip(float(hull.centre()) - forward, 0.0, float(hull.length))
    return forward, np.asarray(hull.radius(jnp.asarray(station)))


def figure_6(changes: Changes) -> tuple[Panel, ...]:
    """Free ship at rest in a wind of 6 m/s, λ [1/s]: nine states against twelve."""
    scenario = free_ship(changes)
    twelve = sweep(scenario, {"wind.speed": [scenario.config.wind.speed]})
    return (Panel("untethered", twelve, "wind.speed", 0, free_modes(changes, nine_states=True), slow=False),)


def _cable_panels(scenario: Scenario, cables: str, changes: Changes) -> tuple[Panel, ...]:
    """Return the panels of light and of heavy cables."""
    names = f"{cables}.diameter", f"{cables}.linear_density"
    light = sweep(scenario, dict(zip(names, light_cables(), strict=True)))
    heavy = sweep(scenario, dict(zip(names, heavy_cables(), strict=True)))
    free, star = free_modes(changes), int(np.argmin(np.abs(heavy_cables()[0] - REFERENCE[0])))
    return (
        Panel("lighter cables, to 6 g/m and 2.5 mm", light, names[0], None, free, slow=True),
        Panel("heavier cables, to 140 g/m and 14 mm", heavy, names[0], star, None, slow=True),
    )


def figure_7(changes: Changes) -> tuple[Panel, ...]:
    """One cable at the nose, from nothing to heavy, coloured by its diameter [m]."""
    return _cable_panels(load_scenario("docking", changes), "cables.nose", changes)


def figure_8(changes: Changes) -> tuple[Panel, ...]:
    """Two cables at the sides, from nothing to heavy, coloured by their diameter [m]."""
    return _cable_panels(load_scenario("side_cables", changes), "cables.*", changes)


def figure_9(changes: Changes) -> tuple[Panel, ...]:
    """Move the tether point along the bottom line, nose to tail, coloured by how far forward of B it is [m]."""
    scenario = load_scenario("docking", changes)
    forward, down = bottom_line(scenario)
    found = sweep(scenario, {"cables.nose.tether_point.0": forward, "cables.nose.tether_point.2": down})
    return (Panel("tether point along the bottom line", found, "cables.nose.tether_point.0", 0, None, slow=True),)


def figure_10(changes: Changes) -> tuple[Panel, ...]:
    """Wind from 6 to 12 [m/s]."""
    found = sweep(load_scenario("docking", changes), {"wind.speed": np.linspace(6.0, 12.0, 13)})
    return (
        Panel("wind", found, "wind.speed", 0, None, slow=False),
        Panel("wind, slow modes", found, "wind.speed", 0, None, slow=True),
    )


def figure_11(changes: Changes) -> tuple[Panel, ...]:
    """Elongation from 0.5 to 0.95 [-]."""
    found = sweep(load_scenario("docking", changes), {"trim.elongation": ELONGATIONS})
    star = ELONGATIONS.index(0.8)
    return (
        Panel("elongation", found, "trim.elongation", star, None, slow=False),
        Panel("elongation, slow modes", found, "trim.elongation", star, None, slow=True),
    )


FIGURES: dict[int, tuple[str, Callable[[Changes], tuple[Panel, ...]]]] = {
    6: ("Untethered ship: nine states and twelve", figure_6),
    7: ("One nose cable, ever heavier", figure_7),
    8: ("Two side cables, ever heavier", figure_8),
    9: ("Tether point from nose to tail", figure_9),
    10: ("Wind from 6 to 12 m/s", figure_10),
    11: ("Elongation of the cable from 0.5 to 0.95", figure_11),
}
"""Title and maker of each figure of section 3."""


def linear_figure(number: int, formulation: str = "consistent", changes: Changes | None = None) -> LinearFigure:
    """Return one of Figures 6–11, computed.

    Parameters
    ----------
    number : int
        6 to 11.
    formulation : str
        consistent or published.
    changes : mapping, optional
        Further changes of the scenario, e.g. of the fins.

    Raises
    ------
    ConfigError
        The paper has no root locus of that number, or a change cannot be.
    """
    if number not in FIGURES:
        raise ConfigError(
            f"the paper has no root locus in figure {number}; give one of {', '.join(map(str, FIGURES))} (12 to 15 are "
            "flights: tethership dock)"
        )
    title, maker = FIGURES[number]
    return LinearFigure(number, title, formulation, maker({**(changes or {}), "formulation": formulation}))
