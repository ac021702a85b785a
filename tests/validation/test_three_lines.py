"""A second vehicle from published sizes: the barrage balloon of `three_lines`, an ellipsoid on three lines.

Verifies: the vehicle file against what is printed (62 ft, 25 ft, 20 000 cubic feet; Lamb's table) and against closed
forms; trim against the equations of the elastic catenary solved by scipy; modes against spring and pendulum; a ship
without fins and without thrusters. Sources: named in the vehicle's file; Irvine, *Cable Structures* (1981), for the
catenary; Ernst (1965) for the stiffness of a sagging line. If it failed, another ship than Lotte on more lines than
one would rest, swing or fly somewhere else than it does.
"""

import numpy as np
import pytest
import scipy.integrate
import scipy.optimize

import tethership as ts
from tethership.spatial import rotation_matrix

LINES = ("north", "south_east", "south_west")
G, FOOT = 9.80665, 0.3048
HALF_LENGTH, RADIUS = 31.0 * FOOT, 12.5 * FOOT
WEIGHT, STIFFNESS = 0.077 * G, 980e3  # of the wire [N/m, N]
DISTANCE = 100.0  # of the anchors from the middle


def load(**changes):
    return ts.load_scenario("three_lines", {key.replace("__", "."): value for key, value in changes.items()})


def loads(scenario, point):
    """Return the named forces at a trim, ground axes [N], and what the cables do."""
    plant = scenario.system
    cables = plant.cable_states(0.0, point.state, plant.initial_lengths())
    rotation = np.asarray(rotation_matrix(point.state.attitude))
    named = plant.wrenches(0.0, point.state, point.command, cables)
    return {name: rotation @ np.asarray(wrench.force) for name, wrench in named.items()}, cables


def ring(scenario, point):
    """Return where the three lines meet [m], ground axes."""
    rotation = np.asarray(rotation_matrix(point.state.attitude))
    return np.asarray(point.state.position) + rotation @ np.asarray(scenario.system.cables[0].tether_point)


@pytest.fixture(scope="module")
def still():
    scenario = load(wind__speed=0.0)
    return scenario, ts.trim(scenario, throw=True)


# --- the file -----------------------------------------------------------------------------------------------------


def test_printed_size_and_printed_capacity_agree():
    """An ellipsoid of the printed length and diameter holds the printed capacity."""
    vehicle = load().config.vehicle
    ellipsoid = 4.0 / 3.0 * np.pi * HALF_LENGTH * RADIUS**2
    # "Approximately 62 feet" and a capacity of two digits: 1 ft of length is 1.6 %.
    assert vehicle.buoyancy.volume == pytest.approx(ellipsoid, rel=0.02)
    assert vehicle.buoyancy.volume == pytest.approx(20_000.0 * FOOT**3, rel=1e-12)
    assert (vehicle.hull.length, vehicle.hull.diameter) == pytest.approx((2 * HALF_LENGTH, 2 * RADIUS), rel=1e-12)


def test_apparent_mass_is_that_of_lambs_table():
    """Lamb (1918), R&M 623: k₁ 0.156, k₂ 0.763 at 2.51; 0.209, 0.702 at 2.00. Linear between them at 2.48."""
    apparent = load().system.ship.apparent_mass
    factors = np.asarray(apparent.translational) / float(apparent.volume)
    along, across = (np.interp(2.48, (2.0, 2.51), pair) for pair in ((0.209, 0.156), (0.702, 0.763)))
    # Three digits off by up to two in the last, and a chord of 0.51 used 0.03 from its end.
    np.testing.assert_allclose(factors, [along, across, across], atol=3e-3)


def shell_moments():
    """Return the squared radii of gyration of an evenly thick shell [m²], axial and transverse, and its area [m²]."""

    def band(t):
        slant = np.hypot(HALF_LENGTH * np.sin(t), RADIUS * np.cos(t))
        return 2.0 * np.pi * RADIUS * np.sin(t) * slant

    def mean(function):
        return scipy.integrate.quad(lambda t: band(t) * function(t), 0.0, np.pi)[0]

    area = mean(lambda t: 1.0)
    axial = mean(lambda t: (RADIUS * np.sin(t)) ** 2) / area
    along = mean(lambda t: (HALF_LENGTH * np.cos(t)) ** 2) / area
    return axial, 0.5 * axial + along, area


def test_mass_centre_and_inertia_are_those_of_the_parts_named_in_the_file():
    body = load().config.vehicle.body
    axial, transverse, area = shell_moments()
    fabric = area * 4.2 * 0.028349523 / 0.9144**2  # 4.2 oz/yd²
    helium = 20_000.0 * FOOT**3 * 101_325.0 * 4.0026e-3 / (8.31446 * 288.15)
    fins = [np.array([-7.7, 3.9 * np.cos(roll), 3.9 * np.sin(roll)]) for roll in np.radians([90.0, 210.0, 330.0])]
    payload = body.mass - fabric - helium - 30.0
    points = [(10.0, fin) for fin in fins] + [(payload, np.array([-2.5, 0.0, 4.2]))]
    assert payload == pytest.approx(120.5, abs=0.05)
    centre = sum(mass * place for mass, place in points) / body.mass
    inertia = np.diag([fabric * axial, fabric * transverse, fabric * transverse])
    long, wide = HALF_LENGTH**2, RADIUS**2
    inertia += helium / 5.0 * np.diag([2.0 * wide, long + wide, long + wide])
    inertia += sum(mass * (place @ place * np.eye(3) - np.outer(place, place)) for mass, place in points)
    # The file rounds to millimetres and to 0.1 kg m².
    np.testing.assert_allclose(body.centre_of_gravity, centre, atol=6e-4)
    np.testing.assert_allclose(body.inertia, inertia, atol=0.06)


# --- rest ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("formulation", ["consistent", "published"])
@pytest.mark.parametrize("wind", [0.0, 10.0, 20.0])
def test_lines_carry_free_lift_and_wind(wind, formulation):
    scenario = load(wind__speed=wind, formulation=formulation)
    point = ts.trim(scenario, throw=True)
    named, cables = loads(scenario, point)
    lines = sum(np.asarray(cable.ship) for cable in cables)
    rest = sum(force for name, force in named.items() if not name.startswith(("cable", *LINES)))
    np.testing.assert_allclose(lines + rest, 0.0, atol=1e-6)
    if wind == 0.0:
        free_lift = -named["buoyancy"][2] - named["gravity"][2]
        assert named["gravity"][2] == pytest.approx(300.0 * G, rel=1e-12)
        assert lines[2] == pytest.approx(free_lift, abs=1e-6)


def line_by_hand(pull_up, length):
    """Return horizontal pull [N] and height [m] of an elastic catenary with a given upward pull at its top.

    Irvine's equations with V at the top given: x = H L/EA + (H/w) (asinh V/H − asinh (V − wL)/H), and for z alike.
    """
    below = pull_up - WEIGHT * length

    def reach(across):
        curve = np.arcsinh(pull_up / across) - np.arcsinh(below / across)
        return across * length / STIFFNESS + across / WEIGHT * curve

    across = scipy.optimize.brentq(lambda h: reach(h) - DISTANCE, 1.0, 1e4, xtol=1e-11)
    height = (pull_up - 0.5 * WEIGHT * length) * length / STIFFNESS
    height += (np.hypot(across, pull_up) - np.hypot(across, below)) / WEIGHT
    return across, height


@pytest.mark.parametrize("length", [120.0, 150.0, 250.0])
def test_still_air_tension_by_hand(length):
    """Each line carries a third of the free lift upwards; its weight and stretch give the rest."""
    scenario = load(wind__speed=0.0, **{f"cables__{name}__length": length for name in LINES})
    point = ts.trim(scenario, throw=True)
    altitude = -float(point.state.position[2])
    density = 1.225 * (1.0 - 0.0065 * altitude / 288.15) ** (G / (287.053 * 0.0065) - 1.0)
    free_lift = (density * 20_000.0 * FOOT**3 - 300.0) * G
    across, height = line_by_hand(free_lift / 3.0, length)
    # ISA's constants as printed give ρ to 2e-6; times the 1.8 by which buoyancy exceeds free lift.
    np.testing.assert_allclose(point.tension, np.hypot(across, free_lift / 3.0), rtol=1e-5)
    np.testing.assert_allclose(point.tension, point.tension[0], rtol=1e-9)
    np.testing.assert_allclose(ring(scenario, point), [0.0, 0.0, -height], atol=1e-3)


def test_wind_from_three_sides_permutes_the_tensions():
    points = [ts.trim(load(wind__from_direction=np.radians(side)), throw=True) for side in (0.0, 120.0, 240.0)]
    for turn, point in enumerate(points):
        np.testing.assert_allclose(np.roll(point.tension, -turn), points[0].tension, rtol=1e-8)
        assert int(np.argmax(point.tension)) == turn  # the windward line
        assert np.degrees(point.state.attitude[2]) == pytest.approx(120.0 * turn, abs=1e-5)  # nose into the wind
        assert float(point.state.position[2]) == pytest.approx(float(points[0].state.position[2]), abs=1e-6)


def test_more_wind_slackens_the_lee_lines_and_tightens_the_other():
    """From the south the lee line is one; the balloon lifts more as it flies nose up, but drag wins there."""
    tension = np.array(
        [ts.trim(load(wind__speed=speed, wind__from_direction=np.pi)).tension for speed in (0.0, 5.0, 10.0, 15.0)]
    )
    assert (np.diff(tension[:, 0]) < 0).all()
    assert (np.diff(tension[:, 1]) > 0).all()


# --- motion -------------------------------------------------------------------------------------------------------


def test_still_air_modes_are_spring_and_pendulum(still):
    """Heave on three springs; roll about the ring, buoyancy above it and weight below; nothing damps, nothing turns."""
    scenario, point = still
    modes = ts.linearize(scenario, point).modes()
    values = modes.eigenvalues
    # Undamped: drag is quadratic. Yaw has neither spring nor damping: a double zero, split by rounding to its root.
    assert np.abs(values.real).max() < 1e-6
    assert np.sum(np.abs(values) < 1e-3) == 2
    ship, tension = scenario.system.ship, float(point.tension[0])
    density = float(scenario.system.environment.atmosphere.density(point.state.position[2]))
    span = np.hypot(DISTANCE, ring(scenario, point)[2])
    sine, cosine = -ring(scenario, point)[2] / span, DISTANCE / span
    sag = (WEIGHT * DISTANCE) ** 2 * STIFFNESS / (12.0 * tension**3)
    stretch = STIFFNESS / span / (1.0 + sag)  # Ernst
    spring = 3.0 * (stretch * sine**2 + tension / span * cosine**2)
    heavy = 300.0 + density * float(ship.apparent_mass.translational[2])
    heave = np.sqrt(spring / heavy)
    # Taken alone; the ring is 1 m ahead of B and 2.8 m ahead of G, so it pitches along: 3 %.
    assert modes.find("heave").frequency == pytest.approx(heave, rel=0.05)
    lever_b, lever_g = 8.0, 8.0 - 1.686
    restoring = G * (density * float(ship.buoyancy.volume) * lever_b - 300.0 * lever_g)
    about_ring = 3702.7 - 300.0 * 1.686**2 + 300.0 * lever_g**2
    about_ring += density * float(ship.apparent_mass.translational[1]) * lever_b**2
    # The ring held fast and no yaw along; both are there: 4 %.
    assert modes.find("side-slip").frequency == pytest.approx(np.sqrt(restoring / about_ring), rel=0.08)


@pytest.mark.parametrize("formulation", ["consistent", "published"])
def test_every_mode_is_damped_in_wind(formulation):
    for speed in (5.0, 10.0, 20.0):
        scenario = load(wind__speed=speed, formulation=formulation)
        values = ts.linearize(scenario, ts.trim(scenario, throw=True)).modes().eigenvalues
        assert values.real.max() < -0.05


def test_without_fins_the_hull_rests_but_turns_away():
    """No fins, no thrusters: everything works, and Munk's moment makes the heading diverge, as it should."""
    scenario = ts.load_scenario("three_lines", {"vehicle.fins": []})
    point = ts.trim(scenario, throw=True)
    assert scenario.system.ship.fins.count == scenario.system.ship.thrusters.count == 0
    values = ts.linearize(scenario, point).modes().eigenvalues
    assert np.sum(values.real > 0) == 1
    assert abs(values[np.argmax(values.real)].imag) < 1e-12


def test_lines_hold_it_through_a_gust():
    """Wind 10 m/s with a gust of 2.5 m/s across, held: it swings, comes back; the flight ends by its clock."""
    scenario = load()
    point = ts.trim(scenario, throw=True)
    flight = ts.dock(scenario, point, layers=())
    assert flight.outcome is ts.Outcome.time_limit
    track = flight.data["position"].values - np.asarray(point.state.position)
    assert 1.0 < np.abs(track).max() < 8.0  # it swings about the ring, which hangs 8 m below
    np.testing.assert_allclose(track[-1], 0.0, atol=1e-3)  # 45 s after: more than ten times the slowest mode's time
    assert flight.data["cable_length"].values == pytest.approx(150.0, abs=1e-12)
    assert flight.metrics["tension_max"] < 4000.0
