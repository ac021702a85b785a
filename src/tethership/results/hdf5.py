"""A dataset as the bytes of a netCDF-4 file, written in one go. Depends on: h5py, xarray.

What xarray and h5netcdf would write (they find every variable and dimension again some fifty times, which takes ten
times as long): every dimension is an HDF5 dimension scale, with netCDF's own attributes of order and name.
"""

from collections.abc import Mapping
from typing import Any

import h5py
import numpy as np
import xarray as xr
from xarray.conventions import cf_encoder

PROPERTIES = "_NCProperties"
"""Attribute that says by which netCDF library a file was written."""

ONLY_DIMENSION = "This is a netCDF dimension but not a netCDF variable.{:10d}"
"""Name of the scale of a dimension without labels; the netCDF libraries know it by these words."""

CHUNK = 1_000_000
"""Size of a compressed piece at most [bytes]: HDF5 keeps no larger one in its cache."""

SMALL = 1000
"""Numbers up to which nothing is compressed."""


def netcdf_bytes(dataset: xr.Dataset) -> bytes:
    """Return the netCDF-4 file of a dataset of numbers and text, its larger variables compressed.

    Notes
    -----
    HDF5 writes into memory: where it meets a full disk itself it ends the process.
    """
    encoded, attributes = cf_encoder(dict(dataset.variables), dataset.attrs)
    with h5py.File("memory", "w", driver="core", backing_store=False, track_order=True) as file:
        _describe(file, attributes)
        file.attrs[PROPERTIES] = np.bytes_(f"version=2,hdf5={h5py.version.hdf5_version},h5py={h5py.__version__}")
        scales = {}
        for place, (name, size) in enumerate(dataset.sizes.items()):
            scales[str(name)] = _scale(file, str(name), size, encoded.get(name), place)
        for name, variable in encoded.items():
            if name not in scales:
                _variable(file, str(name), variable, scales)
        file.flush()
        return file.id.get_file_image()


def _scale(file: h5py.File, name: str, size: int, labels: xr.Variable | None, place: int) -> h5py.Dataset:
    """Write a dimension: its labels or times, or only its size."""
    if labels is None:
        made = file.create_dataset(name, (size,), dtype=">f4", track_order=True)
        made.make_scale(ONLY_DIMENSION.format(size))
    else:
        made = _written(file, name, labels)
        made.make_scale(name)
    made.attrs["_Netcdf4Dimid"] = np.int32(place)
    return made


def _variable(file: h5py.File, name: str, variable: xr.Variable, scales: Mapping[str, h5py.Dataset]) -> None:
    """Write a variable and say what its dimensions are."""
    made, order = _written(file, name, variable), list(scales)
    for axis, dimension in enumerate(variable.dims):
        made.dims[axis].attach_scale(scales[str(dimension)])
    if variable.dims:
        places = [order.index(str(dimension)) for dimension in variable.dims]
        made.attrs["_Netcdf4Dimid"] = np.int32(places[0])
        made.attrs["_Netcdf4Coordinates"] = np.array(places, np.int32)


def _written(file: h5py.File, name: str, variable: xr.Variable) -> h5py.Dataset:
    """Write numbers or text with their attributes."""
    values = np.asarray(variable.values)
    options: dict[str, Any] = {"track_order": True}
    if values.dtype.kind in "OU":
        values, options["dtype"] = values.astype(object), h5py.string_dtype()
    elif values.size > SMALL:
        each = max(values.nbytes // len(values), 1)
        rows = min(len(values), max(1, CHUNK // each))
        options |= {"compression": "gzip", "compression_opts": 1, "chunks": (rows, *values.shape[1:])}
    if "_FillValue" in variable.attrs and values.dtype.kind == "f":
        options["fillvalue"] = variable.attrs["_FillValue"]
    made = file.create_dataset(name, data=values, **options)
    _describe(made, variable.attrs)
    return made


def _describe(place: h5py.Group | h5py.Dataset, attributes: Mapping[Any, Any]) -> None:
    """Write attributes: text as text, numbers as arrays, as netCDF has them."""
    for key, value in attributes.items():
        place.attrs[str(key)] = value if isinstance(value, str) else np.atleast_1d(value)
