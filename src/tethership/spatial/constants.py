"""Constants of nature and of the standard atmosphere, SI units. Depends on nothing."""

STANDARD_GRAVITY = 9.80665
"""Gravity g [m/s²], uniform (ISO 80000-3)."""

SEA_LEVEL_TEMPERATURE = 288.15
"""ISA temperature at zero altitude [K] (ISO 2533)."""

SEA_LEVEL_PRESSURE = 101_325.0
"""ISA pressure at zero altitude [Pa] (ISO 2533)."""

TEMPERATURE_LAPSE = 0.0065
"""ISA temperature fall with altitude in the troposphere [K/m] (ISO 2533)."""

GAS_CONSTANT_AIR = 287.05287
"""Specific gas constant of dry air [J/(kg K)] (ISO 2533)."""

SEA_LEVEL_DENSITY = SEA_LEVEL_PRESSURE / (GAS_CONSTANT_AIR * SEA_LEVEL_TEMPERATURE)
"""ISA density at zero altitude ρ₀ [kg/m³], 1.225."""
