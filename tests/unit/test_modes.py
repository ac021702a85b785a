"""Modes of matrices made by hand: names, groups, frequency, damping.

Truth: eigenvalues, Jordan blocks and names known by construction, and the formulas of a second-order oscillator.
If this fails, a mode is reported under another's name, a drift as an oscillation, or a triple zero of a free ship as
three numbers of rounding.
"""

import math

import numpy as np
import pytest

import tethership as ts
from tethership.analysis.modes.names import SLOTS, slots_of, track_names, unique
from tethership.analysis.modes.spectrum import analyse
from tethership.plant.state import STATE_NAMES

ALONE = {
    "u": "surge",
    "v": "side-slip",
    "q": "pitch subsidence",
    "r": "yaw subsidence",
    "psi": "heading",
    "north": "north",
    "east": "east",
    "down": "vertical",
}
"""What each state rules when it is coupled with nothing; θ with w and φ with p are below."""


def by_hand(matrix, states):
    """Return the linear model of a matrix, its states taken as comparable."""
    count = len(states)
    empty = np.zeros((count, 0))
    values = np.zeros(count), np.zeros(0)
    return ts.LinearModel(
        np.asarray(matrix, dtype=float), empty, tuple(states), (), ("",) * count, (), *values, np.eye(count), {}
    )


def oscillator(growth, frequency):
    """Return a companion matrix with the eigenvalues growth ± i·frequency."""
    return np.array([[2.0 * growth, -(growth**2 + frequency**2)], [1.0, 0.0]])


def blocks(*matrices):
    """Return the block-diagonal matrix."""
    size = sum(len(matrix) for matrix in matrices)
    result, at = np.zeros((size, size)), 0
    for matrix in matrices:
        result[at : at + len(matrix), at : at + len(matrix)] = matrix
        at += len(matrix)
    return result


def free_ship():
    """Return a free ship in small: surge and side-slip damped, heading ψ, north and east at zero, ψ moving east."""
    states = ("u", "v", "q", "psi", "north", "east")
    matrix = np.diag([-0.1, -0.4, -2.0, 0.0, 0.0, 0.0])
    matrix[5, 3] = 6.0
    return by_hand(matrix, states)


@pytest.fixture(scope="module")
def trimmed(docking, point):
    return ts.linearize(docking, point)


def test_decoupled_states_name_their_modes():
    values = dict(zip(ALONE, -np.arange(1.0, 9.0), strict=True))
    found = by_hand(np.diag(list(values.values())), ALONE).modes()
    assert {mode.name: mode.eigenvalue for mode in found.modes} == {ALONE[s]: values[s] for s in ALONE}


def test_all_twelve():
    found = by_hand(np.diag(-np.arange(1.0, 13.0)), STATE_NAMES).modes()
    names = {-mode.eigenvalue.real: mode.name for mode in found.modes}
    for place, state in enumerate(STATE_NAMES, start=1):
        if state in ALONE:
            assert names[place] == ALONE[state]
    assert {names[3], names[8]} == {"pendulum (slow)", "pendulum (fast)"}  # w and θ
    assert {names[4], names[7]} == {"roll (slow)", "roll (fast)"}  # p and φ
    assert found.names == [names[place] for place in range(12, 0, -1)]  # fastest first


@pytest.mark.parametrize(
    ("states", "name"),
    [
        (("u", "north"), "surge–north"),
        (("psi", "east"), "heading–east"),
        (("w", "theta"), "pendulum"),
        (("p", "phi"), "roll oscillation"),
        (("v", "r"), "yaw–side-slip"),
        (("q", "down"), "pitch–vertical"),
    ],
)
def test_an_oscillation_of_two_states(states, name):
    found = by_hand(oscillator(-0.05, 0.45), states).modes()
    assert found.names == [name]
    assert found.modes[0].oscillates
    assert by_hand(oscillator(-0.05, 0.45)[::-1, ::-1], states[::-1]).modes().names == [name]


def test_a_pair_that_broke_is_told_fast_from_slow():
    matrix = blocks([[-0.5, 0.1], [0.1, -3.0]], [[-0.2]])
    assert by_hand(matrix, ("phi", "p", "u")).modes().names == ["roll (fast)", "roll (slow)", "surge"]


def test_a_cables_length_has_a_slot_of_its_own():
    found = by_hand(np.diag([-1.0, 0.0]), ("u", "length_nose")).modes()
    assert found.names == ["surge", "length nose"]


def test_frequency_damping_and_times():
    (mode,) = by_hand(oscillator(-0.1, 0.5), ("u", "north")).modes().modes
    modulus = math.hypot(0.1, 0.5)
    # 1e-12: rounding of an eigenvalue of a 2×2 matrix of condition near 1
    assert mode.eigenvalue == pytest.approx(-0.1 + 0.5j, rel=1e-12)
    assert mode.frequency == pytest.approx(modulus, rel=1e-12)
    assert mode.damping == pytest.approx(0.1 / modulus, rel=1e-12)
    assert mode.half_or_double_time == pytest.approx(math.log(2.0) / 0.1, rel=1e-12)
    assert mode.period == pytest.approx(2.0 * math.pi / 0.5, rel=1e-12)
    assert (mode.stable, mode.oscillates, mode.null) == (True, True, False)
    assert sorted(mode.places) == [0, 1]


def test_growth():
    (mode,) = by_hand(oscillator(0.2, 0.5), ("u", "north")).modes().modes
    assert mode.damping == pytest.approx(-0.2 / math.hypot(0.2, 0.5), rel=1e-12)
    assert mode.half_or_double_time == pytest.approx(math.log(2.0) / 0.2, rel=1e-12)  # time to double: positive too
    assert not mode.stable


def test_real_modes():
    falling, growing = by_hand(np.diag([-0.5, 0.25]), ("u", "psi")).modes().modes
    assert (falling.damping, falling.period, falling.frequency) == (1.0, None, 0.5)
    assert (growing.damping, growing.period, growing.frequency) == (-1.0, None, 0.25)
    assert growing.half_or_double_time == pytest.approx(math.log(2.0) / 0.25, rel=1e-15)
    assert (falling.stable, growing.stable) == (True, False)


def test_an_undamped_oscillation_has_no_half_time():
    (mode,) = by_hand([[0.0, -2.0], [2.0, 0.0]], ("u", "north")).modes().modes
    assert mode.half_or_double_time is None
    assert mode.damping == 0.0
    assert not mode.null


def test_triple_zero_with_a_jordan_block():
    found = free_ship().modes()
    null = [mode for mode in found.modes if mode.null]
    assert sorted(mode.name for mode in null) == ["east", "heading", "north"]
    for mode in null:
        assert (mode.multiplicity, mode.defective, mode.damping, mode.stable) == (3, True, 0.0, False)
        assert mode.half_or_double_time is None
    assert all(mode.multiplicity == 1 and not mode.defective for mode in found.modes if not mode.null)
    group = found.spectrum.groups.index(next(g for g in found.spectrum.groups if len(g) == 3))
    assert found.spectrum.blocks[group] == 2  # eigenvectors: north and east; ψ has none
    # the projector on (ψ, north, east) is exact whatever the eigenvectors are: P² = P, PA = AP, trace 3
    projector = found.spectrum.projectors[group]
    np.testing.assert_allclose(projector, np.diag([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]), atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_triple_zero_in_any_order_of_states(seed):
    model = free_ship()
    order = np.random.default_rng(seed).permutation(6)
    found = model.select([model.states[i] for i in order]).modes()
    null = {mode.name: (mode.multiplicity, mode.defective) for mode in found.modes if mode.null}
    assert null == dict.fromkeys(("heading", "north", "east"), (3, True))


def test_a_repeated_zero_that_is_not_defective():
    found = by_hand(np.diag([-1.0, 0.0, 0.0]), ("u", "north", "east")).modes()
    assert [(m.name, m.multiplicity, m.defective) for m in found.modes if m.null] == [
        ("north", 2, False),
        ("east", 2, False),
    ]


def test_two_equal_oscillators_in_a_chain_are_defective():
    chain = blocks(oscillator(-0.05, 1.4), oscillator(-0.05, 1.4))
    chain[0, 2] = 1.0
    found = by_hand(chain, ("u", "north", "east", "psi")).modes()
    assert [(mode.multiplicity, mode.defective) for mode in found.modes] == [(2, True), (2, True)]
    # of a group the mean is given: rounding splits the pair by 1e-8, the mean is good to 1e-12
    assert found.modes[0].eigenvalue == pytest.approx(-0.05 + 1.4j, abs=1e-11)


@pytest.mark.parametrize("apart", [1e-1, 1e-3, 1e-6])
def test_neighbours_are_not_grouped(apart):
    spectrum = analyse(np.diag([-1.0, -1.0 - apart, -3.0]))
    assert [len(group) for group in spectrum.groups] == [1, 1, 1]
    assert spectrum.blocks == (1, 1, 1)
    np.testing.assert_array_equal(np.sort(spectrum.eigenvalues.real), [-3.0, -1.0 - apart, -1.0])


def test_a_trimmed_ship_on_its_cable_has_simple_eigenvalues(trimmed):
    spectrum = trimmed.modes().spectrum
    assert all(len(group) == 1 for group in spectrum.groups)
    total = sum(spectrum.projectors)
    np.testing.assert_allclose(total, np.eye(12), atol=1e-9)  # they resolve the identity; conditions up to 1e4


def test_a_free_ship_has_a_triple_zero():
    hover = ts.load_scenario("hover")
    found = ts.linearize(hover, ts.trim(hover)).modes()
    null = {mode.name: (mode.multiplicity, mode.defective) for mode in found.modes if mode.null}
    assert null == dict.fromkeys(("heading", "north", "east"), (3, True))


@pytest.mark.parametrize("seed", range(5))
def test_names_do_not_depend_on_the_order_of_states(trimmed, seed):
    order = np.random.default_rng(seed).permutation(12)
    shuffled = trimmed.select([STATE_NAMES[i] for i in order]).modes()
    for mode in trimmed.modes().modes:
        # a similarity by permutation changes the eigenvalues by rounding times their condition (below 1e4)
        assert shuffled.find(mode.name).eigenvalue == pytest.approx(mode.eigenvalue, abs=1e-10)
    assert sorted(shuffled.names) == sorted(trimmed.modes().names)


def test_modes_account_for_every_eigenvalue(trimmed):
    found = trimmed.modes()
    assert sorted(place for mode in found.modes for place in mode.places) == list(range(12))
    assert sum(2 if mode.oscillates else 1 for mode in found.modes) == 12
    for mode in found.modes:
        shape = np.array(list(mode.shape.values()))
        matrix = trimmed.comparable_matrix()
        # A v = λ v in comparable coordinates, largest entry 1
        np.testing.assert_allclose(matrix @ shape, mode.eigenvalue * shape, atol=1e-10)
        assert np.abs(shape).max() == pytest.approx(1.0, rel=1e-12)


def test_participation_of_decoupled_states():
    found = by_hand(blocks(np.diag([-1.0, -2.0]), [[-0.5, -3.0], [3.0, -0.5]]), ("u", "north", "v", "east")).modes()
    # the last block is normal: left and right eigenvectors agree, shares are halves
    np.testing.assert_allclose(found.spectrum.participation.sum(axis=0), 1.0, rtol=1e-12)
    shares = {mode.name: mode.participation for mode in found.modes}
    assert shares["surge"]["u"] == pytest.approx(1.0, rel=1e-12)
    assert shares["surge"]["north"] == pytest.approx(0.0, abs=1e-12)
    assert shares["side-slip–east"]["v"] == pytest.approx(0.5, rel=1e-12)


def test_participation_of_a_group_is_that_of_its_projector():
    found = free_ship().modes()
    for mode in found.modes:
        assert sum(mode.participation.values()) == pytest.approx(1.0, rel=1e-12)
    heading = next(mode for mode in found.modes if mode.name == "heading")
    assert heading.participation["psi"] == pytest.approx(1.0 / 3.0, rel=1e-12)


def test_find(trimmed):
    found = trimmed.modes()
    assert found.find("pendulum").name == "pendulum"
    assert found.find("surge").name == "surge–north"
    assert found.find("north") is found.find("surge")
    assert found.find("surge–north") is found.find("surge-north")  # a hyphen is easier to type
    with pytest.raises(ts.ConfigError, match=r"no mode 'pendlum' here; did you mean 'pendulum'\? There are: roll osc"):
        found.find("pendlum")
    with pytest.raises(ts.ConfigError, match=r"no mode 'phugoid' here\. There are: "):
        found.find("phugoid")


def test_every_state_has_a_slot():
    assert set(SLOTS) == set(STATE_NAMES)
    assert len(slots_of(STATE_NAMES)) == 12
    assert [slot.name for slot in slots_of(("down", "u"))] == ["surge", "vertical"]  # the order of modes, not of states


def test_tracks_have_names_of_their_own():
    names = track_names(STATE_NAMES)
    assert len(set(names)) == 12
    assert {"pendulum", "pendulum 2", "roll oscillation", "roll oscillation 2"} <= set(names)
    assert unique(["a", "b", "a", "a"]) == ["a", "b", "a 2", "a 3"]


@pytest.mark.parametrize("seed", range(5))
def test_triple_zero_in_other_coordinates(seed):
    # eigenvalues of the Jordan block come as ±1e-8 with a large slack, the third as 1e-16 with a small one: one group
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(6, 6)))
    spectrum = analyse(turn @ free_ship().A @ turn.T)
    assert sorted(len(group) for group in spectrum.groups) == [1, 1, 1, 3]


def test_an_empty_name_is_wrong_input(trimmed):
    with pytest.raises(ts.ConfigError, match="no mode ''"):
        trimmed.modes().find("")


def test_any_coalesced_name_may_be_typed_with_a_hyphen(trimmed):
    assert trimmed.modes().find("heading-east").name == "heading–east"
