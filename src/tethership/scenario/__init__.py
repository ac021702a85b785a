"""Scenarios: from TOML files to a validated system, its laws and its run settings."""

from tethership.scenario.load import Scenario, list_packaged, load_scenario, read_solver
from tethership.scenario.parameters import Parameter, check_values, find_parameter, list_parameters, scenario_at
from tethership.scenario.schema import ScenarioConfig
from tethership.scenario.solver import SolverConfig
from tethership.scenario.vehicle_schema import VehicleConfig

__all__ = [
    "Parameter",
    "Scenario",
    "ScenarioConfig",
    "SolverConfig",
    "VehicleConfig",
    "check_values",
    "find_parameter",
    "list_packaged",
    "list_parameters",
    "load_scenario",
    "read_solver",
    "scenario_at",
]
