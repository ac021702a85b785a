"""What was chosen on the page: a scenario, and values of it changed. Depends on: explorer.fields, scenario.

A choice holds exactly what `load_scenario` takes, so the command, the file and the figure cannot differ.
"""

import json
from collections.abc import Mapping
from typing import Any, NamedTuple

from tethership.errors import ConfigError
from tethership.explorer.fields import in_si, known_parameters, shown, typed
from tethership.scenario import LAYERS, Document, Parameter, Scenario, is_share, missing_kind, value_at

FORMULATIONS = ("consistent", "published")


class Form(NamedTuple):
    """What the page says, unchecked.

    Attributes
    ----------
    scenario : str
        Name.
    texts : dict[str, str]
        What was typed, by parameter.
    layers : list of str, optional
        Control layers; those of the scenario if None.
    sas : bool, optional
    formulation : str, optional
    """

    scenario: str
    texts: Mapping[str, str]
    layers: list[str] | None = None
    sas: bool | None = None
    formulation: str | None = None


class Choice(NamedTuple):
    """A scenario and its changes.

    Attributes
    ----------
    scenario : str
        Packaged name, or name of a file in the folder.
    stamp : int
        Of that file; another one where it was edited.
    changes : str
        Dotted name → value as `load_scenario` takes them, as JSON.
    words : tuple of str
        The same for people.
    """

    scenario: str
    stamp: int
    changes: str
    words: tuple[str, ...]

    @property
    def values(self) -> dict[str, Any]:
        """The changes."""
        return json.loads(self.changes)


def choose(base: Scenario, form: Form, stamp: int) -> Choice:
    """Return the choice that a form makes of a scenario, as loaded without changes.

    Raises
    ------
    ConfigError
        A text is no number, a name is not known, or the file's own bounds forbid a value.
    """
    known = known_parameters(base.config)
    changes: dict[str, Any] = {}
    words: list[str] = []
    numbers: dict[str, dict[tuple[int, ...], tuple[float, str]]] = {}
    for name, text in form.texts.items():
        if name not in known:
            raise ConfigError(f"scenario {form.scenario} has no number {name!r}; reload the page")
        parameter = known[name]
        if str(text).strip() == shown(parameter):
            continue
        number = typed(parameter, str(text))
        words.append(f"{name} = {number[0]:g} {number[1]}".removesuffix(" 1"))
        for leaf in parameter.leaves:
            numbers.setdefault(leaf.key, {})[leaf.component] = number
        kind = missing_kind(base, name)
        if kind is not None:
            changes[f"{name.split('.')[0]}.model"] = kind
    units = {leaf.key: parameter for parameter in known.values() for leaf in parameter.leaves}
    changes |= {key: _value(base, units[key], key, entries) for key, entries in numbers.items()}
    changes |= _switches(base, form, words)
    base.changed(changes)
    return Choice(form.scenario, stamp, json.dumps(changes, sort_keys=True), tuple(words))


def _switches(base: Scenario, form: Form, words: list[str]) -> dict[str, Any]:
    """Return what is not a number: layers, SAS, formulation."""
    control, changes = base.config.control, {}
    layers = None if form.layers is None else [name for name in LAYERS if name in form.layers]
    if layers is not None and layers != [name for name in LAYERS if name in control.layers]:
        changes["control.layers"] = layers
        words.append(f"layers {' + '.join(layers) or 'none'}")
    if form.sas is not None and bool(form.sas) != control.sas:
        changes["control.sas"] = bool(form.sas)
        words.append(f"SAS {'on' if form.sas else 'off'}")
    if form.formulation in FORMULATIONS and form.formulation != base.formulation:
        changes["formulation"] = form.formulation
        words.append(f"{form.formulation} formulation")
    return changes


def _value(base: Scenario, parameter: Parameter, key: str, entries: dict[tuple[int, ...], tuple[float, str]]) -> Any:
    """Return the value of a key as `load_scenario` takes it: bare in SI, else with its unit."""
    bare = key.startswith("vehicle.") or is_share(key.split(".")[:-1])
    if () in entries:
        value, unit = entries[()]
        if bare or unit == parameter.unit:
            return in_si(parameter, entries[()])
        return {"value": value, "unit": unit}
    own = _datum(base.document, key)
    unit = own.get("unit") if isinstance(own, dict) else None
    if unit is not None and not bare and all(given == unit for _, given in entries.values()):
        value = _patched(own["value"], {at: value for at, (value, _) in entries.items()})
        return value if unit == parameter.unit else {"value": value, "unit": unit}
    return _patched(value_at(base.config, key), {at: in_si(parameter, number) for at, number in entries.items()})


def _patched(value: Any, entries: Mapping[tuple[int, ...], float], place: tuple[int, ...] = ()) -> Any:
    """Return nested lists with some entries replaced."""
    if isinstance(value, list | tuple):
        return [_patched(item, entries, (*place, index)) for index, item in enumerate(value)]
    return entries.get(place, value)


def _datum(document: Document, key: str) -> Any:
    """Return what a document has at a dotted key, or None."""
    here: Any = document
    for step in key.split("."):
        if isinstance(here, list):
            named = [item for item in here if isinstance(item, dict) and item.get("name") == step]
            here = named[0] if named else here[int(step)]
        else:
            here = here.get(step) if isinstance(here, dict) else None
    return here
