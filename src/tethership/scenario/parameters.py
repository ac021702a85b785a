"""Every scalar of a scenario by its dotted name: to be swept, or differentiated. Depends on: scenario.

A parameter is one number of the files (`wind.speed`, `cables.nose.tether_point.0`, `vehicle.body.mass`), or the
same number of all items of a list where it is the same in all, moved together (`vehicle.fins.*.area`). Numbers that
must stay equal are one parameter: the off-diagonal entries of the inertia matrix, and k2 with k3.
"""

import copy
import difflib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple, get_args

import jax
from jax.tree_util import DictKey, GetAttrKey, SequenceKey

from tethership.errors import MOST_LETTERS, ConfigError, shown
from tethership.scenario.changes import Document, change
from tethership.scenario.load import Scenario, from_document, validated
from tethership.scenario.quantity import Quantity, Table
from tethership.scenario.schema import ScenarioConfig

ALIASES = {"wind": "wind.speed", "elongation": "trim.elongation"}
"""Short names that the command accepts too."""

TIED = {
    "vehicle.body.inertia.1.0": "vehicle.body.inertia.0.1",
    "vehicle.body.inertia.2.0": "vehicle.body.inertia.0.2",
    "vehicle.body.inertia.2.1": "vehicle.body.inertia.1.2",
    "vehicle.apparent_mass.k3": "vehicle.apparent_mass.k2",
}
"""Numbers that follow another one: the matrix is symmetric, the hull a body of revolution."""


class _Leaf(NamedTuple):
    """One number: its place among the leaves, the table's key it belongs to and its place within that value."""

    place: int
    key: str
    component: tuple[int, ...]
    unit: str
    value: float


class Parameter(NamedTuple):
    """One quantity of a scenario.

    Attributes
    ----------
    name : str
        Dotted name.
    unit : str
        SI unit.
    value : float
        Its value in the scenario; that of the first item where it stands for several.
    leaves : tuple
        Which numbers it moves.
    """

    name: str
    unit: str
    value: float
    leaves: tuple[_Leaf, ...]

    @property
    def places(self) -> tuple[int, ...]:
        """Places of its numbers among the leaves of the configuration."""
        return tuple(leaf.place for leaf in self.leaves)


def list_parameters(config: ScenarioConfig) -> dict[str, Parameter]:
    """Return every scalar of a validated scenario by its dotted name, and every `*` name of its lists.

    Examples
    --------
    >>> import tethership as ts
    >>> known = ts.list_parameters(ts.load_scenario("docking").config)
    >>> known["cables.nose.linear_density"].value, known["cables.nose.linear_density"].unit
    (0.08, 'kg/m')
    """
    leaves, _ = jax.tree_util.tree_flatten_with_path(config)
    found: dict[str, list[_Leaf]] = {}
    together: dict[str, list[_Leaf]] = {}
    for place, (path, value) in enumerate(leaves):
        if type(value) is not float:
            continue
        name, starred, leaf = _described(config, place, path, value)
        found.setdefault(TIED.get(name, name), []).append(leaf)
        if starred != name:
            together.setdefault(starred, []).append(leaf)
    several = {n: group for n, group in together.items() if len(group) > 1 and len({leaf.value for leaf in group}) == 1}
    return {
        name: Parameter(name, group[0].unit, group[0].value, tuple(group))
        for name, group in {**found, **several}.items()
    }


def _described(config: ScenarioConfig, place: int, path: Iterable[Any], value: float) -> tuple[str, str, _Leaf]:
    """Return dotted name, name with `*` for items of lists, and the leaf at a path of the configuration."""
    here: Any = config
    unit, names, starred, key, component = "1", [], [], [], []
    for step in path:
        match step:
            case GetAttrKey(name=name):
                unit = _unit(type(here), name)
                here, label, star = getattr(here, name), name, name
            case SequenceKey(idx=index):
                item = here[index]
                is_table = isinstance(item, Table)
                label = str(getattr(item, "name", index)) if is_table else str(index)
                here, star = item, "*" if is_table else label
                if not is_table:
                    component.append(index)
            case DictKey(key=label):
                here, star, unit = here[label], label, "1"
            case _:  # pragma: no cover
                raise TypeError(step)
        names.append(label)
        starred.append(star)
        if not component:
            key.append(label)
    leaf = _Leaf(place, ".".join(key), tuple(component), unit, value)
    return ".".join(names), ".".join(starred), leaf


def _unit(table: type[Table], name: str) -> str:
    """Return the SI unit of a field, as its annotation says; 1 where it says none."""
    field = table.model_fields[name]
    pending: list[Any] = [*field.metadata, field.annotation]
    while pending:
        entry = pending.pop(0)
        if isinstance(entry, Quantity):
            return entry.unit
        pending += [*getattr(entry, "__metadata__", ()), *get_args(entry)]
    return "1"


def find_parameter(known: Mapping[str, Parameter], name: str, scenario_name: str) -> Parameter:
    """Return a parameter by its dotted name or alias.

    Raises
    ------
    ConfigError
        There is none; the nearest names are offered.
    """
    full = ALIASES.get(name, name)
    full = TIED.get(full, full)
    if full in known:
        return known[full]
    near = _nearest(full, known) if len(full) <= MOST_LETTERS else []
    hint = f"; nearest: {', '.join(near)}" if near else ""
    raise ConfigError(
        f"scenario {scenario_name} has no number {shown(name)}{hint}. A dotted name of its file is meant, "
        "e.g. wind.speed, cables.nose.length or vehicle.fins.*.area"
    )


def _nearest(name: str, known: Iterable[str]) -> list[str]:
    """Return up to three known names like one: as a whole, or in their parts."""
    names = list(known)
    near = difflib.get_close_matches(name, names, n=3, cutoff=0.5)
    words = {word for other in names for word in other.split(".")}
    alike = [set(difflib.get_close_matches(word, words, n=2, cutoff=0.7)) for word in name.split(".")]
    shared = {other: sum(bool(words & set(other.split("."))) for words in alike) for other in names}
    near += [other for other in sorted(names, key=lambda o: -shared[o]) if shared[other] and other not in near]
    return near[:3]


def with_values(config: ScenarioConfig, places: Iterable[Iterable[int]], values: Iterable[Any]) -> ScenarioConfig:
    """Return a configuration with the leaves that each parameter moves set to its value [SI], without validation.

    Parameters
    ----------
    config : ScenarioConfig
        What is changed.
    places : iterable
        `Parameter.places` of each.
    values : iterable
        Values; they may be traced.
    """
    leaves, structure = jax.tree_util.tree_flatten(config)
    for group, value in zip(places, values, strict=True):
        for place in group:
            leaves[place] = value
    return jax.tree_util.tree_unflatten(structure, leaves)


def scenario_at(scenario: Scenario, values: Mapping[str, float]) -> Scenario:
    """Return the scenario with parameters set to values [SI], validated.

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`.
    values : mapping
        Parameter → value.

    Raises
    ------
    ConfigError
        A parameter does not exist, or the file's own bounds forbid a value.
    """
    known = list_parameters(scenario.config)
    chosen = [find_parameter(known, name, scenario.name) for name in values]
    document = _document_at(scenario, chosen, list(values.values()))
    return from_document(document, scenario.name, trusted=scenario.trusted)


def check_values(scenario: Scenario, parameters: Sequence[Parameter], values: Sequence[float]) -> None:
    """Raise ConfigError as `scenario_at` where parameters cannot have values [SI]; no plant is built."""
    validated(ScenarioConfig, _document_at(scenario, parameters, values), scenario.name)


def _document_at(scenario: Scenario, parameters: Sequence[Parameter], values: Sequence[float]) -> Document:
    """Return the scenario's document with parameters set."""
    places = [place for parameter in parameters for place in parameter.places]
    if len(set(places)) != len(places):
        names = ", ".join(parameter.name for parameter in parameters)
        raise ConfigError(f"two of {names} are the same number; name each once")
    groups = [parameter.places for parameter in parameters]
    config = with_values(scenario.config, groups, [float(value) for value in values])
    document = copy.deepcopy(scenario.document)
    for leaf in (leaf for parameter in parameters for leaf in parameter.leaves):
        kind = missing_kind(scenario, leaf.key)
        if kind is not None:
            document.setdefault(leaf.key.split(".")[0], {"model": kind})
        change(document, leaf.key, _listed(value_at(config, leaf.key)), scenario.name)
    return document


def missing_kind(scenario: Scenario, key: str) -> str | None:
    """Return what must be said as `model` of a key's table where the file left that table to its defaults."""
    table = key.split(".")[0]
    return None if table in scenario.document else getattr(getattr(scenario.config, table), "model", None)


def value_at(config: ScenarioConfig, key: str) -> Any:
    """Return the value of a configuration by its dotted key; items of lists by name or number."""
    place: Any = config
    for step in key.split("."):
        if isinstance(place, tuple):
            named = [item for item in place if getattr(item, "name", None) == step]
            place = named[0] if named else place[int(step)]
        else:
            place = place[step] if isinstance(place, dict) else getattr(place, step)
    return place


def _listed(value: Any) -> Any:
    """Return nested tuples as lists."""
    return [_listed(item) for item in value] if isinstance(value, tuple) else value
