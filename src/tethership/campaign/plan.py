"""A campaign made ready: its scenario, its cases, its laws, cut into batches. Depends on: campaign, scenario, analysis.

Whatever flies a batch needs nothing but a `Batch` (plain data), so that it may be another process or another machine.
"""

import hashlib
import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tethership._version import __version__
from tethership.campaign.engine import engine_name
from tethership.campaign.flights import BATCH, FEW, SWITCHES
from tethership.campaign.sampling import Sample, draw
from tethership.campaign.schema import CampaignConfig, LawConfig
from tethership.errors import ConfigError, shown
from tethership.scenario import (
    LAYERS,
    Document,
    Scenario,
    check_values,
    find_parameter,
    list_parameters,
    load_scenario,
    read_document,
    validated,
)


def lanes_for(cases: int) -> int:
    """Return how many flights of a campaign are flown at once: few where there are few."""
    return FEW if cases <= 2 * FEW else BATCH


class Batch(NamedTuple):
    """What one call flies.

    Attributes
    ----------
    number : int
        Its place among the batches.
    law : int
        Which law.
    first : int
        Its first case.
    values : ndarray
        Of everything that differs, in SI: [m/s], [rad], [N], …; shape (cases, names).
    verified : tuple of int
        Places in the batch of cases that are flown again to tight tolerance.
    """

    number: int
    law: int
    first: int
    values: np.ndarray
    verified: tuple[int, ...]


class Work(NamedTuple):
    """What all batches have in common, as plain data.

    Attributes
    ----------
    scenario : str
        The scenario's document as JSON.
    scenario_name : str
        For messages.
    names : tuple of str
        Dotted names of the columns of `Batch.values`.
    example : tuple of float
        Values of one case [SI].
    lanes : int
        Flights of one call.
    step : float
        h [s].
    trusted : bool
        Whether laws of one's own that the scenario names may be run.
    engine : str
        What flies them, as `engine_name` says it.
    """

    scenario: str
    scenario_name: str
    names: tuple[str, ...]
    example: tuple[float, ...]
    lanes: int
    step: float
    trusted: bool = False
    engine: str = ""


class Plan(NamedTuple):
    """A campaign, ready.

    Attributes
    ----------
    name : str
        Packaged name or file.
    document : dict
        As read, with what the command changed.
    config : CampaignConfig
    scenario : Scenario
    sample : Sample
        The cases.
    laws : tuple of LawConfig
        All laws fly all cases.
    names : tuple of str
        Columns of a batch: what varies, then gains that differ between laws.
    values : ndarray
        Of everything that differs, in SI: [m/s], [rad], [N], …; shape (laws, cases, names).
    """

    name: str
    document: Document
    config: CampaignConfig
    scenario: Scenario
    sample: Sample
    laws: tuple[LawConfig, ...]
    names: tuple[str, ...]
    values: np.ndarray

    @property
    def cases(self) -> int:
        """Cases; every law flies each."""
        return self.values.shape[1]

    @property
    def lanes(self) -> int:
        """Flights of one call."""
        return lanes_for(self.cases)

    @property
    def batches(self) -> int:
        """Batches."""
        return len(self.laws) * -(-self.cases // self.lanes)

    def work(self) -> Work:
        """Return what all batches have in common."""
        document, example = json.dumps(self.scenario.document), tuple(map(float, self.values[0, 0]))
        step, trusted = self.config.step, self.scenario.trusted
        return Work(document, self.scenario.name, self.names, example, self.lanes, step, trusted, engine_name())

    def batch(self, number: int) -> Batch:
        """Return one batch by its number."""
        law, place = divmod(number, self.batches // len(self.laws))
        first = place * self.lanes
        values = self.values[law, first : first + self.lanes]
        chosen = np.random.default_rng([self.config.seed, number]).random(len(values)) < self.config.verified
        chosen[0] |= number == 0 and self.config.verified > 0.0  # one at least, however few the flights
        return Batch(number, law, first, values, tuple(map(int, np.flatnonzero(chosen))))

    def digest(self) -> str:
        """Return what tells this campaign from another: everything that goes into its numbers."""
        whole = [
            __version__,
            engine_name(),
            self.lanes,
            self.document,
            self.scenario.document,
            self.names,
            [law.name for law in self.laws],
        ]
        text = json.dumps(whole, sort_keys=True, default=str)
        return hashlib.sha256(text.encode() + self.values.tobytes()).hexdigest()


def make_plan(
    name: str,
    changes: dict[str, Any] | None = None,
    scenario_changes: dict[str, Any] | None = None,
    trust: bool = False,
) -> Plan:
    """Return a campaign made ready.

    Parameters
    ----------
    name : str
        Packaged name, or a path that ends in `.toml`.
    changes : mapping, optional
        Of the campaign's own keys: samples, seed, sampling, …
    scenario_changes : mapping, optional
        Of the scenario, by dotted name, as in `load_scenario`; what is set here does not vary.
    trust : bool
        Let laws of one's own that the scenario names be run.

    Raises
    ------
    ConfigError
        Anything in the file that cannot be.
    """
    document = {**read_document("campaigns", name), **(changes or {})}
    for key in ("changes", "vary"):
        if not isinstance(document.get(key, {}), dict):
            raise ConfigError(f"{name}: {key} is {shown(document[key])}; give a table of dotted names")
    if scenario_changes:
        document["changes"] = {**document.get("changes", {}), **scenario_changes}
        document["vary"] = {k: v for k, v in document.get("vary", {}).items() if k not in scenario_changes}
    config = validated(CampaignConfig, document, name)
    if config.sampling == "grid" and "samples" in (changes or {}):
        raise ConfigError(
            f"{name}: a grid flies every combination of its levels; leave out --samples or change the levels"
        )
    own = load_scenario(
        _beside(name, config.scenario), _wind_beside(name, config.changes, scenario_changes or {}), trust
    )
    scenario = own.changed({"control.layers": list(LAYERS)})  # a layer is off by its gains: see `layer_switches`
    _check_limits(config, name)
    sample = draw(config, scenario, name)
    laws = config.laws or (LawConfig(name="own", layers=own.layers),)
    names, values = _columns(scenario, sample, laws, name)
    return Plan(name, document, config, scenario, sample, laws, names, values)


def _beside(campaign: str, scenario: str) -> str:
    """Return a scenario's name, its path counted from the campaign's file."""
    if scenario.endswith(".toml") and campaign.endswith(".toml") and not Path(scenario).is_absolute():
        return str(Path(campaign).parent / scenario)
    return scenario


def _wind_beside(campaign: str, changes: dict[str, Any], typed: dict[str, Any]) -> dict[str, Any]:
    """Return changes with the path of a wind file counted from the campaign's file, unless it was typed."""
    if "wind.file" not in changes or "wind.file" in typed or not campaign.endswith(".toml"):
        return changes
    return {**changes, "wind.file": str(Path(campaign).parent / str(changes["wind.file"]))}


def _check_limits(config: CampaignConfig, origin: str) -> None:
    """Raise ConfigError where a requirement asks for a limit that has no number."""
    for requirement in config.requirements:
        if (
            requirement.limit in ("winch_pull", "attitude", "time")
            and getattr(config.limits, requirement.limit) is None
        ):
            raise ConfigError(f"{origin}: a requirement on {requirement.limit} needs limits.{requirement.limit}")


def _columns(
    scenario: Scenario, sample: Sample, laws: tuple[LawConfig, ...], origin: str
) -> tuple[tuple[str, ...], np.ndarray]:
    """Return names and values (laws, cases, names) of all that differs from flight to flight."""
    gains = [_gains(scenario, law) for law in laws]
    extra = sorted({name for law in gains for name in law} - set(sample.names))
    known = list_parameters(scenario.config)
    for law in laws:
        own = {find_parameter(known, name, scenario.name).name for name in law.changes}
        if twice := sorted(own & set(sample.names)):
            raise ConfigError(
                f"{origin}: law {law.name} sets {', '.join(twice)}, which varies too: leave it out of one of the two"
            )
    names = (*sample.names, *extra)
    values = np.empty((len(laws), len(sample.values), len(names)))
    values[:, :, : len(sample.names)] = sample.values
    for i, law in enumerate(gains):
        for j, name in enumerate(extra):
            values[i, :, len(sample.names) + j] = law.get(name, known[name].value)
        for j, name in enumerate(sample.names):
            if law.get(name) == 0.0 and any(name in switch for switch in SWITCHES.values()):
                values[i, :, j] = 0.0  # the layer whose gain varies is off
    return names, values


def _gains(scenario: Scenario, law: LawConfig) -> dict[str, float]:
    """Return what a law sets, dotted name → value [SI]."""
    known = list_parameters(scenario.config)
    found: dict[str, float] = {}
    if law.gains_of is not None:
        other = list_parameters(load_scenario(law.gains_of).config)
        found |= {n: p.value for n, p in other.items() if n.startswith("control.") and "*" not in n and n in known}
    for name, value in law.changes.items():
        parameter = find_parameter(known, name, scenario.name)
        check_values(scenario, [parameter], [value])
        found[parameter.name] = value
    for layer, names in SWITCHES.items():
        for name in names:
            found[name] = found.get(name, known[name].value) if layer in law.layers else 0.0
    return found
