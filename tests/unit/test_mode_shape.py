"""A mode is drawn as its eigenvector moves the ship, from where it is seen best."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import tethership as ts
from tethership.errors import ConfigError
from tethership.view.linear.mode_shape import ATTITUDE, POSITION, REACH, mode_motion, plot_all_modes


@pytest.fixture(scope="module")
def model(docking, point):
    return ts.linearize(docking, point)


def eigenvector(model, value):
    """Return the eigenvector of an eigenvalue straight from A."""
    values, vectors = np.linalg.eig(model.A)
    return dict(zip(model.states, vectors[:, np.abs(values - value).argmin()], strict=True))


@pytest.mark.parametrize("name", ["pendulum", "surge", "heading", "vertical", "roll oscillation"])
def test_motion_is_the_eigenvector(model, name):
    mode = model.modes().find(name)
    motion, vector = mode_motion(model, mode), eigenvector(model, mode.eigenvalue)
    drawn = np.concatenate([motion.displacement, motion.turning])
    wanted = np.array([vector[state] for state in (*POSITION, *ATTITUDE)])
    scale = np.vdot(wanted, drawn) / np.vdot(wanted, wanted)
    np.testing.assert_allclose(drawn, scale * wanted, atol=1e-8 * np.abs(drawn).max())


@pytest.mark.parametrize("name", ["pendulum", "surge", "vertical"])
def test_largest_displacement_is_set(model, name):
    motion = mode_motion(model, model.modes().find(name))
    still = motion.ends(0.0)
    moved = [np.linalg.norm(motion.ends(np.exp(1j * phase)) - still, axis=1).max() for phase in np.linspace(0, 6.3, 50)]
    length = still[0, 0] - still[1, 0]
    assert max(moved) == pytest.approx(REACH * abs(length), rel=0.05)  # angles are finite, the scale is set once


@pytest.mark.parametrize(
    ("name", "words"),
    [("roll oscillation", "behind"), ("pendulum", "starboard"), ("side-slip", "above"), ("vertical", "starboard")],
)
def test_seen_from_where_it_moves(model, name, words):
    axes = ts.plot_modes(model, name)
    assert f"from {words}" in axes.get_xlabel()


def test_views_turn_with_the_ship():
    """An aerostat heads into the wind: seen along and across its heading, all winds show the same motion."""
    paths = []
    for direction in (0.0, np.pi / 2):
        scenario = ts.load_scenario("aerostat", {"wind.from_direction": direction})
        model = ts.linearize(scenario, ts.trim(scenario))
        axes = ts.plot_modes(model, "pendulum")
        paths.append({line.get_gid(): line.get_xydata() for line in axes.lines})
    for end in ("nose", "tail"):
        np.testing.assert_allclose(np.ptp(paths[0][end], axis=0), np.ptp(paths[1][end], axis=0), rtol=1e-5, atol=1e-6)


def test_axes_in_axes_out(model):
    axes = Figure().subplots()
    assert ts.plot_modes(model, "pendulum", axes, view="behind") is axes
    assert len(axes.patches) == 5 * 5  # rest and four ships, each a hull and four fins
    assert "period" in axes.get_title(loc="left")


def test_reduced_models_are_drawn(model):
    assert len(plot_all_modes(model.longitudinal()).axes) >= 3
    still = mode_motion(model.without_position(), model.without_position().modes().modes[0])
    np.testing.assert_array_equal(still.displacement, 0.0)


@pytest.mark.parametrize(
    ("name", "view", "message"),
    [("pendulun", None, "did you mean 'pendulum'"), ("pendulum", "left", "starboard, above, behind")],
)
def test_wrong_names(model, name, view, message):
    with pytest.raises(ConfigError, match=message):
        ts.plot_modes(model, name, view=view)


def test_a_bare_plant_has_no_shape(docking, point):
    bare = ts.linearize(docking.system, point)
    with pytest.raises(ConfigError, match="not made from a scenario"):
        ts.plot_modes(bare, bare.modes().names[0])
