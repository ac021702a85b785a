"""What a campaign flew, and whether it meets what is required: the first sections of its report. Depends on: view."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from tethership.campaign import Distribution, Plan, limit_values
from tethership.scenario import list_parameters
from tethership.simulation import MEMORY, TRUSTED
from tethership.view.flight.captions import compass, percent, percents, trust
from tethership.view.report.report import Section, Table

CONDITIONS = (
    "**Met**: the whole interval is at or below what is allowed, flights that ended early being counted as exceeding. "
    "**Not met**: the whole interval is above it, they being counted as not exceeding. **Undecided**: neither; a new "
    "campaign with more flights, their number fixed beforehand, may decide (flying on until it is met would meet it "
    "by chance). Intervals are two-sided at the requirement's own confidence, each requirement and law by itself.",
    "A verdict is conditional on the model, on the distributions of what varies and on the fixed steps (section "
    "Checks); none of these is in its interval.",
)
"""What verdicts mean, in paragraphs."""

TRUST = (
    f"**Trust in tensions.** They are a quasi-static cable's, which may be trusted while they change more slowly than "
    f"{TRUSTED:g} of the cable's first transverse mode, and did for {MEMORY:g} s; outside, a dynamic line may peak "
    "elsewhere. *With the snap's wave*: the axial wave of each flight's hardest snap, closing speed × √(EA × linear "
    "density), is added to its peak, an upper bound. The paper's cable (line `published`) pulls before it is "
    "taut and overstates snaps already."
)
"""What is to be said beside every verdict on tension."""


def flown_section(plan: Plan) -> Section:
    """Return what was flown: the scenario, the limits, the laws, and what varies."""
    return Section("What was flown", ["All cases are drawn before the first is flown."], _tables(plan))


def compliance_section(answers: Mapping[str, Any]) -> Section | None:
    """Return the requirements with their verdicts, None where there are none."""
    rows = answers["compliance"]
    if not rows:
        return None
    heads = [
        "requirement",
        "law",
        "verdict",
        "exceeding",
        "ended early",
        "failed",
        "interval",
        "allowed",
        "least flights",
        "on tension",
    ]
    cells = [
        [
            f"{row['requirement']} ({row['limit'].replace('_', ' ')} {numbered(row['value'])})",
            row["law"],
            row["verdict"],
            f"{row['exceeding']} of {row['flights']}",
            row["undetermined"],
            row["failed"],
            percents(row),
            f"{percent(row['allowed'])} at {100 * row['confidence']:g} %",
            row["least_flights"],
            trusted(row),
        ]
        for row in rows
    ]
    reasons = [f"{row['requirement']}, {row['law']}: {row['reason']}." for row in rows if row["reason"]]
    note = (
        "Ended early: flights that did not dock and had not exceeded the limit by then. The interval begins with them "
        "counted as not exceeding and ends with them counted as exceeding. Least flights: as many, none exceeding, as "
        "it takes to meet the requirement."
    )
    return Section(
        "Compliance", [*CONDITIONS, TRUST, *reasons], [Table("Requirements.", heads, cells, note, verdict_column=2)]
    )


def interval(row: Mapping[str, Any]) -> str | None:
    """Return an interval of a probability [-] in words, four digits, None where there is none."""
    return None if row["low"] is None or row["high"] is None else f"{row['low']:.4g} … {row['high']:.4g}"


def trusted(row: Mapping[str, Any]) -> str:
    """Return what is to be said of a verdict on tension, from its shares and probabilities [-], nothing of another."""
    if "quasi_static_outside" not in row:
        return ""
    return (
        f"{trust(row['quasi_static_outside'])}; with the snap's wave added the probability would be at most "
        f"{percent(row['probability_with_snap'])}: {row['verdict_with_snap']}"
    )


def numbered(value: tuple[float, str] | None) -> str:
    """Return a limit's number with its unit, as `limit_values` gives them: 2200 N for [N]."""
    return "" if value is None else f"{value[0]:g} {value[1]}"


def _tables(plan: Plan) -> list[Table]:
    """Return scenario, limits, laws and distributions."""
    limits = [[name.replace("_", " "), value, unit] for name, (value, unit) in limit_values(plan).items()]
    laws = [[law.name, ", ".join(law.layers) or "none", law.gains_of or "", _pairs(law.changes)] for law in plan.laws]
    return [
        Table("Scenario.", ["quantity", "value"], _scenario(plan)),
        Table("Limits.", ["limit", "value", "unit"], limits),
        Table("Laws.", ["law", "layers", "gains of", "changes"], laws),
        Table(
            "What varies.",
            ["quantity", "distribution", "least drawn", "largest drawn"],
            _varied(plan),
        ),
    ]


def _scenario(plan: Plan) -> list[list[str]]:
    """Return what the scenario says of the flight's circumstances; what varies says so."""
    config, varied = plan.scenario.config, plan.config.vary
    wind, turbulence = config.wind, config.turbulence

    def shown(name: str, words: str) -> str:
        return "varies" if name in varied else words

    rows = [
        ["scenario", f"`{plan.config.scenario}`, formulation `{plan.scenario.formulation}`"],
        ["mean wind", shown("wind.speed", f"{float(wind.speed):g} m/s")],
        ["from", shown("wind.from_direction", compass(float(wind.from_direction)))],
        ["wind model", str(wind.model)],
        ["turbulence", "none" if turbulence is None else str(turbulence.spectrum)],
        ["gusts", str(len(config.gusts))],
        ["time limit", f"{float(config.stop.time_limit):g} s"],
        ["fixed step", f"{float(plan.config.step):g} s"],
        ["sampling", f"{plan.config.sampling}, seed {plan.config.seed}"],
    ]
    return rows + [["changed", f"`{name}` = {value}"] for name, value in plan.config.changes.items()]


def _pairs(changes: Mapping[str, Any]) -> str:
    """Return changes in words."""
    return ", ".join(f"{name} = {value:g}" for name, value in changes.items())


def _varied(plan: Plan) -> list[list[Any]]:
    """Return what varies, all numbers in the file's own unit."""
    known = list_parameters(plan.scenario.config)
    cells = []
    for i, (name, spread) in enumerate(plan.config.vary.items()):
        parameter = known[plan.sample.names[i]]
        zero, one = spread.in_si(np.array([0.0, 1.0]), parameter.value, parameter.unit)
        column = (plan.sample.values[:, i] - zero) / ((one - zero) or 1.0)
        unit = "× the scenario's" if spread.relative else spread.unit
        ends = [float(column.min()), float(column.max())]
        cells.append([f"`{name}`", f"{spread.distribution}, {_numbers(spread)} [{unit}]", *ends])
    return cells


def _numbers(spread: Distribution) -> str:
    """Return the numbers of a distribution in words; a bound that is none is left out."""
    numbers = spread.model_dump(exclude_none=True, exclude={"distribution", "unit", "relative"})
    given = {key: value for key, value in numbers.items() if not (isinstance(value, float) and np.isinf(value))}
    words = (f"{key} {value:g}" if isinstance(value, float | int) else f"{key} {value}" for key, value in given.items())
    return ", ".join(words)
