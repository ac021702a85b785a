"""Labelled outputs: arrays to an xarray dataset, to netCDF and back. Depends on: results.schema, errors."""

import json
import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from tethership._version import __version__
from tethership.errors import ConfigError
from tethership.results.schema import ANGLES, BODY, FORMAT, GROUND, REGIMES, VARIABLES

KIND = "tethership flight"
"""What a flight file says it is."""


def to_dataset(arrays: dict[str, np.ndarray], names: dict[str, list[str]], attributes: dict[str, Any]) -> xr.Dataset:
    """Return a labelled dataset of a flight.

    Parameters
    ----------
    arrays : dict
        Outputs by the names of the schema, with `time` [s]; the first axis is time.
    names : dict
        Labels of the dimensions `thruster`, `fin`, `load`, `cable`.
    attributes : dict
        Input, versions and outcome; anything that JSON holds.

    Raises
    ------
    KeyError
        An array is not in the schema.
    """
    labels = {"body_axis": BODY, "ground_axis": GROUND, "angle": ANGLES, **names}
    variables = {}
    for name, array in arrays.items():
        if name == "time":
            continue
        entry = VARIABLES[name]
        described = {"units": entry.unit, "long_name": entry.meaning}
        if entry.frame:
            described["frame"] = entry.frame
        if name == "regime":
            described["flag_meanings"] = " ".join(REGIMES)
        variables[name] = (("time", *entry.dims), np.asarray(array, dtype=np.float64), described)
    coordinates: dict[str, Any] = {"time": ("time", arrays["time"], {"units": "s", "long_name": "time"})}
    used = {dim for name in arrays if name != "time" for dim in VARIABLES[name].dims}
    coordinates |= {key: (key, list(value)) for key, value in labels.items() if key in used and len(value)}
    written = {key: json.dumps(value, sort_keys=True) for key, value in attributes.items()}
    header = {"kind": KIND, "format": FORMAT, "tethership_version": __version__}
    return xr.Dataset(variables, coordinates, {**header, **written})


def attributes_of(dataset: xr.Dataset) -> dict[str, Any]:
    """Return the attributes of a flight's dataset, decoded."""
    header = ("kind", "format", "tethership_version")
    return {str(k): json.loads(v) for k, v in dataset.attrs.items() if k not in header}


def write(dataset: xr.Dataset, path: Path) -> None:
    """Write a dataset to netCDF; the file appears whole or not at all.

    Notes
    -----
    HDF5 writes into memory: where it meets a full disk itself it ends the process.

    Raises
    ------
    ConfigError
        The place cannot be written.
    """
    packed = {name: {"zlib": True, "complevel": 1} for name in dataset.data_vars if dataset[name].size > 1000}
    handle = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        content = dataset.to_netcdf(engine="h5netcdf", encoding=packed)
        handle = tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False)  # noqa: SIM115
        with handle:
            handle.write(content)
        os.chmod(handle.name, 0o644)
        os.replace(handle.name, path)
    except OSError as error:
        if handle is not None:
            Path(handle.name).unlink(missing_ok=True)
        raise ConfigError(
            f"cannot write {path}: {error.strerror or error}; choose another folder with --out"
        ) from error


def read(path: Path, kind: str = KIND, layout: int = FORMAT) -> xr.Dataset:
    """Return the dataset of a file of this package: a flight, or another kind that is asked for.

    Raises
    ------
    ConfigError
        There is no such file, it is of another kind, or it has the layout of another version.
    """
    if not path.is_file():
        raise ConfigError(f"cannot read {path}: no such file")
    try:
        with xr.open_dataset(path, engine="h5netcdf") as opened:
            dataset = opened.load()
    except Exception as error:
        raise ConfigError(f"{path} is not a readable netCDF file (truncated, or another kind of file)") from error
    if dataset.attrs.get("kind") != kind:
        raise ConfigError(f"{path} is a netCDF file but no {kind.removeprefix('tethership ')} of tethership")
    if int(dataset.attrs.get("format", -1)) != layout:
        raise ConfigError(
            f"{path} has layout {dataset.attrs.get('format')} of tethership "
            f"{dataset.attrs.get('tethership_version')}; this version ({__version__}) reads layout {layout}: "
            f"{'fly' if kind == KIND else 'make'} it again with the version that wrote it"
        )
    return dataset
