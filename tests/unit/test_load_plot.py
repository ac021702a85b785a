"""Loads are drawn with the flight's own numbers."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import tethership as ts
from tethership.errors import ConfigError


def lines(axes):
    return {line.get_gid(): line.get_ydata() for line in axes.lines}


def test_sizes(flight):
    drawn = lines(ts.plot_loads(flight))
    force = flight.data["load_force"]
    np.testing.assert_allclose(drawn["fins"], np.linalg.norm(force.sel(load="fins"), axis=1))
    net = force.sel(load="gravity") + force.sel(load="buoyancy")
    np.testing.assert_allclose(drawn["net_weight"], np.linalg.norm(net, axis=1))
    assert "gravity" not in drawn


def test_component_and_names(flight):
    axes = Figure().subplots()
    assert ts.plot_loads(flight, axes, "moment", "starboard", ["fins", "thrust"]) is axes
    drawn = lines(axes)
    assert set(drawn) == {"fins", "thrust"}
    wanted = flight.data["load_moment"].sel(load="fins", body_axis="starboard")
    np.testing.assert_array_equal(drawn["fins"], wanted)
    assert axes.get_ylabel() == "starboard component of moment about P [N m]"


def test_legend_is_sorted(flight):
    axes = ts.plot_loads(flight)
    strengths = [float(text.get_text().split("rms ")[1].removesuffix(" N")) for text in axes.get_legend().get_texts()]
    assert strengths == sorted(strengths, reverse=True)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"kind": "forces"}, "did you mean 'force'"),
        ({"component": "up"}, "forward, starboard, down"),
        ({"names": ["fin"]}, "did you mean 'fins'"),
    ],
)
def test_wrong_names(flight, given, message):
    with pytest.raises(ConfigError, match=message):
        ts.plot_loads(flight, **given)
