"""Many flights of one scenario, each with its own values of some parameters; campaigns over distributions of them."""

from tethership.campaign.flights import Cases, Flyer, fly_blocks, fly_cases, layer_switches
from tethership.campaign.perturbed import Spread, perturbed
from tethership.campaign.plan import Plan, make_plan
from tethership.campaign.run import Campaign, run_campaign
from tethership.campaign.store import open_results

__all__ = [
    "Campaign",
    "Cases",
    "Flyer",
    "Plan",
    "Spread",
    "fly_blocks",
    "fly_cases",
    "layer_switches",
    "make_plan",
    "open_results",
    "perturbed",
    "run_campaign",
]
