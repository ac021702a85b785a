"""Tables of the study's report, from the parts that were computed. Depends on: view.report.content.

Every number comes from the data it is given; nothing is computed here.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from tethership.results import NAMES
from tethership.view.report import Table

LAYERS = {"rewind": "rewind", "heading": "+ heading", "navigation": "+ navigation"}
"""Layers in words."""

TITLES = {
    "table3": "Table 3 of the paper: rewind control",
    "table4": "Table 4 of the paper: rewind and heading control",
    "table5": "Table 5 of the paper: rewind, heading and navigation control",
    "table6": "Table 6 of the paper: control usage and pitch",
}
"""Captions."""

Rows = Sequence[Mapping[str, Any]]


def comparison(name: str, rows: Rows, intervals: Mapping[tuple[str, float, str], Mapping[str, Any]]) -> Table:
    """Return one of Tables 3–6: published beside computed, with the interval of the identified set.

    Numbers are in the unit that stands beside the quantity's name; wind [m/s], ratio [-].
    """
    cells = []
    for row in rows:
        interval = intervals.get((row["layers"], row["wind"], row["metric"]))
        shown = None if interval is None or interval["low"] is None else _range(interval)
        verdict = "broken" if row["outcome"] == "cable_broken" else row["verdict"]
        words = NAMES[row["metric"]] + (f", {LAYERS[row['layers']]}" if name == "table6" else "")
        cells.append([words, row["wind"], row["published"], row["computed"], row["ratio"], shown, verdict])
    ended = sorted({f"{row['wind']:g} m/s {row['outcome']}" for row in rows if row["outcome"] != "docked"})
    note = "The interval is 5–95 % over ships that fit the tables at 6 and 12 m/s nearly as well. " + (
        "No number at 9 m/s was fitted: the computed one is a prediction, and the published one judges it."
    )
    if ended:
        note += f" Flights that did not dock: {', '.join(ended)}."
    heads = ["quantity", "wind [m/s]", "published", "computed", "ratio", "interval of the set", "verdict"]
    return Table(TITLES[name], heads, cells, note, verdict_column=6, label=name)


def _range(row: Mapping[str, Any]) -> str:
    return f"{row['low']:.4g} … {row['high']:.4g}"


def claims_table(claims: Mapping[str, Mapping[str, Any]], caption: str, label: str) -> Table:
    """Return claims with their parts."""
    cells: list[list[Any]] = []
    for name, claim in claims.items():
        verdict = "holds" if claim["holds"] else "does not hold"
        met = sum(claim["parts"].values())
        cells.append([f"**{name}**", claim["statement"], f"{met} of {len(claim['parts'])} parts", verdict])
        cells += [["", part, "", "holds" if good else "does not hold"] for part, good in claim["parts"].items()]
    return Table(caption, ["claim", "what the paper says", "", "verdict"], cells, verdict_column=3, label=label)


def parameter_table(fit: Mapping[str, Any]) -> Table:
    """Return the identified numbers with their spread and bounds, in the units of the fit [m², m, -, N]."""
    cells = []
    for name, value in fit["parameters"].items():
        low, middle, high = fit["spread"][name]
        bounds = fit["bounds"][name]
        flag = "at a bound" if name in fit["at_bound"] else ""
        words = f"{name.replace('_', ' ')} [{fit['units'][name]}]"
        cells.append([words, value, f"{low:.3g} … {high:.3g}", middle, f"{bounds[0]:g} … {bounds[1]:g}", flag])
    heads = ["quantity", "best vector", "5–95 % of the set", "median of the set", "bounds searched", ""]
    note = "Sources of the bounds: " + "; ".join(
        f"{name.replace('_', ' ')}: {source}" for name, source in fit["bound_sources"].items()
    )
    return Table("Identified numbers.", heads, cells, note, label="parameters")


def left_out_table(fit: Mapping[str, Any]) -> Table | None:
    """Return what fits without one table say of it: misfits [-]."""
    if not fit["left_out"]:
        return None
    cells = [
        [LAYERS[table], entry["fitted_misfit"], entry["left_out_misfit"]] for table, entry in fit["left_out"].items()
    ]
    heads = ["left out", "misfit of what was fitted", "misfit of what was left out"]
    return Table("Fits without one table, and what they say of it.", heads, cells, label="left_out")


SAME = 0.05
"""Change of the misfit that a short search may make by itself."""


def variant_table(part: Mapping[str, Any]) -> Table:
    """Return the misfit [-] with and without each reading; the first row is no variant."""
    base = _best(part["variants"][0])
    cells: list[list[Any]] = []
    for row in part["variants"]:
        change = _best(row) / base - 1.0
        words = "better" if change < -SAME else "no difference" if change < SAME else "worse"
        cells.append([row["name"], row["question"], row["misfit"], row["refitted"], words if row["question"] else ""])
    heads = ["reading", "what the print leaves open", "misfit, same ship", "misfit, fitted anew", "than identified"]
    note = (
        "Misfit to the tables: 0 is agreement, 0.83 is one tolerance off in every number (20 %, times over a threshold "
        "65 %). Fitted anew is a short search from the identified set, for tables and spectrum together, stored, and "
        "flown again in this run; the first row shows what it does by itself."
    )
    return Table("Readings that the print leaves open.", heads, cells, note, label="variants")


def _best(row: Mapping[str, Any]) -> float:
    return row["misfit"] if row["refitted"] is None else min(row["refitted"], row["misfit"])


def uncertainty_table(rows: Rows, wind: float) -> Table:
    """Return the interval of every cell at one wind [m/s], each in the unit beside its name; cables broken [%]."""
    cells = []
    for row in rows:
        if row["wind"] != wind:
            continue
        verdict = "" if row["inside"] is None else "inside" if row["inside"] else "outside"
        shown = None if row["low"] is None else _range(row)
        words = f"{NAMES[row['metric']]}, {LAYERS[row['layers']]}"
        cells.append([words, row["published"], shown, row["median"], row["broken"] * 100.0, verdict])
    heads = ["quantity", "published", "5–95 %", "median", "cables broken [%]", "published value"]
    return Table(f"Perturbed flights, {wind:g} m/s.", heads, cells, verdict_column=5, label=f"uncertainty{wind:g}")


def terms_table(rows: Rows, layers: str) -> Table:
    """Return what the peak tension [N] becomes without each term; times [s], θ_rms [deg]."""
    cells = [
        [
            row["term"].replace("_", " "),
            row["peak_tension"],
            row["ratio"],
            row["trim_tension"],
            row["docking_time"],
            row["theta_rms"],
            row["outcome"].replace("_", " "),
        ]
        for row in rows
    ]
    heads = ["without", "peak [N]", "ratio", "tension at trim [N]", "docking time [s]", "θ_RMS [deg]", "outcome"]
    note = (
        "Each flight is trimmed anew. The last rows are the whole model from an attitude moved by 1 %: a smaller "
        "change of the peak says nothing of a term. In `published` hull potential terms without counterpart are absent."
    )
    return Table(f"Terms switched off, {LAYERS[layers]}, 12 m/s.", heads, cells, note, label=f"terms_{layers}")


def breakdown_table(found: Mapping[str, Any]) -> Table:
    """Return how large each load is, by layer: forces [N], moments about P [N m]."""
    names = [name for name in next(iter(found.values()))["force"] if name not in ("gravity", "buoyancy")]
    cells: list[list[Any]] = []
    for name in names:
        row: list[Any] = [name.replace("_", " ")]
        for table in found:
            force, moment = found[table]["force"][name], found[table]["moment"][name]
            row += [force["rms"], force["peak"], moment["rms"]]
        cells.append(row)
    heads = ["load"]
    for table in found:
        heads += [f"{LAYERS[table]}: rms [N]", "peak [N]", "moment, rms [N m]"]
    return Table("Loads over the flight, 12 m/s.", heads, cells, "About P, the centre of buoyancy.", label="loads")


def retuned_table(rows: Rows) -> Table:
    """Return retuned gains beside the paper's: tensions [N], times [s], ADC [1/s], E [-], θ_rms [deg], shares [%]."""
    cells = [
        [
            row["name"],
            row["nominal"]["tension_max"],
            row["nominal"]["tension_mean"],
            row["nominal"]["docking_time"],
            row["nominal"]["ADC"],
            row["nominal"]["E"],
            row["nominal"]["theta_rms"],
            row["perturbed"]["peak_mean"],
            row["perturbed"]["peak_high"],
            100.0 * row["perturbed"]["saturated"],
            row["perturbed"]["saturated_seconds"],
            100.0 * row["perturbed"]["torn"],
            100.0 * row["perturbed"]["late"],
        ]
        for row in rows
    ]
    heads = [
        "gains",
        "peak [N]",
        "mean [N]",
        "docking [s]",
        "ADC [1/s]",
        "E [-]",
        "θ_RMS [deg]",
        "peak, mean of perturbed [N]",
        "95th percentile [N]",
        "saturated [%]",
        "saturated, mean [s]",
        "above 481 N [%]",
        "too late [%]",
    ]
    return Table("Gains retuned for 12 m/s beside the paper's, all layers.", heads, cells, label="retuned")


def misprint_table(rows: Sequence[Any]) -> Table:
    """Return the misprints of the paper."""
    cells = [[row.where, row.printed, row.meant, row.evidence] for row in rows]
    heads = ["where", "printed", "meant", "settled by"]
    return Table("Misprints of the paper.", heads, cells, label="misprints")


def line_table(cases: Mapping[str, Mapping[str, Any]]) -> Table:
    """Return the quasi-static cable beside the dynamic line: tensions [N], delay [ms], time outside the range [%]."""
    cells = [
        [
            case["title"],
            case["peak_quasi_static"],
            case["peak_dynamic"],
            case["peak_ratio"],
            case["rms_difference"],
            f"{case['snaps_matched']} of {case['snaps_quasi_static']}, {case['snaps_dynamic']} in the line",
            case["snap_delay"],
            100.0 * case["outside"],
        ]
        for case in cases.values()
    ]
    heads = [
        "flight",
        "peak, quasi-static [N]",
        "peak, dynamic [N]",
        "ratio",
        "rms difference [N]",
        "snaps matched",
        "delay [ms]",
        "outside the trusted range [% of time]",
    ]
    return Table("The quasi-static cable beside a dynamic line (MoorDyn).", heads, cells, label="line")
