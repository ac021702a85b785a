"""The points of a sweep: parameters moved along axes, checked, and lines filled up. Depends on: scenario, errors."""

import fnmatch
import math
from collections.abc import Mapping, Sequence

import numpy as np

from tethership.errors import ConfigError
from tethership.scenario import Parameter, Scenario, check_values, find_parameter, list_parameters

Axis = Mapping[str, Sequence[float] | np.ndarray]
"""Parameters moved together along one axis: name → values [SI]."""


MOST_POINTS = 100_000
"""Points of one sweep: its results stay in memory."""

USUAL = (
    "wind.speed",
    "trim.elongation",
    "cables.*.tether_point.0",
    "cables.*.tether_point.2",
    "cables.*.diameter",
    "cables.*.linear_density",
    "cables.*.length",
)
"""Numbers that are swept often: one compiled program serves every choice of them, which spares 10 s of compiling."""


def lay_grid(scenario: Scenario, axes: tuple[Axis, ...]) -> tuple[list[Parameter], np.ndarray, tuple[int, ...]]:
    """Return the parameters, their values [SI] at all points (points, parameters) and the shape of the grid.

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`.
    axes : tuple of mapping
        Names and values of the parameters moved together along each axis; a length is in [m], an angle in [rad].

    Raises
    ------
    ConfigError
        It is no scenario, a name or a range is not usable, two move the same number, there are more than `MOST_POINTS`,
        or a value is outside what the file allows.
    """
    if not isinstance(scenario, Scenario):
        raise ConfigError(f"sweep: a scenario is needed, not {scenario!r}; give what load_scenario() returns")
    known = list_parameters(scenario.config)
    parameters: list[Parameter] = []
    columns: list[tuple[int, np.ndarray]] = []
    shape: list[int] = []
    if not axes or not all(axes):
        raise ConfigError("sweep: name at least one parameter with its values")
    for index, axis in enumerate(axes):
        checked = {name: _checked(name, values) for name, values in axis.items()}
        lengths = {name: len(values) for name, values in checked.items()}
        if len(set(lengths.values())) != 1:
            raise ConfigError(f"sweep: parameters moved together need as many values each; there are {lengths}")
        shape.append(next(iter(lengths.values())))
        for name, values in checked.items():
            parameter = find_parameter(known, name, scenario.name)
            _check_alone(parameter, parameters)
            parameters.append(parameter)
            columns.append((index, values))
    if math.prod(shape) > MOST_POINTS:
        raise ConfigError(f"sweep: {math.prod(shape)} points are too many (at most {MOST_POINTS}); sweep in parts")
    mesh = np.meshgrid(*[np.arange(count) for count in shape], indexing="ij")
    grid = np.stack([values[mesh[index].ravel()] for index, values in columns], axis=1)
    extremes = {0, len(grid) - 1, *np.argmin(grid, axis=0).tolist(), *np.argmax(grid, axis=0).tolist()}
    for row in sorted(extremes):  # bounds are intervals: what the extremes may, all between may
        check_values(scenario, parameters, grid[row].tolist())
    return parameters, grid, tuple(shape)


def _check_alone(parameter: Parameter, others: list[Parameter]) -> None:
    """Raise ConfigError where a parameter moves a number that another one moves."""
    for other in others:
        if other.name == parameter.name:
            raise ConfigError(f"sweep: {parameter.name} is named twice; name each parameter once")
        if set(other.places) & set(parameter.places):
            raise ConfigError(f"sweep: {other.name} and {parameter.name} move the same number; name one of them")


def _checked(name: str, given: Sequence[float] | np.ndarray) -> np.ndarray:
    """Return the values of a parameter, or raise ConfigError."""
    try:
        values = np.atleast_1d(np.asarray(given, dtype=float))
    except (TypeError, ValueError) as error:
        raise ConfigError(
            f"sweep: the range of {name} is {given!r}, no list of numbers; give e.g. [6, 9, 12]"
        ) from error
    if values.ndim != 1:
        raise ConfigError(f"sweep: the range of {name} is a table, not a list of numbers; give e.g. [6, 9, 12]")
    if values.size == 0:
        raise ConfigError(f"sweep: the range of {name} is empty; give at least one value")
    if not np.isfinite(values).all():
        raise ConfigError(f"sweep: the range of {name} has values that are not finite numbers")
    return values


def fill_lines(grid: np.ndarray, count: int, fill: int) -> tuple[np.ndarray, int]:
    """Return the points with `fill` − 1 more between neighbours of every line, and how many a line then has.

    Parameters
    ----------
    grid : ndarray
        Parameters of every point in SI ([m], [m/s], [rad], …), shape (points, parameters), the points of a line in a
        row.
    count : int
        How many points a line has.
    fill : int
        Into how many equal steps each step is cut.
    """
    lines = grid.reshape(-1, count, grid.shape[1])
    places = np.linspace(0.0, count - 1.0, (count - 1) * fill + 1)
    before = np.minimum(places.astype(int), max(count - 2, 0))
    share = (places - before)[:, None]
    after = np.minimum(before + 1, count - 1)
    fine = (1.0 - share) * lines[:, before] + share * lines[:, after]
    fine[:, ::fill] = lines
    return fine.reshape(-1, grid.shape[1]), len(places)


def usual_places(scenario: Scenario) -> list[int]:
    """Return the leaves of a scenario's `USUAL` numbers, one by one."""
    known = list_parameters(scenario.config)
    single = {name: parameter for name, parameter in known.items() if "*" not in name}
    chosen = (single[name] for name in single if any(fnmatch.fnmatchcase(name, pattern) for pattern in USUAL))
    return [place for parameter in chosen for place in parameter.places]
