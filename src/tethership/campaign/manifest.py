"""Whose folder it is: `campaign.json`, with a checksum, checked before anything of it is believed.

Depends on: pydantic, results, campaign.plan.
"""

import json
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from tethership._version import __version__
from tethership.campaign.engine import engine_name
from tethership.campaign.plan import Plan, lanes_for
from tethership.errors import ConfigError
from tethership.results import array_digest, is_whole, sealed, write_atomically

MANIFEST = "campaign.json"


class Manifest(BaseModel):
    """What a campaign is.

    `digest` is of everything that goes into its numbers, `input` of the values of its cases, whose names are `inputs`;
    `engine` is what flew them. Version 0.1 wrote neither these three nor `lanes`.
    """

    model_config = ConfigDict(strict=True)

    digest: str
    tethership: str
    name: str
    cases: Annotated[int, Field(ge=1)]
    seed: Annotated[int, Field(ge=0)]
    laws: Annotated[list[str], Field(min_length=1)]
    campaign: dict[str, Any]
    scenario: dict[str, Any]
    lanes: Annotated[int, Field(ge=1)] | None = None
    input: str | None = None
    inputs: list[str] | None = None
    engine: str | None = None

    def rows(self, number: int) -> tuple[int, slice]:
        """Return law and cases of a batch."""
        lanes = self.lanes or lanes_for(self.cases)
        law, place = divmod(number, -(-self.cases // lanes))
        return law, slice(place * lanes, min((place + 1) * lanes, self.cases))

    @property
    def unsealed(self) -> bool:
        """Whether version 0.1 wrote it, which had no checksums."""
        return self.input is None

    @property
    def batches(self) -> int:
        """How many batches it has."""
        return len(self.laws) * -(-self.cases // (self.lanes or lanes_for(self.cases)))


def write_manifest(folder: Path, plan: Plan, cure: str) -> None:
    """Write what a campaign is into its folder, whole or not at all."""
    manifest = {
        "digest": plan.digest(),
        "tethership": __version__,
        "name": plan.name,
        "cases": plan.cases,
        "seed": plan.config.seed,
        "laws": [law.name for law in plan.laws],
        "campaign": plan.document,
        "scenario": plan.scenario.document,
        "lanes": plan.lanes,
        "input": array_digest(plan.values),
        "inputs": list(plan.names),
        "engine": engine_name(),
    }
    write_atomically(folder / MANIFEST, json.dumps(sealed(manifest), indent=1), cure)


def read_manifest(folder: Path) -> Manifest | None:
    """Return what a folder's campaign is, None where there is none.

    Raises
    ------
    ConfigError
        It cannot be read, or is not as it was written.
    """
    path = folder / MANIFEST
    if not path.is_file():
        return None
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        manifest = Manifest.model_validate(document)
        whole = is_whole(document)
    except (OSError, ValueError, RecursionError) as error:
        first = error.errors(include_url=False)[0]["msg"] if isinstance(error, ValidationError) else error
        raise ConfigError(f"cannot read {path}: {first}; fly it again, or into another --out") from error
    if whole is False:
        raise ConfigError(
            f"{path} is damaged or was changed: it has not the checksum it was written with; fly it again, or into "
            "another --out"
        )
    return manifest
