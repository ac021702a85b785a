"""The study's report: sections in words, tables and figures, from the parts that were computed.

Depends on: view.report.report, view.report_tables, studies.docking_paper.
"""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from tethership._extras import needs
from tethership.studies.docking_paper.fit.fit_file import stored_fit
from tethership.studies.docking_paper.jobs import Settings, load_part
from tethership.studies.docking_paper.linear_figures import FIGURES
from tethership.studies.docking_paper.misprints import MISPRINTS
from tethership.studies.docking_paper.tables import counts
from tethership.studies.docking_paper.view import report_tables as tables
from tethership.studies.docking_paper.view.pictures import DOCKING_FIGURES, LAYER_WORDS
from tethership.view.report import Figure, Section, write_report

with needs("plots"):
    import plotly.io

PAPER = "Riboldi, Croce, Pagani, He, Bortolini, Airship dynamics in a tethered docking maneuver"


KINDS = ("png", "json")
"""Files of a figure: its picture, its plot."""


class _Study:
    """The parts of the report and their pictures; whatever else is in the folder stays out."""

    def __init__(self, folder: Path, settings: Settings, parts: Collection[str]) -> None:
        self.folder, self.settings = folder, settings
        self.fit = stored_fit(settings.formulation)
        self._parts = {name: load_part(folder, name) for name in parts}
        self._files = {file for part in self._parts.values() for file in part.get("files", [])}

    def part(self, name: str) -> dict[str, Any] | None:
        """Return a part's result, None where the report has none."""
        return self._parts.get(name)

    def figure(self, name: str, caption: str, label: str = "") -> list[Figure]:
        """Return a picture, a plot or both, nothing where the report has neither."""
        png, data = (f"figures/{name}.{kind}" if f"figures/{name}.{kind}" in self._files else None for kind in KINDS)
        if png is None and data is None:
            return []
        picture, plot = (None if file is None else self.folder / file for file in (png, data))
        drawn = None if plot is None else plotly.io.from_json(plot.read_text(encoding="utf-8"), skip_invalid=True)
        return [Figure(caption, picture, drawn, caption, label)]


def write_study(
    folder: Path, settings: Settings, parts: Collection[str], left_out: Sequence[str], footer: Mapping[str, Any]
) -> Path:
    """Write report.html from parts of a study that are in a folder; returns where.

    Parameters
    ----------
    folder : Path
        Of the study.
    settings : Settings
        What it is of.
    parts : collection of str
        Names of the jobs whose results belong to it.
    left_out : sequence of str
        Titles of those whose results are not there: with any the report is partial, and says so.
    footer : mapping
        Versions and provenance.
    """
    study = _Study(folder, settings, parts)
    makers = (
        _tables, _identification, _linear, _docking, _variants, _line, _terms, _uncertainty, _retuning, _misprints
    )  # fmt: skip
    sections = [section for maker in makers if (section := maker(study)) is not None]
    title = "An airship docking with a rewinding tether: the paper, reproduced and tested"
    abstract = _abstract(study)
    if left_out:
        title += " (partial report)"
        abstract.insert(0, f"**This report is partial.** It was made without: {', '.join(left_out)}.")
    return write_report(folder / "report.html", title, abstract, sections, footer)


def _abstract(study: _Study) -> list[str]:
    """Return the summary."""
    form = study.settings.formulation
    lines = [
        f"Section by section, the study of {PAPER} is computed again and set beside its print, in the formulation "
        f"`{form}`, with a ship whose unpublished numbers were identified from the tables at 6 and 12 m/s. "
        "Every number below was computed by the version that wrote this page, but for the identification itself, which "
        "is stored (its misfit to the tables is computed again); what was fitted, what is predicted and what does not "
        "hold is said where it stands."
    ]
    table = study.part("tables")
    if table is not None:
        total = counts([row for rows in table["tables"].values() for row in rows])
        predicted = total["held_out"]
        claims = {**table["claims"], **((study.part("linear") or {}).get("claims") or {})}
        held = [name for name, claim in claims.items() if claim["holds"]]
        lines.append(
            f"Of the numbers of Tables 3–6 in rows that were fitted, **{total['agrees']}** agree within 20 % (times of "
            f"docking within 2 %), **{total['near']}** are near (a factor 1.5) and **{total['differs']}** differ. Of "
            f"the {total['prediction']} numbers at 9 m/s, which were held out of the fit, **{predicted['agrees']}** "
            f"agree, **{predicted['near']}** are near and **{predicted['differs']}** differ. Of {len(claims)} claims "
            f"**{len(held)}** hold in every part" + (f": {', '.join(held)}." if held else ".")
        )
    return lines


def _intervals(study: _Study) -> dict[tuple[str, float, str], dict[str, Any]]:
    part = study.part("uncertainty")
    rows: Sequence[dict[str, Any]] = [] if part is None else part["set_alone"]
    return {(row["layers"], row["wind"], row["metric"]): row for row in rows}


def _tables(study: _Study) -> Section | None:
    part = study.part("tables")
    if part is None:
        return None
    intervals = _intervals(study)
    drawn = [tables.comparison(name, rows, intervals) for name, rows in part["tables"].items()]
    words = [
        "The docking starts at rest from the trim with 10° added to roll, pitch and yaw about the tether point, in a "
        "uniform wind from the north with a gust from the west at 20 s, and ends at 1.5 m of cable. A number "
        "**agrees** within 20 % (docking times within 2 %), is **near** within a factor 1.5 (4 %), else **differs**; "
        "times over a threshold that are both below 0.1 s agree."
    ]
    return Section("Tables 3–6", words, drawn)


def _identification(study: _Study) -> Section:
    fit = study.fit
    unmet = fit["spectrum_unmet"]
    words = [
        "Fins, drag coefficients of the hull and nominal thrusts are not published. They were searched inside "
        "the bounds of [[parameters]] for the least misfit to the rows at 6 and 12 m/s and to claims L1 and L2: "
        f"{fit['vectors']} vectors by Sobol points, differential evolution and least squares. Times over a threshold "
        "have a wide tolerance, and every tolerance is widened by how far its number moves when the initial attitude "
        "moves by 1 %.",
        f"The best vector has a misfit of **{fit['tables_misfit']:.3f}** to the tables, {fit['misfit']:.3f} with the "
        "four parts of the spectrum counted in. It is one of a set: what fits within 10 % of it spreads as "
        "[[marginals]] shows, and only combinations of numbers are well determined ([[correlation]]). The best "
        "vector may lie outside the set's 5–95 %: a set in eleven dimensions has far corners.",
        (
            "Identified numbers within 2 % of a bound of their range: "
            + ", ".join(n.replace("_", " ") for n in fit["at_bound"])
            + "."
            if fit["at_bound"]
            else "No identified number is at a bound of its range."
        ),
        (
            f"The tables and the spectra pull apart: with the identified ship, these parts of L1 and L2 do not hold: "
            f"{', '.join(unmet)}."
            if unmet
            else "The identified ship has the four parts of L1 and L2 that were weighed: unstable side-slip and "
            "vertical, mild pendulum, stable roll."
        ),
    ]
    words.append(
        "**How blind the rows at 9 m/s are.** The numbers of Tables 3–6 there were not at hand when the ship was "
        "identified and are held out of every fit: its loader refuses them. The first fit was frozen before any flight "
        "at 9 m/s was computed; it was then searched again, because its spectrum had been read in the wrong axes, by "
        "the same rows at 6 and 12 m/s and nothing else."
    )
    shown = [tables.parameter_table(fit)]
    if (left := tables.left_out_table(fit)) is not None:
        words.append(
            "Fits that never saw one of the tables say of it what [[left_out]] has: a misfit well above that of "
            "what was fitted means that the table carries information the others do not."
        )
        shown.append(left)
    figures = [
        *study.figure("fit_marginals", "Marginal ranges of the identified numbers.", label="marginals"),
        *study.figure("fit_correlation", "Correlation of the identified numbers over the set.", label="correlation"),
        *study.figure(
            "fit_residuals",
            "Computed over published, every fitted number, as the fit sees it: fixed steps, a cable that does not "
            "break, half a second added to times over a threshold.",
        ),
    ]
    if not figures:
        words[1] = words[1].replace(" as [[marginals]] shows", "").replace(" ([[correlation]])", "")
    return Section("Identification of what is not published", words, shown, figures)


def _linear(study: _Study) -> Section | None:
    part = study.part("linear")
    figures = []
    for number, (title, _) in FIGURES.items():
        figures += study.figure(f"figure_{number:02d}", f"Figure {number} of the paper, computed: {title}.")
    if part is None and not figures:
        return None
    words = [
        "Root loci of the identified ship about its trim, by exact differentiation; every mode keeps its name along a "
        "locus. A claim holds only if each of its parts does."
    ]
    shown = [] if part is None else [tables.claims_table(part["claims"], "Claims L1–L9 of section 3.", "linear_claims")]
    return Section("Free response: Figures 6–11, claims L1–L9", words, shown, figures)


def _docking(study: _Study) -> Section | None:
    part = study.part("tables")
    figures = []
    for number, table in DOCKING_FIGURES.items():
        caption = f"Figure {number} of the paper, computed: {LAYER_WORDS[table]}, 12 m/s, gust of 4 m/s at 20 s."
        figures += study.figure(f"figure_{number}", caption)
        figures += study.figure(f"figure_{number}_histories", f"Histories of the flight of Figure {number}.")
    figures += study.figure("figure_15", "Figure 15 of the paper, computed: the three trajectories.")
    if part is None and not figures:
        return None
    words = ["The docking under the three control logics, and what the text of section 4 says of it."]
    if figures:
        words.append("Beside this page `figures/figure_12.html` to `figures/figure_14.html` play the flights in space.")
    shown = (
        [] if part is None else [tables.claims_table(part["claims"], "Claims D1–D11 of section 4.", "docking_claims")]
    )
    return Section("Docking: Figures 12–15, claims D1–D11", words, shown, figures)


def _variants(study: _Study) -> Section | None:
    part = study.part("variants")
    if part is None:
        return None
    other = "consistent" if study.settings.formulation == "published" else "published"
    words = [
        "The print leaves readings open. Each was flown with the identified ship as it is, and with a ship fitted anew "
        "from the identified set ([[variants]]).",
        f"Formulation: fitted by the same search, `{study.settings.formulation}` reaches a misfit to the tables of "
        f"{study.fit['tables_misfit']:.3f} and `{other}` {stored_fit(other)['tables_misfit']:.3f}.",
        "Where another reading fits as well or a little better, the plain sense of the print is kept.",
    ]
    return Section("What the print leaves open", words, [tables.variant_table(part)])


def _line(study: _Study) -> Section | None:
    part = study.part("cable")
    if part is None:
        return None
    if not part["cases"]:
        return Section("The quasi-static cable", [part["message"]])
    figures = []
    for name, case in part["cases"].items():
        figures += study.figure(f"line_{name}", f"Tension at the tether point: {case['title']}.")
    return Section("The quasi-static cable", part["words"], [tables.line_table(part["cases"])], figures)


def _terms(study: _Study) -> Section | None:
    part = study.part("terms")
    if part is None:
        return None
    shown = [tables.breakdown_table(part["breakdown"])]
    shown += [tables.terms_table(rows, layers) for layers, rows in part["switched_off"].items()]
    figures = []
    for layers in part["breakdown"]:
        figures += study.figure(f"loads_{layers}", f"Loads over the flight: {LAYER_WORDS[layers]}, 12 m/s.")
    words = ["How large each load is over a flight, and what becomes of the peak tension when a term is taken out."]
    return Section("Which terms matter", words, shown, figures)


def _uncertainty(study: _Study) -> Section | None:
    part = study.part("uncertainty")
    if part is None:
        return None
    rows = [row for row in part["perturbed"] if row["inside"] is not None]
    fitted, held = ([row["inside"] for row in rows if row["held_out"] == apart] for apart in (False, True))
    words = [
        f"Each row was flown {part['flights']} times (seed {part['seed']}) with the initial attitude moved by up to "
        "2°, the gust by up to 1 s, the wind by up to 3 %, and the ship drawn from the identified set.",
        f"Of {len(fitted)} published numbers in fitted rows **{sum(fitted)}** lie inside the 5–95 % range, to the "
        f"rounding of the print; of {len(held)} held out, at 9 m/s, **{sum(held)}**.",
    ]
    return Section(
        "Uncertainty", words, [tables.uncertainty_table(part["perturbed"], wind) for wind in (6.0, 9.0, 12.0)]
    )


def _retuning(study: _Study) -> Section | None:
    part = study.part("retuned")
    if part is None:
        return None
    words = [
        "The paper remarks that its gains might be tuned for 12 m/s and leaves that undone. `tethership tune` "
        "searched the gains of all four layers over perturbed flights; both were flown again "
        f"{part['flights']} times here.",
        part["words"],
    ]
    return Section("Gains retuned for 12 m/s", words, [tables.retuned_table(part["rows"])])


def _misprints(study: _Study) -> Section:
    words = ["Found by deriving every equation again."]
    return Section("Misprints", words, [tables.misprint_table(MISPRINTS)])
