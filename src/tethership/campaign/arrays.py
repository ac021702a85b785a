"""The Zarr group of a campaign: an array for each output, a chunk for each batch, a checksum in each chunk.

Depends on: zarr with its codecs, campaign.plan. Whatever the metadata say is held against what the plan makes of them:
a group or array whose metadata are damaged gets them anew, and its chunks stay.
"""

import shutil
from pathlib import Path
from typing import Any

import numpy as np

from tethership._extras import needs
from tethership.campaign.marks import Form
from tethership.campaign.plan import Batch, Plan

RESULTS = "results.zarr"
METADATA = "zarr.json"

LEVEL = 0
"""Of the compression."""


def zarr_library() -> Any:
    """Return zarr; raises ConfigError with the cure where it is not installed."""
    with needs("campaign"):
        import zarr.codecs
        import zarr.storage
    return zarr


class Arrays:
    """The arrays of one campaign.

    Parameters
    ----------
    folder : Path
        Of the campaign.
    plan : Plan
        The campaign.
    """

    def __init__(self, folder: Path, plan: Plan) -> None:
        self.root, self._plan = folder / RESULTS, plan
        self._open: dict[str, Any] = {}
        self._zarr = zarr_library()
        from google_crc32c import value as checksum  # zarr's own
        from numcodecs.zstd import Zstd

        self._pack, self._checksum = Zstd(LEVEL).encode, checksum

    def lay_out(self) -> None:
        """Make the group and its inputs where they are not as they must be."""
        plan = self._plan
        attributes = {"laws": [law.name for law in plan.laws], "inputs": list(plan.names)}
        if self._group_attributes() != attributes:
            (self.root / METADATA).unlink(missing_ok=True)
            self._zarr.create_group(self.root, attributes=attributes)
        chunks = (1, plan.lanes, plan.values.shape[2])
        self._keep_input("input", plan.values, chunks, ("law", "case", "quantity"))
        replicate = np.asarray(plan.sample.replicate)
        self._keep_input("replicate", replicate, replicate.shape, ("case",))

    def output(self, name: str, form: Form) -> Any:
        """Return the array of an output, made at its first use."""
        if name not in self._open:
            dtype = np.dtype(form.dtype)
            made = {
                "shape": (*self._plan.values.shape[:2], *form.shape),
                "chunks": (1, self._plan.lanes, *form.shape),
                "dtype": dtype,
                "fill_value": np.nan if dtype.kind == "f" else -1,
                "dimension_names": ("law", "case", *(f"{name}_item" for _ in form.shape)),
            }
            self._open[name] = self._array(name, made)
        return self._open[name]

    def write(self, name: str, batch: Batch, values: np.ndarray) -> None:
        """Write a batch's part of an output, one chunk, as zarr would: it takes a millisecond for each."""
        form = Form.of(values)
        array = self.output(name, form)
        place = (batch.law, batch.first // self._plan.lanes, *(0 for _ in form.shape))
        path = self.root / name / array.metadata.encode_chunk_key(place)
        empty = np.full((self._plan.lanes, *form.shape), array.fill_value, np.dtype(form.dtype))
        whole = empty.copy()
        whole[: len(values)] = values
        if np.array_equal(whole, empty, equal_nan=empty.dtype.kind == "f"):
            path.unlink(missing_ok=True)  # what a reader takes where there is no chunk
            return
        packed = self._pack(whole.tobytes())
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(packed + self._checksum(packed).to_bytes(4, "little"))

    def _keep_input(self, name: str, values: np.ndarray, chunks: tuple[int, ...], dims: tuple[str, ...]) -> None:
        """Write an input where it is not what it must be: it is known from the plan."""
        made = {"shape": values.shape, "chunks": chunks, "dtype": values.dtype, "dimension_names": dims}
        array = self._array(name, made)
        try:
            same = np.array_equal(array[...], values)
        except Exception:  # whatever the libraries make of a damaged chunk
            same = False
        if not same:
            shutil.rmtree(self.root / name)
            self._array(name, made)[...] = values

    def _array(self, name: str, made: dict[str, Any]) -> Any:
        """Return an array with these metadata; where it has others it gets them, and keeps its chunks."""
        zarr = self._zarr
        made = {**made, "compressors": (zarr.codecs.ZstdCodec(level=LEVEL), zarr.codecs.Crc32cCodec())}
        wanted = zarr.create_array(zarr.storage.MemoryStore(), name=name, **made).metadata.to_dict()
        try:
            there = zarr.open_array(self.root / name, mode="r+")
            if repr(there.metadata.to_dict()) == repr(wanted):  # by their words: a fill value of NaN is not itself
                return there
        except Exception:  # whatever the libraries make of damaged metadata
            pass
        (self.root / name / METADATA).unlink(missing_ok=True)
        return zarr.create_array(self.root, name=name, **made)

    def _group_attributes(self) -> Any:
        """Return the attributes of the group, None where it is not there or not readable."""
        try:
            return dict(self._zarr.open_group(self.root, mode="r").attrs)
        except Exception:  # whatever the libraries make of damaged metadata
            return None
