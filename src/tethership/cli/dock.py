"""`tethership dock`: trim, fly the docking manoeuvre, print the metrics, write flight, picture and replay."""

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
from tethership.cli.flown import LayersOption, NoSasOption, SolverOption, again, split, summary, tell
from tethership.cli.points import trimmed_start
from tethership.cli.progress import flying
from tethership.cli.tables import CsvOption
from tethership.errors import ConfigError

__all__ = ["dock", "summary"]

EXAMPLE = "Example: tethership dock --wind 12 --layers rewind,heading --out flights/12"


def dock(
    scenario: ScenarioArgument = "docking",
    wind: WindOption = None,
    formulation: FormulationOption = None,
    line: LineOption = None,
    trust: TrustOption = False,
    layers: LayersOption = None,
    no_sas: NoSasOption = False,
    solver: SolverOption = "adaptive",
    from_: Annotated[Path | None, typer.Option("--from", help="Fly the stored input of a flight file again.")] = None,
    changes: SetOption = None,
    out: OutOption = Path("out"),
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Trim the ship on its cable, fly the docking manoeuvre and show what happened.

    Writes flight.nc (labelled data with the full input), docking.png (the paper's four panels) and replay.html (the
    flight in space, opens in a browser without a network) into --out.
    """
    from tethership.scenario import read_solver

    given = (scenario, wind, formulation, line, layers, changes, no_sas, solver)
    if from_ is not None and given != ("docking", None, None, None, None, None, False, "adaptive"):
        raise ConfigError(
            "--from flies the stored input as it is; leave out the scenario and all flags but --out, --csv, --json"
        )
    if from_ is not None and from_.resolve() == (out / "flight.nc").resolve():
        raise ConfigError(f"--from {from_} would be overwritten; choose another folder with --out")
    if from_ is not None:
        writable(out, csv)
        flown_scenario, flight = again(from_, trust)
        trim_outcome = "stored"
    else:
        flown_scenario = chosen_scenario(scenario, wind, formulation, changes, line, trust)
        names = None if layers is None else split(layers)
        flown_scenario.law(names)  # a wrong name is found before anything is computed
        read_solver(solver)
        writable(out, csv)
        point = trimmed_start(flown_scenario, json)
        trim_outcome = point.outcome.name
        from tethership.simulation import dock as fly

        with flying(flown_scenario.config.stop.time_limit) as reached:
            flight = fly(flown_scenario, point, names, False if no_sas else None, solver, reached)
    tell(flown_scenario, flight, trim_outcome, out, "docking.png", csv, json)
