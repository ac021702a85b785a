"""A fit as a file: everything found, as JSON. Depends on: fitting."""

import json
import warnings
from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from tethership._version import __version__
from tethership.errors import ConfigError, TethershipWarning
from tethership.results import CHECKSUM, is_whole, sealed
from tethership.studies.docking_paper.fit.identify import Budget, Identification, at_bounds
from tethership.studies.docking_paper.fit.space import UNKNOWNS
from tethership.studies.docking_paper.fit.spectrum import PARTS, unmet
from tethership.tuning import NEARLY

FORMULATIONS = ("published", "consistent")
"""Formulations that are fitted."""


def fit_document(found: Identification, scenario_name: str, seed: int, budget: Budget) -> dict[str, Any]:
    """Return a fit as plain data: parameters, spread, correlations, misfits, members of the set.

    Parameters, bounds, spread and members are in the SI units under `units`; misfits, correlations and residuals (in
    tolerances) are without unit [-]; winds are in [m/s], the wall time in [s].
    """
    low, middle, high = np.percentile(found.members, [5.0, 50.0, 95.0], axis=0)
    count = len(found.items)
    return {
        "formulation": found.formulation,
        "scenario": scenario_name,
        "version": __version__,
        "seed": seed,
        "budget": budget._asdict(),
        "vectors": found.vectors,
        "seconds": round(found.seconds, 1),
        "misfit": found.misfit,
        "tables_misfit": found.tables_misfit,
        "nearly": NEARLY,
        "parameters": {u.name: float(value) for u, value in zip(UNKNOWNS, found.values, strict=True)},
        "units": {u.name: u.unit for u in UNKNOWNS},
        "bounds": {u.name: [u.low, u.high] for u in UNKNOWNS},
        "bound_sources": {u.name: u.source for u in UNKNOWNS},
        "at_bound": at_bounds(found.values),
        "spread": {
            u.name: [float(a), float(b), float(c)] for u, a, b, c in zip(UNKNOWNS, low, middle, high, strict=True)
        },
        "correlation": np.round(_correlation(found.members), 3).tolist(),
        "spectrum": {part: float(r) for part, r in zip(PARTS, found.residuals[count:], strict=True)},
        "spectrum_unmet": unmet(found.residuals[count:].tolist()),
        "items": [
            {
                "table": item.table,
                "wind": item.wind,
                "metric": item.metric,
                "published": item.published,
                "tolerance": item.tolerance,
                "nudged": float(moved),
                "residual": float(residual),
            }
            for item, moved, residual in zip(found.items, found.nudged, found.residuals, strict=False)
        ],
        "left_out": found.left_out,
        "left_out_misfit": {table: entry["left_out_misfit"] for table, entry in found.left_out.items()},
        "members": [[float(f"{x:.6g}") for x in member] for member in found.members],
    }


def _correlation(members: np.ndarray) -> np.ndarray:
    """Return the correlation of the unknowns over the set; 0 where one does not vary."""
    if len(members) < 3:
        return np.eye(members.shape[1])
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.nan_to_num(np.corrcoef(members, rowvar=False))


def stored_fit(formulation: str) -> dict[str, Any]:
    """Return the packaged fit of a formulation.

    Raises
    ------
    ConfigError
        There is none.
    """
    file = resources.files("tethership").joinpath(f"data/fits/identified_{formulation}.json")
    if not file.is_file():
        raise ConfigError(f"no stored fit of formulation {formulation!r}; allowed: {', '.join(FORMULATIONS)}")
    return json.loads(file.read_text(encoding="utf-8"))


def read_fit(path: Path) -> dict[str, Any]:
    """Return a fit that `tethership identify` wrote.

    Raises
    ------
    ConfigError
        It cannot be read, is no fit, or is not as it was written.

    Warns
    -----
    TethershipWarning
        It was written by version 0.1 and carries no checksum.
    """
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise ConfigError(f"cannot read the fit {path}: {error}") from error
    try:
        _Fit.model_validate(document)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"])) or "the file"
        raise ConfigError(
            f"{path} is no fit: {where}: {first['msg']}; give a file that `tethership identify` wrote"
        ) from error
    whole = is_whole(document)
    if whole is None:
        warnings.warn(f"{path}: written by tethership 0.1, without a checksum", TethershipWarning, stacklevel=2)
    elif not whole:
        raise ConfigError(f"{path} is damaged or was changed; take a whole copy, or make the fit again")
    return {key: value for key, value in document.items() if key != CHECKSUM}


_Number = Annotated[float, Field(allow_inf_nan=False)]


class _Fit(BaseModel):
    """What every fit must have; the rest of it is told, not computed with."""

    model_config = ConfigDict(strict=True)

    formulation: Literal["published", "consistent"]
    misfit: _Number
    parameters: Annotated[dict[str, _Number], Field(min_length=1)]
    units: dict[str, str]
    bounds: dict[str, Annotated[list[_Number], Field(min_length=2, max_length=2)]]
    members: list[list[_Number]]

    @model_validator(mode="after")
    def _same_width(self) -> "_Fit":
        names = set(self.parameters)
        if set(self.units) != names or set(self.bounds) != names or any(len(m) != len(names) for m in self.members):
            raise ValueError("units, bounds and members are not of the same parameters")
        return self


def fit_text(document: dict[str, Any]) -> str:
    """Return a fit as the text of its file: one key a line, one member a line, with its checksum."""
    document = sealed(document)
    members = document["members"]
    head = {key: value for key, value in document.items() if key != "members"}
    lines = [f"  {json.dumps(key)}: {json.dumps(value)}," for key, value in head.items()]
    rows = ",\n".join(f"    {json.dumps(member)}" for member in members)
    return "{\n" + "\n".join(lines) + f'\n  "members": [\n{rows}\n  ]\n}}\n'
