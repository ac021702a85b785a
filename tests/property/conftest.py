"""Random cables for the property tests: geometries, loads and stiffnesses from a seed."""

from typing import NamedTuple

import numpy as np
import pytest

from tethership.physics.cable.law import LOAD_FLOOR

KINDS = ("slack", "near_taut", "taut", "near_plumb", "near_coincident")


class CableCases(NamedTuple):
    """A batch of cables; the arrays of a batch have the same first axis.

    `across` and `along` are the distances of the ends across and against the load over L, a and b; `stretch`
    is wL/EA. `load` is short of the laws' LOAD_FLOOR: the load that they compute with is `full_load`.
    """

    stiffness: np.ndarray
    span: np.ndarray
    length: np.ndarray
    load: np.ndarray
    full_load: np.ndarray
    across: np.ndarray
    along: np.ndarray
    stretch: np.ndarray

    @property
    def arguments(self):
        return self.stiffness, self.span, self.length, self.load

    @property
    def weight(self):
        return np.linalg.norm(self.full_load, axis=1)

    @property
    def elongation(self):
        return np.hypot(self.across, self.along)


def draw_cables(kind, count, seed, stretch=(1e-12, 1.0)):
    """Return `count` cables of a kind, with wL/EA log-uniform between the two of `stretch`."""
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    elevation = np.arcsin(rng.uniform(-1.0, 1.0, count))  # against the load, uniform on the sphere
    sign = rng.choice([-1.0, 1.0], count)
    match kind:
        case "slack":
            e = rng.uniform(0.02, 0.97, count)
        case "near_taut":
            e = 1.0 + sign * 10.0 ** rng.uniform(-7.0, -2.0, count)
        case "taut":
            e = rng.uniform(1.0, 1.1, count)
        case "near_plumb":
            e = rng.uniform(0.1, 0.98, count)
            elevation = sign * (0.5 * np.pi - 10.0 ** rng.uniform(-3.5, -1.0, count))
        case _:
            e = 10.0 ** rng.uniform(-3.0, -1.0, count)
    across, along = e * np.cos(elevation), e * np.sin(elevation)
    length = 10.0 ** rng.uniform(0.2, 2.2, count)
    upward = rng.normal(size=(count, 3))
    upward /= np.linalg.norm(upward, axis=1, keepdims=True)
    aside = np.cross(upward, rng.normal(size=(count, 3)))
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    weight = 10.0 ** rng.uniform(-2.0, 1.5, count)
    ratio = 10.0 ** rng.uniform(*np.log10(stretch), count)
    full_load = -weight[:, None] * upward
    return CableCases(
        stiffness=weight * length / ratio,
        span=length[:, None] * (across[:, None] * aside + along[:, None] * upward),
        length=length,
        load=full_load - np.array([0.0, 0.0, LOAD_FLOOR]),
        full_load=full_load,
        across=across,
        along=along,
        stretch=ratio,
    )


@pytest.fixture(scope="session")
def cables():
    """Return `draw_cables`."""
    return draw_cables


@pytest.fixture(params=KINDS)
def cable_kind(request):
    """Return each kind of cable in turn."""
    return request.param
