"""Many flights of one scenario, each with its own values of some parameters."""

from tethership.campaign.flights import Cases, fly_cases

__all__ = ["Cases", "fly_cases"]
