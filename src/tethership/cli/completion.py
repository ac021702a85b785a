"""What the shell offers when Tab is pressed: packaged names, layers, parameters. Depends on: scenario.

Each returns what begins with what is typed; a path is completed by the shell itself.
"""

from tethership.scenario import list_packaged, list_parameters, load_scenario
from tethership.scenario.parameters import ALIASES


def complete_scenario(incomplete: str) -> list[str]:
    """Return packaged scenarios."""
    return _begun(list_packaged()["scenarios"], incomplete)


def complete_campaign(incomplete: str) -> list[str]:
    """Return packaged campaigns."""
    return _begun(list_packaged()["campaigns"], incomplete)


def complete_solver(incomplete: str) -> list[str]:
    """Return packaged solver settings."""
    return _begun(list_packaged()["solvers"], incomplete)


def complete_formulation(incomplete: str) -> list[str]:
    """Return the formulations."""
    return _begun(["consistent", "published"], incomplete)


def complete_line(incomplete: str) -> list[str]:
    """Return the models of a line."""
    return _begun(["catenary", "published"], incomplete)


def complete_kind(incomplete: str) -> list[str]:
    """Return what `tethership list` lists."""
    return _begun([*list_packaged(), "outputs", "parameters"], incomplete)


def complete_layers(incomplete: str) -> list[str]:
    """Return layers that are not named yet, after those that are."""
    *before, begun = incomplete.split(",")
    left = [name for name in ("rewind", "heading", "navigation") if name not in before]
    return [",".join([*before, name]) for name in _begun(left, begun)]


def complete_parameter(incomplete: str) -> list[str]:
    """Return the numbers of `docking` by their dotted names, each with an equals sign."""
    names = [*ALIASES, *list_parameters(load_scenario("docking").config)]
    return [f"{name}=" for name in _begun(names, incomplete)]


def _begun(names: list[str], incomplete: str) -> list[str]:
    """Return the names that begin so."""
    return [name for name in names if name.startswith(incomplete)]
