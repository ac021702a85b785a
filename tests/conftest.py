"""Shared starts: a scenario, its trim and one flight, computed once per worker."""

import pytest

import tethership as ts


@pytest.fixture(scope="session")
def docking():
    """The packaged docking scenario."""
    return ts.load_scenario("docking")


@pytest.fixture(scope="session")
def point(docking):
    """Its trim."""
    return ts.trim(docking)


@pytest.fixture(scope="session")
def flight(docking, point):
    """Its flight with all three layers."""
    return ts.dock(docking, point)
