"""What a campaign file may say. Depends on: campaign.distributions, scenario."""

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, field_validator, model_validator

from tethership.campaign.distributions import Distribution
from tethership.scenario import Quantity, Table, Title, check_apart, check_layers

MOST_CASES = 10_000_000
"""Cases of a campaign."""

Probability = Annotated[float, Field(gt=0.0, lt=1.0)]

LIMITS = (
    "control_threshold",
    "envelope_tear",
    "envelope_tensile",
    "cable_break",
    "winch_pull",
    "attitude",
    "ground_contact",
    "time",
)
"""What may be exceeded."""


class CorrelatedGroup(Table):
    """Quantities that vary together, through a Gaussian copula.

    Attributes
    ----------
    names : tuple of str
        Of quantities in `vary`.
    correlation : tuple of tuple of float
        ρ of the copula [-], symmetric with ones on its diagonal, shape (names, names); rank correlations are
        (6/π) asin(ρ/2).
    """

    names: Annotated[tuple[str, ...], Field(min_length=2)]
    correlation: tuple[tuple[float, ...], ...]

    @field_validator("correlation", mode="before")
    @classmethod
    def _matrix(cls, given: Any) -> Any:
        if not isinstance(given, list | tuple) or not all(isinstance(row, list | tuple) for row in given):
            raise ValueError(f"it is {given!r}; give the whole matrix, e.g. [[1.0, 0.6], [0.6, 1.0]]")
        return given

    @model_validator(mode="after")
    def _positive_definite(self) -> "CorrelatedGroup":
        count = len(self.names)
        if len(self.correlation) != count or any(len(row) != count for row in self.correlation):
            raise ValueError(f"{count} names need a {count} × {count} correlation")
        matrix = np.array(self.correlation)
        if not np.allclose(matrix, matrix.T) or not np.allclose(np.diag(matrix), 1.0):
            raise ValueError("the correlation must be symmetric with ones on its diagonal")
        if np.abs(matrix).max() > 1.0 or np.linalg.eigvalsh(matrix)[0] <= 1e-9:
            raise ValueError("the correlation is not positive definite: these numbers cannot belong together")
        return self


class LawConfig(Table):
    """One way to control the ship; all fly the same cases.

    `layers` act, the others do nothing; `gains_of` takes the gains of another scenario, `changes` sets single numbers
    (dotted name, SI).
    """

    name: Title
    layers: tuple[str, ...]
    gains_of: str | None = None
    changes: dict[str, float] = Field(default_factory=dict)

    @field_validator("layers")
    @classmethod
    def _known_layers(cls, layers: tuple[str, ...]) -> tuple[str, ...]:
        return check_layers(layers)


class CampaignLimits(Table):
    """Limits besides the tensions that the scenario watches.

    Attributes
    ----------
    winch_pull : float, optional
        Tension at the anchor [N].
    attitude : float, optional
        Of |φ| and |θ| [rad].
    time : float, optional
        By which the ship must have docked [s].
    """

    winch_pull: Annotated[float, Quantity("N", positive=True)] | None = None
    attitude: Annotated[float, Quantity("rad", positive=True, high=1.55)] | None = None
    time: Annotated[float, Quantity("s", positive=True)] | None = None


class Requirement(Table):
    """A limit may be exceeded with `probability` at most, said with `confidence`.

    Attributes
    ----------
    probability : float
        Per flight [-].
    confidence : float
        Of the two-sided interval [-].
    """

    limit: str
    probability: Probability
    confidence: Probability = 0.95
    text: str = ""
    law: str | None = None

    @field_validator("limit")
    @classmethod
    def _known_limit(cls, limit: str) -> str:
        if limit not in LIMITS:
            raise ValueError(f"unknown limit {limit!r}; allowed: {', '.join(LIMITS)}")
        return limit


class CampaignConfig(Table):
    """Many flights of one scenario.

    `vary` gives each varied quantity, by its dotted name, a distribution. `sampling` is `random` (independent draws:
    the way to a probability with an exact interval), `sobol` or `latin_hypercube` (evenly spread, in `replicates`
    independent scrambles from which intervals are taken), `grid` (every combination of levels) or `saltelli` (the
    design of Sobol's sensitivity indices). The `worst` and `random` flights are flown again with histories.

    Attributes
    ----------
    step : float
        Length of a fixed step h [s].
    verified : float
        Share of the flights that are flown again with steps of h/8 (by XLA: adaptively) [-].
    samples, replicates, worst, random : int
        How many cases, scrambles, and flights of each law that are kept: the worst, and others.
    """

    title: Annotated[str, Field(max_length=200)]
    description: Annotated[str, Field(max_length=10_000)] = ""
    scenario: str
    changes: dict[str, Any] = Field(default_factory=dict)
    samples: Annotated[int, Field(ge=1, le=MOST_CASES)] = 1000
    seed: Annotated[int, Field(ge=0)] = 1
    sampling: Literal["random", "sobol", "latin_hypercube", "grid", "saltelli"] = "random"
    replicates: Annotated[int, Field(ge=4, le=64)] = 8
    step: Annotated[float, Quantity("s", positive=True, high=0.1)] = 0.05
    verified: Annotated[float, Field(ge=0.0, le=1.0)] = 0.02
    worst: Annotated[int, Field(ge=0, le=100)] = 3
    random: Annotated[int, Field(ge=0, le=100)] = 3
    vary: dict[str, Distribution]
    correlated: tuple[CorrelatedGroup, ...] = ()
    laws: tuple[LawConfig, ...] = ()
    limits: CampaignLimits = CampaignLimits()
    requirements: tuple[Requirement, ...] = ()

    @model_validator(mode="after")
    def _whole(self) -> "CampaignConfig":
        if not self.vary:
            raise ValueError('nothing varies; give at least one [vary."…"] table')
        grouped = [name for group in self.correlated for name in group.names]
        for name in grouped:
            if name not in self.vary:
                raise ValueError(f"correlated names {name!r}, which has no distribution in vary")
            if grouped.count(name) > 1:
                raise ValueError(f"{name!r} is in two correlated groups")
        if grouped and self.sampling in ("grid", "saltelli"):
            raise ValueError(f"sampling {self.sampling!r} takes independent quantities; take correlated out")
        names = [law.name for law in self.laws]
        check_apart(names, "laws")
        for requirement in self.requirements:
            if requirement.law is not None and requirement.law not in names:
                raise ValueError(f"requirement names the law {requirement.law!r}; known: {', '.join(names) or 'none'}")
        return self
