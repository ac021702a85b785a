"""A campaign's results on disk, as batches end: a Zarr group and a mark for each finished batch.

Depends on: xarray, campaign.arrays, campaign.manifest, campaign.marks. A mark is written when a batch's numbers are:
killed at any moment, a campaign goes on with what has none. Numbers that are not those of their mark are flown again.
"""

import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from tethership._version import __version__
from tethership.campaign.arrays import RESULTS, Arrays, zarr_library
from tethership.campaign.engine import engine_name
from tethership.campaign.manifest import MANIFEST, Manifest, read_manifest, write_manifest
from tethership.campaign.marks import MARKS, Mark, read_marks, write_mark
from tethership.campaign.plan import Batch, Plan
from tethership.errors import ConfigError, TethershipWarning
from tethership.results import array_digest, table_digest
from tethership.simulation import CODES, Outcome

CURE = "what is finished is kept: make room and run the same command again"
"""What to do where results cannot be written."""

MOST_ITEMS = 1000
"""Most values of one output of one flight that are read."""

UNITS = {
    "outcome": "1",
    "unbalanced": "1",
    "docking_time": "s",
    "flight_time": "s",
    "tension_max": "N",
    "tension_mean": "N",
    "tension_largest": "N",
    "tension_anchor": "N",
    "ADC": "1/s",
    "E": "1",
    "theta_rms": "deg",
    "roll_max": "deg",
    "pitch_max": "deg",
    "clearance_min": "m",
    "rewind_rate_min": "m/s",
    "seconds_above": "s",
    "saturated_seconds": "s",
    "misalignment_jumps": "1",
    "quasi_static_outside": "1",
    "snap_impulse": "N",
}
"""Units of what a campaign keeps; without one of these finished results are not whole."""


class CampaignStore:
    """The folder of one campaign.

    Parameters
    ----------
    folder : Path
        Made if it is not there; what is in it is gone on with if it is of the same campaign.
    plan : Plan
        The campaign.

    Raises
    ------
    ConfigError
        The folder holds another campaign, or one of another version, or something else; nothing is touched.

    Warns
    -----
    TethershipWarning
        Finished batches were damaged: they count as not finished.
    """

    def __init__(self, folder: Path, plan: Plan) -> None:
        self.folder, self._plan, self._digest = folder, plan, plan.digest()
        known = owner(folder, plan)
        if known is None or known.unsealed:
            write_manifest(folder, plan, CURE)
        self._arrays = Arrays(folder, plan)
        with self._said():
            self._arrays.lay_out()
            (folder / MARKS).mkdir(exist_ok=True)
            self._drop_damaged()

    def unfinished(self) -> list[int]:
        """Return the numbers of the batches that have not ended."""
        done = read_marks(self.folder, self._plan.batches)
        return [number for number in range(self._plan.batches) if number not in done]

    def keep(self, batch: Batch, found: Mapping[str, np.ndarray]) -> None:
        """Write a batch's numbers, then its mark.

        Raises
        ------
        ConfigError
            They cannot be written (disk full): what was written before stays readable.
        """
        with self._said():
            for name, values in found.items():
                self._arrays.write(name, batch, values)
        write_mark(self.folder, batch.number, self._digest, found, CURE)

    def _drop_damaged(self) -> None:
        """Take away the marks of batches whose numbers are not those of their mark, and say so."""
        marks = read_marks(self.folder, self._plan.batches)
        stored: dict[str, Any] = {}
        damaged = [number for number, mark in marks.items() if not self._is_whole(number, mark, stored)]
        for number in damaged:
            (self.folder / MARKS / f"{number:06d}").unlink(missing_ok=True)
        if damaged:
            flights = sum(len(self._plan.batch(number).values) for number in damaged)
            warnings.warn(
                f"{len(damaged)} of {len(marks)} finished batches in {self.folder} ({flights} flights) are damaged or "
                "have no checksum: they are flown again",
                TethershipWarning,
                stacklevel=4,
            )

    def _is_whole(self, number: int, mark: Mark | None, stored: dict[str, Any]) -> bool:
        """Return whether the numbers of a batch are those of its mark; arrays that were read are kept in `stored`."""
        if mark is None or mark.campaign != self._digest:
            return False
        batch = self._plan.batch(number)
        rows = slice(batch.first, batch.first + len(batch.values))
        try:
            for name, form in mark.forms.items():
                if name not in stored:
                    stored[name] = _read_whole(self._arrays.output(name, form))
            return table_digest({name: stored[name][batch.law, rows] for name in mark.forms}) == mark.values
        except Exception:  # whatever the libraries make of a damaged chunk
            return False

    @contextmanager
    def _said(self) -> Iterator[None]:
        """Say in one line, with its cure, what the disk refuses."""
        try:
            yield
        except OSError as error:
            raise ConfigError(f"cannot write to {self.folder}: {error.strerror or error}; {CURE}") from error


def owner(folder: Path, plan: Plan) -> Manifest | None:
    """Return what a folder says it is, if that is this campaign; None where it is free, or lost its `campaign.json`.

    Raises
    ------
    ConfigError
        It holds another campaign, or one of another version, or something else.
    """
    digest = plan.digest()
    ours = any(mark and mark.campaign == digest for mark in read_marks(folder, plan.batches).values())
    try:
        known = read_manifest(folder)
    except ConfigError:
        if not ours:
            raise
        warnings.warn(f"{folder / MANIFEST} is damaged: it is written anew", TethershipWarning, stacklevel=3)
        return None
    if known is None and (folder / RESULTS).exists() and not ours:
        raise ConfigError(f"{folder / RESULTS} has no {MANIFEST} beside it; choose another --out")
    if known is not None and known.digest != digest:
        other = known.tethership != __version__
        if not other and known.engine is not None and known.engine != engine_name():
            raise ConfigError(
                f"{folder} was flown by {known.engine}, here it would be {engine_name()}, whose last digits differ: "
                "go on where it was begun, or choose another --out (TETHERSHIP_ENGINE=xla is alike on all machines)"
            )
        what = f"a campaign of tethership {known.tethership}" if other else "another campaign"
        raise ConfigError(
            f"{folder} holds {what} ({known.name}, {known.cases} cases, seed {known.seed}); "
            "choose another --out, or delete the folder"
        )
    return known


def open_results(folder: str | Path) -> xr.Dataset:
    """Return a campaign's results: every metric over law and case, inputs over law, case and quantity.

    Metrics carry their unit as an attribute: tensions [N], times [s], angles [deg], clearance [m], others as in
    `UNITS`; inputs are in SI.

    Raises
    ------
    ConfigError
        The folder holds no campaign, numbers of it are lost or changed, or zarr is not installed.

    Warns
    -----
    TethershipWarning
        It was written by version 0.1 and carries no checksums.
    """
    folder = Path(folder)
    manifest = read_manifest(folder)
    if manifest is None:
        raise ConfigError(f"{folder} holds no campaign; give the folder that `tethership campaign` wrote")
    if manifest.unsealed:
        warnings.warn(f"{folder}: written by tethership 0.1, without a checksum", TethershipWarning, stacklevel=2)
    zarr_library()
    loaded = _loaded(folder / RESULTS, manifest)
    _check_batches(folder, manifest, loaded)
    for name in set(UNITS) & set(loaded):
        loaded[name].attrs["units"] = UNITS[name]
    if "outcome" in loaded:
        loaded["outcome"].attrs["flag_meanings"] = " ".join(code.name for code in CODES)
        loaded["outcome"].attrs["flag_values"] = list(range(len(CODES)))
    places = {"law": manifest.laws, "case": np.arange(loaded.sizes["case"]), "quantity": loaded.attrs["inputs"]}
    return loaded.assign_coords(places)


def whole_results(folder: str | Path) -> xr.Dataset:
    """Return a finished campaign's results, as `open_results`.

    Raises
    ------
    ConfigError
        As `open_results`, or something that every campaign keeps is not there.
    """
    data = open_results(folder)
    missing = [name for name in UNITS if name not in data]
    if missing:
        raise ConfigError(f"{Path(folder) / RESULTS} lacks {', '.join(missing)}; {_AGAIN}")
    return data


_AGAIN = "run the same command again, which flies again what is damaged"


def _loaded(path: Path, manifest: Manifest) -> xr.Dataset:
    """Return what is in a group, or raise ConfigError where it is not what the campaign says."""
    try:
        with warnings.catch_warnings(action="ignore"), xr.open_zarr(path, chunks=None, consolidated=False) as data:
            sizes = {str(dim): size for dim, size in data.sizes.items()}
            whole = (sizes.get("law"), sizes.get("case")) == (len(manifest.laws), manifest.cases)
            inner = [size for dim, size in sizes.items() if dim not in ("law", "case")]
            names = data.attrs["inputs"]
            named = len(names) == sizes.get("quantity") and names == (manifest.inputs or names)
            if not whole or not named or max(inner, default=0) > MOST_ITEMS:
                raise ValueError(f"sizes {sizes}")
            return data.load()
    except Exception as error:  # whatever the libraries make of damaged files
        raise ConfigError(f"cannot read {path}, which is damaged or was changed; {_AGAIN}") from error


def _check_batches(folder: Path, manifest: Manifest, data: xr.Dataset) -> None:
    """Raise ConfigError where the numbers of finished batches are not those that were flown."""
    marks = read_marks(folder, manifest.batches)
    lost = sorted({name for mark in marks.values() if mark for name in mark.forms if name not in data})
    if lost:
        raise ConfigError(f"{folder / RESULTS} lacks {', '.join(lost)}; {_AGAIN}")
    if not manifest.unsealed and ("input" not in data or array_digest(data["input"].values) != manifest.input):
        raise ConfigError(f"{folder / RESULTS} is damaged: its inputs are not those of the campaign; {_AGAIN}")
    damaged = [number for number, mark in marks.items() if not _holds(manifest, data, number, mark)]
    if damaged:
        raise ConfigError(f"{len(damaged)} of {len(marks)} finished batches in {folder} are damaged; {_AGAIN}")


def _holds(manifest: Manifest, data: xr.Dataset, number: int, mark: Mark | None) -> bool:
    """Return whether a batch has the numbers of its mark; of version 0.1, which had none, whether they can be."""
    law, rows = manifest.rows(number)
    if mark is not None:
        part = {name: data[name].values[law, rows] for name in mark.forms}
        return mark.campaign == manifest.digest and table_digest(part) == mark.values
    return manifest.unsealed and _can_be({name: data[name].values[law, rows] for name in UNITS if name in data})


def _can_be(part: Mapping[str, np.ndarray]) -> bool:
    """Return whether a batch's numbers are possible: a known outcome, and none missing where a flight had one."""
    if "outcome" not in part or not np.isin(part["outcome"], range(len(CODES))).all():
        return False
    flown = part["outcome"] != CODES.index(Outcome.diverged)
    return all(np.isfinite(values[flown]).all() for name, values in part.items() if name != "docking_time")


def _read_whole(array: Any) -> Any:
    """Return an array's numbers, or itself where not all can be read: its parts are then read one by one."""
    try:
        return np.asarray(array[...])
    except Exception:  # whatever the libraries make of a damaged chunk
        return array
