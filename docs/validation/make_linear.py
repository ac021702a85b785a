"""Write docs/validation/linear.md and its figures: claims L1–L9 and Figures 6–11, computed in this run.

Run: make validation. Numbers come from the run; the explanations below were written for it, and say "here" of them.
"""

from pathlib import Path

import numpy as np

import tethership as ts
from tethership.studies.docking_paper import CLAIMS, FIGURES, check_claims, linear_figure
from tethership.studies.docking_paper.linear_claims import FINS, LITERATURE_FINS
from tethership.studies.docking_paper.view.linear_figures import plot_linear_figure

HERE = Path(__file__).parent
BOTH = ("consistent", "published")


def surge_drag() -> str:
    """Return the hull drag coefficient from which surge and north stay apart up to 6 g/m."""
    light = {"cables.nose.diameter": 2.5e-3, "cables.nose.linear_density": 6e-3}
    scenario = ts.load_scenario("docking", light)
    found = ts.sweep(scenario, {"vehicle.envelope.axial_drag_coefficient": np.linspace(0.02, 0.08, 25)})
    meetings = [event for event in found.events if set(event.tracks) == {"surge", "north"}]
    if not meetings:
        return "no hull drag coefficient up to 0.08"
    return f"a hull drag coefficient of {meetings[0].at['vehicle.envelope.axial_drag_coefficient']:.3f} or more"


def table(found: dict) -> list[str]:
    """Return the table of verdicts: parts as rows, formulation and fins as columns."""
    heads = [f"{form[0].upper()} {area:g}" for form in BOTH for area in FINS]
    lines = ["| claim | " + " | ".join(heads) + " |", "|---|" + "---|" * len(heads)]
    for name in CLAIMS:
        first = found[BOTH[0], FINS[0]][name]
        cells = ["**holds**" if found[form, area][name].holds else "no" for form in BOTH for area in FINS]
        lines.append(f"| **{name}** {first.statement} | " + " | ".join(cells) + " |")
        for part in first.parts:
            marks = ["✓" if found[form, area][name].parts[part] else "·" for form in BOTH for area in FINS]
            lines.append(f"| {part} | " + " | ".join(marks) + " |")
    return lines


def numbers(found: dict) -> list[str]:
    """Return what was computed for each claim at the literature's fins."""
    lines = []
    for name in CLAIMS:
        lines.append(f"### {name}\n")
        for form in BOTH:
            claim = found[form, LITERATURE_FINS][name]
            lines.append(f"`{form}`, {LITERATURE_FINS} m²: {claim.verdict}.\n")
            for what, value in claim.numbers.items():
                lines.append(f"- {what}: {shown(value)}")
            lines.append("")
    return lines


def shown(value: object) -> str:
    """Return a number, eigenvalue or list as text."""
    if isinstance(value, dict):
        return "; ".join(f"{key} {shown(item)}" for key, item in value.items())
    if isinstance(value, list) and len(value) == 2 and all(isinstance(item, list) for item in value):
        return f"{shown(value[0])} → {shown(value[1])}"
    if isinstance(value, list):
        return ", ".join(shown(item) for item in value)
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def main() -> None:
    """Compute everything and write the page."""
    found = {(form, area): check_claims(form, area) for form in BOTH for area in FINS}
    for number in FIGURES:
        for form in BOTH:
            plot_linear_figure(linear_figure(number, form)).savefig(HERE / f"figure_{number:02d}_{form}.png", dpi=75)
    text = (HERE / "linear.in.md").read_text(encoding="utf-8")
    text = text.replace("{{table}}", "\n".join(table(found))).replace("{{numbers}}", "\n".join(numbers(found)))
    text = text.replace("{{surge_drag}}", surge_drag())
    figures = [
        f"### Figure {number}: {title}\n\n" + "\n".join(f"![{form}](figure_{number:02d}_{form}.png)\n" for form in BOTH)
        for number, (title, _) in FIGURES.items()
    ]
    (HERE / "linear.md").write_text(text.replace("{{figures}}", "\n".join(figures)), encoding="utf-8")


if __name__ == "__main__":
    main()
