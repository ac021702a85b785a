"""How a file names code of one's own: a law, a part, a line. Depends on: scenario.quantity."""

from collections.abc import Iterable
from typing import Annotated, Any

from pydantic import Field, field_validator

from tethership.scenario.names import Part, Word
from tethership.scenario.quantity import Table

OWN_CODE = r"^[A-Za-z_][\w.]*:[A-Za-z_]\w*$"
"""`module:Class`, a module beside the file or on Python's path."""

PACKAGE = "tethership."
"""Beginning of a module that is this package's own, which needs no trust."""


class OwnCode(Table):
    """Code of one's own: `model = "module:Class"` and its numbers by name, given to the class as arrays, as they are.

    Numbers, or lists of them, in units of the class's own. It runs only when told so (`--trust`).
    """

    model: Annotated[str, Field(pattern=OWN_CODE, max_length=200)]
    numbers: dict[str, float | tuple[float, ...]] = Field(default_factory=dict)

    @field_validator("numbers", mode="before")
    @classmethod
    def _vectors(cls, datum: Any) -> Any:
        if not isinstance(datum, dict):
            return datum
        for key, value in datum.items():
            if isinstance(value, dict):
                raise ValueError(f"{key} is given with a unit; own code takes bare numbers, in units of its own")
        return {key: tuple(value) if isinstance(value, list) else value for key, value in datum.items()}


class OwnLawConfig(OwnCode):
    """A law of one's own, a subclass of `tethership.AbstractLaw`."""

    name: Word


class OwnPartConfig(OwnCode):
    """A part of the ship of one's own, a subclass of `tethership.AbstractPart`; its name is that of its load."""

    name: Part


class OwnLine(OwnCode):
    """A line of one's own, a subclass of `physics.cable.AbstractTensionLaw`.

    The class is given its numbers and, where it has fields of these names, the cable's `stiffness`, `joint_start`,
    `joint_end`, `diameter` and `linear_density`, in [N, -, -, m, kg/m].
    """


def foreign(entries: Iterable[OwnCode]) -> list[str]:
    """Return the `module:Class` of all that are not this package's own."""
    return [entry.model for entry in entries if not entry.model.startswith(PACKAGE)]
