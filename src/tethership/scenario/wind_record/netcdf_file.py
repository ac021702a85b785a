"""Columns of a netCDF file, 3 or 4, with CF attributes. Depends on: xarray, errors."""

import math
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr

from tethership.errors import ConfigError
from tethership.scenario.wind_record.column import MOST_VALUES, Column
from tethership.scenario.wind_record.names import role_of, to_si

ENGINES = {b"\x89HDF": "h5netcdf", b"CDF\x01": "scipy", b"CDF\x02": "scipy"}
"""Who reads a file, by its first bytes."""


def read_netcdf(path: Path) -> list[Column]:
    """Return the variables of a netCDF file that are known, and the names alone of those that are not.

    Packed numbers are unpacked and `_FillValue` and `missing_value` become NaN; times stay numbers. Values are in the
    file's own units, the heights of columns in [m].

    Raises
    ------
    ConfigError
        It cannot be read, declares more than is read, or has a wind of more than one place.
    """
    with path.open("rb") as file:
        engine = ENGINES.get(file.read(4))
    if engine is None:
        raise ConfigError(f"cannot read the wind of {path}: it is no netCDF file (truncated, or another kind)")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # xarray's, of a second fill value
            opened = xr.open_dataset(path, engine=engine, decode_times=False, create_default_indexes=False)
            with opened as data:  # an index would be read whole, whatever its size
                return list(_columns(data, path))
    except ConfigError:
        raise
    except Exception as error:  # a hostile file can make the readers raise anything
        reason = (str(error).splitlines() or [type(error).__name__])[0]
        raise ConfigError(f"cannot read the wind of {path}: {reason}") from error


def _columns(data: xr.Dataset, path: Path) -> Iterator[Column]:
    """Yield a column for each variable, and for each height where it runs over heights."""
    roles = {str(name): role_of(str(name), str(v.attrs.get("standard_name", ""))) for name, v in data.variables.items()}
    over_time = next(
        (data.variables[n].dims[0] for n in roles if roles[n] == "time" and data.variables[n].ndim == 1), ""
    )
    for name, role in roles.items():
        if role is None or (role == "time" and data.variables[name].dims != (over_time,)):
            yield Column(name, np.zeros(0))
            continue
        variable = data.variables[name]
        if variable.size > MOST_VALUES:
            raise ConfigError(
                f"{path}: {name} declares {variable.size:.3g} values, at most {MOST_VALUES:.0e} are read; cut out the "
                "place and time to be flown"
            )
        described = (str(variable.attrs.get("units", "")), str(variable.attrs.get("standard_name", "")))
        if role in ("height", "time"):
            yield Column(name, variable.to_numpy().reshape(-1), *described)
            continue
        others = [d for d in variable.dims if d != over_time and variable.sizes[d] != 1]
        heights = _heights(data, roles, others, path)
        if len(heights) != math.prod(variable.sizes[d] for d in others):
            over = ", ".join(f"{d} ({variable.sizes[d]})" for d in others)
            raise ConfigError(f"{path}: {name} runs over {over} besides time; select one place first")
        table = variable.transpose(..., *others).to_numpy().reshape(-1, len(heights))
        for index, height in enumerate(heights):
            yield Column(name, table[:, index], *described, height)


def _heights(data: xr.Dataset, roles: dict[str, str | None], dims: list, path: Path) -> list[float | None]:
    """Return the heights [m] along the dimension of heights, None alone where there is no such dimension."""
    for name, role in roles.items():
        variable = data.variables[name]
        if role == "height" and list(variable.dims) == dims and len(dims) == 1 and variable.size <= MOST_VALUES:
            column = Column(name, variable.to_numpy(), str(variable.attrs.get("units", "")))
            return [float(height) for height in to_si(column, "height", path)]
    return [None]
