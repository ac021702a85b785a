"""Metrics of a flight in words, for tables. Depends on nothing."""

NAMES = {
    "tension_max": "largest tension [N]",
    "tension_mean": "mean tension [N]",
    "rewind_rate_min": "slowest rewind rate [m/s]",
    "seconds_above 144.3 N": "time above 144.3 N [s]",
    "seconds_above 481 N": "time above 481 N [s]",
    "seconds_above 2354 N": "time above 2354 N [s]",
    "seconds_above 3040 N": "time above 3040 N [s]",
    "docking_time": "docking time [s]",
    "ADC": "ADC [1/s]",
    "E": "E [-]",
    "theta_rms": "θ_RMS [deg]",
}
"""Those of Tables 3–6 of Riboldi et al. in words, with their units."""
