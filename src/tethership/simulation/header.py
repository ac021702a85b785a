"""What a flight's file must say of its input: its attributes, checked. Depends on: pydantic, scenario, simulation."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from tethership.errors import ConfigError, suggestion
from tethership.plant import STATE_NAMES
from tethership.scenario import SI_UNIT, Quantity, SolverConfig, validated
from tethership.simulation.outcome import Outcome

Number = Annotated[float, Field(allow_inf_nan=False)]


class StoredTrim(BaseModel):
    """A trimmed point as plain numbers.

    They are the state [m/s, rad/s, rad, m], shape (12,), in the order of `plant.state.STATE_NAMES`, the throttles δ [-]
    and the deflections [rad].
    """

    model_config = ConfigDict(strict=True)

    state: Annotated[list[Number], Field(min_length=len(STATE_NAMES), max_length=len(STATE_NAMES))]
    throttle: list[Number]
    deflection: list[Number]


class StoredStop(BaseModel):
    """What was to end a flight, as `simulation.events.Stop` has it, and whether the winches took in cable.

    `time_limit` [s], `cable_length` [m] or none, `largest_pitch` [rad].
    """

    model_config = ConfigDict(strict=True)

    time_limit: Annotated[float, Field(gt=0, allow_inf_nan=False)]
    cable_length: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None
    largest_pitch: Annotated[float, Field(gt=0, allow_inf_nan=False)]
    ground_contact: bool
    rewind: bool


class FlightHeader(BaseModel):
    """Attributes of a flight; their meanings are in `results.schema.ATTRIBUTES`.

    `limits` are the four tensions [N] that are watched: control threshold, envelope's tear and tensile force, weakest
    cable. The scenario and the solver are validated as their own files are when they are used.
    """

    model_config = ConfigDict(strict=True)

    outcome: str
    steps: Annotated[int, Field(ge=0)]
    layers: list[str]
    own_laws: list[str]
    sas: bool
    formulation: Literal["consistent", "published"]
    line: dict[str, dict[str, Any]] | None = None
    limits: Annotated[list[Number], Field(min_length=4, max_length=4)]
    scenario_name: str
    scenario: dict[str, Any]
    solver: dict[str, Any]
    stop: StoredStop | None = None
    trim: StoredTrim
    versions: dict[str, str]

    @field_validator("outcome")
    @classmethod
    def _known_outcome(cls, name: str) -> str:
        known = Outcome.__members__
        if name not in known:
            raise ValueError(f"unknown outcome {name!r}{suggestion(name, known)} Known: {', '.join(known)}")
        return name


def check_header(attributes: dict[str, Any], origin: str) -> None:
    """Raise ConfigError, in one line, where a flight's attributes are not what they must be."""
    try:
        FlightHeader.model_validate(attributes)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where, what = ".".join(map(str, first["loc"])), first["msg"].removeprefix("Value error, ")
        raise ConfigError(
            f"{origin} is no whole flight: {where}: {what[0].lower()}{what[1:]}; take a whole copy, or fly it again"
        ) from error


def stored_solver(numbers: dict[str, Any], origin: str) -> SolverConfig:
    """Return solver settings that a flight keeps as plain numbers: steps and output interval [s], the rest as it is.

    Raises
    ------
    ConfigError
        They cannot be.
    """
    fields = SolverConfig.model_fields
    in_si = {
        key: {"value": value, "unit": SI_UNIT}
        if key in fields and any(isinstance(entry, Quantity) for entry in fields[key].metadata)
        else value
        for key, value in numbers.items()
    }
    return validated(SolverConfig, in_si, origin)
