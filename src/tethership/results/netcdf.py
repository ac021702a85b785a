"""NetCDF files of this package: written whole with checksums, read with everything about them checked.

Depends on: h5py, xarray, results.files, results.hdf5, results.seal, results.schema, errors.
"""

import warnings
from pathlib import Path
from typing import Any

import h5py
import xarray as xr

from tethership._version import __version__
from tethership.errors import ConfigError, TethershipWarning
from tethership.results.files import write_atomically
from tethership.results.hdf5 import netcdf_bytes
from tethership.results.schema import FORMAT, UNSEALED, Kind
from tethership.results.seal import check_dataset, sealed_dataset

MOST_BYTES = 4 * 2**30
"""Largest content that is read [bytes]: half a day of flight at the usual 80 samples a second."""


def content(dataset: xr.Dataset, kind: Kind) -> bytes:
    """Return a dataset as the bytes of a netCDF file, with its checksums."""
    return netcdf_bytes(sealed_dataset(dataset, kind.own))


def write(dataset: xr.Dataset, path: Path, kind: Kind) -> None:
    """Write a dataset to netCDF; the file appears whole or not at all.

    Raises
    ------
    ConfigError
        The place cannot be written.
    """
    write_atomically(path, content(dataset, kind))


def read(path: Path, kind: Kind) -> xr.Dataset:
    """Return the dataset of a file of this package.

    What others added to it (attributes, variables) is left alone, and so is another compression.

    Raises
    ------
    ConfigError
        There is no such file, it is of another kind or a later layout, it declares more than `MOST_BYTES`, or it is
        not as it was written.

    Warns
    -----
    TethershipWarning
        It was written by version 0.1 and carries no checksums.
    """
    if not path.is_file():
        raise ConfigError(f"cannot read {path}: {'it is a folder' if path.is_dir() else 'no such file'}")
    dataset = _opened(path)
    if str(dataset.attrs.get("kind")) != kind.name:
        raise ConfigError(f"{path} is a netCDF file but no {kind.name.removeprefix('tethership ')} of tethership")
    layout, version = str(dataset.attrs.get("format")), dataset.attrs.get("tethership_version")
    if layout == str(UNSEALED):
        warnings.warn(f"{path}: {_NO_CHECKSUM}", TethershipWarning, stacklevel=3)
        return dataset.assign_attrs(format=FORMAT)
    if layout != str(FORMAT):
        raise ConfigError(
            f"{path} has layout {layout} of tethership {version}; this version ({__version__}) reads layouts "
            f"{UNSEALED} and {FORMAT}: {kind.verb} it again with the version that wrote it"
        )
    return check_dataset(dataset, kind.own, str(path))


_NO_CHECKSUM = "written by tethership 0.1, without a checksum: damage to its numbers would not be seen"


def _opened(path: Path) -> xr.Dataset:
    """Return what is in a file, of which nothing is believed yet."""
    try:
        with h5py.File(path, "r") as file:
            _check_declared(path, file)
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as opened:
            return opened.load()
    except ConfigError:
        raise
    except Exception as error:  # whatever the libraries make of a damaged file
        raise ConfigError(f"{path} is not a readable netCDF file (truncated, damaged or of another kind)") from error


def _check_declared(path: Path, file: h5py.File) -> None:
    """Raise ConfigError where a file is larger than can be, or takes its numbers from another file."""
    total = 0
    for name in file:
        item: Any = file[name] if isinstance(file.get(name, getlink=True), h5py.HardLink) else None
        if item is None or (isinstance(item, h5py.Dataset) and (item.external or item.is_virtual)):
            raise ConfigError(f"{path} takes {name} from another file, which is not read; give a file that is whole")
        if isinstance(item, h5py.Dataset):
            total += (item.size or 0) * max(item.dtype.itemsize, 1)
    if total > MOST_BYTES:
        raise ConfigError(
            f"{path} declares {total / 2**30:.3g} GiB of numbers; at most {MOST_BYTES / 2**30:g} GiB are read"
        )
