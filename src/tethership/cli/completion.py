"""What the shell offers when Tab is pressed: packaged names, layers, parameters. Depends on: scenario.

Each returns what begins with what is typed; a path is completed by the shell itself.
"""

from collections.abc import Callable, Iterable

from tethership.scenario import list_packaged


def _offered(names: Callable[[], Iterable[str]]) -> Callable[[str], list[str]]:
    """Return a completion that offers those of some names, listed when Tab is pressed, that begin so."""

    def complete(incomplete: str) -> list[str]:
        return [name for name in names() if name.startswith(incomplete)]

    return complete


def _parameters() -> Iterable[str]:
    """Return what --set takes: the packaged docking's parameters stand for those of any scenario."""
    from tethership.scenario import ALIASES, list_parameters, load_scenario

    return (f"{name}=" for name in (*ALIASES, *list_parameters(load_scenario("docking").config)))


complete_scenario = _offered(lambda: list_packaged()["scenarios"])
complete_campaign = _offered(lambda: list_packaged()["campaigns"])
complete_solver = _offered(lambda: list_packaged()["solvers"])
complete_formulation = _offered(lambda: ("consistent", "published"))
complete_line = _offered(lambda: ("catenary", "published"))
complete_kind = _offered(lambda: (*list_packaged(), "outputs", "parameters"))
complete_parameter = _offered(_parameters)


def complete_layers(incomplete: str) -> list[str]:
    """Return layers that are not named yet, after those that are."""
    *before, begun = incomplete.split(",")
    left = _offered(lambda: (name for name in ("rewind", "heading", "navigation") if name not in before))
    return [",".join([*before, name]) for name in left(begun)]
