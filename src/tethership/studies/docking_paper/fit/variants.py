"""The readings that the print leaves open, each to be settled by its misfit. Depends on: fitting, scenario.

A variant is the identified scenario with one thing otherwise. Its misfit at the identified vector says what the change
does by itself; its misfit after a short fit of its own, started from the identified set, says whether another ship
would make up for it.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tethership.scenario import Scenario
from tethership.studies.docking_paper.fit.identify import Objective
from tethership.studies.docking_paper.fit.misfit import Item, fly_rows, items, residuals
from tethership.studies.docking_paper.fit.space import to_shares, to_values
from tethership.studies.docking_paper.fit.spectrum import Spectrum
from tethership.studies.docking_paper.fit.targets import fitted_rows
from tethership.tuning import Archive, evolve, misfit

PRINTED_SHARE = 2.2675
"""½ q_T2x/q_T3x of Eq. 40 with the sign of the print: #3, #4 then cancel the moment of #2 [-]."""


class Variant(NamedTuple):
    """One reading.

    Attributes
    ----------
    name : str
    question : str
        What the print leaves open.
    changes : dict
        Changes of the scenario.
    """

    name: str
    question: str
    changes: dict[str, Any]


def _thruster_share(law: str, share: str, **values: float) -> dict[str, float]:
    return {f"control.{law}.{share}.{thruster}": value for thruster, value in values.items()}


AS_IDENTIFIED = Variant("as identified", "", {})
"""No variant: what the others, fitted anew by the same short search, are held against."""

VARIANTS = (
    Variant("threshold 144.3 N", "F′ of Eq. 41: Table A.2 or the text's third", {"control.rewind.threshold": 144.3}),
    Variant("χ from atan2", "Eq. 42: χ over the full circle", {"control.heading.angle": "full"}),
    Variant("χ to the line", "Eq. 42: χ to the line, either way round", {"control.heading.angle": "line"}),
    Variant("χ from B", "Eq. 42: χ measured from the centre of buoyancy", {"control.heading.measured_behind": 6.97}),
    Variant("heading fades in 1 m", "fade of Eq. 42 near the anchor", {"control.heading.fade_radius": 1.0}),
    Variant("heading fades in 3 m", "fade of Eq. 42 near the anchor", {"control.heading.fade_radius": 3.0}),
    Variant(
        "Eq. 40 as printed",
        "sign of the share of #3, #4",
        _thruster_share("attitude", "pitch_share", port_up=PRINTED_SHARE, starboard_up=PRINTED_SHARE),
    ),
    Variant("Eq. 43 as printed", "sign of the speed term", {"control.navigation.speed_gain": -0.033}),
    Variant("range along the line of sight", "ε_hor of Eq. 43", {"control.navigation.range": "line_of_sight"}),
    Variant("gains on thrust of 120 N", "unit of the gains", {"control.gain_thrust": 120.0}),
    Variant("C at the anchor", "where C of Eqs. 15-18 sits", {"cables.nose.load_reference": 0.0}),
    Variant("C at the tether point", "where C of Eqs. 15-18 sits", {"cables.nose.load_reference": 1.0}),
    Variant("gust repeated", "shape of the gust: pulses to the end", {"gusts.0.shape": "repeated"}),
    Variant("gust a bare cosine", "shape of the gust: one period of A cos", {"gusts.0.shape": "cosine"}),
    Variant("start holds P", "what the 10° turn about", {"start.hold": "reference_point"}),
)
"""Every reading but the formulation, which has a fit of its own."""

Progress = Callable[[str, float], None]
"""Called with the variant's name and the share of all that is done."""


def refit_all(scenario: Scenario, fit: dict[str, Any], progress: Progress | None = None) -> dict[str, dict[str, Any]]:
    """Return the vector fitted to every variant, and to none, as plain data by the variant's name.

    `values` are in SI, in the order of `UNKNOWNS` [m², m, -, N]; `misfit` is that to the tables [-].
    """
    found: dict[str, dict[str, Any]] = {}
    everything = (AS_IDENTIFIED, *VARIANTS)
    for done, variant in enumerate(everything):
        if progress is not None:
            progress(variant.name, done / len(everything))
        values = refit(scenario, fit, variant)
        found[variant.name] = {
            "values": [float(f"{value:.6g}") for value in values],
            "misfit": float(table_misfits(scenario, fit, variant, values)[0]),
        }
    return found


def fitted_items(fit: dict[str, Any]) -> tuple[Item, ...]:
    """Return what a stored fit fitted, with its tolerances of the logarithm [-]."""
    tolerance = {(entry["table"], entry["wind"], entry["metric"]): entry["tolerance"] for entry in fit["items"]}
    return tuple(item._replace(tolerance=tolerance[item.table, item.wind, item.metric]) for item in items())


def objective(scenario: Scenario, fit: dict[str, Any]) -> Objective:
    """Return the residuals of a scenario, in the tolerances of a fit [-], as a function of places in the box, 0 … 1."""
    return Objective(scenario, fitted_rows(), fitted_items(fit), Spectrum(scenario.formulation))


def refit(
    scenario: Scenario,
    fit: dict[str, Any],
    variant: Variant,
    population: int = 32,
    generations: int = 8,
    seed: int = 1,
) -> np.ndarray:
    """Return the best vector of a variant, in SI [m², m, -, N], searched from the identified set.

    Parameters
    ----------
    scenario : Scenario
        What was fitted.
    fit : dict
        From `fit_document`.
    variant : Variant
        What is otherwise.
    population, generations : int
        Of the differential evolution; its first members are the best vector and others of the set.
    seed : int
        Of everything random.
    """
    archive = Archive(objective(scenario.changed(variant.changes), fit))
    members = np.array([list(fit["parameters"].values()), *fit["members"][: population - 1]])
    places = to_shares(members)
    noise = np.random.default_rng(seed).normal(0.0, 0.05, places.shape)
    noise[0] = 0.0
    evolve(archive, np.clip(places + noise, 0.0, 1.0), generations, seed)
    return to_values(archive.best()[0])


def table_misfits(scenario: Scenario, fit: dict[str, Any], variant: Variant | None, values: np.ndarray) -> np.ndarray:
    """Return the misfits to the tables [-] of vectors, in the tolerances of a fit, with or without a variant.

    Parameters
    ----------
    scenario : Scenario
        What was fitted.
    fit : dict
        From `fit_document`.
    variant : Variant or None
        What is otherwise.
    values : ndarray
        Unknowns in SI [m², m, -, N], shape (vectors, unknowns) or (unknowns,).
    """
    here = scenario if variant is None else scenario.changed(variant.changes)
    rows = fitted_rows()
    return misfit(residuals(fly_rows(here, np.atleast_2d(values), rows), rows, fitted_items(fit)))
