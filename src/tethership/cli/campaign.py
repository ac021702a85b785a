"""`tethership campaign`: many flights, resumable, and what they say."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from tethership.cli.common import (
    FormulationOption,
    JsonOption,
    LineOption,
    SetOption,
    TrustOption,
    WindOption,
    flag_changes,
    line_change,
    provenance,
    writable,
)
from tethership.cli.completion import complete_campaign
from tethership.cli.progress import Pace, Report, progress_bar
from tethership.cli.result import Result, show
from tethership.cli.tables import CsvOption, Row, Table
from tethership.errors import ConfigError, SolveError

EXAMPLE = "Example: tethership campaign gusts --samples 1000 --workers 2"


def campaign(
    name: Annotated[
        str,
        typer.Argument(
            help="Packaged campaign (see `tethership list`) or a path that ends in .toml.",
            autocompletion=complete_campaign,
        ),
    ],
    samples: Annotated[int | None, typer.Option(min=1, help="Cases, in place of the file's number.")] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Of the cases, in place of the file's.")] = None,
    sampling: Annotated[
        str | None, typer.Option(help="random, sobol, latin_hypercube, grid or saltelli, in place of the file's.")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, max=1024, help="Processes of this machine; without it this one flies.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Scheduler of a Dask cluster, e.g. tcp://127.0.0.1:8786.")
    ] = None,
    confidence: Annotated[float, typer.Option(min=0.5, max=0.9999, help="Of the intervals.")] = 0.95,
    wind: WindOption = None,
    formulation: FormulationOption = None,
    line: LineOption = None,
    trust: TrustOption = False,
    changes: SetOption = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder of the campaign; the same again goes on with it. Default: campaigns/NAME."),
    ] = None,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Fly a manoeuvre many times over what may vary, and say how often each limit is exceeded.

    Results are kept batch by batch: interrupted at any moment, the same command goes on. Writes results.zarr,
    report.html, tables as CSV and the worst flights with their histories into --out.
    """
    from tethership.campaign import run_campaign

    own = {
        key: value for key, value in (("samples", samples), ("seed", seed), ("sampling", sampling)) if value is not None
    }
    folder = _own_folder(name) if out is None else out
    writable(None, csv)
    begun = time.perf_counter()
    with progress_bar(f"campaign {Path(name).stem}", resumed=True) as report:
        varied = flag_changes(wind, formulation, changes) | line_change(line)
        try:
            found = run_campaign(name, folder, own, varied, workers, scheduler, confidence, _counted(report), trust)
        except KeyboardInterrupt:
            raise SolveError(f"interrupted; what is flown is in {folder}: run the same command to go on") from None
    document, files = _concluded(found, folder)
    show(_told(document | {"seconds": round(time.perf_counter() - begun, 1)}, files), json, csv)


def _own_folder(name: str) -> Path:
    """Return the folder of a campaign that was given none, by the name of its file."""
    from tethership.scenario import check_title

    try:
        return Path("campaigns") / check_title(Path(name).stem)
    except ValueError as error:
        raise ConfigError(f"{error}; rename the file or choose a folder with --out") from error


def _counted(report: Report) -> Callable[[int, int], None]:
    """Return a progress that says flights, and their rate in the last minute of this run."""
    pace = Pace()

    def progress(done: int, total: int) -> None:
        rate = pace.rate(done)
        words = "" if rate is None else f", {rate:.3g}/s"
        report(f"{done} of {total} flights{words}", done / total)

    return progress


def _concluded(found: Any, folder: Path) -> tuple[dict[str, Any], list[str]]:
    """Return what the flights say, and the files it was written to."""
    from tethership.view.campaign import write_campaign

    plan, answers = found.plan, found.answers
    footer = provenance(campaign=plan.name, digest=plan.digest()[:16])
    written = write_campaign(folder, plan, found.data, answers, footer)
    first = next(iter(answers["laws"].values()))
    document = {
        "campaign": plan.name,
        "formulation": plan.scenario.formulation,
        "line": plan.scenario.config.line_models(),
        "flown": found.flown,
        **answers,
        "exceedance": first["exceedance"],
        "outcomes": first["outcomes"],
    }
    return document, [*map(str, written), str(folder / "results.zarr")]


def _numbers(result: dict[str, Any]) -> list[Row]:
    """Return probabilities [-], shares outside the trusted range [-] and verdicts as numbers for a file."""
    rows = []
    for name, law in result["laws"].items():
        for limit, row in law["exceedance"].items():
            rows.append(Row(f"{limit.replace('_', ' ')}, {name}", row["probability"]))
            if "probability_with_snap" in row:
                words = f"{limit.replace('_', ' ')} with the snap's wave at most, {name}"
                rows.append(Row(words, row["probability_with_snap"]))
        outside = law["quasi_static_outside"]
        rows += [Row(f"cable outside its trusted range, {end}, {name}", outside[end]) for end in ("median", "largest")]
    return rows + [Row(row["requirement"], row["verdict"], row["law"]) for row in result["compliance"]]


def _shown(result: dict[str, Any]) -> list[tuple[str, list[Row]]]:
    """Return titles and rows of what is told: probabilities law by law, and verdicts."""
    from tethership.view.campaign import trusted
    from tethership.view.flight import percent, percents, trust

    found = []
    for name, law in result["laws"].items():
        rows = []
        for limit, row in law["exceedance"].items():
            bound = percent(row.get("probability_with_snap"))
            note = f"; at most {bound} with the snap's wave" if "probability_with_snap" in row else ""
            words = f"{limit.replace('_', ' ')}, {name}"
            rows.append(Row(words, percent(row["probability"]), "", "", f"{percents(row)}{note}"))
        title = f"{name}: probability of exceeding each limit, {100 * result['confidence']:g} % interval"
        found.append((f"{title}; of tensions: {trust(law['quasi_static_outside'])}", rows))
    rows = [
        Row(row["requirement"], row["verdict"], row["law"], "", f"  {percents(row)}; {trusted(row)}".rstrip("; "))
        for row in result["compliance"]
    ]
    return [*found, ("requirements", rows)] if rows else found


def _told(document: dict[str, Any], files: list[str]) -> Result:
    """Return probabilities, times and verdicts, and no answer where no flight has a result."""
    most = max(document["outcomes"], key=lambda name: document["outcomes"][name])
    flown = f"{document['runs']} flights, {document['failed']} failed, {document['seconds']:.0f} s"
    return Result(
        document,
        f"{document['campaign']}: {flown}",
        [Table(rows, title) for title, rows in _shown(document)],
        Table(_numbers(document)),
        files=files,
        answered=document["failed"] < document["runs"],
        reason=f"no flight has a result ({most}): nothing can be said of the odds",
    )
