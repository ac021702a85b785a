"""A netCDF file written in one go: the same to every reader as what xarray and h5netcdf write.

Truth: xarray's own writer. If this fails, a flight that was kept cannot be read by others, or loses a unit.
"""

import io

import h5py
import numpy as np
import xarray as xr

from tethership.results.hdf5 import CHUNK, netcdf_bytes


def opened(content):
    """Return what a reader finds in a file."""
    return xr.open_dataset(io.BytesIO(content), engine="h5netcdf", decode_times=False).load()


def theirs(dataset):
    return opened(bytes(dataset.to_netcdf(engine="h5netcdf")))


def test_a_flight_reads_back_as_xarray_would_have_written_it(flight):
    assert opened(flight.content()).drop_attrs().identical(theirs(flight.data).drop_attrs())
    for name, variable in opened(flight.content()).variables.items():
        assert variable.attrs == theirs(flight.data)[name].attrs


def test_labels_sizes_text_and_numbers_of_any_kind():
    rows = CHUNK // 8 // 50 + 3  # more than one compressed piece
    numbers = np.random.default_rng(0).random((rows, 50))
    numbers[3, 4] = np.nan
    dataset = xr.Dataset(
        {
            "many": (("time", "unlabelled"), numbers, {"units": "N", "long_name": "schöne Größe"}),
            "whole": ("time", np.arange(rows), {"flag_values": [1, 2], "factor": 0.5}),
            "single": ((), 3.25),
            "words": ("label", np.array(["", "Größe", "c"], dtype=object)),
            "none": (("empty", "label"), np.zeros((0, 3))),
        },
        {"time": ("time", np.linspace(0.0, 1.0, rows), {"units": "s"}), "label": ["a", "ß", "c d"]},
        {"kind": "a test", "format": 2},
    )
    found = opened(netcdf_bytes(dataset))
    assert found.identical(theirs(dataset))
    with h5py.File(io.BytesIO(netcdf_bytes(dataset)), "r") as file:
        assert file["many"].compression == "gzip"
        assert 1 < file["many"].id.get_num_chunks() < 5
        assert file["single"].compression is None
        assert [scale[0].name for scale in file["many"].dims] == ["/time", "/unlabelled"]
        assert list(file["many"].attrs["_Netcdf4Coordinates"]) == [0, 1]


def test_the_same_dataset_gives_the_same_file(flight):
    assert flight.content() == flight.content()
