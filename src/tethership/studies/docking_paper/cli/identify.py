"""`tethership identify`: fit the paper's unpublished parameters to its tables."""

from pathlib import Path
from typing import Annotated, Any

import typer

from tethership.cli.common import (
    FormulationOption,
    JsonOption,
    OutOption,
    ScenarioArgument,
    SetOption,
    chosen_scenario,
    writable,
)
from tethership.cli.progress import progress_bar
from tethership.cli.result import Result, show
from tethership.cli.tables import CsvOption, Row, Table
from tethership.errors import ConfigError
from tethership.results import write_together

EXAMPLE = "Example: tethership identify --formulation published --out fit"


def identify(
    scenario: ScenarioArgument = "docking_paper",
    formulation: FormulationOption = None,
    seed: Annotated[int, typer.Option(min=0, help="Of everything random; the same seed gives the same answer.")] = 1,
    generations: Annotated[
        int, typer.Option(min=1, max=1000, help="Of the differential evolution; fewer is quicker and coarser.")
    ] = 60,
    population: Annotated[int, typer.Option(min=8, max=1000, help="Vectors of a generation.")] = 96,
    power: Annotated[int, typer.Option(min=5, max=16, help="2^power Sobol points come first.")] = 11,
    left_out: Annotated[
        int, typer.Option("--left-out", min=0, max=1000, help="Generations of each fit without one table; 0 for none.")
    ] = 24,
    variants: Annotated[
        bool, typer.Option("--variants", help="Then fit every reading that the print leaves open (16 short searches).")
    ] = False,
    rounds: Annotated[
        int, typer.Option(min=2, max=10_000, help="Moves of each walker over the set that fits nearly as well.")
    ] = 100,
    changes: SetOption = None,
    out: OutOption = Path("out"),
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Fit what the paper does not publish (fins, hull drag, thrust) to its Tables 3-6 at 6 and 12 m/s.

    Global search, least squares, the set of all that fits nearly as well, and a fit without each table. The
    defaults look at 25 000 vectors, in 17 to 21 minutes on two cores, as the stored fits did. Writes
    identified_FORMULATION.json and the vehicle lotte_identified_FORMULATION.toml.
    """
    from tethership.studies.docking_paper.fit.fit_file import fit_document, fit_text
    from tethership.studies.docking_paper.fit.identify import Budget
    from tethership.studies.docking_paper.fit.identify import identify as fit

    loaded = chosen_scenario(scenario, None, formulation, changes)
    _check(loaded)
    if 2**power < population:
        raise ConfigError(f"2^{power} Sobol points are fewer than the population of {population}; raise --power")
    writable(out, csv)
    budget = Budget(power, population, generations, rounds, left_out)
    with progress_bar("identify") as report:
        found = fit(loaded, budget, seed, lambda what, share, least: report(f"{what}, misfit {least:.3f}", share))
    document = fit_document(found, loaded.name, seed, budget)
    if variants:
        from tethership.studies.docking_paper.fit.variants import refit_all

        with progress_bar("variants") as report:
            document["variants"] = refit_all(loaded, document, report)
    fit_file = out / f"identified_{loaded.formulation}.json"
    vehicle_file = out / f"lotte_identified_{loaded.formulation}.toml"
    written = write_together({fit_file: fit_text(document), vehicle_file: vehicle_of(document)})
    show(_told(document, [*map(str, written)]), json, csv)


def _check(scenario: Any) -> None:
    """Raise ConfigError where a scenario is not the paper's docking."""
    from tethership.scenario import LAYERS
    from tethership.studies.docking_paper.fit.space import THRUSTERS

    config = scenario.config
    names = [thruster.name for thruster in config.vehicle.thrusters]
    ship = names == list(THRUSTERS) and len(config.vehicle.fins) == 4 and len(config.cables) == 1
    if not ship or set(scenario.layers) != set(LAYERS) or len(config.gusts) != 1:
        raise ConfigError(
            f"{scenario.name} is not the paper's docking (thrusters {', '.join(THRUSTERS)}, four fins, one cable, one "
            "gust, all three layers); its tables can only be fitted with that: start from docking_paper"
        )
    _check_vehicle(scenario)


def _check_vehicle(scenario: Any) -> None:
    """Raise ConfigError where a number of the ship that is not fitted differs from Lotte's."""
    from tethership.scenario import list_parameters, load_scenario
    from tethership.studies.docking_paper.fit.space import UNKNOWNS

    own, lotte = (list_parameters(config) for config in (scenario.config, load_scenario("docking").config))
    fitted = {place for unknown in UNKNOWNS for name in unknown.parameters for place in lotte[name].places}
    for name, parameter in lotte.items():
        rest = name.startswith("vehicle.") and not set(parameter.places) & fitted
        if rest and (name not in own or own[name].value != parameter.value):
            raise ConfigError(f"identify fits Lotte: {name} must be {parameter.value:g}, as in lotte.toml, to be kept")


def vehicle_of(document: dict[str, Any]) -> str:
    """Return the vehicle file of a fit."""
    import numpy as np

    from tethership.scenario import packaged_text
    from tethership.studies.docking_paper.fit.vehicle_file import vehicle_text

    name = f"lotte_identified_{document['formulation']}"
    return vehicle_text(
        packaged_text("vehicles", "lotte"),
        np.array(list(document["parameters"].values())),
        name,
        f"Lotte, unpublished numbers identified from the paper's tables, formulation {document['formulation']}",
        f"identified, tethership identify, Tables 3-6 at 6 and 12 m/s, {document['formulation']}",
    )


def _fitted(document: dict[str, Any]) -> list[Row]:
    """Return the fitted numbers as rows of a table."""
    ends = {name: f"  [{low:.4g} … {high:.4g}]" for name, (low, _, high) in document["spread"].items()}
    return [
        Row(name, value, document["units"][name], ".4g", ends[name] + _flag(name, document))
        for name, value in document["parameters"].items()
    ]


def _quality(document: dict[str, Any]) -> list[Row]:
    """Return the misfits as rows of a table."""
    left_out = document["left_out_misfit"]
    return [
        Row("misfit, all", document["misfit"], "", ".3f"),
        Row("misfit, tables", document["tables_misfit"], "", ".3f"),
        *[Row(f"misfit of {name} left out", value, "", ".3f") for name, value in left_out.items()],
        Row("vectors looked at", document["vectors"]),
    ]


def _told(document: dict[str, Any], files: list[str]) -> Result:
    """Return parameters, spread and misfits."""
    best = f"formulation {document['formulation']}: best vector, and 5-95 % of all within 10 % of its misfit"
    quality = "quality (0 is agreement; 0.83 is one tolerance off in every number)"
    unmet = ", ".join(document["spectrum_unmet"])
    lines = [f"The best vector's free ship does not have: {unmet}"] if unmet else []
    tables = [Table(_fitted(document), best), Table(_quality(document), quality)]
    return Result(document, tables=tables, lines=lines, files=files)


def _flag(name: str, document: dict[str, Any]) -> str:
    """Return a remark on a number that ran into a bound."""
    return "  at a bound" if name in document["at_bound"] else ""
