"""A campaign's results on disk, as batches end: a Zarr group and a mark for each finished batch.

Depends on: zarr, campaign.plan. The folder of marks is made when the store is whole, a mark when a batch's numbers are
written: killed at any moment, a campaign goes on with what has none.
"""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import zarr

from tethership._version import __version__
from tethership.campaign.plan import Batch, Plan
from tethership.errors import ConfigError
from tethership.simulation.batch import CODES

RESULTS, MARKS, MANIFEST = "results.zarr", "finished", "campaign.json"

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
    """

    def __init__(self, folder: Path, plan: Plan) -> None:
        self.folder, self._plan = folder, plan
        known = read_manifest(folder)
        if known is None:
            self._claim()
        elif known.get("digest") != plan.digest():
            version = known.get("tethership")
            what = f"a campaign of tethership {version}" if version != __version__ else "another campaign"
            raise ConfigError(
                f"{folder} holds {what} ({known.get('name')}, {known.get('cases')} cases, seed {known.get('seed')}); "
                "choose another --out, or delete the folder"
            )
        with self._said():
            self._lay_out()
        self._arrays: dict[str, Any] = {}

    def _claim(self) -> None:
        """Write whose folder it is; refuse one that holds something of another kind."""
        if (self.folder / RESULTS).exists():
            raise ConfigError(f"{self.folder / RESULTS} has no {MANIFEST} beside it; choose another --out")
        with self._said():
            self._write_manifest()

    def _write_manifest(self) -> None:
        """Write what the campaign is, whole or not at all."""
        plan = self._plan
        manifest = {
            "digest": plan.digest(),
            "tethership": __version__,
            "name": plan.name,
            "cases": plan.cases,
            "seed": plan.config.seed,
            "laws": [law.name for law in plan.laws],
            "campaign": plan.document,
            "scenario": plan.scenario.document,
        }
        self.folder.mkdir(parents=True, exist_ok=True)
        partial = self.folder / f"{MANIFEST}.partial"
        partial.write_text(json.dumps(manifest, indent=1, default=str), encoding="utf-8")
        partial.replace(self.folder / MANIFEST)

    def _lay_out(self) -> None:
        """Make the store, where it is not whole: a folder was claimed and its owner killed before it was."""
        if (self.folder / MARKS).is_dir():
            return
        plan = self._plan
        group = zarr.create_group(self.folder / RESULTS, overwrite=True)
        group.attrs.update({"laws": [law.name for law in plan.laws], "inputs": list(plan.names)})
        shape = plan.values.shape
        chunks = (1, plan.lanes, shape[2])
        inputs = group.create_array(
            "input", shape=shape, chunks=chunks, dtype="f8", dimension_names=("law", "case", "quantity")
        )
        inputs[...] = plan.values
        group.create_array("replicate", data=plan.sample.replicate, dimension_names=("case",))
        (self.folder / MARKS).mkdir()

    def unfinished(self) -> list[int]:
        """Return the numbers of the batches that have not ended."""
        done = {int(path.name) for path in (self.folder / MARKS).iterdir()}
        return [number for number in range(self._plan.batches) if number not in done]

    def keep(self, batch: Batch, found: Mapping[str, np.ndarray]) -> None:
        """Write a batch's numbers, then its mark.

        Raises
        ------
        ConfigError
            They cannot be written (disk full): what was written before stays readable.
        """
        rows = slice(batch.first, batch.first + len(batch.values))
        with self._said():
            for name, values in found.items():
                self._array(name, values)[batch.law, rows] = values
            (self.folder / MARKS / f"{batch.number:06d}").touch()

    @contextmanager
    def _said(self) -> Iterator[None]:
        """Say in one line, with its cure, what the disk refuses."""
        try:
            yield
        except OSError as error:
            raise ConfigError(
                f"cannot write to {self.folder}: {error.strerror or error}. What is finished is kept: make room and "
                "run the same command again"
            ) from error

    def _array(self, name: str, example: np.ndarray) -> Any:
        """Return the array of an output, made at its first use."""
        if name not in self._arrays:
            group = zarr.open_group(self.folder / RESULTS)
            if name not in group:
                own = example.shape[1:]
                fill: Any = np.nan if example.dtype.kind == "f" else -1
                group.create_array(
                    name,
                    shape=(*self._plan.values.shape[:2], *own),
                    chunks=(1, self._plan.lanes, *own),
                    dtype=example.dtype,
                    fill_value=fill,
                    dimension_names=("law", "case", *(f"{name}_item" for _ in own)),
                )
            self._arrays[name] = group[name]
        return self._arrays[name]


def read_manifest(folder: Path) -> dict[str, Any] | None:
    """Return what a folder's campaign is, None where there is none."""
    path = folder / MANIFEST
    if not path.is_file():
        return None
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise ConfigError(f"cannot read {path}: {error}; choose another --out") from error
    if not isinstance(found, dict):
        raise ConfigError(f"{path} is no campaign's; choose another --out")
    return found


def open_results(folder: str | Path) -> xr.Dataset:
    """Return a campaign's results: every metric over law and case, inputs over law, case and quantity.

    Raises
    ------
    ConfigError
        The folder holds no campaign.
    """
    manifest = read_manifest(Path(folder))
    if manifest is None:
        raise ConfigError(f"{folder} holds no campaign; give the folder that `tethership campaign` wrote")
    try:
        with xr.open_zarr(Path(folder) / RESULTS, consolidated=False) as data:
            loaded = data.load()
    except (OSError, ValueError, KeyError) as error:
        raise ConfigError(f"cannot read {Path(folder) / RESULTS}: {error}; fly it again into another --out") from error
    for name in set(UNITS) & set(loaded):
        loaded[name].attrs["units"] = UNITS[name]
    if "outcome" in loaded:
        loaded["outcome"].attrs["flag_meanings"] = " ".join(code.name for code in CODES)
        loaded["outcome"].attrs["flag_values"] = list(range(len(CODES)))
    places = {"law": manifest["laws"], "case": np.arange(loaded.sizes["case"]), "quantity": loaded.attrs["inputs"]}
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
        raise ConfigError(f"{Path(folder) / RESULTS} lacks {', '.join(missing)}; fly it again into another --out")
    return data
