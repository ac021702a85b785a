"""Shared starts: a scenario, its trim and one flight, computed once per worker."""

import gc
from pathlib import Path

import jax
import pytest

import tethership as ts

MAPS = Path("/proc/self/maps")
MOST_MAPS = 20_000
"""Every compiled program keeps hundreds of memory maps; Linux allows a process 65 530 and XLA aborts beyond."""


@pytest.fixture(autouse=True, scope="module")
def _room_for_programs():
    """Forget compiled programs before a process has no maps left; they come back from the compilation cache."""
    yield
    if MAPS.exists() and MAPS.read_bytes().count(b"\n") > MOST_MAPS:
        jax.clear_caches()
        gc.collect()


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
