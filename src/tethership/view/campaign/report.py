"""A campaign's report and tables: what its flights say, for people. Depends on: view, campaign (its data)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from tethership.campaign import CURE, Campaign, Plan, exceeded
from tethership.results import NAMES, write_atomically
from tethership.view.campaign import figures
from tethership.view.campaign.csv import write_exceedance, write_flights
from tethership.view.campaign.plot import plot_campaign
from tethership.view.campaign.setting import TRUST, compliance_section, flown_section, interval
from tethership.view.flight.captions import percent, percents, trust
from tethership.view.picture import png
from tethership.view.report.report import Figure, Section, Table, write_report


def write_campaign(
    folder: Path, plan: Plan, data: xr.Dataset, answers: dict[str, Any], footer: Mapping[str, Any]
) -> list[Path]:
    """Write report.html, its figures and the tables as CSV into a campaign's folder; returns what was written.

    Parameters
    ----------
    folder : Path
        Of the campaign.
    plan : Plan
        What was flown.
    data : xr.Dataset
        Its results.
    answers : dict
        From `campaign.answers.answer`, with `kept` flights.
    footer : mapping
        Versions and provenance.

    Raises
    ------
    ConfigError
        They cannot be written.
    """
    flags = exceeded(plan, data)
    sections = [
        flown_section(plan),
        compliance_section(answers),
        _exceedance(folder, plan, data, answers, flags),
        _pairs(answers),
        _tails(folder, data, answers),
        _importance(folder, answers),
        _checks(answers),
    ]
    written = [write_exceedance(folder, answers), write_flights(folder, plan, data, flags)]
    path = write_report(
        folder / "report.html",
        plan.config.title,
        _abstract(plan, answers),
        [s for s in sections if s is not None],
        footer,
    )
    return [path, *written]


def _abstract(plan: Plan, answers: dict[str, Any]) -> list[str]:
    """Return the summary."""
    verdicts = [row["verdict"] for row in answers["compliance"]]
    lines = [
        f"{(plan.config.description or plan.config.title).rstrip('.')}. {answers['cases']} cases of "
        f"`{plan.config.scenario}`, formulation "
        f"`{plan.scenario.formulation}`, sampling `{answers['sampling']}`, seed {plan.config.seed}, flown under "
        f"{len(plan.laws)} law{'s' * (len(plan.laws) > 1)}: {answers['runs']} flights, {answers['failed']} failed. "
        "A flight without a result (no equilibrium at the start, diverged) counts as exceeding every limit; a broken "
        "cable or a time-out is a result."
    ]
    if verdicts:
        words = ("met", "not met", "undecided", "no verdict")
        counted = ", ".join(f"**{verdicts.count(word)}** {word}" for word in words if word in verdicts)
        lines.append(f"Requirements: {counted}.")
    if answers["wind_warning"]:
        lines.append(f"**Wind:** {answers['wind_warning']}.")
    if answers["failed"]:
        lines.append(f"**{answers['failed']} of {answers['runs']} flights have no result**: {_why(answers)}.")
    return lines


EARLY = (
    "Ended early: flights that did not dock and had not exceeded the limit by then (a broken cable, a time-out); what "
    "they would have done later nobody saw, and the probability counts them as not exceeding."
)


def _why(answers: dict[str, Any]) -> str:
    """Return how flights without a result ended."""
    names = ("no_equilibrium", "diverged")
    counted = {name: sum(of["outcomes"].get(name, 0) for of in answers["laws"].values()) for name in names}
    return ", ".join(f"{name.replace('_', ' ')} {count}" for name, count in counted.items() if count)


def _exceedance(
    folder: Path, plan: Plan, data: xr.Dataset, answers: dict[str, Any], flags: dict[str, np.ndarray]
) -> Section:
    """Return the probability of exceeding each limit, with pictures."""
    cells = []
    for law, of in answers["laws"].items():
        cells += [
            [
                f"{limit.replace('_', ' ')} {row['value']:g} {row['unit']}",
                law,
                row["exceeding"],
                row["undetermined"],
                row["flights"],
                percent(row["probability"]),
                percents(row),
                percent(row.get("probability_with_snap")),
                row["method"],
            ]
            for limit, row in of["exceedance"].items()
        ]
    heads = [
        "limit",
        "law",
        "exceeding",
        "ended early",
        "of",
        "probability",
        "interval",
        "with the snap's wave, at most",
        "method",
    ]
    times = [
        [law, *(of["docking_time"].get(key) for key in ("count", "p5", "p50", "p95"))]
        for law, of in answers["laws"].items()
    ]
    shown = [
        Table("Probability of exceeding each limit.", heads, cells, EARLY),
        _trusted(answers),
        Table("Time to dock of those that do [s].", ["law", "docked", "5 %", "median", "95 %"], times),
    ]
    drawn = _limit_figures(folder, plan, data, answers, flags)
    return Section(
        "Limits",
        [
            "Tensions are those at the tether point. Ground contact is a least clearance of the hull below zero: with "
            "the anchor at ground level, as in the paper, almost every docking has it.",
            TRUST,
        ],
        shown,
        drawn,
    )


def _trusted(answers: dict[str, Any]) -> Table:
    """Return how far each law's tensions are to be trusted."""
    outside = {law: of["quasi_static_outside"] for law, of in answers["laws"].items()}
    cells = [[law, percent(of["median"]), percent(of["largest"]), of["impulse"]] for law, of in outside.items()]
    heads = ["law", "outside, flight in the middle", "outside, at most", "largest wave of a snap [N]"]
    return Table("Share of the flight with a cable outside the quasi-static range.", heads, cells)


def _limit_figures(
    folder: Path, plan: Plan, data: xr.Dataset, answers: dict[str, Any], flags: dict[str, np.ndarray]
) -> list[Figure]:
    """Return pictures of peaks, times and convergence."""
    campaign = Campaign(plan, data, answers, flown=0)
    texts = {
        "limits": "Probability of exceeding each limit.",
        "peaks": "Share of flights whose peak exceeds a tension.",
        "times": "Time to dock.",
    }
    if answers["sampling"] == "random" and any(0 < of[0].sum() < of[0].size for of in flags.values()):
        texts["convergence"] = f"How the probabilities of `{plan.laws[0].name}` settle with the number of flights."
    return [_figure(folder, kind, plot_campaign(campaign, kind=kind), text) for kind, text in texts.items()]


PAIRED = (
    "Every law flew the same cases, so differences are taken case by case, over the cases that both have (docking "
    "time: that docked under both). A cable that breaks cuts its peak off, which makes differences of the peak look "
    "smaller. p-values are of single tests of independent draws, not corrected for their number; other samplings have "
    "none."
)


def _pairs(answers: dict[str, Any]) -> Section | None:
    """Return laws compared case by case."""
    if not answers["pairs"]:
        return None
    shown = []
    for pair in answers["pairs"]:
        cells = [
            [
                NAMES[m["name"]],
                m["first"],
                m["second"],
                m["difference"],
                interval(m),
                percent(m["lower"]),
                m["cases"],
                m["p_value"],
            ]
            for m in pair["metrics"]
        ]
        heads = [
            "metric",
            pair["first"],
            pair["second"],
            "mean difference",
            "95 % interval",
            "share lower",
            "cases",
            "Wilcoxon p",
        ]
        shown.append(Table(f"{pair['second']} against {pair['first']}, case by case.", heads, cells))
        cells = [
            [e["name"].replace("_", " "), e["only_first"], e["only_second"], e["both"], e["p_value"]]
            for e in pair["limits"]
        ]
        heads = ["limit", f"only {pair['first']}", f"only {pair['second']}", "both", "McNemar p"]
        shown.append(Table(f"Cases that exceed a limit under {pair['first']} and {pair['second']}.", heads, cells))
    return Section("Laws compared", [PAIRED], shown)


def _tails(folder: Path, data: xr.Dataset, answers: dict[str, Any]) -> Section | None:
    """Return the tails of the peak tension."""
    shown, drawn = [], []
    for i, (law, of) in enumerate(answers["laws"].items()):
        tail = of["tail"]
        if tail is None:
            continue
        cells = [
            [percent(level["probability"]), level["level"], f"{level['low']:.4g} … {level['high']:.4g}"]
            for level in tail["levels"]
        ]
        note = (
            f"Generalised Pareto over {tail['threshold']:.0f} N, {tail['excesses']} excesses and "
            f"{tail['censored']} broken cables, whose peak is only known to be higher: "
            f"shape {tail['shape']:.3f}, scale {tail['scale']:.1f} N; Kolmogorov distance {tail['distance']:.3f}"
            + (f"; the tail ends at {tail['end']:.0f} N." if tail["end"] is not None else "; the tail has no end.")
            + (
                ""
                if tail["adequate"]
                else " The peaks are not of this form (Kolmogorov, 5 %): take the levels as rough."
            )
        )
        heads = ["probability per flight", "tension [N]", "interval [N]"]
        shown.append(Table(f"Tension exceeded with a probability, {law}.", heads, cells, note))
        picture = figures.plot_tail(data["tension_max"].values[i], tail)
        drawn.append(_figure(folder, f"tail_{law}", picture, f"Tail of the peak tension, {law}."))
    if not shown:
        words = "No tail is fitted: it takes independent draws and some 300 flights of a law whose cable holds."
        return Section("Extremes", [words])
    words = [
        "Levels beyond the flights are extrapolated; their interval is of the fit alone, not of the model: "
        + "; ".join(f"{law}: {trust(of['quasi_static_outside'])}" for law, of in answers["laws"].items())
        + "."
    ]
    return Section("Extremes", words, shown, drawn)


def _importance(folder: Path, answers: dict[str, Any]) -> Section:
    """Return what the peak tension hangs on."""
    shown, drawn = [], []
    for law, of in answers["laws"].items():
        entries = of["importance"]
        if not entries:
            continue
        cells = [[f"`{e['name']}`", e["rank_correlation"], e["p_value"], e["first"], e["total"]] for e in entries]
        heads = ["quantity", "rank correlation", "p", "Sobol first order", "Sobol total"]
        shown.append(Table(f"What the peak tension hangs on, {law}.", heads, cells))
        text = f"What the peak tension hangs on, {law}."
        drawn.append(_figure(folder, f"importance_{law}", figures.plot_importance(entries), text))
    words = ['Rank correlation sees what rises or falls throughout; Sobol\'s indices need `sampling = "saltelli"`.']
    return Section("Sensitivity", words, shown, drawn)


def _checks(answers: dict[str, Any]) -> Section:
    """Return what the fixed steps cost, and the flights that were kept."""
    error = answers["step_error"]
    cells = [
        [NAMES[name], 100.0 * entry["median"], 100.0 * entry["largest"]]
        for name, entry in error.items()
        if isinstance(entry, dict)
    ]
    kept = [[k["law"], k["case"], k["why"], k["file"] or k.get("error")] for k in answers.get("kept", [])]
    shown = [Table("Fixed steps against tight adaptive flights.", ["metric", "median [%]", "largest [%]"], cells)]
    if kept:
        shown.append(Table("Flights kept with their histories.", ["law", "case", "why", "file"], kept))
    outcomes = [[law, name, count] for law, of in answers["laws"].items() for name, count in of["outcomes"].items()]
    shown.append(Table("How the flights ended.", ["law", "outcome", "flights"], outcomes))
    words = [
        f"{error['flights']} flights, drawn at random, were flown again "
        "with steps of an eighth (without a C++ compiler: adaptively). What the steps "
        "change is in no interval above; a flight close to a limit may change sides."
    ]
    return Section("Checks", words, shown)


def _figure(folder: Path, name: str, drawn: Axes | Drawing, caption: str) -> Figure:
    """Write a picture and return it as a figure of the report."""
    drawing = drawn if isinstance(drawn, Drawing) else drawn.get_figure(root=True)
    assert drawing is not None, "axes of a new figure have one"
    picture = png(drawing, 140)
    write_atomically(folder / "figures" / f"{name}.png", picture, CURE)
    return Figure(caption, picture, None, caption)
