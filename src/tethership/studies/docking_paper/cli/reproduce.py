"""`tethership reproduce`: the whole study of the paper, published beside computed, as one report."""

import time
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tethership.cli.common import JsonOption, json_text, provenance, writable
from tethership.cli.progress import progress_bar
from tethership.cli.result import Result, show
from tethership.cli.tables import CsvOption, Table
from tethership.errors import ConfigError, suggestion
from tethership.results import write_atomically

if TYPE_CHECKING:
    from tethership.studies.docking_paper.jobs import Job, Settings

EXAMPLE = "Example: tethership reproduce --only table3,figure12 --out reproduction"

ITEMS: dict[str, tuple[str, ...]] = {
    **{f"table{number}": ("tables",) for number in range(3, 7)},
    **{f"figure{number}": ("linear_pictures",) for number in range(6, 12)},
    **{f"figure{number}": ("docking_pictures",) for number in range(12, 16)},
    **{f"L{number}": ("linear",) for number in range(1, 10)},
    **{f"D{number}": ("tables",) for number in range(1, 12)},
    "claims": ("linear", "tables"),
    "identification": ("fit_pictures",),
    "variants": ("variants",),
    "cable": ("cable", "line_pictures"),
    "terms": ("terms", "docking_pictures"),
    "uncertainty": ("uncertainty",),
    "retuned": ("retuned",),
}
"""What --only may name, and the jobs that make it."""

UNSEEN = ("flights", "line_pictures")
"""Jobs that are no part of the report by themselves: what others read, pictures of what is there without them."""


def reproduce(
    only: Annotated[
        str | None,
        typer.Option(
            help="Parts, by commas: table3 … table6, figure6 … figure15, L1 … L9, D1 … D11, claims, identification, "
            "variants, cable, terms, uncertainty, retuned."
        ),
    ] = None,
    formulation: Annotated[
        str | None, typer.Option(help="published or consistent. Default: that of docking_paper, which fits better.")
    ] = None,
    flights: Annotated[int, typer.Option(min=8, max=100_000, help="Perturbed flights of each row.")] = 200,
    seed: Annotated[int, typer.Option(min=0, help="Of perturbations.")] = 1,
    fresh: Annotated[bool, typer.Option("--fresh", help="Compute everything again.")] = False,
    out: Annotated[Path, typer.Option(help="Folder for the report and all that is in it.")] = Path("reproduction"),
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Compute Tables 3-6, Figures 6-15 and every claim of the paper, from the stored fits, and write a report.

    Writes report.html (one page, opens without a network), tables.json and all figures (PNG and interactive) into
    --out. A second run takes what is unchanged from there. With --only the report also keeps the parts that stand in
    --out already, and says what it lacks.
    """
    from tethership.results import held
    from tethership.studies.docking_paper.jobs import Settings, load_part, run_jobs
    from tethership.studies.docking_paper.view.report import write_study

    jobs = _chosen(only)
    settings = Settings(_formulation(formulation), flights=flights, seed=seed)
    writable(out, csv)
    begun = time.perf_counter()
    with held(out), progress_bar("reproduce") as report:
        anew = run_jobs(jobs, out, settings, report, fresh)
        report("report", 1.0)
        parts, left_out = _in_the_report(out, settings, jobs)
        path = write_study(out, settings, parts, left_out, provenance(formulation=settings.formulation))
    result: dict[str, Any] = {"formulation": settings.formulation, "partial": bool(left_out), "left_out": left_out}
    result |= {"tables": {}, "claims": {}}
    for name in ("tables", "linear"):
        if name in parts:
            part = load_part(out, name)
            result["tables"] |= part.get("tables", {})
            result["claims"] |= part["claims"]
    for name in ("variants", "uncertainty", "cable", "terms", "retuned"):
        if name in parts:
            result[name] = load_part(out, name)
    result["counts"] = _counts(result)
    write_atomically(out / "tables.json", json_text(result))
    result["computed_anew"] = [name for name, again in anew.items() if again]
    result["seconds"] = round(time.perf_counter() - begun, 1)
    show(_told(result, [str(path), str(out / "tables.json")]), json, csv)


def _formulation(given: str | None) -> str:
    """Return the formulation, the packaged scenario's own if none is given."""
    from tethership.scenario import load_scenario
    from tethership.studies.docking_paper.fit.fit_file import FORMULATIONS

    if given is None:
        return load_scenario("docking_paper").formulation
    if given not in FORMULATIONS:
        raise ConfigError(
            f"--formulation {given!r}{suggestion(given, FORMULATIONS)} Allowed: {', '.join(FORMULATIONS)}"
        )
    return given


def _jobs() -> dict[str, "Job"]:
    """Return all parts of the study, in the order in which two processes do them fastest."""
    from tethership.studies.docking_paper import study
    from tethership.studies.docking_paper.jobs import Job
    from tethership.studies.docking_paper.view import pictures

    return {
        "flights": Job(study.fly_part, (), "flights"),
        "linear": Job(study.linear_part, (), "claims L1-L9"),
        "cable": Job(study.cable_part, ("flights",), "dynamic cable"),
        "terms": Job(study.term_part, ("flights",), "terms"),
        "variants": Job(study.variant_part, (), "variants"),
        "uncertainty": Job(study.uncertainty_part, (), "uncertainty"),
        "linear_pictures": Job(pictures.linear_pictures, (), "figures 6-11", after=("linear",)),
        "retuned": Job(study.retuned_part, (), "retuned gains", after=("uncertainty",)),
        "docking_pictures": Job(pictures.docking_pictures, ("flights",), "figures 12-15"),
        "tables": Job(study.table_part, ("flights",), "tables and claims D1-D11"),
        "line_pictures": Job(pictures.line_pictures, ("cable",), "dynamic cable, pictures"),
        "fit_pictures": Job(pictures.fit_pictures, (), "identification"),
    }


def _chosen(only: str | None) -> dict[str, "Job"]:
    """Return the jobs that make what was asked for, and what they need."""
    jobs = _jobs()
    if only is None:
        return jobs
    wanted: list[str] = []
    for item in filter(None, (text.strip() for text in only.split(","))):
        if item not in ITEMS:
            raise ConfigError(f"--only has no part {item!r}{suggestion(item, ITEMS)} Allowed: {', '.join(ITEMS)}")
        wanted += ITEMS[item]
    if not wanted:
        raise ConfigError(f"--only names no part. Allowed: {', '.join(ITEMS)}")
    while missing := {need for name in wanted for need in jobs[name].needs} - set(wanted):
        wanted += sorted(missing)
    return {name: job for name, job in jobs.items() if name in wanted}


def _in_the_report(out: Path, settings: "Settings", done: Collection[str]) -> tuple[list[str], list[str]]:
    """Return the parts that the report has, those just done and those that stand already, and titles of the others."""
    from tethership.studies.docking_paper.jobs import belongs

    jobs = _jobs()
    parts = [name for name in jobs if name in done or belongs(out, name, settings)]
    return parts, [job.title for name, job in jobs.items() if name not in parts and name not in UNSEEN]


def _counts(result: dict[str, Any]) -> dict[str, Any]:
    """Return how many claims hold and numbers agree."""
    from tethership.studies.docking_paper.tables import counts

    rows = [row for table in result["tables"].values() for row in table]
    holds = sum(claim["holds"] for claim in result["claims"].values())
    return {"holds": holds, "does_not_hold": len(result["claims"]) - holds, **counts(rows)}


def _told(result: dict[str, Any], files: list[str]) -> Result:
    """Return verdicts in short for people, the paper's numbers beside ours for CSV."""
    keys = ("wind", "metric", "published", "computed", "ratio", "verdict", "held_out")
    rows = [[name, *(row[key] for key in keys)] for name, table in result["tables"].items() for row in table]
    data = Table(rows, columns=("table", *keys))
    return Result(result, f"formulation {result['formulation']}", data=data, lines=list(_lines(result)), files=files)


def _lines(result: dict[str, Any]) -> Iterator[str]:
    """Yield what the report lacks, how many numbers agree, and which claims hold."""
    number = result["counts"]
    if result["left_out"]:
        yield f"  partial: without {', '.join(result['left_out'])}; leave out --only for the whole study"
    if result["tables"]:
        for words, of in (("fitted", number), ("held out", number["held_out"])):
            yield f"  tables, {words:<8}  {of['agrees']} agree, {of['near']} near, {of['differs']} differ"
    for name, claim in result["claims"].items():
        met = sum(claim["parts"].values())
        verdict = "holds" if claim["holds"] else f"does not hold ({met} of {len(claim['parts'])} parts do)"
        yield f"  {name:<4} {verdict}"
