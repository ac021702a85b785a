"""`tethership tune`: gains of the four layers, over many perturbed flights and under constraints."""

from pathlib import Path
from typing import Annotated, Any

import typer

from tethership.cli.common import (
    FormulationOption,
    JsonOption,
    OutOption,
    ScenarioArgument,
    SetOption,
    TrustOption,
    chosen_scenario,
    writable,
)
from tethership.cli.progress import progress_bar
from tethership.cli.result import Result, show
from tethership.cli.tables import CsvOption, Row, Table
from tethership.errors import ConfigError
from tethership.results import write_together

EXAMPLE = "Example: tethership tune docking_paper --wind 12 --out tuned"


def tune(
    scenario: ScenarioArgument = "docking_paper",
    wind: Annotated[float, typer.Option("--wind", metavar="M_PER_S", help="Wind to tune for [m/s].")] = 12.0,
    formulation: FormulationOption = None,
    flights: Annotated[int, typer.Option(min=8, max=10_000, help="Perturbed flights that judge the result.")] = 200,
    searched: Annotated[
        int | None, typer.Option(min=4, help="How many of them the search looks at. Default: 24, or all if fewer.")
    ] = None,
    population: Annotated[int, typer.Option(min=8, max=1000, help="Sets of gains of a generation.")] = 32,
    generations: Annotated[int, typer.Option(min=1, max=1000, help="Of the differential evolution.")] = 40,
    seed: Annotated[int, typer.Option(min=0, help="Of everything random.")] = 1,
    trust: TrustOption = False,
    changes: SetOption = None,
    out: OutOption = Path("out"),
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Tune the gains of SAS, rewind, heading and navigation for one wind.

    Constraints, over flights with the start's attitude +-2 deg, the gust +-1 s and the wind +-3 %: no throttle
    saturates, the tension stays below the envelope's tear force, docking within 1.1 times the shortest time. Writes
    tuning.json and, for packaged scenarios, NAME_retuned.toml.
    """
    from tethership.tuning import tune as search
    from tethership.tuning import tuning_document

    searched = min(24, flights) if searched is None else searched
    if searched > flights:
        raise ConfigError(f"--searched {searched} is more than the {flights} flights there are; lower it")
    loaded = chosen_scenario(scenario, wind, formulation, changes, trust=trust)
    writable(out, csv)
    with progress_bar("tune") as report:
        found = search(
            loaded,
            flights,
            searched,
            population,
            generations,
            seed,
            lambda what, share, least: report(f"{what}, cost {least:.3f}", share),
        )
    document = tuning_document(found, loaded, seed, flights)
    gains = f"gains for {document['wind']:g} m/s, formulation {document['formulation']}"
    effects = f"over {document['flights']} perturbed flights"
    result = Result(
        document,
        tables=[Table(_gains(document), gains), Table(_effects(document), effects)],
        files=_written(document, scenario, changes, out),
        answered=found.after.undocked < 1.0,
    )
    show(result, json, csv)


def _written(document: dict[str, Any], name: str, changes: list[str] | None, out: Path) -> list[str]:
    """Write the tuning and its scenario; returns the files."""
    import json as json_module

    from tethership.scenario import packaged_text
    from tethership.tuning import retuned_text

    files = {out / "tuning.json": json_module.dumps(document, indent=1)}
    if not name.endswith(".toml") and not changes:
        text = retuned_text(
            packaged_text("scenarios", name),
            document["parameters"],
            document["wind"],
            {
                "title": f"Docking, gains retuned for {document['wind']:g} m/s",
                "description": f"{name} with gains tuned over perturbed flights in {document['wind']:g} m/s of wind",
                "formulation": document["formulation"],
            },
            f"tuned, tethership tune, {document['wind']:g} m/s",
        )
        files[out / f"{name.removesuffix('_paper')}_retuned.toml"] = text
    return [str(path) for path in write_together(files)]


EFFECTS = {
    "saturated": ("flights with a saturated throttle", 100.0, "%"),
    "saturated_seconds": ("mean time saturated", 1.0, "s"),
    "torn": ("flights above the tear force", 100.0, "%"),
    "late": ("flights that dock too late", 100.0, "%"),
    "undocked": ("flights that do not dock", 100.0, "%"),
    "peak_mean": ("mean peak tension", 1.0, "N"),
    "peak_high": ("95th percentile of the peak", 1.0, "N"),
    "duty": ("mean ADC", 1.0, "1/s"),
    "effort": ("mean E", 1.0, ""),
    "pitch": ("mean pitch, root mean square", 1.0, "deg"),
    "time": ("mean flight time", 1.0, "s"),
}
"""What is told of a set of gains: its words, factor and unit."""


def _gains(document: dict[str, Any]) -> list[Row]:
    """Return the gains as rows of a table."""
    former = document["former"]
    return [Row(name, value, "", ".4g", f"was {former[name]:.4g}") for name, value in document["parameters"].items()]


def _effects(document: dict[str, Any]) -> list[Row]:
    """Return what the gains do as rows of a table."""
    after, before = document["after"], document["before"]
    return [
        Row(text, factor * after[key], unit, ".4g", f"  (before {factor * before[key]:.4g})")
        for key, (text, factor, unit) in EFFECTS.items()
    ]
