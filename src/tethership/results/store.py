"""Labelled outputs of a flight: arrays to an xarray dataset and back. Depends on: results.schema, errors."""

import json
from typing import Any

import numpy as np
import xarray as xr

from tethership._version import __version__
from tethership.errors import ConfigError
from tethership.results.schema import (
    ANGLES,
    ATTRIBUTES,
    BODY,
    FLIGHT,
    FORMAT,
    GROUND,
    OWN_VARIABLES,
    REGIMES,
    SINCE_LAYOUT_2,
    VARIABLES,
)


def to_dataset(arrays: dict[str, np.ndarray], names: dict[str, list[str]], attributes: dict[str, Any]) -> xr.Dataset:
    """Return a labelled dataset of a flight.

    Parameters
    ----------
    arrays : dict
        Outputs by the names of the schema, with `time` [s]; the first axis is time.
    names : dict
        Labels of the dimensions `thruster`, `fin`, `load`, `cable`.
    attributes : dict
        Input, versions and outcome by the names of the schema; anything that JSON holds.

    Raises
    ------
    KeyError
        An array or an attribute is not in the schema.
    """
    if unknown := set(attributes) - set(ATTRIBUTES):
        raise KeyError(f"results.schema.ATTRIBUTES has no {', '.join(sorted(unknown))}")
    labels = {"body_axis": BODY, "ground_axis": GROUND, "angle": ANGLES, **names}
    variables = {}
    for name, array in arrays.items():
        if name == "time":
            continue
        entry = (VARIABLES | OWN_VARIABLES)[name]
        described = {"units": entry.unit, "long_name": entry.meaning}
        if entry.frame:
            described["frame"] = entry.frame
        if name == "regime":
            described["flag_meanings"] = " ".join(REGIMES)
        variables[name] = (("time", *entry.dims), np.asarray(array, dtype=np.float64), described)
    coordinates: dict[str, Any] = {"time": ("time", arrays["time"], {"units": "s", "long_name": "time"})}
    used = {dim for name in arrays if name != "time" for dim in (VARIABLES | OWN_VARIABLES)[name].dims}
    coordinates |= {key: (key, list(value)) for key, value in labels.items() if key in used and len(value)}
    written = {key: json.dumps(value, sort_keys=True) for key, value in attributes.items()}
    header = {"kind": FLIGHT.name, "format": FORMAT, "tethership_version": __version__}
    return xr.Dataset(variables, coordinates, {**header, **written})


def attributes_of(dataset: xr.Dataset) -> dict[str, Any]:
    """Return the attributes of a flight's dataset, decoded; those that others added are left alone.

    Raises
    ------
    ConfigError
        One of them is no JSON.
    """
    found = {}
    for name in ATTRIBUTES:
        if name in dataset.attrs:
            try:
                found[name] = json.loads(str(dataset.attrs[name]))
            except (ValueError, RecursionError) as error:
                raise ConfigError(f"the flight's attribute {name} is not readable: {error}") from error
    return found


def check_flight(dataset: xr.Dataset, origin: str) -> None:
    """Check that a file's dataset is a flight: every output with its unit, dimensions and finite numbers, in time.

    Raises
    ------
    ConfigError
        It is not.
    """
    if "time" not in dataset.variables:
        raise ConfigError(f"{origin} is no whole flight: time is missing")
    own = {name: entry for name, entry in OWN_VARIABLES.items() if name in dataset.variables}
    expected = {name: (entry.unit, ("time", *entry.dims)) for name, entry in (VARIABLES | own).items()}
    for name, (unit, dims) in {"time": ("s", ("time",)), **expected}.items():
        if name in SINCE_LAYOUT_2 and name not in dataset.variables:
            continue  # where a file of layout 2 lost it, its checksums have said so
        problem = _problem(dataset, name, unit, dims)
        if problem is not None:
            raise ConfigError(f"{origin} is no whole flight: {name} {problem}; take a whole copy, or fly it again")
    if np.any(np.diff(dataset["time"].values) < 0):
        raise ConfigError(f"{origin} is no whole flight: its time runs backwards; take a whole copy, or fly it again")


def _problem(dataset: xr.Dataset, name: str, unit: str, dims: tuple[str, ...]) -> str | None:
    """Return what is wrong with an output, None where nothing is."""
    if name not in dataset.variables:
        return "is missing"
    variable = dataset.variables[name]
    sizes = {"body_axis": len(BODY), "ground_axis": len(GROUND), "angle": len(ANGLES)}
    if variable.dims != dims or variable.dtype.kind != "f":
        return f"has dimensions {', '.join(map(str, variable.dims))} of {variable.dtype}, not numbers over {dims}"
    if any(variable.sizes[dim] != size for dim, size in sizes.items() if dim in dims):
        return "has not three components"
    if variable.attrs.get("units") != unit:
        return f"is in {variable.attrs.get('units')!r}, not in {unit!r}"
    if name != "cable_curve" and not np.isfinite(variable.values).all():  # a slack curve may have no points
        return "has numbers that are not finite"
    return None
