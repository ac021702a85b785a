"""Derivatives of eigenvalues, the trim moving along.

Truth: central differences of the eigenvalue of re-trimmed scenarios, which never see a derivative with respect to a
parameter.
If this fails, the ranked table sends a designer to the wrong number of the ship.
"""

import json
import sys

import numpy as np
import pytest

import tethership as ts
from tethership.analysis.loci.sensitivity import ordinary_step, rank_sensitivities
from tethership.cli import main


@pytest.fixture(scope="module")
def tables(docking, point):
    """Return the tables of pendulum, surge and roll."""
    return rank_sensitivities(docking, ["pendulum", "surge", "roll oscillation"], point)


@pytest.fixture(scope="module")
def pendulum(tables):
    return tables[0]


@pytest.fixture(scope="module")
def null_tables():
    """Return the tables of two null modes of a free ship."""
    return rank_sensitivities(ts.load_scenario("hover"), ["north", "heading"])


def rows(table):
    return {row.parameter: row for row in table.rows}


def retrimmed(scenario, values, mode):
    """Return a mode's eigenvalue of the scenario with values set, trimmed anew."""
    there = ts.scenario_at(scenario, values)
    return ts.linearize(there, ts.trim(there)).modes().find(mode).eigenvalue


@pytest.mark.parametrize(
    "name",
    [
        "wind.speed",
        "cables.nose.length",
        "cables.nose.tether_point.2",
        "vehicle.body.mass",
        "vehicle.body.inertia.1.1",
        "vehicle.fins.*.area",
        "vehicle.apparent_mass.k2",
        "trim.elongation",
        "cables.nose.diameter",
    ],
)
@pytest.mark.parametrize(("index", "mode"), [(0, "pendulum"), (1, "surge")])
def test_equals_the_difference_of_two_trims(docking, tables, name, index, mode):
    equals_the_difference(docking, tables[index], name, mode)


def test_a_tied_number_of_a_lateral_mode(docking, tables):
    # the product of inertia is two entries of a matrix, and moves the roll
    equals_the_difference(docking, tables[2], "vehicle.body.inertia.0.2", "roll oscillation")


def equals_the_difference(docking, table, name, mode):
    """Check one row against two trims."""
    row = rows(table)[name]
    step = 0.1 * row.step  # 0.1 % of the value: the third derivative leaves 1e-6 of the first, a trim 1e-9 of λ
    up, down = (retrimmed(docking, {name: row.value + sign * step}, mode) for sign in (1.0, -1.0))
    expected = (up - down) / (2.0 * step)
    assert abs(row.derivative - expected) < 1e-3 * abs(expected) + 1e-9 / row.step
    # the trim is felt: none of these derivatives is zero
    assert abs(expected) * row.step > 1e-8


def test_a_coefficient_of_the_hull_moves_against_the_one_that_closes_it(docking, pendulum):
    name, closing = "vehicle.hull.coefficients.1", "vehicle.hull.coefficients.5"
    row = rows(pendulum)[name]
    last = docking.config.vehicle.hull.coefficients[5]
    step = 0.1 * row.step
    up, down = (
        retrimmed(docking, {name: row.value + sign * step, closing: last - sign * step}, "pendulum")
        for sign in (1.0, -1.0)
    )
    assert row.derivative == pytest.approx((up - down) / (2.0 * step), rel=1e-3)
    assert closing not in rows(pendulum)  # alone it would open the tail


def test_what_does_not_touch_a_mode_is_zero(tables):
    # a product of inertia couples roll and yaw only; where a thruster sits changes its throttle, not the forces
    for table in tables[:2]:
        for name in ("vehicle.body.inertia.0.2", "vehicle.thrusters.tail_down.position.0"):
            assert abs(rows(table)[name].shift) < 1e-12


def test_rows_are_ranked_by_what_an_ordinary_step_does(tables):
    for table in tables:
        known = [row for row in table.rows if row.shift is not None]
        sizes = [abs(row.shift) for row in known]
        assert sizes == sorted(sizes, reverse=True)
        assert table.rows[: len(known)] == tuple(known)  # those without a derivative come last
        assert all(row.shift == row.derivative * row.step for row in known)
        assert np.isfinite(sizes).all()
        assert all(row.derivative is None for row in table.rows[len(known) :])


def test_every_number_that_matters_has_a_row(docking, pendulum):
    listed = ts.list_parameters(docking.config)
    for row in pendulum.rows:
        assert (row.value, row.unit) == (listed[row.parameter].value, listed[row.parameter].unit)
    present = set(rows(pendulum))
    tables_of_trim = ("vehicle.", "wind.", "cables.", "trim.")
    missing = {name for name in listed if name.startswith(tables_of_trim)} - present
    # what cannot change by itself, or does nothing to a trim
    allowed = ("direction", "coefficients.5", "breaking_force", "rewind_rate", "fastest_rate")
    assert all(any(word in name for word in allowed) for name in missing)
    assert not any(name.startswith(("control.", "gusts.", "limits.", "stop.", "start.")) for name in present)


def test_four_fins_together_are_the_sum_of_each(pendulum):
    found = rows(pendulum)
    each = [found[f"vehicle.fins.{name}.area"].derivative for name in ("fin_top", "fin_bottom", "fin_port")]
    each.append(found["vehicle.fins.fin_starboard.area"].derivative)
    # linear in the leaves: only rounding
    assert found["vehicle.fins.*.area"].derivative == pytest.approx(sum(each), rel=1e-9)


def test_port_and_starboard_are_alike(pendulum):
    found = rows(pendulum)
    for quantity in ("area", "efficiency", "aerodynamic_station"):
        port, starboard = (found[f"vehicle.fins.fin_{side}.{quantity}"].derivative for side in ("port", "starboard"))
        assert port == pytest.approx(starboard, rel=1e-6)  # symmetry; conditions of the trim up to 1e6


def test_wind_from_the_side_has_no_trim(tables):
    # six throttles cannot hold the ship against a wind from the side: no throttle pushes sideways
    for table in tables:
        row = rows(table)["wind.from_direction"]
        assert (row.derivative, row.shift) == (None, None)
        assert rows(table)["trim.bearing"].derivative is None
        assert rows(table)["wind.speed"].derivative is not None


def test_message_of_a_simple_eigenvalue(tables, docking, point):
    pendulum, surge, _ = tables
    modes = ts.linearize(docking, point).modes()
    assert (pendulum.mode, surge.mode) == ("pendulum", "surge–north")
    assert (pendulum.multiplicity, surge.multiplicity) == (1, 1)
    assert pendulum.message == "derivatives of the eigenvalue of pendulum"
    assert pendulum.eigenvalue == pytest.approx(modes.find("pendulum").eigenvalue, rel=1e-12)
    assert surge.eigenvalue == pytest.approx(modes.find("surge").eigenvalue, rel=1e-12)


def test_a_null_mode_has_the_derivative_of_the_mean(null_tables):
    for table, name in zip(null_tables, ("north", "heading"), strict=True):
        assert (table.mode, table.multiplicity) == (name, 3)
        assert table.message.startswith(f"{name} is one of 3 eigenvalues that coincide: none of them has a derivative")
        shifts = [row.shift for row in table.rows if row.shift is not None]
        assert len(shifts) > 100
        # a free ship stays a free ship whatever its numbers: three zeros, moved by rounding only
        assert np.abs(shifts).max() < 1e-9
        assert abs(table.eigenvalue) < 1e-9


def test_ordinary_steps(docking):
    known = ts.list_parameters(docking.config)
    steps = {
        "wind.speed": 0.06,
        "vehicle.body.inertia.0.2": 0.88,
        "vehicle.body.inertia.0.1": 0.01,  # a zero that is no length
        "cables.nose.tether_point.2": 0.16,  # a zero that is a length: 1 % of the hull's 16 m
        "trim.elevation": 0.01,
        "wind.from_direction": 0.01,
        "vehicle.hull.coefficients.3": 0.01,
    }
    for name, step in steps.items():
        assert ordinary_step(known[name], 16.0) == pytest.approx(step, rel=1e-12)


def test_wrong_input(docking, point):
    with pytest.raises(ts.ConfigError, match=r"there is no mode 'pendlum' here; did you mean 'pendulum'\?"):
        ts.sensitivities(docking, "pendlum", point)
    with pytest.raises(ts.SolveError, match=r"No equilibrium .*Without it there are no modes"):
        ts.sensitivities(docking, "pendulum", point._replace(outcome=ts.TrimOutcome.no_equilibrium))


def test_command(docking, pendulum, monkeypatch, capsys):
    # here and not with the other commands: it shares what was compiled above
    monkeypatch.setattr(sys, "argv", ["tethership", "modes", "--sensitivity", "pendulum", "--json"])
    with pytest.raises(SystemExit, match=r"^0$"):
        main()
    out, err = capsys.readouterr()
    table = json.loads(out)["sensitivity"]
    assert err == ""
    assert (table["mode"], table["multiplicity"], table["message"]) == ("pendulum", 1, pendulum.message)
    for shown, row in zip(table["rows"], pendulum.rows, strict=True):
        assert shown["parameter"] == row.parameter
        assert (shown["unit"], shown["value"], shown["step"]) == (row.unit, row.value, row.step)
        for key, value in (("derivative", row.derivative), ("shift", row.shift)):
            assert shown[key] == (None if value is None else [value.real, value.imag])


def test_no_derivative_at_a_corner():
    """A symmetric aerostat with its tether point moved sideways: λ goes as |h|, so there is no derivative.

    |v| of the fins' cross-flow has a corner at zero. Automatic differentiation would give one side's slope.
    """
    scenario = ts.load_scenario("aerostat", {"wind.speed": 9.0})
    table = ts.sensitivities(scenario, "side-slip")
    found = rows(table)
    for name in ("cables.nose.tether_point.1", "vehicle.buoyancy.centre.1"):
        assert (found[name].derivative, found[name].shift, found[name].reason) == (None, None, "corner")

    def eigenvalue(aside):
        here = ts.scenario_at(scenario, {"cables.nose.tether_point.1": aside})
        values = ts.linearize(here, ts.trim(here)).modes().eigenvalues
        return values[np.argmin(np.abs(values - table.eigenvalue))]

    here, port, starboard = (eigenvalue(aside) for aside in (0.0, -1e-3, 1e-3))
    assert port == pytest.approx(starboard, abs=1e-9)  # mirror images
    assert abs(port - here) > 3e-6  # measured 9.5e-6 for 1 mm: of first order
    # What is smooth keeps its derivative, and the docking's side force is told from a corner.
    assert found["vehicle.body.mass"].reason == ""
    assert found["vehicle.body.mass"].derivative is not None


def test_a_point_of_another_trim_is_refused(docking):
    """A trim's derivative depends on what it looks for: with other unknowns it is another question."""
    other = ts.trim(docking, unknowns=["throttle", "theta"], fixed={"theta": 0.02})
    with pytest.raises(ts.ConfigError, match="no answer to the scenario's own trim table"):
        ts.sensitivities(docking, "pendulum", other)
