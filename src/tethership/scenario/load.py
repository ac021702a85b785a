"""Reading scenarios, vehicles and solver settings: packaged by name, or a TOML file. Depends on: scenario, errors."""

import copy
import dataclasses
import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from tethership.control import LayeredLaw
from tethership.errors import ConfigError, TethershipWarning, shown
from tethership.plant import AbstractPart, TetheredAirship
from tethership.scenario.build import assemble
from tethership.scenario.changes import Document, change
from tethership.scenario.control_schema import check_layers
from tethership.scenario.laws import build_law
from tethership.scenario.messages import first_problem
from tethership.scenario.own_code import as_entry, find_beside
from tethership.scenario.packaged import list_packaged as list_packaged
from tethership.scenario.packaged import packaged_text as packaged_text
from tethership.scenario.quantity import Table
from tethership.scenario.reading import parse_toml, read_text
from tethership.scenario.schema import ScenarioConfig
from tethership.scenario.solver import SolverConfig
from tethership.scenario.vehicle_schema import VehicleConfig
from tethership.scenario.wind_file import expand_wind_file, take_wind_file

ModelType = TypeVar("ModelType", bound=Table)


@dataclasses.dataclass(frozen=True)
class Scenario:
    """A validated flight: the plant and everything that is set around it.

    Attributes
    ----------
    name : str
        Packaged name or file.
    config : ScenarioConfig
        Its numbers, SI and radians.
    document : dict
        The file as read, vehicle and changes included: enough to load it again, bit for bit.
    system : TetheredAirship
        The plant.
    trusted : bool
        Whether code of one's own that it names may be run.
    """

    name: str
    config: ScenarioConfig
    document: Document
    system: TetheredAirship
    trusted: bool = False

    def __repr__(self) -> str:
        """Return what it is in a line; `config` shows the rest."""
        return f"<Scenario: {self.name}, {self.config.title}>"

    @property
    def formulation(self) -> str:
        """`consistent` or `published`."""
        return self.config.formulation

    @property
    def layers(self) -> tuple[str, ...]:
        """Control layers besides SAS/attitude."""
        return self.config.control.layers

    @property
    def remarks(self) -> tuple[str, ...]:
        """What reading a measured wind left out, bridged or guessed, a line each."""
        return getattr(self.config.wind, "remarks", ())

    def law(self, layers: Iterable[str] | None = None, sas: bool | None = None, switched: bool = False) -> LayeredLaw:
        """Return the layered law.

        Parameters
        ----------
        layers : iterable of str, optional
            Instead of the scenario's own.
        sas : bool, optional
            SAS/attitude on or off instead of the scenario's own.
        switched : bool
            All laws, with a switch for each, as in `build_law`.

        Raises
        ------
        ConfigError
            A layer is not known, or the scenario names code of one's own and is not trusted.
        """
        self.check_trust()
        control = self.config.control
        try:
            names = control.layers if layers is None else check_layers(layers)
        except ValueError as error:
            raise ConfigError(str(error)) from error
        if names and not self.config.cables:
            raise ConfigError(f"layers {', '.join(names)} need a cable, and {self.name} has none; use --layers none")
        chosen = control.model_copy(update={"layers": names, "sas": control.sas if sas is None else sas})
        return build_law(self.config.model_copy(update={"control": chosen}), switched)

    def changed(self, changes: Mapping[str, Any]) -> "Scenario":
        """Return the scenario with values changed; see `load_scenario`."""
        return from_document(self.document, self.name, changes, self.trusted)

    def check_trust(self) -> None:
        """Raise ConfigError where the scenario names code of one's own, and nobody said that it may run."""
        _check_trust(self.name, self.config.own_code(), self.trusted)

    def with_parts(self, parts: Mapping[str, AbstractPart]) -> "Scenario":
        """Return the scenario with parts of one's own on its ship, by name; those of a name that is there replace it.

        They are kept in the scenario as a file would name them, by class and numbers, so that workers, stored flights
        and campaigns have them too; their code is trusted.

        Raises
        ------
        ConfigError
            One is no part, its class is not at the top of a module, or a field is no number; or the scenario names
            code of one's own itself and is not trusted.
        """
        self.check_trust()  # the parts given are trusted, what the file names is not thereby
        entries = {part["name"]: part for part in self.document["vehicle"].get("parts", [])}
        entries |= {name: as_entry(name, part) for name, part in parts.items()}
        return from_document(self.document, self.name, {"vehicle.parts": list(entries.values())}, trusted=True)


def _check_trust(name: str, code: list[str], trusted: bool) -> None:
    """Raise ConfigError where there is code of one's own, and nobody said that it may run."""
    if code and not trusted:
        raise ConfigError(
            f"{name} names code of one's own, {', '.join(code)}, which runs only when told so: --trust, or "
            "load_scenario(..., trust=True)"
        )


MOST_BASES = 8
"""Scenarios that may stand on one another."""


def _read(folder: str, name: str, base: Path | None = None) -> tuple[Document, str]:
    """Return a document and where it came from."""
    if not name.endswith(".toml"):
        return parse_toml(packaged_text(folder, name), name), name
    path = Path(name) if base is None or Path(name).is_absolute() else base / name
    return parse_toml(read_text(path), str(path)), str(path)


def read_document(folder: str, name: str) -> Document:
    """Return the document of a packaged file by name, or of a path that ends in `.toml`; errors as `load_scenario`."""
    return _read(folder, name)[0]


def validated(model: type[ModelType], document: Document, origin: str) -> ModelType:
    """Return the model of a document, or raise ConfigError that names file, key and value."""
    try:
        return model.model_validate(document)
    except ValidationError as error:
        raise ConfigError(first_problem(error, origin, document)) from error


def load_scenario(
    name: str = "docking",
    changes: Mapping[str, Any] | None = None,
    trust: bool = False,
    own_parts: Mapping[str, AbstractPart] | None = None,
) -> Scenario:
    """Return a scenario.

    Parameters
    ----------
    name : str
        A packaged name (see `list_packaged`) or a path that ends in `.toml`. A file may name another one as its `base`:
        it then says only what differs, whole tables or single values under `[changes]`.
    changes : mapping, optional
        Dotted name → value, e.g. ``{"wind.speed": 12.0, "vehicle.body.mass": 130.0}``; numbers in SI and radians.
        Items of a list go by name or number, all of them by a star: ``cables.nose.length``, ``gusts.0.start``,
        ``vehicle.thrusters.*.lag``.
    trust : bool
        Let code of one's own that the file names be run (`control.laws`, `vehicle.parts`, `cables.*.line`).
    own_parts : mapping of str to AbstractPart, optional
        Parts of one's own for its ship, as in `Scenario.with_parts`.

    Raises
    ------
    ConfigError
        Not found, not TOML, or a key, unit or value that cannot be.

    Warns
    -----
    TethershipWarning
        The drag of a hull that is nearly a sphere is split into axial and cross-flow drag.

    Examples
    --------
    >>> import tethership as ts
    >>> scenario = ts.load_scenario("docking", {"wind.speed": 9.0})
    >>> scenario.config.wind.speed
    9.0
    """
    document, origin = _changed_document(name, changes or {})
    if trust:
        find_beside(origin)
    scenario = from_document(document, origin, trusted=trust)
    doubt = scenario.config.vehicle.drag_warning()
    if doubt:
        warnings.warn(doubt, TethershipWarning, stacklevel=2)
    return scenario.with_parts(own_parts) if own_parts else scenario


def _changed_document(name: str, changes: Mapping[str, Any]) -> tuple[Document, str]:
    """Return the document of a scenario, vehicle included, changes made, and where it came from."""
    document, origin = _read("scenarios", name)
    document, base_changes = _on_base(document, origin)
    if isinstance(changes.get("vehicle"), str):
        document["vehicle"] = changes["vehicle"]
        changes = {key: value for key, value in changes.items() if key != "vehicle"}
    base = Path(origin).parent if origin.endswith(".toml") else None
    changes = take_wind_file(document, dict(changes))
    expand_wind_file(document, base, origin)
    vehicle = document.get("vehicle")
    if isinstance(vehicle, str):
        document["vehicle"], vehicle_origin = _read("vehicles", vehicle, base)
        validated(VehicleConfig, document["vehicle"], vehicle_origin)
    for key, value in {**base_changes, **changes}.items():
        change(document, key, value, origin)
    return document, origin


def _on_base(document: Document, origin: str, depth: int = 0) -> tuple[Document, Document]:
    """Return the document of a scenario with the tables of its `base` that it does not say itself, and their changes.

    Raises
    ------
    ConfigError
        A base is not found, or stands on itself; `changes` is no table.
    """
    own_changes = document.pop("changes", {})
    if not isinstance(own_changes, dict):
        raise ConfigError(f"{origin}: changes is {shown(own_changes)}; give a table, [changes], of dotted names")
    base = document.pop("base", None)
    if base is None:
        return document, own_changes
    if not isinstance(base, str):
        raise ConfigError(f"{origin}: base is {shown(base)}; give a packaged scenario, or a path that ends in .toml")
    if depth >= MOST_BASES:
        raise ConfigError(
            f"{origin}: base {shown(base)} is the {depth + 1}th in a row, or stands on itself; use a copy"
        )
    folder = Path(origin).parent if origin.endswith(".toml") else None
    found, where = _read("scenarios", base, folder)
    below, its_changes = _on_base(found, where, depth + 1)
    return {**_rooted(below, where), **document}, {**its_changes, **own_changes}


def _rooted(document: Document, origin: str) -> Document:
    """Return a document whose own files, vehicle and measured wind, are found from any folder."""
    if not origin.endswith(".toml"):
        return document
    folder, found = Path(origin).resolve().parent, dict(document)
    if str(found.get("vehicle", "")).endswith(".toml"):
        found["vehicle"] = str(folder / found["vehicle"])
    wind = found.get("wind")
    if isinstance(wind, dict) and isinstance(wind.get("file"), str):
        found["wind"] = {**wind, "file": str(folder / wind["file"])}
    return found


def from_document(
    document: Document, origin: str, changes: Mapping[str, Any] | None = None, trusted: bool = False
) -> Scenario:
    """Return the scenario of a document whose vehicle is included, with changes as in `load_scenario`."""
    document = copy.deepcopy(document)
    for key, value in (changes or {}).items():
        change(document, key, value, origin)
    config = validated(ScenarioConfig, document, origin)
    _check_trust(origin, config.own_plant_code(), trusted)
    return Scenario(origin, config, document, assemble(config), trusted)


def read_solver(name: str = "adaptive") -> SolverConfig:
    """Return solver settings, packaged by name or from a path that ends in `.toml`.

    Raises
    ------
    ConfigError
        As `load_scenario`.
    """
    document, origin = _read("solvers", name)
    return validated(SolverConfig, document, origin)


def check_file(name: str) -> str:
    """Return what a file is (`scenario`, `vehicle` or `solver`) after checking all of it.

    Raises
    ------
    ConfigError
        As `load_scenario`.
    """
    document, origin = _read("scenarios", name)
    if "body" in document or "hull" in document:
        validated(VehicleConfig, document, origin)
        return "vehicle"
    if "method" in document or "step" in document:
        validated(SolverConfig, document, origin)
        return "solver"
    document, origin = _changed_document(name, {})
    if not validated(ScenarioConfig, document, origin).own_plant_code():
        load_scenario(name)  # what the plant is built of is checked too; code of one's own is not run
    return "scenario"
