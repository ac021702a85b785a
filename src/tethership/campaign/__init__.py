"""Many flights of one scenario, each with its own values of some parameters."""

from tethership.campaign.flights import Cases, fly_blocks, fly_cases, layer_switches
from tethership.campaign.perturbed import Spread, perturbed

__all__ = ["Cases", "Spread", "fly_blocks", "fly_cases", "layer_switches", "perturbed"]
