"""`tethership fly`: trim any scenario and fly it for a while, without docking."""

from pathlib import Path
from typing import Annotated

import typer

from tethership.cli.common import (
    FormulationOption,
    JsonOption,
    LineOption,
    OutOption,
    ScenarioArgument,
    SetOption,
    TrustOption,
    WindOption,
    chosen_scenario,
    writable,
)
from tethership.cli.flown import LayersOption, NoSasOption, SolverOption, split, tell
from tethership.cli.points import trimmed_start
from tethership.cli.progress import flying
from tethership.cli.tables import CsvOption
from tethership.errors import ConfigError

EXAMPLE = "Example: tethership fly hover --time 30 --set 'gusts=[]' --out flights/hover"

LONGEST = 36_000.0
"""Longest flight [s]."""


def fly(
    scenario: ScenarioArgument = "hover",
    time: Annotated[
        float | None, typer.Option(help="How long to fly [s]; the scenario's time limit if left out.")
    ] = None,
    rewind: Annotated[
        bool, typer.Option("--rewind", help="Let the winches take in cable, as dock does; else they hold.")
    ] = False,
    wind: WindOption = None,
    formulation: FormulationOption = None,
    line: LineOption = None,
    trust: TrustOption = False,
    layers: LayersOption = None,
    no_sas: NoSasOption = False,
    solver: SolverOption = "adaptive",
    changes: SetOption = None,
    out: OutOption = Path("out"),
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Trim a ship, free or on cables, and fly it under its laws; nothing docks and winches hold.

    Writes flight.nc, flight.png and replay.html into --out. dock --from flies a flight.nc again.
    """
    from tethership.scenario import read_solver

    if time is not None and not 0.0 < time <= LONGEST:
        raise ConfigError(f"--time {time:g} is no time to fly; give a number of seconds above 0, at most {LONGEST:g}")
    loaded = chosen_scenario(scenario, wind, formulation, changes, line, trust)
    names = None if layers is None else split(layers)
    loaded.law(names)  # a wrong name is found before anything is computed
    read_solver(solver)
    writable(out, csv)
    point = trimmed_start(loaded, json)
    from tethership.simulation import fly as flown

    sas = False if no_sas else None
    with flying(loaded.config.stop.time_limit if time is None else time) as reached:
        flight = flown(loaded, point, stop=time, layers=names, sas=sas, rewind=rewind, solver=solver, progress=reached)
    tell(loaded, flight, point.outcome.name, out, "flight.png", csv, json)
