"""The paper's study in parts: flights, tables, claims, variants, terms, cable, uncertainty, retuning. Data only.

Depends on: studies.docking_paper, campaign, simulation, analysis, scenario. Each part is a function of a
folder and `Settings` that returns plain data (`jobs`); flights are kept as files, so that later parts and pictures read
them.
"""

from pathlib import Path
from typing import Any

import numpy as np

from tethership.analysis import TrimOutcome, trim
from tethership.campaign import perturbed
from tethership.errors import ConfigError
from tethership.scenario import Scenario, list_parameters, load_scenario
from tethership.simulation import Flight, dock
from tethership.studies.docking_paper.docking_claims import check_docking_claims
from tethership.studies.docking_paper.fit.fit_file import stored_fit
from tethership.studies.docking_paper.fit.targets import TABLES
from tethership.studies.docking_paper.fit.variants import AS_IDENTIFIED, VARIANTS, table_misfits
from tethership.studies.docking_paper.flights_read import WINDS, FlightKey
from tethership.studies.docking_paper.jobs import Settings
from tethership.studies.docking_paper.line_comparison import compare_line
from tethership.studies.docking_paper.line_words import line_words
from tethership.studies.docking_paper.linear_claims import CLAIMS
from tethership.studies.docking_paper.moordyn_line import load_moordyn
from tethership.studies.docking_paper.tables import compare, paper_tables
from tethership.studies.docking_paper.terms import load_breakdown, switch_off
from tethership.studies.docking_paper.uncertainty import uncertainty
from tethership.tuning import GAINS, judge

GROUND_EFFECT = 0.01
"""Coefficient of the ground effect of claim D7 [1/m], vertical wind per ground speed and height: not published."""


def vehicle_name(formulation: str) -> str:
    """Return the packaged vehicle identified in a formulation."""
    return f"lotte_identified_{formulation}"


def study_scenario(settings: Settings, wind: float | None = None, ground_effect: float = 0.0) -> Scenario:
    """Return the paper's docking in the study's formulation, with its identified ship.

    Parameters
    ----------
    settings : Settings
        Its formulation.
    wind : float, optional
        [m/s].
    ground_effect : float
        Coefficient [1/m]; with 0 the flights are those without, by the same compiled program.
    """
    changes: dict[str, Any] = {"formulation": settings.formulation, "ground.effect_coefficient": ground_effect}
    changes["vehicle"] = vehicle_name(settings.formulation)
    if wind is not None:
        changes["wind.speed"] = wind
    return load_scenario("docking_paper", changes)


def flight_file(folder: Path, key: FlightKey, grounded: bool = False) -> Path:
    """Return where a flight of the study, by its table and wind [m/s], is kept."""
    table, wind = key
    return folder / "flights" / f"{table}_{wind:g}{'_ground_effect' if grounded else ''}.nc"


def load_flights(folder: Path, grounded: bool = False) -> dict[FlightKey, Flight]:
    """Return the study's flights by table and wind [m/s], as far as they could be flown."""
    keys = [(table, wind) for table in TABLES for wind in WINDS]
    return {
        key: Flight.load(flight_file(folder, key, grounded))
        for key in keys
        if flight_file(folder, key, grounded).exists()
    }


def fly_part(folder: Path, settings: Settings) -> dict[str, Any]:
    """Fly the nine flights of Tables 3–5, and again with ground effect, whose coefficient is `GROUND_EFFECT` [1/m]."""
    files, trims = [], {}
    for wind in WINDS:
        for coefficient in (0.0, GROUND_EFFECT):
            scenario = study_scenario(settings, wind, coefficient)
            point = trim(scenario)
            trims[f"{wind:g}"] = {"outcome": point.outcome.name, "throttle": np.asarray(point.command.throttle)}
            if point.outcome is TrimOutcome.no_equilibrium:
                continue
            for table, layers in TABLES.items():
                path = flight_file(folder, (table, wind), coefficient > 0)
                dock(scenario, point, layers).save(path)
                files.append(str(path.relative_to(folder)))
    return {"files": files, "trims": trims, "ground_effect": GROUND_EFFECT}


def table_part(folder: Path, settings: Settings) -> dict[str, Any]:
    """Compare Tables 3–6 and judge claims D1–D11."""
    flights = load_flights(folder)
    rows = compare(flights)
    claims = check_docking_claims(flights, load_flights(folder, grounded=True), rows)
    return {"tables": paper_tables(rows), "claims": {claim.name: claim_data(claim) for claim in claims}}


def claim_data(claim: Any) -> dict[str, Any]:
    """Return a claim as plain data."""
    return {"holds": claim.holds, "statement": claim.statement, "parts": claim.parts, "numbers": claim.numbers}


def linear_part(folder: Path, settings: Settings) -> dict[str, Any]:
    """Judge claims L1–L9 with the identified ship; eigenvalues are [1/s]."""
    changes = {"formulation": settings.formulation, "vehicle": vehicle_name(settings.formulation)}
    return {"claims": {name: claim_data(claim(changes)) for name, claim in CLAIMS.items()}}


def variant_part(folder: Path, settings: Settings) -> dict[str, Any]:
    """Compute the misfit to the tables [-] of every reading: at the identified ship, and at the one fitted to it."""
    fit = stored_fit(settings.formulation)
    scenario = study_scenario(settings)
    best = np.array(list(fit["parameters"].values()))
    rows = []
    for variant in (AS_IDENTIFIED, *VARIANTS):
        own = fit.get("variants", {}).get(variant.name)
        vectors = np.stack([best, best if own is None else np.array(own["values"])])
        same, refitted = table_misfits(scenario, fit, variant, vectors)
        rows.append(
            {
                "name": variant.name,
                "question": variant.question,
                "misfit": float(same),
                "refitted": None if own is None else float(refitted),
            }
        )
    return {"variants": rows}


def uncertainty_part(folder: Path, settings: Settings) -> dict[str, Any]:
    """Compute the interval of every table cell, perturbed and of the identified set alone."""
    members = np.array(stored_fit(settings.formulation)["members"])
    scenario = study_scenario(settings)
    return {
        "perturbed": uncertainty(scenario, members, WINDS, settings.flights, settings.seed),
        "set_alone": uncertainty(scenario, members, WINDS, settings.flights, settings.seed, perturb=False),
        "flights": settings.flights,
        "seed": settings.seed,
    }


TERMS_WIND = 12.0
"""Wind at which terms are switched off [m/s]."""


def term_part(folder: Path, settings: Settings) -> dict[str, Any]:
    """Break down the loads [N, N m] at 12 m/s and switch off each term: peak tensions [N], times [s], θ_rms [deg]."""
    flights = load_flights(folder)
    scenario = study_scenario(settings, TERMS_WIND)
    return {
        "breakdown": {
            table: load_breakdown(flights[table, TERMS_WIND]) for table in TABLES if (table, TERMS_WIND) in flights
        },
        "switched_off": {table: switch_off(scenario, layers) for table, layers in TABLES.items()},
    }


def retuned_part(folder: Path, settings: Settings) -> dict[str, Any]:
    """Fly the paper's gains and the retuned ones at 12 m/s, once and perturbed.

    Numbers are tensions [N], times [s], ADC [1/s], E [-], θ_rms [deg] and shares of the perturbed flights [-].
    """
    layers = TABLES["navigation"]
    paper = study_scenario(settings, TERMS_WIND)
    tuned = load_scenario("docking_retuned")
    known = list_parameters(tuned.config)
    rows = []
    for name, gains in (("paper", list_parameters(paper.config)), ("retuned", known)):
        scenario = paper.changed({key: gains[key].value for key in GAINS})
        flight = dock(scenario, trim(scenario), layers)
        columns = perturbed(scenario, settings.flights, settings.seed)
        judged = judge(scenario, np.array([[gains[key].value for key in GAINS]]), columns)[0]
        nominal = {key: flight.metrics[key] for key in ("tension_max", "tension_mean", "ADC", "E", "theta_rms")}
        nominal |= {"docking_time": flight.docking_time, "outcome": flight.outcome.name}
        rows.append({"name": name, "nominal": nominal, "perturbed": judged._asdict()})
    gain = known["control.heading.gain"].value
    return {"rows": rows, "flights": settings.flights, "words": _verdict(rows[1]["perturbed"], tuned.formulation, gain)}


def _verdict(judged: dict[str, Any], formulation: str, heading_gain: float) -> str:
    """Return in words whether the constraints are kept, for a gain of the heading layer [1/rad]."""
    limits = {"saturated": "saturate a throttle", "torn": "pass the tear force", "late": "dock too late"}
    broken = [f"{100 * judged[key]:.3g} % {words}" for key, words in limits.items() if judged[key] > 0]
    said = f"The gains were tuned in the formulation {formulation}. "
    if not broken:
        return said + "They keep every constraint in every perturbed flight."
    return said + (
        f"No gains were found that keep every constraint in every perturbed flight: {', '.join(broken)}. A "
        f"throttle is saturated for {judged['saturated_seconds']:.2f} s on average; 10° of misalignment "
        f"alone ask for {heading_gain * np.sin(np.radians(10.0)):.1f} times full thrust of the side thrusters."
    )


LINE_FLIGHTS = (("rewind", 6.0), ("rewind", 12.0), ("navigation", 6.0), ("navigation", 12.0))
"""Flights whose cable is flown again as a dynamic line."""


def cable_part(folder: Path, settings: Settings) -> dict[str, Any]:
    """Fly the cables of recorded flights again as dynamic lines, under both tension laws: tensions [N], times [s]."""
    laws = {"published": "the paper's cable", "consistent": "elastic catenary"}
    cases: dict[str, Any] = {}
    try:
        load_moordyn()
    except ConfigError as error:
        return {"cases": {}, "message": f"Left out: {error}.", "words": []}
    for formulation, law in laws.items():
        for table, wind in LINE_FLIGHTS:
            scenario = study_scenario(settings._replace(formulation=formulation), wind)
            path = flight_file(folder, (table, wind))
            own = formulation == settings.formulation and path.exists()
            flight = Flight.load(path) if own else dock(scenario, trim(scenario), TABLES[table])
            cases[f"{formulation}_{table}_{wind:g}"] = compare_line(flight, f"{law}, {table}, {wind:g} m/s")
    return {"cases": cases, "words": line_words(cases)}
