"""The table of usual units says what pint says, to the last bit.

If this failed, a file would give another flight than before it was read without pint.
"""

import random

import pytest

from tethership.scenario.quantity import converted, in_unit, unit_registry
from tethership.scenario.units import PLAIN, USUAL, factor, to_base

RNG = random.Random(1)

NUMBERS = [
    0,
    1,
    -3,
    *(RNG.randint(-400, 400) for _ in range(100)),
    *(RNG.uniform(-360, 360) for _ in range(500)),
    *(10 ** RNG.uniform(-12, 12) for _ in range(500)),
]


@pytest.mark.parametrize("unit", USUAL)
def test_a_usual_unit_is_converted_as_pint_does(unit):
    si_unit, _ = USUAL[unit]
    by_pint = unit_registry().Quantity
    assert [converted(number, unit, si_unit) for number in NUMBERS] == [
        float(by_pint(number, unit).m_as(si_unit)) for number in NUMBERS
    ]
    assert to_base(unit) == float(by_pint(1.0, unit).to_base_units().magnitude)
    assert in_unit(2.5, "SI", unit) == 2.5 / to_base(unit)


@pytest.mark.parametrize("unit", PLAIN)
def test_a_plain_unit_is_its_own(unit):
    assert unit_registry().Quantity(1.0, {"1": "dimensionless"}.get(unit, unit)).to_base_units().magnitude == 1.0
    assert to_base(unit) == 1.0


def test_what_is_not_usual_is_left_to_pint():
    assert factor("deg", "m") is None
    assert factor("furlong", "m") is None
    assert converted(1.0, "furlong", "m") == pytest.approx(201.168, rel=1e-5)
    with pytest.raises(ValueError, match="which is no 'm'"):
        converted(1.0, "kN", "m")
