"""From a validated scenario to its closed loop: plant, laws, sampling, allocation. Depends on: plant, scenario."""

from tethership.control import AbstractLaw
from tethership.plant import ClosedLoop, Command, TetheredAirship
from tethership.scenario.laws import build_allocation, build_law, build_sampling
from tethership.scenario.schema import ScenarioConfig


def build_loop(
    config: ScenarioConfig, plant: TetheredAirship, trimmed: Command, law: AbstractLaw | None = None
) -> ClosedLoop:
    """Return a plant under the laws of its scenario; can be traced.

    Parameters
    ----------
    config : ScenarioConfig
        A validated scenario.
    plant : TetheredAirship
        Built from it.
    trimmed : Command
        Throttles [-] and deflections [rad] about which the laws act.
    law : AbstractLaw, optional
        Instead of the scenario's own layers.
    """
    chosen = build_law(config) if law is None else law
    return ClosedLoop(plant, chosen, trimmed, build_sampling(config), build_allocation(config))
