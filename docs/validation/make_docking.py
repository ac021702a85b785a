"""Write docs/validation/docking.md and its figures from a run of `tethership reproduce`.

Run: make validation. Takes tables.json and figures of the study's folder; every number on the page is of that run.
"""

import json
import shutil
import sys
from pathlib import Path
from typing import Any

from tethership.studies.docking_paper.fit.fit_file import stored_fit
from tethership.studies.docking_paper.misprints import MISPRINTS

HERE = Path(__file__).parent
SHOWN = ("figure_12", "figure_13", "figure_14", "figure_15", "fit_marginals", "fit_residuals")


def number(value: Any) -> str:
    """Return a number of a table, a dash for none."""
    return "–" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)


def table(heads: list[str], rows: list[list[Any]]) -> str:
    """Return a Markdown table."""
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join([*lines, *("| " + " | ".join(map(number, row)) + " |" for row in rows)])


def tables(study: dict[str, Any]) -> str:
    """Return Tables 3–6."""
    intervals = {(r["layers"], r["wind"], r["metric"]): r for r in study["uncertainty"]["set_alone"]}
    parts = []
    for name, rows in study["tables"].items():
        cells = []
        for row in rows:
            of = intervals[row["layers"], row["wind"], row["metric"]]
            span = f"{number(of['low'])} … {number(of['high'])}"
            what = row["metric"] if name != "table6" else f"{row['metric']}, {row['layers']}"
            said = row["verdict"] + (", held out" if row["held_out"] else "")
            cells.append([what, row["wind"], row["published"], row["computed"], row["ratio"], span, said])
        heads = ["quantity", "wind [m/s]", "published", "computed", "ratio", "5–95 % of the set", "verdict"]
        parts.append(f"### Table {name[5:]}\n\n{table(heads, cells)}")
    return "\n\n".join(parts)


def claims(study: dict[str, Any]) -> str:
    """Return all claims with their parts."""
    rows = []
    for name, claim in study["claims"].items():
        rows.append([f"**{name}** {claim['statement']}", "**holds**" if claim["holds"] else "no"])
        rows += [[part, "✓" if good else "·"] for part, good in claim["parts"].items()]
    return table(["claim", ""], rows)


def variants(study: dict[str, Any]) -> str:
    """Return the misfit of every reading."""
    rows = [[r["name"], r["question"], r["misfit"], r["refitted"]] for r in study["variants"]["variants"]]
    return table(["reading", "what the print leaves open", "misfit, same ship", "fitted anew"], rows)


def fit_words(fit: dict[str, Any]) -> str:
    """Return what the fit found, in words."""
    left = ", ".join(f"{value:.2f} ({name})" for name, value in fit["left_out_misfit"].items())
    weighed = f"lacks {', '.join(fit['spectrum_unmet'])}" if fit["spectrum_unmet"] else "has all"
    bound = ", ".join(name.replace("_", " ") for name in fit["at_bound"]) or "none"
    return (
        f"The search looked at {fit['vectors']} vectors; the best has a misfit to the tables of "
        f"{fit['tables_misfit']:.2f} (0.83 is one tolerance off in every number). Of the four parts of L1 and L2 "
        f"that were weighed too it {weighed}. "
        f"Within 2 % of a bound: {bound}. Fits that never saw the flights of one logic miss them by {left}."
    )


def verdicts(study: dict[str, Any], held_out: bool) -> str:
    """Return in words how the numbers of the fitted rows, or of those held out, compare, and which differ.

    Zeros in print and set rates of the winch agree without saying much, and are counted apart.
    """
    rows = [row for table in study["tables"].values() for row in table if row["held_out"] == held_out]
    met = [row for row in rows if row["verdict"] == "agrees"]
    few = sum(row["published"] == 0 or row["metric"] == "rewind_rate_min" for row in met)
    near = sum(row["verdict"] == "near" for row in rows)
    missed = [row for row in rows if row["verdict"] == "differs"]
    named = [f"{r['metric']} with {r['layers']} at {r['wind']:g} m/s ({apart(r)})" for r in missed]
    return (
        f"Of {len(rows)} numbers {len(met)} agree, {near} are near and {len(missed)} differ. Of the {len(met)} that "
        f"agree {few} say little: zeros in print, or a slowest rewind rate. What differs: "
        f"{'; '.join(named) or 'nothing'}."
    )


def apart(row: dict[str, Any]) -> str:
    """Return how far a computed number is from the published one: a factor, or both where one is zero or missing."""
    if row["ratio"]:
        return f"{row['ratio']:.2f} ×"
    return f"{number(row['computed'])} in place of {number(row['published'])}"


def lines(study: dict[str, Any]) -> str:
    """Return the quasi-static cable beside the dynamic line."""
    keys = ("title", "peak_quasi_static", "peak_dynamic", "peak_ratio", "rms_difference", "snaps_matched", "outside")
    rows = [[case[key] for key in keys] for case in study["cable"]["cases"].values()]
    heads = ["flight", "peak, static [N]", "peak, dynamic [N]", "ratio", "rms [N]", "snaps matched", "share outside"]
    return table(heads, rows) + "\n\n" + "\n\n".join(study["cable"]["words"])


def misprints() -> str:
    """Return the misprints."""
    rows = [[m.where, m.printed, m.meant, m.evidence] for m in MISPRINTS]
    return table(["where", "printed", "meant", "settled by"], rows)


def main(folder: Path) -> None:
    """Write the page."""
    study = json.loads((folder / "tables.json").read_text(encoding="utf-8"))
    if study["partial"]:
        sys.exit(f"{folder} holds a partial study, without {', '.join(study['left_out'])}; run `tethership reproduce`")
    text = (HERE / "docking.in.md").read_text(encoding="utf-8")
    fills = {
        "formulation": study["formulation"],
        "claims_counted": f"{study['counts']['holds']} of {len(study['claims'])}",
        "fit": fit_words(stored_fit(study["formulation"])),
        "fitted": verdicts(study, held_out=False),
        "held_out": verdicts(study, held_out=True),
        "tables": tables(study),
        "claims": claims(study),
        "variants": variants(study),
        "lines": lines(study),
        "misprints": misprints(),
        "figures": "\n\n".join(f"![{name}](docking_{name}.png)" for name in SHOWN),
    }
    for key, value in fills.items():
        text = text.replace("{{" + key + "}}", value)
    for name in SHOWN:
        shutil.copy(folder / "figures" / f"{name}.png", HERE / f"docking_{name}.png")
    (HERE / "docking.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "reproduction"))
