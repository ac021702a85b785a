"""One plot of a campaign, by the name of what it shows. Depends on: campaign, view.campaign.figures."""

import numpy as np
from matplotlib.axes import Axes

from tethership.campaign import Campaign, Plan, exceeded, running
from tethership.errors import ConfigError, suggestion
from tethership.view.campaign import figures

KINDS = ("limits", "peaks", "times", "convergence", "importance")
"""What can be drawn."""

TENSIONS = ("control threshold", "tear", "tensile", "break")
"""The scenario's watched tensions in words."""


def plot_campaign(campaign: Campaign, axes: Axes | None = None, kind: str = "limits", law: str | None = None) -> Axes:
    """Draw one view of a campaign.

    Parameters
    ----------
    campaign : Campaign
        From `run_campaign`; the same call again on a finished folder flies nothing and returns it.
    axes : Axes, optional
        Draw there; new ones if not given.
    kind : str
        `limits`: probability of exceeding each limit [%], with intervals. `peaks`: share of flights [%] above a tension
        [N]. `times`: histogram of the time to dock [s]. `convergence`: how one law's probabilities [%] settle
        (independent draws only). `importance`: what one law's peak tension hangs on [-].
    law : str, optional
        For `convergence` and `importance`: whose; the first if not given.

    Returns
    -------
    Axes
        Not shown and not saved: ``plot_campaign(found).figure.savefig("odds.png")``.

    Raises
    ------
    ConfigError
        There is no such kind or law, or convergence is asked of draws that are not independent.
    """
    if kind not in KINDS:
        raise ConfigError(f"there is no kind {kind!r} of plot{suggestion(kind, KINDS)} Allowed: {', '.join(KINDS)}")
    plan, answers = campaign.plan, campaign.answers
    match kind:
        case "limits":
            rows = {name: of["exceedance"] for name, of in answers["laws"].items()}
            return figures.plot_limits(rows, answers["confidence"], axes)
        case "peaks":
            return figures.plot_peaks(_of_laws(campaign, "tension_max"), _watched(plan), axes)
        case "times":
            return figures.plot_times(_of_laws(campaign, "docking_time"), plan.config.limits.time, axes)
        case "convergence":
            return _convergence(campaign, axes, _law_place(plan, law))
        case _:
            name = plan.laws[_law_place(plan, law)].name
            return figures.plot_importance(answers["laws"][name]["importance"], axes)


def _of_laws(campaign: Campaign, name: str) -> dict[str, np.ndarray]:
    """Return a metric by law, shape (cases,) each."""
    return {law.name: campaign.data[name].values[i] for i, law in enumerate(campaign.plan.laws)}


def _law_place(plan: Plan, law: str | None) -> int:
    """Return the place of a law, the first if none is named."""
    names = [each.name for each in plan.laws]
    if law is not None and law not in names:
        raise ConfigError(f"the campaign has no law {law!r}{suggestion(law, names)} It has: {', '.join(names)}")
    return 0 if law is None else names.index(law)


def _convergence(campaign: Campaign, axes: Axes | None, law: int) -> Axes:
    """Draw how probabilities settle."""
    answers = campaign.answers
    if answers["sampling"] != "random":
        raise ConfigError(
            f"convergence is of independent draws, and this campaign was drawn by {answers['sampling']}; "
            'use sampling = "random"'
        )
    confidence = answers["confidence"]
    flags = {name: of[law] for name, of in exceeded(campaign.plan, campaign.data).items()}
    # limits that all or no flights exceed say nothing of settling
    found = {name: running(of, confidence) for name, of in flags.items() if 0 < of.sum() < of.size}
    return figures.plot_convergence(found, confidence, axes)


def _watched(plan: Plan) -> dict[str, float]:
    """Return the tensions that a campaign's scenario watches, by their names in words [N]."""
    return dict(zip(TENSIONS, map(float, plan.scenario.config.watched_tensions()), strict=True))
